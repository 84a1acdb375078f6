//! Every shader compiles, with and without evidence, and no GPU is needed to know.

use mirrorbench::gpu::Shaders;

#[test]
fn every_shader_compiles() {
    let mut shaders = Shaders::new(None).unwrap();
    let files = shaders.entry_files();
    assert!(files.len() > 5, "only {files:?}");
    let mut wrong = Vec::new();
    for file in &files {
        for defines in [&[][..], &[("RECORD_FULL", 1)]] {
            if let Err(error) = shaders.check(file, defines) {
                wrong.push(error.to_string());
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

//! Every shader compiles, with evidence, glass and a tree in parts or without, in compute and in
//! fragment form; no GPU is needed.

use mirrorbench::gpu::Shaders;

#[test]
fn every_shader_compiles() {
    let mut shaders = Shaders::new(None).unwrap();
    let files = shaders.entry_files();
    assert!(files.len() > 5, "only {files:?}");
    let mut wrong = Vec::new();
    for file in &files {
        let parts = [("TREE_PARTS", 1), ("NODES_OF_PART", 100), ("SLOTS_OF_PART", 50)];
        let fragment = [("STAGE_FRAGMENT", 1), ("RECORD_FULL", 1)];
        for defines in [
            &[][..],
            &[("RECORD_FULL", 1)],
            &[("GLASS", 1)],
            &[("RAY_QUERY", 1)],
            &parts,
            &fragment[..1],
            &fragment,
        ] {
            if let Err(error) = shaders.check(file, defines) {
                wrong.push(error.to_string());
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

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
        let on = |names: &[&'static str]| names.iter().map(|&name| (name, 1)).collect::<Vec<_>>();
        let revised = ["HIDDEN_CLIP", "PYRAMID", "START_PYRAMID", "POINT_NEWTON"];
        let [second, refracted, roots] = ["SECOND", "REFRACTED", "ROOTS_ALL"]
            .map(|define| on(&[&revised[..], &[define]].concat()));
        let morphed = ["RAY_MAP", "POINT_BUNDLE", "LEAVES_NEIGHBOURS", "WEIGHTS_VALID"];
        let [morphed, mixed, further] = ["RECORD_FULL", "TRACES_MIXED", "FURTHER"]
            .map(|define| on(&[&morphed[..], &[define]].concat()));
        let billboards = on(&[
            "BACKDROP",
            "MORPH",
            "FILTER_MIP",
            "ORIGIN_STORED",
            "LAST_DIFFUSE",
            "RECORD_FULL",
        ]);
        let revised_boards = on(&[
            "RELIEF",
            "ORIGIN_STORED",
            "FILTER_MIP",
            "RECORD_FULL",
            "BACKDROP",
            "MORPH",
            "FAR_DISTANCE",
            "BORDER_SHARP",
        ]);
        for defines in [
            &[][..],
            &[("RECORD_FULL", 1)],
            &[("GLASS", 1)],
            &[("RAY_QUERY", 1)],
            &[("RADIAL", 1)],
            &[("MISS_ENVIRONMENT", 1)],
            &[("MARCH", 1)],
            &[("SKINS", 1), ("RE_ANCHOR", 1), ("RECORD_FULL", 1)],
            &parts,
            &fragment[..1],
            &fragment,
            &second,
            &refracted,
            &roots,
            &morphed,
            &mixed,
            &further,
            &[("FURTHER", 1), ("THRICE", 1), ("RECORD_FULL", 1)],
            &billboards[..5],
            &billboards,
            &revised_boards[..3],
            &revised_boards,
            &[("FADES", 1), ("BY_ANGLE", 1)],
        ] {
            if let Err(error) = shaders.check(file, defines) {
                wrong.push(error.to_string());
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

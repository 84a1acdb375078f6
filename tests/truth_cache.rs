//! Traced frames are kept, and nothing but a whole one is ever taken back.

mod truth_support;

use std::fs;

use mirrorbench::truth::{Cache, Shapes, Tracer, TruthOptions};
use truth_support::{BALL, scene, tracer};

const SIZE: [u32; 2] = [40, 24];

#[test]
fn a_kept_frame_comes_back_bit_by_bit() {
    let scene = scene(BALL);
    let tracer = tracer(&scene, Shapes::Tessellated);
    let folder = tempfile::tempdir().unwrap();
    let cache = Cache::new(folder.path().join("new"));
    let traced = cache.frame(&tracer, SIZE).unwrap();
    assert_eq!(traced, tracer.frame(SIZE));
    let path = cache.path(&tracer, SIZE);
    let kept = fs::read(&path).unwrap();
    assert_eq!(cache.frame(&tracer, SIZE).unwrap(), traced);
    assert_eq!(fs::read(&path).unwrap(), kept);
    // Nothing else is left lying there.
    assert_eq!(fs::read_dir(folder.path().join("new")).unwrap().count(), 1);
}

#[test]
fn a_damaged_frame_is_traced_again_and_replaced() {
    let scene = scene(BALL);
    let tracer = tracer(&scene, Shapes::Tessellated);
    let folder = tempfile::tempdir().unwrap();
    let cache = Cache::new(folder.path());
    let traced = cache.frame(&tracer, SIZE).unwrap();
    let path = cache.path(&tracer, SIZE);
    let whole = fs::read(&path).unwrap();
    let flipped = |at: usize| {
        let mut bytes = whole.clone();
        bytes[at] ^= 1;
        bytes
    };
    let longer = [whole.as_slice(), &[0]].concat();
    let damages = [
        flipped(3),
        flipped(whole.len() / 2),
        flipped(whole.len() - 1),
        whole[..whole.len() - 5].to_vec(),
        longer,
        Vec::new(),
    ];
    for damaged in damages {
        fs::write(&path, damaged).unwrap();
        assert_eq!(cache.frame(&tracer, SIZE).unwrap(), traced);
        assert_eq!(fs::read(&path).unwrap(), whole);
    }
}

#[test]
fn whatever_changes_the_frame_changes_its_file() {
    let first = scene(BALL);
    let second = scene(&BALL.replace("[1.4, 0.5, 1.2]", "[1.4, 0.5, 1.3]"));
    let cache = Cache::new("folder");
    let with = |options| Tracer::new(&first, &first.at(0), options);
    let plain = TruthOptions::default();
    let mut turned = first.at(0);
    turned.camera.eye.x += 0.1;
    let paths = [
        cache.path(&with(plain), SIZE),
        cache.path(&with(plain), [40, 25]),
        cache.path(&with(TruthOptions { spp: 4, ..plain }), SIZE),
        cache.path(&with(TruthOptions { bounces: Some(1), ..plain }), SIZE),
        cache.path(&with(TruthOptions { shapes: Shapes::Analytic, ..plain }), SIZE),
        cache.path(&Tracer::new(&second, &second.at(0), plain), SIZE),
        cache.path(&Tracer::new(&first, &turned, plain), SIZE),
    ];
    for (index, path) in paths.iter().enumerate() {
        assert!(!paths[..index].contains(path));
    }
}

#[test]
fn a_folder_that_cannot_be_written_is_an_error_that_names_it() {
    let scene = scene(BALL);
    let tracer = tracer(&scene, Shapes::Tessellated);
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "not a folder").unwrap();
    let error = Cache::new(&file).frame(&tracer, SIZE).unwrap_err();
    assert_eq!(error.exit_code(), 6);
    assert!(error.to_string().contains(file.to_str().unwrap()));
}

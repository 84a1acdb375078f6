//! Pictures of reflection morphing (Martin & Popescu 2004): what they must agree with, and what is kept
//! from frame to frame and from run to run.

mod gpu_support;

use std::fs;

use assert_cmd::Command;
use glam::{Vec3, Vec4Swizzles};
use gpu_support::{Session, engine, frame, judged, options};
use mirrorbench::geometry::Camera;
use mirrorbench::scene::{self, CameraPath, FrameRecord, Scene, Status};

const SIZE: [u32; 2] = [128, 96];

/// `columns` seen from one place.
fn seen_from(eye: Vec3) -> Scene {
    let mut scene = scene::load("columns").unwrap();
    let camera = scene.camera.at(0.0);
    scene.camera = CameraPath::Keys(vec![(0.0, Camera { eye, ..camera })]);
    scene
}

/// The share of pixels of which two frames show the same point within so many metres, of those where
/// both show one.
fn agreement(a: &FrameRecord, b: &FrameRecord, within: f32) -> (usize, f64) {
    let found = |frame: &FrameRecord, i: usize| frame.record.ids[i].status() == Status::Found;
    let both: Vec<usize> =
        a.reflector_pixels().into_iter().filter(|&i| found(a, i) && found(b, i)).collect();
    let same = |i: &&usize| {
        let [p, q] = [a, b].map(|frame| frame.record.point[**i].xyz());
        p.abs_diff_eq(q, within)
    };
    let share = both.iter().filter(same).count() as f64 / both.len().max(1) as f64;
    (both.len(), share)
}

#[test]
fn at_a_node_the_picture_is_that_nodes_own() {
    // The node is one of both grids; all others are elsewhere.
    let (session, scene) = (Session::open(), seen_from(Vec3::new(0.0, 1.5, 4.0)));
    let [coarse, fine, apart] = [0.5, 0.25, 0.4].map(|cell| {
        let case = format!("reflection-morphing:map=96,files=none,cell={cell}");
        frame(&session, &scene, &case, SIZE, 0)
    });
    let (pixels, share) = agreement(&coarse, &fine, 1e-4);
    assert!(pixels > 300 && share > 0.97, "{share} of {pixels} pixels");
    let (_, share) = agreement(&coarse, &apart, 1e-4);
    assert!(share < 0.2, "{share} of the pixels, though no node is at the eye");
}

#[test]
fn from_cell_to_cell_nothing_jumps_that_both_know() {
    // The face's four nodes are both cells'. What one of the others does not see comes and goes.
    let session = Session::open();
    let case = "reflection-morphing:map=96,files=none";
    let [before, after, farther] = [0.4999, 0.5001, 0.54].map(|x| {
        let scene = seen_from(Vec3::new(x, 1.7, 3.8));
        frame(&session, &scene, case, SIZE, 0)
    });
    let (pixels, share) = agreement(&before, &after, 0.01);
    assert!(pixels > 300 && share > 0.97, "{share} of {pixels} pixels");
    let (_, share) = agreement(&before, &farther, 0.01);
    assert!(share < 0.8, "{share} of the pixels, 4 cm on");
}

#[test]
fn all_rays_find_what_leaves_miss() {
    let (session, scene) = (Session::open(), seen_from(Vec3::new(0.1, 1.6, 3.9)));
    let case = "reflection-morphing:map=64,files=none";
    let (leaf, by_leaf, _) = judged(&session, &scene, case, SIZE, 0);
    let brute = format!("{case},lookup=brute-force");
    let (all, by_all, _) = judged(&session, &scene, &brute, SIZE, 0);
    assert!(by_all.missing < 0.5 * by_leaf.missing, "{} of {}", by_all.missing, by_leaf.missing);
    // Where leaves find three rays, they are mostly near the nearest.
    let (pixels, share) = agreement(&leaf, &all, 0.1);
    assert!(pixels > 100 && share > 0.6, "{share} of {pixels} pixels");
}

#[test]
fn finer_maps_err_less() {
    let (session, scene) = (Session::open(), scene::load("columns").unwrap());
    let bad = [64, 128, 256, 512].map(|map| {
        let case = format!("reflection-morphing:files=none,map={map}");
        judged(&session, &scene, &case, SIZE, 0).1.bad_share.one
    });
    assert!(bad.is_sorted_by(|a, b| a > b), "{bad:?}");
    assert!(bad[0] > 2.0 * bad[3], "{bad:?}");
}

#[test]
fn still_vertices_are_looked_up_once_a_node() {
    let (session, scene) = (Session::open(), scene::load("columns").unwrap());
    let mut engine =
        engine(&session, &scene, "reflection-morphing:map=48,files=none", &options(SIZE));
    let mut look_ups = |at: u32| {
        let (drawn, times) = engine.frame(&scene.at(at), at == 1).unwrap();
        let counter = times.counters.iter().find(|(name, _)| name == "look-ups").unwrap().1;
        let built = times.passes.iter().any(|pass| pass.name == "reflection-morphing/octree");
        (drawn, counter, built)
    };
    // The eye goes on by 5 cm a frame along x, and is in the next cell at frame 10.
    let (_, first, built) = look_ups(1);
    // `prepare` has brought the first cell.
    assert!(!built);
    let (next, second, built) = look_ups(2);
    assert!(!built);
    // The cube alone moves.
    assert!(second > 0 && 200 * second < first, "{second} look-ups after {first}");
    let (crossed, third, built) = look_ups(10);
    assert!(built);
    // Both cells have four nodes in common.
    assert_eq!(third - second, (first - second) / 2);
    // What is kept is what would be found.
    for (at, kept) in [(2, next), (10, crossed)] {
        let cold = frame(&session, &scene, "reflection-morphing:map=48,files=none", SIZE, at);
        assert_eq!(cold, kept, "frame {at}");
    }
}

#[test]
fn each_mirror_has_its_own_rays() {
    let (session, scene) = (Session::open(), scene::load("two-spheres").unwrap());
    let case = "reflection-morphing:files=none";
    let (tested, accuracy, _) = judged(&session, &scene, case, SIZE, 0);
    for mirror in scene.reflectors() {
        let found = tested.reflector_pixels().into_iter().filter(|&i| {
            tested.reflector[i] == mirror && tested.record.ids[i].status() == Status::Found
        });
        assert!(found.count() > 60, "mirror {mirror}");
    }
    assert!(accuracy.bad_share.four < 0.35, "{accuracy:?}");
}

/// What the program says on stderr while it draws with octrees kept in a folder, and the picture.
fn render(folder: &std::path::Path) -> (String, Vec<u8>) {
    let mut command = Command::cargo_bin("mirrorbench").unwrap();
    let case = "reflection-morphing:map=32";
    command.env("MIRRORBENCH_CACHE", folder.join("cache"));
    command.args(["render", "--scene", "columns", "--case", case, "--size", "64x48"]);
    let done = command.arg("--out").arg(folder.join("out")).assert().success();
    let said = String::from_utf8(done.get_output().stderr.clone()).unwrap();
    (said, fs::read(folder.join("out/frame-0000.png")).unwrap())
}

#[test]
fn a_damaged_octree_is_built_anew_and_said_so() {
    let folder = tempfile::tempdir().unwrap();
    let (said, picture) = render(folder.path());
    assert!(!said.contains("built anew"), "{said}");
    let files = || {
        let entries = fs::read_dir(folder.path().join("cache")).unwrap();
        let mut paths: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
        paths.sort();
        paths
    };
    assert_eq!(files().len(), 8);
    let whole: Vec<_> = files().iter().map(|path| fs::read(path).unwrap()).collect();
    let (said, again) = render(folder.path());
    assert!(!said.contains("built anew") && again == picture, "{said}");
    // Cut short, a bit flipped, of another version.
    let paths = files();
    fs::write(&paths[1], &whole[1][..whole[1].len() / 2]).unwrap();
    for (file, at) in [(3, whole[3].len() / 2), (6, 8)] {
        let mut bytes = whole[file].clone();
        bytes[at] ^= 4;
        fs::write(&paths[file], bytes).unwrap();
    }
    let (said, rebuilt) = render(folder.path());
    assert_eq!(said.matches("built anew").count(), 3, "{said}");
    for (file, cause) in [(1, "checksum"), (3, "checksum"), (6, "another version")] {
        let name = paths[file].file_name().unwrap().to_str().unwrap();
        let line = said.lines().find(|line| line.contains(name)).unwrap();
        assert!(line.contains(cause), "{line}");
    }
    assert_eq!(rebuilt, picture);
    let now: Vec<_> = files().iter().map(|path| fs::read(path).unwrap()).collect();
    assert_eq!(now, whole);
}

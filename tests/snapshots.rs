//! Every method's picture against its last blessed one. `BLESS=1` writes the pictures and fails
//! the run, so that nobody blesses by accident; a missing or wrong-sized one fails too.

mod gpu_support;
mod snapshot_support;

use std::fs;
use std::path::{Path, PathBuf};

use gpu_support::{Session, frame};
use mirrorbench::experiment::frame_file::write_png;
use mirrorbench::scene;
use snapshot_support::{EDGE_SHARE, Picture, difference};

const SIZE: [u32; 2] = [96, 64];

/// Name, scene, case, frame.
const SNAPSHOTS: [(&str, &str, &str, u32); 19] = [
    ("columns-environment-map", "columns", "environment-map", 40),
    ("patow-room-environment-map", "patow-room", "environment-map", 0),
    ("patow-room-index-surface", "patow-room", "environment-map:index=surface", 0),
    ("kitchen-environment-map", "kitchen", "environment-map", 150),
    ("teapot-environment-map", "teapot", "environment-map", 0),
    ("glass-sphere-environment-map", "glass-sphere", "environment-map", 0),
    ("patow-room-z-buffered-map", "patow-room", "z-buffered-map", 0),
    ("patow-room-z-buffered-map-one-layer", "patow-room", "z-buffered-map:layers=1", 0),
    ("lecture-planar-mirror", "lecture", "planar-mirror", 0),
    ("columns-distance-impostor", "columns", "distance-impostor@revised", 40),
    ("columns-reflection-morphing", "columns", "reflection-morphing:files=none", 40),
    (
        "columns-reflection-morphing-revised",
        "columns",
        "reflection-morphing@revised:files=none,map=64,subdivide=0.5",
        40,
    ),
    (
        "two-spheres-reflection-morphing-eye",
        "two-spheres",
        "reflection-morphing@revised:nodes=eye,map=128,subdivide=0.5,bounces=2",
        40,
    ),
    ("lecture-screen-space", "lecture", "screen-space", 0),
    ("columns-explosion-map", "columns", "explosion-map@revised", 40),
    ("statue-depth-impostors", "statue", "depth-impostors@revised:size=128,step_deg=10", 600),
    ("glass-sphere-ray-traced", "glass-sphere", "ray-traced", 0),
    ("table-billboard-impostors", "table", "billboard-impostors:size=128,map=128", 0),
    ("hall-of-mirrors-ray-traced", "hall-of-mirrors", "ray-traced", 60),
];

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/snapshots")
}

/// Blesses, or says what differs.
fn check(session: &Session, name: &str, picture: &Picture, actual: &Path) -> Result<(), String> {
    let blessed_path = folder().join(format!("{name}.png"));
    let driver_path = folder().join("driver.txt");
    let info = session.device().info();
    let driver = format!("{}, {}", info.name, info.driver);
    if std::env::var_os("BLESS").is_some() {
        fs::create_dir_all(folder()).map_err(|e| e.to_string())?;
        fs::copy(actual, &blessed_path).map_err(|e| e.to_string())?;
        fs::write(driver_path, format!("{driver}\n")).map_err(|e| e.to_string())?;
        return Err(format!("blessed {name}"));
    }
    let Some(blessed) = Picture::read(&blessed_path) else {
        return Err(format!("{} is missing or no PNG", blessed_path.display()));
    };
    let same_driver = fs::read_to_string(driver_path).is_ok_and(|d| d.trim() == driver.trim());
    let edge_share = if same_driver { 0.0 } else { EDGE_SHARE };
    difference(&blessed, picture, edge_share)
        .map_err(|e| format!("{name}: {e}; see {}", actual.display()))
}

#[test]
fn pictures_are_as_blessed() {
    let session = Session::open();
    let actual_folder = std::env::temp_dir().join("mirrorbench-snapshots");
    fs::create_dir_all(&actual_folder).unwrap();
    let mut wrong = Vec::new();
    for (name, scene, case, at) in SNAPSHOTS {
        let scene = scene::load(scene).unwrap();
        let drawn = frame(&session, &scene, case, SIZE, at);
        let actual = actual_folder.join(format!("{name}.png"));
        write_png(&actual, drawn.size, &drawn.colour).unwrap();
        let picture = Picture::read(&actual).unwrap();
        match check(&session, name, &picture, &actual) {
            Ok(()) => fs::remove_file(actual).unwrap(),
            Err(difference) => wrong.push(difference),
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

//! What `virtual-objects` shows through one refracting surface, and `reflection-morphing` by rays at the eye,
//! against the truth.

mod gpu_support;
mod truth_support;

use gpu_support::{Session, frame};
use mirrorbench::measure::{self, Class};
use mirrorbench::scene::{FrameRecord, Scene, Status};
use mirrorbench::truth::Shapes;
use truth_support::{scene, tracer};

const SIZE: [u32; 2] = [160, 100];
const REVISED: &str = "virtual-objects@revised:subdivide=0.25";
const RAYS: &str = "reflection-morphing:nodes=eye,subdivide=0.05";

/// Water over a checkered bottom, a pole that stands in it, a box that lies in it.
const POOL: &str = r#"
[camera]
fov_deg = 45.0
eye = [0.4, 1.3, 3.0]
target = [0.0, -0.2, 0.0]
[[objects]]
name = "bottom"
shape = { plane = { size = [6.0, 6.0] } }
material = "floor"
position = [0.0, -1.0, 0.0]
[[objects]]
name = "water"
shape = { plane = { size = [3.0, 3.0] } }
material = "glass"
[[objects]]
name = "pole"
shape = { cylinder = { radius = 0.1, height = 2.0, slices = 48 } }
material = "red"
position = [-0.5, 0.0, 0.0]
[[objects]]
name = "box"
shape = { box = { size = [0.4, 0.4, 0.4] } }
material = "red"
position = [0.4, -0.7, 0.2]
rotation_deg = [0.0, 30.0, 0.0]
"#;

/// A checkered plate and a box, cast into a ball of glass.
const PAPERWEIGHT: &str = r#"
[camera]
fov_deg = 40.0
eye = [0.3, 1.2, 3.4]
target = [0.0, 0.0, 0.0]
[[objects]]
name = "ball"
shape = { sphere = { radius = 1.0, edge = 0.02 } }
material = "glass"
[[objects]]
name = "plate"
shape = { plane = { size = [1.0, 1.0] } }
material = "floor"
position = [0.0, -0.2, 0.0]
[[objects]]
name = "box"
shape = { box = { size = [0.3, 0.3, 0.3] } }
material = "red"
position = [0.1, 0.0, 0.1]
rotation_deg = [0.0, 30.0, 0.0]
"#;

fn with_index(text: &str, index: f32) -> Scene {
    let mut scene = scene(text);
    for glass in scene.materials.iter_mut().filter_map(|material| material.glass.as_mut()) {
        glass.index = index;
    }
    scene
}

/// Of the pixels where the truth sees a surface through one refraction: their number, the share that is bad at
/// a pixel, and the displacements of the others at the 95th percentile, pixels.
fn seen_through(session: &Session, scene: &Scene, case: &str, size: [u32; 2]) -> (usize, f64, f32) {
    let tested = frame(session, scene, case, size, 0);
    let tracer = tracer(scene, Shapes::Tessellated);
    let truth = tracer.frame(size);
    let (_, maps) = measure::accuracy(&truth, &tested, &tracer).unwrap();
    let pixels = through_one(&truth);
    let is_bad = |&&i: &&usize| maps.class[i] != Class::Placed || maps.displacement_px[i] > 1.0;
    let bad = pixels.iter().filter(is_bad).count() as f64 / pixels.len() as f64;
    let mut placed: Vec<f32> = pixels
        .iter()
        .filter(|&&i| maps.class[i] == Class::Placed)
        .map(|&i| maps.displacement_px[i])
        .collect();
    placed.sort_by(f32::total_cmp);
    (pixels.len(), bad, placed[placed.len() * 95 / 100])
}

fn through_one(truth: &FrameRecord) -> Vec<usize> {
    let ids = &truth.refracted.as_ref().unwrap().ids;
    let shows = |&i: &usize| ids[i].order() == 1 && ids[i].status() == Status::Found;
    (0..ids.len()).filter(shows).collect()
}

#[test]
fn one_surface_is_looked_through_as_snell_has_it() {
    let session = Session::open();
    for (text, index) in [(POOL, 1.0), (POOL, 1.33), (POOL, 2.4), (PAPERWEIGHT, 1.5)] {
        for case in [REVISED, RAYS] {
            let (pixels, bad, p95) = seen_through(&session, &with_index(text, index), case, SIZE);
            assert!(pixels > 900, "{index}: only {pixels} pixels");
            assert!(bad < 0.05 && p95 < 0.5, "{case}, {index}: {bad} bad, p95 {p95} px");
        }
    }
}

#[test]
fn only_the_revised_method_refracts() {
    let (session, scene) = (Session::open(), with_index(POOL, 1.33));
    let found = |case| {
        let record = frame(&session, &scene, case, SIZE, 0).refracted.unwrap();
        record.ids.iter().filter(|ids| ids.status() == Status::Found).count()
    };
    assert_eq!(found("virtual-objects"), 0);
    assert_eq!(found("reflection-morphing:files=none,map=8"), 0);
    assert!(found(REVISED) > 5000);
}

#[test]
#[ignore = "a minute: prints the table of paper-figures/estalella-2006/README.md"]
fn by_index() {
    let session = Session::open();
    for (name, text) in [("water", POOL), ("ball", PAPERWEIGHT)] {
        for index in [1.0, 1.1, 1.33, 1.5, 1.8, 2.1, 2.4] {
            let (pixels, bad, p95) =
                seen_through(&session, &with_index(text, index), REVISED, [320, 200]);
            println!("{name} {index}: {pixels} pixels, {:.2} % bad, p95 {p95:.3} px", 100.0 * bad);
        }
    }
}

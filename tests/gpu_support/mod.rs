//! What tests on a real device share: a session that fails when the validation layers speak up or
//! an object outlives it, and engines for small views.
#![allow(dead_code, reason = "each test file uses its own part")]

use std::sync::Arc;

use mirrorbench::experiment::engine::{Engine, Fallback, RecordMode, RunOptions};
use mirrorbench::gpu::{Device, ValidationLog};
use mirrorbench::measure::{self, Accuracy, Class, Maps};
use mirrorbench::methods::{Case, METHODS, MethodInfo};
use mirrorbench::scene::{self, FrameRecord, Moment, Scene};
use mirrorbench::truth::{Tracer, TruthOptions};

/// A device with validation and synchronization checks; its end is a check too.
pub struct Session {
    device: Option<Arc<Device>>,
    log: ValidationLog,
}

impl Session {
    /// No device is a failure, never a skip.
    pub fn open() -> Session {
        let device = Device::open("auto", true).expect("a Vulkan device with validation layers");
        let log = device.validation();
        Session { device: Some(device), log }
    }

    pub fn device(&self) -> &Arc<Device> {
        self.device.as_ref().unwrap()
    }

    /// What is wrong at the end: objects still alive, messages heard, leaks heard on destruction.
    pub fn faults(mut self) -> Vec<String> {
        self.take_faults()
    }

    fn take_faults(&mut self) -> Vec<String> {
        let Some(device) = self.device.take() else { return Vec::new() };
        let alive = Arc::strong_count(&device) - 1;
        drop(device);
        let mut faults = self.log.messages();
        if alive > 0 {
            faults.push(format!("{alive} objects are still alive"));
        }
        faults
    }
}

impl Drop for Session {
    fn drop(&mut self) {
        let faults = self.take_faults();
        if !std::thread::panicking() {
            assert!(faults.is_empty(), "{}", faults.join("\n"));
        }
    }
}

pub fn methods() -> Vec<&'static MethodInfo> {
    METHODS.iter().collect()
}

pub fn options(size: [u32; 2]) -> RunOptions {
    RunOptions {
        size,
        record: RecordMode::Full,
        fallback: Fallback::None,
        shader_dir: None,
        dump: None,
    }
}

pub fn engine(session: &Session, scene: &Scene, case: &str, options: &RunOptions) -> Engine {
    let case = Case::parse(case, &methods()).unwrap();
    Engine::new(session.device(), scene, &case, &methods(), options).unwrap()
}

/// One frame of a case, with full records.
pub fn frame(session: &Session, scene: &Scene, case: &str, size: [u32; 2], at: u32) -> FrameRecord {
    let mut engine = engine(session, scene, case, &options(size));
    engine.frame(&scene.at(at), true).unwrap().0
}

pub fn tracer<'s>(scene: &'s Scene, moment: &Moment) -> Tracer<'s> {
    Tracer::new(scene, moment, TruthOptions::default())
}

/// A frame of a case against the truth.
pub fn judged(
    session: &Session,
    scene: &Scene,
    case: &str,
    size: [u32; 2],
    at: u32,
) -> (FrameRecord, Accuracy, Maps) {
    let tested = frame(session, scene, case, size, at);
    let tracer = tracer(scene, &scene.at(at));
    let (accuracy, maps) = measure::accuracy(&tracer.frame(size), &tested, &tracer).unwrap();
    (tested, accuracy, maps)
}

/// A scene's text with every seed moved on.
pub fn reseeded(name: &str, by: u32) -> Scene {
    let text = std::fs::read_to_string(scene::scenes_dir().unwrap().join(format!("{name}.toml")));
    let text = text.unwrap();
    let mut parts = text.split("seed = ");
    let mut moved = parts.next().unwrap().to_owned();
    for part in parts {
        let end = part.find(',').unwrap();
        let seed: u32 = part[..end].parse().unwrap();
        moved += &format!("seed = {}{}", seed + 100 * by, &part[end..]);
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("reseeded.toml");
    std::fs::write(&path, moved).unwrap();
    scene::load(path.to_str().unwrap()).unwrap()
}

fn is_wrong(maps: &Maps, i: usize) -> bool {
    match maps.class[i] {
        Class::Outside | Class::Footprint => false,
        Class::Placed => maps.displacement_px[i] > 1.0,
        _ => true,
    }
}

/// Pixels that are wrong at a pixel, and those of them that carry no flag.
pub fn wrong(tested: &FrameRecord, maps: &Maps) -> [Vec<usize>; 2] {
    let all: Vec<usize> =
        tested.reflector_pixels().into_iter().filter(|&i| is_wrong(maps, i)).collect();
    let unflagged = all.iter().copied().filter(|&i| !tested.record.ids[i].flag()).collect();
    [all, unflagged]
}

/// What a mirror of some shape shows in a round room, seen from below its middle; `more` are further keys of it.
pub fn mirror_in_a_room(
    session: &Session,
    case: &str,
    size: [u32; 2],
    shape: &str,
    more: &str,
) -> FrameRecord {
    let text = format!(
        r#"
        about = "test"
        environment = {{ colour = [0.5, 0.6, 0.7] }}
        materials = {{ mirror = {{ mirror = {{ reflectance = 1.0 }} }}, room = {{ colour = [0.5, 0.5, 0.5] }} }}
        [camera]
        fov_deg = 40.0
        eye = [0.0, 0.4, 3.4]
        target = [0.0, 0.9, 0.0]
        [[objects]]
        name = "room"
        shape = {{ sphere = {{ radius = 6.0, slices = 96, stacks = 48 }} }}
        material = "room"
        [[objects]]
        name = "mirror"
        shape = {shape}
        {more}
        material = "mirror"
        position = [0.0, 1.0, 0.0]
        "#
    );
    let file = tempfile::Builder::new().suffix(".toml").tempfile().unwrap();
    std::fs::write(file.path(), text).unwrap();
    let scene = scene::load(file.path().to_str().unwrap()).unwrap();
    frame(session, &scene, case, size, 0)
}

//! What a method hears in bursts of whether a frame follows the one before.

mod gpu_support;

use std::sync::Mutex;

use gpu_support::{Session, options};
use mirrorbench::error::Result;
use mirrorbench::experiment::engine::Engine;
use mirrorbench::gpu::Frame;
use mirrorbench::methods::{Case, Changes, Family, MethodInfo, ReflectionMethod, Setup, Want};
use mirrorbench::scene::{self, Moment};
use mirrorbench::stages::{GpuScene, ReflectionRecord, View};

/// The frames a method was asked for, and whether each was a cut.
static HEARD: Mutex<Vec<(u32, bool)>> = Mutex::new(Vec::new());

static LISTENER: MethodInfo = MethodInfo {
    id: "listener",
    title: "Notes what it is asked for",
    paper: "none",
    family: Family::Baseline,
    depends: Changes { objects: false, reflectors: false, shading: false },
    flags: false,
    refracts: false,
    variants: &["published"],
    params: &[],
    limits: "",
    passes: &[],
    counters: &[],
    new: Some(|_: &Setup| Ok(Box::new(Listener))),
};

struct Listener;

impl ReflectionMethod for Listener {
    fn prepare(&mut self, _: &mut Frame, _: &GpuScene, _: &Want) -> Result<()> {
        Ok(())
    }

    fn reflect(
        &mut self,
        _: &mut Frame,
        scene: &GpuScene,
        view: &View,
        _: &mut ReflectionRecord,
    ) -> Result<()> {
        HEARD.lock().unwrap().push((scene.moment().frame, view.cut));
        Ok(())
    }
}

#[test]
fn a_frame_that_follows_the_one_before_it_is_no_cut() {
    let (session, scene) = (Session::open(), scene::load("columns").unwrap());
    let methods = [&LISTENER];
    let case = Case::parse("listener", &methods).unwrap();
    let mut engine =
        Engine::new(session.device(), &scene, &case, &methods, &options([64, 48])).unwrap();
    let moments = |frames: &[u32]| frames.iter().map(|&at| scene.at(at)).collect::<Vec<Moment>>();
    let mut burst = |frames: &[u32]| {
        engine.burst(&moments(frames)).unwrap();
        std::mem::take(&mut *HEARD.lock().unwrap())
    };
    assert_eq!(
        burst(&[3, 4, 5]),
        [(3, true), (4, false), (5, false)],
        "the first of all follows none"
    );
    assert_eq!(burst(&[6, 7]), [(6, false), (7, false)], "a burst may go on with the last");
    assert_eq!(burst(&[7, 7]), [(7, false); 2], "a frame drawn again is warm");
    assert_eq!(burst(&[9, 8]), [(9, true), (8, true)], "forward by one, or a cut");
    engine.frame(&scene.at(20), true).unwrap();
    engine.burst(&moments(&[21])).unwrap();
    assert_eq!(*HEARD.lock().unwrap(), [(20, true), (21, false)], "a frame read back counts too");
}

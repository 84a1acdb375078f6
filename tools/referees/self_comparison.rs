//! Whether ratios of times can be believed on the machine at hand: a case is benched against itself,
//! and against itself with a tenth more work, over and over.
//!
//!     cargo bench --bench self_comparison [-- REPEATS]
//!
//! 100 repeats take five minutes at most. Prints how often each verdict was given.

use std::sync::Arc;
use std::time::Duration;

use mirrorbench::error::{Error, Result};
use mirrorbench::experiment::clock::{self, ClockSource};
use mirrorbench::experiment::comparison::{Ratio, ratio};
use mirrorbench::experiment::engine::{Engine, Fallback, RecordMode, RunOptions};
use mirrorbench::experiment::timing::{TimingPlan, measure};
use mirrorbench::gpu::{Buffer, ComputePipeline, Device, Frame};
use mirrorbench::measure::ratio::Verdict;
use mirrorbench::measure::statistics::{median, percentile, sorted};
use mirrorbench::methods::{
    Case, Changes, Family, Kind, METHODS, MethodInfo, Param, ReflectionMethod, Setup, Want,
};
use mirrorbench::scene::{self, Moment};
use mirrorbench::stages::{GpuScene, ReflectionRecord, View};

const SCENE: &str = "patow-room";
const SIZE: [u32; 2] = [96, 72];
const FRAMES: u32 = 64;
/// Wall time for each of the three cases of a repeat, warm-up included.
const CAP: Duration = Duration::from_secs(1);
/// What the slowed case does beyond the others.
const BURDEN: f64 = 0.1;

/// The case that bears a burden.
const BORNE_BY: &str = "environment-map";

static BURDENED: MethodInfo = MethodInfo {
    id: "burdened",
    title: "Environment map, and work beside it that shows nowhere",
    paper: "none",
    family: Family::ImageSpace,
    depends: Changes::ALL,
    flags: false,
    refracts: false,
    variants: &["published"],
    params: &[Param {
        name: "iterations",
        kind: Kind::Integer { min: 0, max: 1 << 24 },
        defaults: &["0"],
        needs: None,
        doc: "loops of useless work in each of 4096 threads",
    }],
    limits: "of no use",
    passes: &["burdened/spin"],
    counters: &[],
    new: Some(burdened),
};

struct Burdened {
    bearer: Box<dyn ReflectionMethod>,
    spin: ComputePipeline,
    sink: Buffer,
    iterations: u32,
}

const THREADS: u32 = 4096;

fn burdened(setup: &Setup) -> Result<Box<dyn ReflectionMethod>> {
    let bearer = Case::parse(BORNE_BY, &methods())?;
    let info = METHODS.iter().find(|info| info.id == BORNE_BY).and_then(|info| info.new);
    let new = info.ok_or_else(|| Error::Usage(format!("no method {BORNE_BY}")))?;
    Ok(Box::new(Burdened {
        bearer: new(&Setup { values: &bearer.parts[0].values, ..*setup })?,
        spin: ComputePipeline::new(setup.device, "tests/spin.wgsl", &[])?,
        sink: Buffer::storage(setup.device, "sink", 4 * u64::from(THREADS))?,
        iterations: setup.values.u32("iterations"),
    }))
}

impl ReflectionMethod for Burdened {
    fn prepare(&mut self, frame: &mut Frame, scene: &GpuScene, want: &Want) -> Result<()> {
        self.bearer.prepare(frame, scene, want)
    }

    fn reflect(
        &mut self,
        frame: &mut Frame,
        scene: &GpuScene,
        view: &View,
        record: &mut ReflectionRecord,
    ) -> Result<()> {
        self.bearer.reflect(frame, scene, view, record)?;
        let pass = frame.pass("burdened/spin").compute(&self.spin);
        pass.uniform("params", &self.iterations).buffer("sink", &self.sink).over(THREADS)
    }
}

fn methods() -> Vec<&'static MethodInfo> {
    METHODS.iter().chain([&BURDENED]).collect()
}

/// What repeats share.
struct Bench {
    device: Arc<Device>,
    moments: Vec<Moment>,
}

impl Bench {
    fn engine(&self, iterations: u32) -> Result<Engine> {
        let options = RunOptions {
            size: SIZE,
            record: RecordMode::Radiance,
            fallback: Fallback::None,
            shader_dir: None,
            dump: None,
        };
        let case = Case::parse(&format!("burdened:iterations={iterations}"), &methods())?;
        Engine::new(&self.device, &scene::load(SCENE)?, &case, &methods(), &options)
    }

    /// The ratio of every engine but the first to the first; `None` where the cap came too soon.
    fn ratios(
        &self,
        engines: &mut [Engine],
        seed: u64,
        cap: Duration,
    ) -> Result<Vec<Option<Ratio>>> {
        let software = self.device.info().is_software;
        let clock = if software { ClockSource::Processor } else { ClockSource::Graphics };
        let plan = TimingPlan { repeat: None, seed, clock, cap, baseline: 0 };
        let timings = measure(engines, &self.moments, &plan, &mut |_| ())?;
        let first = ("itself", &timings[0]);
        Ok(timings[1..].iter().map(|timing| ratio(timing, first, seed)).collect())
    }

    /// How many iterations make a frame take a tenth longer: the burden grows until it is plain to
    /// see, and what it adds is in proportion.
    fn calibrate(&self) -> Result<u32> {
        let mut iterations = 64;
        loop {
            let mut engines = [self.engine(0)?, self.engine(iterations)?];
            let ratio = self.ratios(&mut engines, 0, 8 * CAP)?.remove(0);
            let added = ratio.map_or(0.0, |ratio| ratio.frame.median - 1.0);
            if added > 1.0 {
                return Ok((BURDEN / added * f64::from(iterations)).round() as u32);
            }
            if iterations > 1 << 21 {
                return Err(Error::Usage("no burden can be seen in the times".into()));
            }
            iterations *= 4;
        }
    }
}

fn main() -> Result<()> {
    // Cargo hands its own `--bench` on.
    let repeats = std::env::args().skip(1).find_map(|word| word.parse().ok()).unwrap_or(100);
    let device = Device::open("auto", false)?;
    let scene = scene::load(SCENE)?;
    let bench = Bench { device, moments: (0..FRAMES).map(|frame| scene.at(frame)).collect() };
    let iterations = bench.calibrate()?;
    let before = clock::load();
    let mut engines = [bench.engine(0)?, bench.engine(0)?, bench.engine(iterations)?];
    let ratios = (1..=repeats).map(|seed| bench.ratios(&mut engines, seed, CAP));
    let ratios = ratios.collect::<Result<Vec<_>>>()?;
    let info = bench.device.info();
    println!("{repeats} repeats: {BORNE_BY} on {SCENE}, {}x{}, {}", SIZE[0], SIZE[1], info.name);
    println!("load {before:?} before, {:?} after; {iterations} iterations", clock::load());
    report("itself", ratios.iter().filter_map(|pair| pair[0].as_ref()));
    report("slowed", ratios.iter().filter_map(|pair| pair[1].as_ref()));
    Ok(())
}

/// Verdicts, and the quartiles of ratio, width of the interval and rounds.
fn report<'r>(name: &str, ratios: impl Iterator<Item = &'r Ratio> + Clone) {
    use Verdict::{Faster, NoDifference, Slower, Undecided};
    let verdicts = [NoDifference, Slower, Faster, Undecided].map(|verdict| {
        let count = ratios.clone().filter(|ratio| ratio.frame.verdict == verdict).count();
        format!("{} {count}", verdict.text())
    });
    let middle = |value: fn(&Ratio) -> f64| {
        let values = sorted(&ratios.clone().map(value).collect::<Vec<_>>());
        [25.0, 50.0, 75.0].map(|percent| percentile(&values, percent).unwrap_or(f64::NAN))
    };
    let [low, ratio, high] = middle(|ratio| ratio.frame.median);
    let [_, width, widest] = middle(|ratio| 0.5 * (ratio.frame.ci95[1] - ratio.frame.ci95[0]));
    let rounds: Vec<f64> = ratios.clone().map(|ratio| ratio.rounds as f64).collect();
    println!("{name}: {}", verdicts.join(", "));
    println!("  ratio {ratio:.4} (quartiles {low:.4}..{high:.4})");
    println!("  half of the interval {width:.4} (upper quartile {widest:.4})");
    println!("  rounds {:.0}", median(&rounds).unwrap_or(f64::NAN));
}

//! What every command that draws shares: the device, opened when first needed, and the settings.

use std::cell::OnceCell;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use indicatif::ProgressBar;

use super::clock::ClockSource;
use super::engine::{Engine, Fallback, FrameTimes, RecordMode, RunOptions};
use super::frame_file::Provenance;
use super::results::{COMMIT, DeviceCard};
use crate::error::{Error, Result};
use crate::gpu::Device;
use crate::methods::{Case, MethodInfo, Selected};
use crate::scene::{FrameRecord, Moment, Scene};
use crate::truth::{Cache, Shapes, Tracer, TruthOptions};

/// The method that is the truth itself: traced on the CPU, never on a device.
pub const TRUTH: &str = "truth";

/// The user's choices that are the same for every scene and case of a command.
#[derive(Clone, Debug)]
pub struct Settings {
    pub device: String,
    pub validation: bool,
    pub size: [u32; 2],
    pub fallback: Fallback,
    /// What timed frames write.
    pub record: RecordMode,
    pub seed: u64,
    pub shader_dir: Option<PathBuf>,
    /// Passes whose images are written to the folder.
    pub dump: Option<(Vec<String>, PathBuf)>,
}

pub struct Lab<'m> {
    pub methods: &'m [&'static MethodInfo],
    pub settings: Settings,
    pub progress: ProgressBar,
    device: OnceCell<Arc<Device>>,
}

/// What draws the frames of one case.
pub enum Artist<'s> {
    /// Frames traced, and kept where there is a cache.
    Truth {
        scene: &'s Scene,
        options: TruthOptions,
        cache: Option<Cache>,
    },
    Engine(Box<Engine>),
}

impl<'m> Lab<'m> {
    pub fn new(
        methods: &'m [&'static MethodInfo],
        settings: Settings,
        progress: ProgressBar,
    ) -> Self {
        Lab { methods, settings, progress, device: OnceCell::new() }
    }

    pub fn device(&self) -> Result<&Arc<Device>> {
        if let Some(device) = self.device.get() {
            return Ok(device);
        }
        let device = Device::open(&self.settings.device, self.settings.validation)?;
        Ok(self.device.get_or_init(|| device))
    }

    /// An engine for one case, writing radiance or everything.
    pub fn engine(
        &self,
        scene: &Scene,
        case: &Case,
        size: [u32; 2],
        record: RecordMode,
    ) -> Result<Engine> {
        let options = RunOptions { dump: self.settings.dump.clone(), ..self.options(size, record) };
        Engine::new(self.device()?, scene, case, self.methods, &options)
    }

    /// How engines are set up; nothing is dumped.
    fn options(&self, size: [u32; 2], record: RecordMode) -> RunOptions {
        let Settings { fallback, ref shader_dir, .. } = self.settings;
        RunOptions { size, record, fallback, shader_dir: shader_dir.clone(), dump: None }
    }

    /// What draws full records of a case.
    ///
    /// # Errors
    /// [`Error::Usage`] for a hybrid with the truth in it: the truth knows no parts.
    pub fn artist<'s>(&self, scene: &'s Scene, case: &Case, size: [u32; 2]) -> Result<Artist<'s>> {
        match truth_options(case)? {
            Some(options) => Ok(Artist::Truth { scene, options, cache: Some(Cache::of_user()?) }),
            None => {
                let engine = self.engine(scene, case, size, RecordMode::Full)?;
                Ok(Artist::Engine(Box::new(engine)))
            }
        }
    }

    /// What draws a case beside another: it dumps nothing, for the dumps are the other's, and keeps no
    /// truths, for a film has many and needs each once.
    ///
    /// # Errors
    /// Those of [`Lab::artist`].
    pub fn companion<'s>(
        &self,
        scene: &'s Scene,
        case: &Case,
        size: [u32; 2],
    ) -> Result<Artist<'s>> {
        if let Some(options) = truth_options(case)? {
            return Ok(Artist::Truth { scene, options, cache: None });
        }
        let options = self.options(size, RecordMode::Full);
        let engine = Engine::new(self.device()?, scene, case, self.methods, &options)?;
        Ok(Artist::Engine(Box::new(engine)))
    }

    /// The device a case's row names.
    pub fn device_card(&self, case: &Case) -> Result<DeviceCard> {
        if case.uses(TRUTH) {
            return Ok(DeviceCard {
                name: "processor".into(),
                driver: "truth".into(),
                api: "none".into(),
                is_software: true,
            });
        }
        Ok(self.device()?.info().into())
    }

    pub fn clock_source(&self) -> Result<ClockSource> {
        let software = self.device()?.info().is_software;
        Ok(if software { ClockSource::Processor } else { ClockSource::Graphics })
    }

    pub fn provenance(&self, scene: &Scene, case: &Case, frame: u32) -> Result<Provenance> {
        Ok(Provenance {
            scene: scene.name.clone(),
            frame,
            case: case.text.clone(),
            commit: COMMIT.into(),
            device: self.device_card(case)?.name,
        })
    }

    /// Ends the work.
    ///
    /// # Errors
    /// [`Error::Validation`] where the validation layers said anything.
    pub fn close(self) -> Result<()> {
        let log = self.device.get().map(|device| device.validation());
        // The device goes first, so that leaks are heard too.
        drop(self.device);
        match log.map(|log| log.messages()).unwrap_or_default().as_slice() {
            [] => Ok(()),
            [first, rest @ ..] => Err(Error::Validation(format!(
                "Vulkan validation: {first}{}",
                if rest.is_empty() { String::new() } else { format!(" (and {} more)", rest.len()) }
            ))),
        }
    }
}

impl Artist<'_> {
    /// One frame with its full record. `cut`: the last call was not the frame before.
    pub fn frame(
        &mut self,
        moment: &Moment,
        size: [u32; 2],
        cut: bool,
    ) -> Result<(FrameRecord, FrameTimes)> {
        match self {
            Artist::Engine(engine) => engine.frame(moment, cut),
            Artist::Truth { scene, options, cache } => {
                let tracer = Tracer::new(scene, moment, *options);
                let kept = cache.as_ref().map(|cache| cache.frame(&tracer, size)).transpose()?;
                let frame = kept.unwrap_or_else(|| tracer.frame(size));
                Ok((frame, FrameTimes::default()))
            }
        }
    }
}

/// How the truth is traced, where the case is the truth.
fn truth_options(case: &Case) -> Result<Option<TruthOptions>> {
    match case.parts.as_slice() {
        [Selected { method: TRUTH, reflectors, values, .. }] if reflectors == "*" => {
            let analytic = values.is("shapes", "analytic");
            let shapes = if analytic { Shapes::Analytic } else { Shapes::Tessellated };
            let (spp, bounces) = (values.u32("spp"), values.u32("bounces"));
            // 0 is the scene's own.
            let bounces = (bounces > 0).then_some(bounces);
            Ok(Some(TruthOptions { spp, bounces, shapes }))
        }
        _ if case.uses(TRUTH) => Err(Error::Usage(format!(
            "case `{}`: the truth cannot be a part of a hybrid; valid: truth alone",
            case.text
        ))),
        _ => Ok(None),
    }
}

/// The folder of a scene and case where the user named none.
pub fn default_folder(scene: &Scene, case: &Case) -> PathBuf {
    Path::new("out").join(&scene.name).join(case.folder())
}

//! One case, set up on one device for one scene and size: draws frames, reads them back, times them.

use std::ops::Range;
use std::path::PathBuf;
use std::sync::Arc;

use glam::{Vec3, Vec4, Vec4Swizzles};
use half::f16;

use super::dump_file;
use super::part::{self, Part};
use crate::error::{Error, Result};
use crate::gpu::{Device, Frame, Recorded};
use crate::methods::{Case, Changes, MethodInfo, Want};
use crate::scene::{FrameRecord, Lobe, Moment, ObjectId, Scene};
use crate::stages::{
    CameraUniform, Composite, DirectView, FallbackStage, Filling, Footprint, GpuScene,
    ReflectionRecord, View,
};

pub use crate::gpu::PassTime;
pub use crate::stages::RecordMode;

/// Times of one frame.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrameTimes {
    /// Passes recorded by the method's `prepare`; empty when nothing it depends on moved.
    pub prepare: Vec<PassTime>,
    /// All other passes, in order; first those that bring surfaces into the moment's shape.
    pub passes: Vec<PassTime>,
    /// GPU milliseconds from the first timestamp to the last, without the time of `prepare`.
    pub frame_gpu_ms: f64,
    /// Bytes of device memory the prepared structures hold.
    pub prepare_bytes: u64,
    /// The method's counters, named as in its `MethodInfo`; empty without full records.
    pub counters: Vec<(String, u64)>,
}

/// What fills pixels the method left missing or flagged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Fallback {
    None,
    Environment,
    Ray,
}

impl Fallback {
    fn filling(self) -> Option<Filling> {
        match self {
            Fallback::None => None,
            Fallback::Environment => Some(Filling::Environment),
            Fallback::Ray => Some(Filling::Ray),
        }
    }
}

/// How an engine is set up.
#[derive(Clone, Debug)]
pub struct RunOptions {
    pub size: [u32; 2],
    pub record: RecordMode,
    pub fallback: Fallback,
    /// Read shaders from here instead of from the program.
    pub shader_dir: Option<PathBuf>,
    /// Write the stored images of passes that match a pattern into the folder, and the buffers of `PASS:VARIABLE`.
    pub dump: Option<(Vec<String>, PathBuf)>,
}

/// Draws a case.
pub struct Engine {
    device: Arc<Device>,
    frame: Frame,
    scene: GpuScene,
    direct: DirectView,
    footprint: Footprint,
    record: ReflectionRecord,
    /// What glass lets through, where there is any.
    refracted: Option<ReflectionRecord>,
    fallback: Option<FallbackStage>,
    /// The moment the fallback was last prepared for.
    fallback_prepared: Option<Moment>,
    composite: Composite,
    parts: Vec<Part>,
    options: RunOptions,
    /// Opposite corners of the box of all eyes of the scene's camera path.
    eyes: [Vec3; 2],
    prepare_bytes: u64,
    /// The frame drawn last.
    drawn: Option<u32>,
}

/// Where one frame's passes stand among those of a submit.
struct Recording {
    /// What the scene itself needs.
    scene: Range<usize>,
    prepare: Range<usize>,
    passes: Range<usize>,
}

impl Engine {
    /// Upload the scene, compile the pipelines.
    ///
    /// # Errors
    /// [`Error::Usage`] where the case does not fit the scene, or the scene asks for shadows;
    /// [`Error::Device`]
    /// where the scene is beyond the device's limits, [`Error::Shader`].
    pub fn new(
        device: &Arc<Device>,
        scene: &Scene,
        case: &Case,
        registry: &[&'static MethodInfo],
        options: &RunOptions,
    ) -> Result<Engine> {
        if scene.lighting.shadows {
            return Err(Error::Usage(format!(
                "scene {} asks for shadows, which only the truth casts; \
                 valid: the case truth, or a scene without",
                scene.name
            )));
        }
        if let Some(folder) = &options.shader_dir {
            device.read_shaders(folder)?;
        }
        let record = options.record.enough_for(scene);
        let options = &RunOptions { record, ..options.clone() };
        let (size, mode) = (options.size, record);
        let gpu_scene = GpuScene::new(device, &Arc::new(scene.clone()))?;
        let fallback = options.fallback.filling();
        let fallback =
            fallback.map(|filling| FallbackStage::new(device, &gpu_scene, filling, mode));
        let refracted =
            scene.refracts().then(|| ReflectionRecord::new(device, size, mode, case.parts.len()));
        let parts = part::make(device, &gpu_scene, case, registry, options)?;
        Ok(Engine {
            frame: Frame::new(device)?,
            direct: DirectView::new(device, size, mode)?,
            footprint: Footprint::new(device, size)?,
            record: ReflectionRecord::new(device, size, mode, case.parts.len())?,
            refracted: refracted.transpose()?,
            composite: Composite::new(device, &gpu_scene, size)?,
            eyes: eyes(scene),
            prepare_bytes: 0,
            drawn: None,
            fallback: fallback.transpose()?,
            fallback_prepared: None,
            parts,
            options: options.clone(),
            scene: gpu_scene,
            device: device.clone(),
        })
    }

    /// Draw one frame and read it back. `cut`: it does not follow the frame before.
    pub fn frame(&mut self, moment: &Moment, cut: bool) -> Result<(FrameRecord, FrameTimes)> {
        self.frame.count_invocations(true);
        if let Some((patterns, _)) = &self.options.dump {
            self.frame.dump_where(dump_file::filter(patterns));
        }
        self.frame.begin()?;
        let recording = self.record_frame(moment, cut)?;
        let recorded = self.frame.submit()?;
        if let Some((_, folder)) = &self.options.dump {
            for dump in &recorded.dumps {
                dump_file::write(folder, dump)?;
            }
        }
        let mut times = self.times(&recorded, &recording);
        times.counters = self.counters()?;
        Ok((self.read()?, times))
    }

    /// The work of the last frame, over all lobes, by the names of its parts and the fallback.
    fn counters(&self) -> Result<Vec<(String, u64)>> {
        let mut named = Vec::new();
        for (place, part) in self.parts.iter().enumerate() {
            let mut counts = self.record.counters(place)?;
            if let Some(refracted) = &self.refracted {
                for (count, more) in counts.iter_mut().zip(refracted.counters(place)?) {
                    *count += more;
                }
            }
            let of_part = part.counters.iter().cloned().zip(0..);
            // The fallback counts beside the first part.
            let with_fallback = place == 0 && self.fallback.is_some();
            let of_fallback = FallbackStage::COUNTERS.iter().filter(|_| with_fallback);
            let of_fallback = of_fallback.map(|name| (*name).to_owned());
            let places = of_part.chain(of_fallback.zip(FallbackStage::FIRST_COUNTER..));
            let count = |at: usize| counts.get(at).map(|&count| u64::from(count));
            named.extend(places.filter_map(|(name, at)| Some((name, count(at)?))));
        }
        Ok(named)
    }

    /// Draw frames in one submit, nothing read back: for timing. A frame is a cut unless the one
    /// before it was drawn last, here or by an earlier call; a frame drawn once more follows itself.
    pub fn burst(&mut self, moments: &[Moment]) -> Result<Vec<FrameTimes>> {
        self.frame.count_invocations(false);
        self.frame.begin()?;
        let recordings = moments
            .iter()
            .map(|moment| {
                let follows = |drawn| drawn == moment.frame || drawn + 1 == moment.frame;
                let cut = !self.drawn.is_some_and(follows);
                self.record_frame(moment, cut)
            })
            .collect::<Result<Vec<_>>>()?;
        let recorded = self.frame.submit()?;
        Ok(recordings.iter().map(|recording| self.times(&recorded, recording)).collect())
    }

    /// Record everything of one frame.
    fn record_frame(&mut self, moment: &Moment, cut: bool) -> Result<Recording> {
        let start = self.frame.scopes();
        self.scene.pose(&mut self.frame, moment)?;
        let posed = self.frame.scopes();
        self.prepare(moment)?;
        let prepared = self.frame.scopes();
        let camera = CameraUniform::new(&moment.camera, self.options.size);
        let (frame, scene) = (&mut self.frame, &self.scene);
        self.direct.draw(frame, scene, &camera, &self.footprint.depth_stencil)?;
        self.footprint.draw(frame, scene, &camera)?;
        let view = View {
            camera,
            size: self.options.size,
            direct: &self.direct,
            footprint: &self.footprint,
            reflectors: &[],
            lobe: Lobe::Reflected,
            cut,
        };
        let lobes =
            [(Lobe::Reflected, Some(&mut self.record)), (Lobe::Refracted, self.refracted.as_mut())];
        for (lobe, record) in lobes {
            let Some(record) = record else { continue };
            record.clear(frame)?;
            for (place, part) in self.parts.iter_mut().enumerate() {
                let Part { info, method, reflectors, glass, .. } = part;
                let asked: &[ObjectId] = match lobe {
                    Lobe::Reflected => reflectors,
                    Lobe::Refracted if info.refracts => glass,
                    Lobe::Refracted => &[],
                };
                if !asked.is_empty() {
                    record.count_for(place);
                    let view = View { reflectors: asked, lobe, ..view };
                    method.reflect(frame, scene, &view, record)?;
                }
            }
            if let Some(fallback) = &self.fallback {
                let all = scene.scene.with_lobe(lobe);
                let view = View { reflectors: &all, lobe, ..view };
                record.count_for(0);
                fallback.fill(frame, scene, &view, record)?;
            }
        }
        let refracted = self.refracted.as_ref();
        self.composite.run(frame, scene, &view, &self.record, refracted)?;
        let end = self.frame.scopes();
        self.drawn = Some(moment.frame);
        Ok(Recording { scene: start..posed, prepare: posed..prepared, passes: prepared..end })
    }

    /// Prepare the methods for which something they depend on moved.
    fn prepare(&mut self, moment: &Moment) -> Result<()> {
        for part in &mut self.parts {
            let changed = match &part.prepared {
                None => Changes::ALL,
                Some(before) => changes(&self.scene.scene, before, moment),
            };
            if part.prepared.is_some() && !changed.touches(part.info.depends) {
                continue;
            }
            let want = Want { changed, eyes: self.eyes, reflectors: &part.reflectors };
            let before = self.device.allocated_bytes();
            part.method.prepare(&mut self.frame, &self.scene, &want)?;
            let after = self.device.allocated_bytes();
            // What a later call frees, an earlier one had allocated.
            self.prepare_bytes = (self.prepare_bytes + after).saturating_sub(before);
            part.prepared = Some(moment.clone());
        }
        self.prepare_fallback(moment)
    }

    /// Prepare the fallback where it depends on what moved.
    fn prepare_fallback(&mut self, moment: &Moment) -> Result<()> {
        let Some(fallback) = self.fallback.as_mut().filter(|fallback| fallback.has_tree()) else {
            return Ok(());
        };
        let scene = &self.scene.scene;
        let moved = |before: &Moment| changes(scene, before, moment) != Changes::default();
        if self.fallback_prepared.as_ref().is_none_or(moved) {
            fallback.prepare(&mut self.frame, &self.scene)?;
            self.fallback_prepared = Some(moment.clone());
        }
        Ok(())
    }

    fn times(&self, recorded: &Recorded, recording: &Recording) -> FrameTimes {
        let of = |range: &Range<usize>| &recorded.passes[range.clone()];
        let span = |passes: &[PassTime]| {
            let mut gpu = passes.iter().filter(|pass| pass.cpu_ms == 0.0);
            let first = gpu.next();
            let last = gpu.next_back().or(first);
            first.zip(last).map_or(0.0, |(a, b)| b.begin_ms + b.gpu_ms - a.begin_ms)
        };
        let (scene, passes) = (of(&recording.scene), of(&recording.passes));
        FrameTimes {
            prepare: of(&recording.prepare).to_vec(),
            passes: [scene, passes].concat(),
            frame_gpu_ms: span(scene) + span(passes),
            prepare_bytes: self.prepare_bytes,
            counters: Vec::new(),
        }
    }

    /// The images of the last frame.
    fn read(&self) -> Result<FrameRecord> {
        let xyz = |v: Vec<Vec4>| v.into_iter().map(|v| v.xyz()).collect();
        let colour = self.composite.picture.read::<[f16; 4]>()?;
        Ok(FrameRecord {
            size: self.options.size,
            colour: colour
                .iter()
                .map(|c| Vec3::from([c[0], c[1], c[2]].map(f16::to_f32)))
                .collect(),
            depth: self.direct.depth.read()?,
            object: self.direct.object.read()?,
            reflector: self.footprint.reflector.read()?,
            position: xyz(self.footprint.position.read()?),
            normal: xyz(self.footprint.normal.read()?),
            record: self.record.read()?,
            refracted: self.refracted.as_ref().map(ReflectionRecord::read).transpose()?,
        })
    }
}

/// What moved between two moments. Light and environment do not move yet.
fn changes(scene: &Scene, before: &Moment, now: &Moment) -> Changes {
    let mut changed = Changes::default();
    for object in 0..scene.objects.len() as ObjectId {
        if scene.has_moved(object, before, now) {
            let mirror = scene.is_reflector(object);
            changed.reflectors |= mirror;
            changed.objects |= !mirror;
        }
    }
    changed
}

/// The box of all eyes of the camera path.
fn eyes(scene: &Scene) -> [Vec3; 2] {
    let eyes = (0..scene.frames.max(1)).map(|frame| scene.camera.at(frame as f32).eye);
    let start = [Vec3::INFINITY, Vec3::NEG_INFINITY];
    eyes.fold(start, |[low, high], eye| [low.min(eye), high.max(eye)])
}

//! Depth image impostors: reflected objects as depth images, and mirrored rays intersected with them along
//! one dimension (Popescu et al. 2006, slides 35 to 47).
//!
//! "Depth image-ray intersection: epipolar-like constraints: intersection computed as 1D search" (slide 36),
//! in `search=march`; and by simplified rotated depth maps (slides 37, 38): a ray is looked for in the one row
//! of the map rotated most nearly as it lies in the image. Rays go to each object's own space, so "rigid body
//! transformations, color updates, and reflector updates do not require reconstruction" (39).
//!
//! `@published` takes the row through the middle of the ray's part in the image, keeps the image that the
//! reflector saw first, and lets surfaces go on across silhouettes. `@revised` looks again in the row that
//! the ray is in where the first was hit, which ends most of what slide 46 shows; lets rays pass behind
//! silhouettes, and flags those that do; has a second image of each object from behind; builds on the
//! device, so that images can follow what moves; and lets a mirror see itself, in depth images of its own whose
//! stored normals send rays on ("self-reflections", slide 50).
//!
//! Choices the slides leave to us: what a depth is (such that lines stay straight), the rule of simplifying
//! (the worst of a row's pieces split at once), the ray's middle as where a row is chosen, what is a
//! silhouette (a fall ten times as deep as wide), and what has an impostor: whatever reflects nothing, those
//! that look largest from a reflector first (`objects`). What is flat, floors and walls, has one image along
//! its thinnest side, under parallel rays. What the scene calls its backdrop is shown by a map taken from the mirror's
//! middle, as billboards have it; `@revised` takes depth images of it too.

mod backdrop;
pub mod build;
mod params;
mod sitter;

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use crate::error::{Error, Result};
use crate::geometry::depth_rows::{DepthRows, Heights, Limits, RowShape, simplify};
use crate::gpu::{Device, Frame};
use crate::scene::{Moment, ObjectId};
use crate::stages::{
    CaptureStage, GpuScene, PixelPass, PortraitStage, PortraitView, Portraits, ReflectionRecord,
    Sight, View,
};

use super::{Changes, Family, MethodInfo, ReflectionMethod, Setup, Want};
use backdrop::Backdrop;
use build::{RowBuffers, RowBuilder};
use sitter::{Most, Sitter};

pub const INFO: MethodInfo = MethodInfo {
    id: "depth-impostors",
    title: "Depth image impostors: objects as depth images, rays searched for in simplified rotated rows",
    paper: "Popescu, Mei, Dauble & Sacks 2006, slides 35 to 47",
    family: Family::ImageSpace,
    depends: Changes::ALL,
    flags: true,
    refracts: true,
    variants: &["published", "revised"],
    params: params::PARAMS,
    limits: "what no image of an object shows is not there; more than one bounce only within one mirror (`own`); \
             objects beyond `objects`, and other reflectors, show what is far away",
    passes: &[
        "depth-impostors/portrait",
        "depth-impostors/heights",
        "depth-impostors/build",
        "depth-impostors/rows",
        "depth-impostors/rotate",
        "depth-impostors/simplify",
        "depth-impostors/portrait-light",
        "depth-impostors/capture-background",
        "depth-impostors/capture",
        "footprint/clear-list",
        "footprint/list",
        "depth-impostors/reflect",
    ],
    counters: &["rays", "degenerate", "rows", "segments", "texels", "self_met"],
    new: Some(new),
};

const NAME: &str = "depth-impostors";
/// Sides of images where no size is forced.
const SIZES: [u32; 6] = [512, 384, 256, 192, 128, 64];

/// WGSL `Impostors` of `shaders/depth_impostors/rows.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Impostors {
    size: u32,
    angles: u32,
    segments: u32,
    layers: u32,
    own: u32,
    bounces: u32,
}

/// Where rows are built.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Build {
    /// Not at all: the depth image is marched over.
    None,
    Processor,
    Device,
}

struct DepthImpostors {
    device: Arc<Device>,
    stage: PortraitStage,
    /// Takes backdrops.
    capture: CaptureStage,
    builder: RowBuilder,
    reflect: PixelPass,
    shape: RowShape,
    /// Mip levels of what images show.
    levels: u32,
    build: Build,
    sight: Sight,
    /// Images follow what moves.
    anew: bool,
    most: Most,
    /// Longest chain of reflections in one mirror.
    bounces: u32,
    groups: Vec<Group>,
}

/// The impostors that one group of reflectors sees.
struct Group {
    reflectors: Vec<ObjectId>,
    sitters: Vec<Sitter>,
    portraits: Portraits,
    rows: RowBuffers,
    /// What is shown beyond the impostors; where the scene has a backdrop.
    backdrop: Option<Backdrop>,
}

fn new(setup: &Setup) -> Result<Box<dyn ReflectionMethod>> {
    let (device, values) = (setup.device, setup.values);
    let march = values.is("search", "march");
    let most = Most {
        objects: values.u32("objects") as usize,
        views: values.u32("views"),
        own: values.u32("own"),
        mapped: values.is("backdrop", "map"),
    };
    let shape = shape(setup, march, most)?;
    let build = match values.get("build") {
        _ if march => Build::None,
        "cpu" => Build::Processor,
        _ => Build::Device,
    };
    let wobbling = !setup.scene.scene.wobbles.is_empty();
    if build == Build::Processor && wobbling && deforms(setup) {
        return refuse("build=cpu for what changes its shape; valid: build=gpu".to_owned());
    }
    let parallel = values.is("rays", "parallel");
    Ok(Box::new(DepthImpostors {
        device: device.clone(),
        stage: PortraitStage::new(device)?,
        capture: CaptureStage::new(device)?,
        builder: RowBuilder::new(device, shape)?,
        reflect: setup.pixel_pass("depth_impostors/reflect.wgsl", &defines(setup, most))?,
        shape,
        levels: if values.is("filter", "mip") { shape.size.ilog2() + 1 } else { 1 },
        build,
        sight: if parallel { Sight::Parallel } else { Sight::Central },
        anew: values.is("view", "now"),
        most,
        bounces: if most.own > 0 { setup.scene.scene.bounces } else { 1 },
        groups: Vec::new(),
    }))
}

/// What the shader that answers pixels is made with.
fn defines(setup: &Setup, most: Most) -> Vec<(&'static str, u32)> {
    let values = setup.values;
    let (again, filter) = (values.is("re_anchor", "on"), values.is("filter", "mip"));
    [
        ("MARCH", values.is("search", "march")),
        ("SKINS", values.is("silhouettes", "skins")),
        ("RE_ANCHOR", again),
        ("FINISH", again && values.is("finish", "image")),
        ("OWN", most.own > 0),
        ("FILTER_MIP", filter),
        ("NORMALS", most.own > 0 || filter),
        ("BACKDROP", sitter::has_backdrop(&setup.scene.scene, most)),
    ]
    .into_iter()
    .filter_map(|(define, on)| on.then_some((define, 1)))
    .collect()
}

/// The rows' shape: of the size forced, or the largest whose rows fit one buffer for every group of reflectors.
fn shape(setup: &Setup, march: bool, most: Most) -> Result<RowShape> {
    let (scene, values) = (&setup.scene.scene, setup.values);
    let angles = (180.0 / values.f32("step_deg")).round() as u32;
    let of = |size: u32| match march {
        true => RowShape { size, angles: 1, segments: 1 },
        false => RowShape { size, angles, segments: values.u32("segments") },
    };
    if let Some(size) = values.forced_u32("size") {
        if !size.is_multiple_of(8) {
            return refuse(format!("size={size}; valid: a multiple of 8"));
        }
        return Ok(of(size));
    }
    let layers_for = |(_, reflectors): (String, Vec<ObjectId>)| {
        sitter::sitters(scene, &reflectors, most).last().map_or(0, |sitter| sitter.layers.end)
    };
    let groups = scene.groups(&scene.reflectors());
    let layers = groups.into_iter().map(layers_for).max().unwrap_or(0);
    let limit = setup.device.storage_limit();
    let fits = |shape: &RowShape| u64::from(layers) * shape.bytes() <= limit;
    let mut shapes = SIZES.into_iter().map(of);
    Ok(shapes.find(fits).unwrap_or_else(|| of(SIZES[SIZES.len() - 1])))
}

/// Whether anything that may have an impostor wobbles.
fn deforms(setup: &Setup) -> bool {
    let scene = &setup.scene.scene;
    (0..scene.objects.len() as ObjectId).any(|o| scene.wobbles(o) && !scene.is_reflector(o))
}

fn refuse<T>(what: String) -> Result<T> {
    Err(Error::Usage(format!("{NAME}: {what}")))
}

impl ReflectionMethod for DepthImpostors {
    fn prepare(&mut self, frame: &mut Frame, scene: &GpuScene, want: &Want) -> Result<()> {
        if self.groups.is_empty() {
            for (name, reflectors) in scene.scene.groups(want.reflectors) {
                let group = self.group(&name, scene, reflectors)?;
                self.groups.push(group);
            }
        }
        let mut groups = std::mem::take(&mut self.groups);
        let built = groups.iter_mut().try_for_each(|group| {
            self.fill(frame, scene, group)?;
            let Group { reflectors, backdrop, .. } = group;
            let taken = |backdrop: &mut Backdrop| {
                backdrop.take(frame, scene, &self.capture, reflectors, want.changed.shading)
            };
            backdrop.as_mut().map_or(Ok(()), taken)
        });
        self.groups = groups;
        built
    }

    fn reflect(
        &mut self,
        frame: &mut Frame,
        scene: &GpuScene,
        view: &View,
        record: &mut ReflectionRecord,
    ) -> Result<()> {
        for Group { reflectors, sitters, portraits, rows, backdrop } in &self.groups {
            let RowShape { size, angles, segments } = self.shape;
            let layers = sitters.last().map_or(0, |sitter| sitter.layers.end);
            let own = sitters.iter().find(|sitter| sitter.own);
            let own = own.map_or(layers, |sitter| sitter.layers.start);
            let bounces = self.bounces;
            let impostors = Impostors { size, angles, segments, layers, own, bounces };
            let uniforms = frame.upload(&portraits.uniforms(scene))?;
            let limits: Vec<[f32; 2]> = (0..layers)
                .filter_map(|layer| portraits.view(layer))
                .map(|view| [sitter::limits(view, size).jump, sitter::texel(view, size)[1]])
                .collect();
            let limits = frame.upload(&limits)?;
            let name = "depth-impostors/reflect";
            self.reflect.run(frame, name, (scene, view), record, reflectors, |pass| {
                let pass = pass
                    .storage_struct("impostors", &impostors)
                    .sample("quads", &rows.quads)
                    .buffer("counts", &rows.counts)
                    .optional()
                    .buffer("segments", &rows.segments)
                    .optional()
                    .slice("portraits", uniforms)
                    .slice("layer_limits", limits);
                let pass = portraits.bind(pass);
                match backdrop {
                    None => pass,
                    Some(backdrop) => backdrop.bind(pass),
                }
            })?;
        }
        Ok(())
    }
}

impl DepthImpostors {
    fn group(&self, name: &str, scene: &GpuScene, reflectors: Vec<ObjectId>) -> Result<Group> {
        let sitters = sitter::sitters(&scene.scene, &reflectors, self.most);
        let layers = sitters.last().map_or(1, |sitter| sitter.layers.end);
        let backdrop = sitter::has_backdrop(&scene.scene, self.most).then(|| {
            let name = format!("backdrop of {name}");
            Backdrop::new(&self.device, &name, &scene.scene, &sitters)
        });
        let name = format!("depth impostors of {name}");
        Ok(Group {
            backdrop: backdrop.transpose()?,
            reflectors,
            sitters,
            portraits: Portraits::new(&self.device, &name, self.shape.size, layers, self.levels)?,
            rows: RowBuffers::new(&self.device, self.shape, layers)?,
        })
    }

    /// Take the images that are not as they should be, build their rows, and light them all.
    fn fill(&self, frame: &mut Frame, scene: &GpuScene, group: &mut Group) -> Result<()> {
        let stale = self.stale(scene, group);
        if self.build == Build::Processor && !stale.is_empty() {
            self.build_on_processor(frame, scene, group, &stale)?;
        } else {
            self.take(frame, scene, group, &stale)?;
            for &Stale { layer, limits, .. } in &stale {
                if self.build == Build::Device {
                    self.builder.build(frame, NAME, &group.rows, layer, limits)?;
                }
            }
        }
        self.stage.light(frame, scene, NAME, &group.portraits)
    }

    /// The layers that have to be taken again, and how they should look at their objects.
    fn stale(&self, scene: &GpuScene, group: &Group) -> Vec<Stale> {
        let start = scene.scene.at(0);
        let moment: &Moment = if self.anew { scene.moment() } else { &start };
        let eye: Vec3 = scene.scene.centre_of(moment, &group.reflectors);
        let mut stale = Vec::new();
        for (place, sitter) in group.sitters.iter().enumerate() {
            let deforms = sitter.objects.iter().any(|&object| scene.scene.wobbles(object));
            let moment = if deforms { scene.moment() } else { moment };
            let views = sitter.views(&scene.scene, moment, eye, self.sight);
            for (layer, view) in sitter.layers.clone().zip(views) {
                if deforms || group.portraits.view(layer) != Some(&view) {
                    let limits = sitter::limits(&view, self.shape.size);
                    stale.push(Stale { sitter: place, layer, view, limits });
                }
            }
        }
        stale
    }

    /// Take portraits and make depth images of them.
    fn take(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        group: &mut Group,
        stale: &[Stale],
    ) -> Result<()> {
        for &Stale { sitter, layer, view, .. } in stale {
            let target = (&mut group.portraits, layer);
            let objects = &group.sitters[sitter].objects;
            self.stage.take(frame, scene, NAME, target, objects, view)?;
        }
        let uniforms = frame.upload(&group.portraits.uniforms(scene))?;
        for &Stale { layer, .. } in stale {
            let taken = (&group.portraits, uniforms);
            self.builder.heights(frame, NAME, taken, (&group.rows, layer))?;
        }
        Ok(())
    }

    /// Rows built from depth images that are fetched first: passes before the one at hand have to have run,
    /// so these are submitted by themselves.
    fn build_on_processor(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        group: &mut Group,
        stale: &[Stale],
    ) -> Result<()> {
        let mut taking = Frame::new(&self.device)?;
        taking.begin()?;
        self.take(&mut taking, scene, group, stale)?;
        taking.submit()?;
        for &Stale { layer, limits, .. } in stale {
            let texels = group.rows.heights(layer)?;
            let rows = frame.cpu("depth-impostors/build", || {
                let heights = Heights { texels: &texels, size: self.shape.size };
                Ok(DepthRows::build(heights, self.shape, limits, simplify))
            })?;
            group.rows.copy(frame, NAME, layer, &rows)?;
        }
        Ok(())
    }
}

/// An image to be taken.
struct Stale {
    /// Its place in the group's list.
    sitter: usize,
    layer: u32,
    view: PortraitView,
    limits: Limits,
}

#[cfg(test)]
mod tests {
    use super::Impostors;
    use crate::gpu::layout::assert_layout;

    #[test]
    fn impostors_are_laid_out_as_their_wgsl_twin() {
        assert_layout!(
            "depth_impostors/reflect.wgsl",
            "Impostors",
            Impostors,
            size,
            angles,
            segments,
            layers,
            own,
            bounces
        );
    }
}

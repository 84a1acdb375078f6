//! The captured map: how it is taken, laid out and filtered.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use super::super::{Setup, Values};
use crate::error::Result;
use crate::gpu::{ComputePipeline, Device, Format, Frame, Image, Pass, Sampler, Shape};
use crate::scene::ObjectId;
use crate::stages::{
    Capture, CaptureStage, GpuScene, SceneTree, TreeKind, TreeLayout, TreeUpdate, shrink,
};

/// How directions are laid out in the map.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Projection {
    Cube,
    Sphere,
    LatLong,
}

impl Projection {
    fn of(values: &Values) -> Projection {
        match values.get("projection") {
            "sphere" => Projection::Sphere,
            "latlong" => Projection::LatLong,
            _ => Projection::Cube,
        }
    }

    fn defines(self) -> &'static [(&'static str, u32)] {
        match self {
            Projection::Cube => &[],
            Projection::Sphere => &[("FLAT_MAP", 1), ("PROJECTION_SPHERE", 1)],
            Projection::LatLong => &[("FLAT_MAP", 1), ("PROJECTION_LATLONG", 1)],
        }
    }

    /// Width and height of a flat map as fine, where it is finest, as a cube at the middle of its
    /// faces: there a texel spans 2/N radians in a cube of N texels, 4/D in a sphere map of D.
    fn flat_size(self, cube: u32) -> [u32; 2] {
        match self {
            Projection::Sphere => [2 * cube; 2],
            Projection::Cube | Projection::LatLong => [4 * cube, 2 * cube],
        }
    }
}

/// A map in one image: light, and each texel's own evidence as in a [`Capture`].
struct Flat {
    radiance: Image,
    point: Image,
    ids: Image,
}

/// The map of one group of reflectors.
pub struct Map {
    /// Where it is taken from.
    pub centre: Vec3,
    capture: Option<Capture>,
    flat: Option<Flat>,
}

impl Map {
    /// Light, point and ids.
    fn images(&self) -> Option<[&Image; 3]> {
        let flat = self.flat.as_ref().map(|flat| [&flat.radiance, &flat.point, &flat.ids]);
        let cube = || self.capture.as_ref().map(|cube| [&cube.radiance, &cube.point, &cube.ids]);
        flat.or_else(cube)
    }

    /// Bind what `environment_map::map` looks up.
    pub fn bind<'f>(&'f self, pass: Pass<'f>) -> Pass<'f> {
        let pass = pass.sampler("linear_filter", Sampler::Linear).optional();
        match self.images() {
            None => pass,
            Some([radiance, point, ids]) => pass
                .sample("map_radiance", radiance)
                .sample("map_point", point)
                .optional()
                .sample("map_ids", ids)
                .optional(),
        }
    }
}

/// WGSL `Ball` of `shaders/environment_map/ball.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct BallUniform {
    centre: [f32; 3],
    radius: f32,
}

/// What fills a map.
enum Source {
    Cube(CaptureStage),
    /// A cube, then resampled.
    Resampled(CaptureStage, ComputePipeline),
    Ball {
        pipeline: ComputePipeline,
        tree: SceneTree,
        radius: f32,
    },
}

/// Makes maps and fills them.
pub struct MapMaker {
    device: Arc<Device>,
    projection: Projection,
    /// Texels along a cube face's side.
    size: u32,
    source: Source,
    /// With mip maps only.
    shrink: Option<ComputePipeline>,
}

impl MapMaker {
    /// # Errors
    /// [`crate::error::Error::Device`] where the tree for a ball's rays is beyond the device.
    pub fn new(setup: &Setup) -> Result<MapMaker> {
        let (device, values) = (setup.device, setup.values);
        let projection = Projection::of(values);
        let defines = projection.defines();
        let pipeline = |file: &str| ComputePipeline::new(device, file, defines);
        let source = if values.is("source", "ball") {
            let kind = TreeKind::Binary(TreeUpdate::Refit);
            let layout = TreeLayout::new(&setup.scene.scene, kind, device.storage_limit())?;
            let defines = [defines, &layout.defines()].concat();
            Source::Ball {
                pipeline: ComputePipeline::new(device, "environment_map/ball.wgsl", &defines)?,
                tree: SceneTree::new(device, layout)?,
                radius: values.f32("ball_radius"),
            }
        } else if projection == Projection::Cube {
            Source::Cube(CaptureStage::new(device)?)
        } else {
            let resample = pipeline("environment_map/resample.wgsl")?;
            Source::Resampled(CaptureStage::new(device)?, resample)
        };
        let mips = values.is("filter", "mip");
        let shrink = mips.then(|| pipeline("stages/shrink.wgsl")).transpose()?;
        let (device, size) = (device.clone(), values.u32("size"));
        Ok(MapMaker { device, projection, size, source, shrink })
    }

    /// Shader definitions of what imports `environment_map::map`.
    pub fn defines(&self, values: &Values) -> Vec<(&'static str, u32)> {
        let mut defines = self.projection.defines().to_vec();
        match values.get("filter") {
            "nearest" => defines.push(("FILTER_NEAREST", 1)),
            "mip" => defines.push(("FILTER_MIP", 1)),
            _ => {}
        }
        defines
    }

    /// An empty map.
    pub fn make(&self, group: &str) -> Result<Map> {
        let name = format!("environment map of {group}");
        let levels = |size: [u32; 2]| match self.shrink {
            Some(_) => size[0].max(size[1]).ilog2() + 1,
            None => 1,
        };
        let capture = match self.source {
            Source::Ball { .. } => None,
            Source::Resampled(..) => Some(Capture::new(&self.device, &name, self.size)?),
            Source::Cube(_) => {
                let levels = levels([self.size; 2]);
                Some(Capture::with_levels(&self.device, &name, self.size, levels)?)
            }
        };
        let size = self.projection.flat_size(self.size);
        let image = |what: &str, format, levels| {
            let name = format!("{name} {what}");
            Image::with_levels(&self.device, &name, format, size, Shape::Flat, levels)
        };
        let flat = match self.projection {
            Projection::Cube => None,
            Projection::Sphere | Projection::LatLong => Some(Flat {
                radiance: image("radiance", Format::Rgba16Float, levels(size))?,
                point: image("point", Format::Rgba32Float, 1)?,
                ids: image("ids", Format::Rgba32Uint, 1)?,
            }),
        };
        Ok(Map { centre: Vec3::ZERO, capture, flat })
    }

    /// What all maps need of the moment before any is filled.
    pub fn prepare(&mut self, frame: &mut Frame, scene: &GpuScene) -> Result<()> {
        match &mut self.source {
            Source::Ball { tree, .. } => tree.prepare(frame, scene, "environment-map"),
            Source::Cube(_) | Source::Resampled(..) => Ok(()),
        }
    }

    /// Take the scene as seen from `centre`, some objects left out.
    pub fn fill(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        map: &mut Map,
        centre: Vec3,
        exclude: &[ObjectId],
    ) -> Result<()> {
        map.centre = centre;
        if let (Source::Cube(stage) | Source::Resampled(stage, _), Some(capture)) =
            (&self.source, &mut map.capture)
        {
            stage.capture(frame, scene, "environment-map", capture, centre, exclude)?;
        }
        if let (Source::Resampled(_, pipeline), Some(cube), Some(flat)) =
            (&self.source, &map.capture, &map.flat)
        {
            let pass = frame.pass("environment-map/resample").compute(pipeline);
            store(pass, flat)
                .sample("capture_radiance", &cube.radiance)
                .sample("capture_point", &cube.point)
                .sample("capture_ids", &cube.ids)
                .sampler("linear_filter", Sampler::Linear)
                .over_pixels(flat.radiance.size)?;
        }
        if let (Source::Ball { pipeline, tree, radius }, Some(flat)) = (&self.source, &map.flat) {
            let uniform = BallUniform { centre: centre.to_array(), radius: *radius };
            let selection = scene.selection(frame, exclude)?;
            let pass = frame.pass("environment-map/ball").compute(pipeline);
            let pass = tree.bind(scene.bind(pass)).slice("objects", selection);
            store(pass, flat).uniform("ball", &uniform).over_pixels(flat.radiance.size)?;
        }
        self.shrink(frame, map)
    }

    /// The mip levels of its light, each from the one before.
    fn shrink(&self, frame: &mut Frame, map: &Map) -> Result<()> {
        let (Some(pipeline), Some([radiance, ..])) = (&self.shrink, map.images()) else {
            return Ok(());
        };
        shrink(frame, pipeline, "environment-map", radiance)
    }
}

fn store<'f>(pass: Pass<'f>, flat: &'f Flat) -> Pass<'f> {
    pass.store("map_radiance", &flat.radiance)
        .store("map_point", &flat.point)
        .store("map_ids", &flat.ids)
}

#[cfg(test)]
mod tests {
    use super::BallUniform;
    use crate::gpu::layout::assert_layout;

    #[test]
    fn the_ball_is_laid_out_as_its_wgsl_twin() {
        assert_layout!("environment_map/ball.wgsl", "Ball", BallUniform, centre, radius);
    }
}

//! Flat mirrors: the scene mirrored in their plane and drawn through the stencil
//! (Diefenbach & Badler 1997; McReynolds & Blythe 1997). Exact, so it anchors the measures.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use super::{Changes, Family, MethodInfo, ReflectionMethod, Setup, Want};
use crate::error::{Error, Result};
use crate::gpu::{Attachments, Depth, Frame, GraphicsPipeline, Load, Stencil};
use crate::scene::{Moment, ObjectId, Scene};
use crate::stages::{Footprint, GpuScene, MirroredEnvironment, ReflectionRecord, View};

pub const INFO: MethodInfo = MethodInfo {
    id: "planar-mirror",
    title: "Planar mirror",
    paper: "Diefenbach & Badler 1997; McReynolds & Blythe 1997",
    family: Family::FeedForward,
    depends: Changes { objects: false, reflectors: false, shading: false },
    flags: false,
    refracts: false,
    variants: &["published"],
    params: &[],
    limits: "flat reflectors only; one bounce",
    passes: &[
        "footprint/clear-list",
        "footprint/list",
        "planar-mirror/background",
        "planar-mirror/mirrored",
    ],
    counters: &[],
    new: Some(new),
};

/// How far a flat mirror's vertices may lie from its plane, as a share of its size.
const FLATNESS: f32 = 1e-5;

/// WGSL `Plane` of `shaders/planar_mirror/mirrored.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub struct PlaneUniform {
    normal: [f32; 3],
    offset: f32,
    object: u32,
    pad_a: u32,
    pad_b: u32,
    pad_c: u32,
}

struct PlanarMirror {
    background: MirroredEnvironment,
    mirrored: GraphicsPipeline,
}

fn new(setup: &Setup) -> Result<Box<dyn ReflectionMethod>> {
    let scene = &*setup.scene.scene;
    for &object in setup.reflectors {
        plane(scene, setup.scene.moment(), object)?;
    }
    let defines = setup.mode.defines();
    let attachments = Attachments {
        colours: setup.mode.formats(),
        depth_stencil: true,
        depth: Depth::Nearest,
        stencil: Stencil::Within,
    };
    let (device, file) = (setup.device, "planar_mirror/mirrored.wgsl");
    Ok(Box::new(PlanarMirror {
        background: MirroredEnvironment::new(device, setup.mode)?,
        mirrored: GraphicsPipeline::new(device, file, &defines, &attachments)?,
    }))
}

/// The plane of a flat reflector: unit normal, and its dot product with the plane's points.
fn plane(scene: &Scene, moment: &Moment, object: ObjectId) -> Result<(Vec3, f32)> {
    let mesh = scene.mesh_at(moment, object);
    let pose = &moment.poses[object as usize];
    let normal = pose.transform_vector3(mesh.normals[0]).normalize();
    let points = || mesh.positions.iter().map(|&p| pose.transform_point3(p));
    let (low, high) = points().fold((f32::MAX, f32::MIN), |(low, high), p| {
        let height = p.dot(normal);
        (low.min(height), high.max(height))
    });
    let (corner, opposite) = scene.bounds_of(moment, &[object]);
    if high - low > FLATNESS * corner.distance(opposite) {
        return Err(Error::Usage(format!(
            "planar-mirror needs flat reflectors; `{}` is {:.3} m deep across its plane",
            scene.objects[object as usize].name,
            high - low
        )));
    }
    Ok((normal, 0.5 * (low + high)))
}

impl ReflectionMethod for PlanarMirror {
    fn prepare(&mut self, _: &mut Frame, _: &GpuScene, _: &Want) -> Result<()> {
        Ok(())
    }

    fn reflect(
        &mut self,
        frame: &mut Frame,
        scene: &GpuScene,
        view: &View,
        record: &mut ReflectionRecord,
    ) -> Result<()> {
        self.background.fill(frame, scene, "planar-mirror", view, record)?;
        for &object in view.reflectors {
            let (mut normal, mut offset) = plane(&scene.scene, scene.moment(), object)?;
            // A mirror shows the side its viewer is on.
            if view.camera.eye().dot(normal) < offset {
                (normal, offset) = (-normal, -offset);
            }
            let uniform =
                PlaneUniform { normal: normal.to_array(), offset, object, ..Zeroable::zeroed() };
            let pass = frame.pass("planar-mirror/mirrored").graphics(&self.mirrored);
            let pass = record.attach(view.bind(scene.bind(pass)));
            let depth = Load::Clear([0.0; 4]);
            pass.uniform("plane", &uniform)
                .depth_stencil(&view.footprint.depth_stencil, depth, Load::Keep)
                .draw(|draw| {
                    draw.stencil_reference(Footprint::stencil_of(object));
                    scene.draw(draw, |other| other != object);
                })?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::PlaneUniform;
    use crate::gpu::layout::assert_layout;

    #[test]
    #[rustfmt::skip]
    fn the_plane_is_laid_out_as_its_wgsl_twin() {
        assert_layout!("planar_mirror/mirrored.wgsl", "Plane", PlaneUniform,
            normal, offset, object, pad_a, pad_b, pad_c);
    }
}

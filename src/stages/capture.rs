//! The captured map: the scene as seen from a point, in six faces, with each texel's own point.
//! A texel shows what its centre sees.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec3, Vec4};

use super::GpuScene;
use crate::error::Result;
use crate::geometry::cube;
use crate::gpu::{
    Attachments, Depth, Device, Format, Frame, GraphicsPipeline, Image, Load, Shape, Stencil,
};
use crate::scene::ObjectId;

/// Nearest depth captured, metres.
const NEAR: f32 = 1e-3;

const FORMATS: [Format; 3] = [Format::Rgba16Float, Format::Rgba32Float, Format::Rgba32Uint];

/// WGSL `Cube` of `shaders/bindings/faces.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub struct CubeUniform {
    clip_from_world: [[[f32; 4]; 4]; 6],
    centre: [f32; 3],
    near: f32,
}

impl CubeUniform {
    pub fn new(centre: Vec3) -> CubeUniform {
        CubeUniform {
            clip_from_world: std::array::from_fn(|face| {
                face_matrix(face as u32, centre).to_cols_array_2d()
            }),
            centre: centre.to_array(),
            near: NEAR,
        }
    }

    /// With faces of `size` texels a side wider by half a texel all round: the outermost texels' centres
    /// are then on the cube's edges, where faces share them.
    pub fn with_edges(mut self, size: u32) -> CubeUniform {
        let share = (size - 1) as f32 / size as f32;
        for column in self.clip_from_world.iter_mut().flatten() {
            column[0] *= share;
            column[1] *= share;
        }
        self
    }
}

/// The images of one capture.
pub struct Capture {
    pub radiance: Image,
    /// Surface point with w = 1, or direction with w = 0.
    pub point: Image,
    /// Object and triangle.
    pub ids: Image,
    depth: Image,
    /// Where it was taken from.
    pub centre: Vec3,
    /// Texels along a face's side.
    pub size: u32,
}

impl Capture {
    pub fn new(device: &Arc<Device>, name: &str, size: u32) -> Result<Capture> {
        Self::with_levels(device, name, size, 1)
    }

    /// One whose radiance has room for mip levels, which a capture leaves alone.
    pub fn with_levels(
        device: &Arc<Device>,
        name: &str,
        size: u32,
        levels: u32,
    ) -> Result<Capture> {
        let image = |what: &str, format, levels| {
            let name = format!("{name} {what}");
            Image::with_levels(device, &name, format, [size; 2], Shape::Cube, levels)
        };
        Ok(Capture {
            radiance: image("radiance", FORMATS[0], levels)?,
            point: image("point", FORMATS[1], 1)?,
            ids: image("ids", FORMATS[2], 1)?,
            depth: image("depth", Format::DepthStencil, 1)?,
            centre: Vec3::ZERO,
            size,
        })
    }
}

/// Pipelines that fill captures.
pub struct CaptureStage {
    background: GraphicsPipeline,
    surfaces: GraphicsPipeline,
}

impl CaptureStage {
    pub fn new(device: &Arc<Device>) -> Result<CaptureStage> {
        let background = Attachments {
            colours: &FORMATS,
            depth_stencil: false,
            depth: Depth::Off,
            stencil: Stencil::Off,
        };
        let surfaces = Attachments { depth_stencil: true, depth: Depth::Nearest, ..background };
        let pipeline = |file, a| GraphicsPipeline::new(device, file, &[], a);
        Ok(CaptureStage {
            background: pipeline("stages/capture_background.wgsl", &background)?,
            surfaces: pipeline("stages/capture.wgsl", &surfaces)?,
        })
    }

    /// Take the scene as seen from `centre`, some objects left out. `name` begins the passes' names.
    pub fn capture(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        name: &str,
        target: &mut Capture,
        centre: Vec3,
        exclude: &[ObjectId],
    ) -> Result<()> {
        target.centre = centre;
        let target = &*target;
        let uniform = CubeUniform::new(centre);
        let pass = frame.pass(&format!("{name}/capture-background")).graphics(&self.background);
        let clear = Load::Clear([0.0; 4]);
        scene
            .bind(pass)
            .colour("radiance", &target.radiance, clear)
            .colour("point", &target.point, clear)
            .colour("ids", &target.ids, Load::ClearWords([0; 4]))
            .draw_layers(6, |draw| draw.vertices(3))?;
        let pass = frame.pass(&format!("{name}/capture")).graphics(&self.surfaces);
        scene
            .bind(pass)
            .uniform("cube", &uniform)
            .colour("radiance", &target.radiance, Load::Keep)
            .colour("point", &target.point, Load::Keep)
            .colour("ids", &target.ids, Load::Keep)
            .depth_stencil(&target.depth, clear, Load::ClearWords([0; 4]))
            .draw_layers(6, |draw| scene.draw(draw, |object| !exclude.contains(&object)))
    }
}

/// World to clip space of one face: infinitely far reversed depth, rows as Vulkan's faces run.
fn face_matrix(face: u32, centre: Vec3) -> Mat4 {
    let at = |u: f32, v: f32| cube::direction(face, glam::Vec2::new(u, v));
    // Face coordinates run -1 to 1; the middle of the face is its axis.
    let major = at(0.5, 0.5).normalize();
    let s = (at(1.0, 0.5) - at(0.0, 0.5)).normalize();
    let t = (at(0.5, 1.0) - at(0.5, 0.0)).normalize();
    let row = |axis: Vec3| axis.extend(-axis.dot(centre));
    Mat4::from_cols(row(s), row(t), Vec4::new(0.0, 0.0, 0.0, NEAR), row(major)).transpose()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::assert_layout;
    use glam::Vec4Swizzles;

    #[test]
    fn the_cube_is_laid_out_as_its_wgsl_twin() {
        assert_layout!("stages/capture.wgsl", "Cube", CubeUniform, clip_from_world, centre, near);
    }

    #[test]
    fn a_point_lands_on_the_texel_of_its_direction() {
        let centre = Vec3::new(1.0, -2.0, 0.5);
        for d in [Vec3::new(0.3, -0.2, 0.9), Vec3::new(-1.0, 0.4, 0.1), Vec3::new(0.2, -3.0, 1.0)] {
            let (face, uv) = cube::face_uv(d);
            let clip = face_matrix(face, centre) * (centre + 2.0 * d).extend(1.0);
            let position = 0.5 * (clip.xy() / clip.w) + 0.5;
            assert!(position.abs_diff_eq(uv, 1e-5), "{d}: {position} instead of {uv}");
        }
    }
}

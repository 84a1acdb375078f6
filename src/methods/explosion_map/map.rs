//! The explosion map of one reflector: which of its triangles mirrors what lies in each direction, on one
//! sphere or two.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use super::reflector::Reflector;
use crate::error::{Error, Result};
use crate::gpu::{
    Attachments, Buffer, ComputePipeline, Depth, Device, Format, Frame, GraphicsPipeline, Image,
    Load, Shape, Stencil,
};
use crate::methods::Values;
use crate::scene::ObjectId;
use crate::stages::{CameraUniform, GpuScene};

/// WGSL `Spheres` of `shaders/explosion_map/sphere.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub struct SpheresUniform {
    centre: [f32; 3],
    layers: u32,
    right: [f32; 3],
    near: f32,
    up: [f32; 3],
    far: f32,
    axis: [f32; 3],
    side: u32,
}

/// WGSL `Corners` of `shaders/explosion_map/rays.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct CornersUniform {
    first: u32,
    total: u32,
    reflector: ObjectId,
    pad: u32,
}

/// Bytes of WGSL `Ray` of `shaders/explosion_map/sphere.wgsl`.
const RAY: u64 = 48;
/// Where the far sphere holds the scene it is so many times the near one at least.
const FARTHER: f32 = 1.01;

/// Which spheres, in radii of the reflector.
struct Radii {
    near: f32,
    /// None: there is one sphere. 0: it holds the scene.
    far: Option<f32>,
}

/// Pipelines and the images of one reflector, redrawn for the next.
pub struct Map {
    cast: ComputePipeline,
    draw: GraphicsPipeline,
    radii: Radii,
    /// One layer a sphere: a triangle's number plus one, 0 where there is none.
    pub cells: Image,
    /// WGSL `Ray`s, three a triangle.
    pub rays: Buffer,
    side: u32,
}

impl Map {
    /// With room for so many corners of triangles; `side` in texels.
    ///
    /// # Errors
    /// [`Error::Usage`] where the far sphere is inside the near one, [`Error::Device`] where the device has
    /// no such images.
    pub fn new(device: &Arc<Device>, values: &Values, side: u32, corners: u32) -> Result<Map> {
        let far = values.is("spheres", "2").then(|| values.f32("far"));
        let radii = Radii { near: values.f32("radius"), far };
        if far.is_some_and(|far| far > 0.0 && far <= radii.near) {
            return Err(Error::Usage(format!(
                "explosion-map: far={}; valid: more than radius={}, or 0 to hold the scene",
                values.get("far"),
                values.get("radius")
            )));
        }
        let layers = Shape::Array(1 + u32::from(far.is_some()));
        let attachments = Attachments {
            colours: &[Format::R32Uint],
            depth_stencil: false,
            depth: Depth::Off,
            stencil: Stencil::Off,
        };
        let (cast, draw) = ("explosion_map/rays.wgsl", "explosion_map/map.wgsl");
        Ok(Map {
            cast: ComputePipeline::new(device, cast, &[])?,
            draw: GraphicsPipeline::new(device, draw, &[], &attachments)?,
            radii,
            cells: Image::new(device, "explosion map", Format::R32Uint, [side; 2], layers)?,
            rays: Buffer::storage(
                device,
                "rays of the reflector",
                RAY * u64::from(corners.max(1)),
            )?,
            side,
        })
    }

    /// Draw the map of a reflector as the camera's eye makes it; the spheres, for searches.
    pub fn fill(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        camera: &CameraUniform,
        reflector: &Reflector,
    ) -> Result<SpheresUniform> {
        let spheres = self.spheres(scene, camera, reflector.object);
        let (first, total) = scene.closed_range(reflector.object);
        let corners = CornersUniform { first, total, reflector: reflector.object, pad: 0 };
        let pass = frame.pass("explosion-map/rays").compute(&self.cast);
        scene
            .bind(pass)
            .uniform("camera", camera)
            .uniform("part", &corners)
            .buffer("rays", &self.rays)
            .over(total)?;
        frame
            .pass("explosion-map/map")
            .graphics(&self.draw)
            .storage_struct("spheres", &spheres)
            .buffer("rays", &self.rays)
            .colour("cells", &self.cells, Load::ClearWords([0; 4]))
            .draw_layers(spheres.layers, |draw| draw.vertices(total))?;
        Ok(spheres)
    }

    /// About the middle of the reflector's box. The map's middle is towards the eye: the singular direction
    /// then lies behind the reflector, where a convex one hides what there is and mirrors nothing.
    fn spheres(
        &self,
        scene: &GpuScene,
        camera: &CameraUniform,
        reflector: ObjectId,
    ) -> SpheresUniform {
        let (moment, scene) = (scene.moment(), &scene.scene);
        let points = scene.closed_points_of(moment, reflector);
        let empty = (Vec3::INFINITY, Vec3::NEG_INFINITY);
        let (low, high) = points.iter().fold(empty, |(low, high), &p| (low.min(p), high.max(p)));
        let centre = 0.5 * (low + high);
        let own = points.iter().map(|p| p.distance(centre)).fold(0.0, f32::max);
        let near = self.radii.near * own;
        let (low, high) = scene.bounds(moment);
        let holding = (centre - low).abs().max((high - centre).abs()).length();
        let far = match self.radii.far {
            Some(far) if far > 0.0 => far * own,
            _ => holding.max(FARTHER * near),
        };
        let axis = camera.towards_eye(centre);
        let (right, up) = axis.any_orthonormal_pair();
        SpheresUniform {
            centre: centre.to_array(),
            layers: self.cells.shape.layers(),
            right: right.to_array(),
            near,
            up: up.to_array(),
            far,
            axis: axis.to_array(),
            side: self.side,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::assert_layout;

    #[test]
    #[rustfmt::skip]
    fn uniforms_are_laid_out_as_their_wgsl_twins() {
        assert_layout!("explosion_map/map.wgsl", "Spheres", SpheresUniform,
            centre, layers, right, near, up, far, axis, side);
        assert_layout!("explosion_map/rays.wgsl", "Corners", CornersUniform, first, total, reflector, pad);
    }
}

//! The reflector in two cube maps about its centroid: points and normals in its own space, whatever the
//! eye (Estalella, Martin, Drettakis, Tost, Devillers & Cazals 2005, "Accurate interactive specular
//! reflections on curved objects").
//!
//! A direction outwards has one texel, so the reflector must be star-shaped about its centroid: of what it
//! meets more than once the last is kept. Texels at the edges of faces are of the edges themselves, so that
//! what lies between texels joins from face to face.

use std::collections::BTreeMap;
use std::collections::btree_map::Entry;
use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use crate::error::Result;
use crate::gpu::{
    Attachments, Depth, Device, Format, Frame, GraphicsPipeline, Image, Load, Pass, Shape, Stencil,
};
use crate::methods::Values;
use crate::scene::ObjectId;
use crate::stages::{CubeUniform, GpuScene};

/// What a case asks of the maps and of searches over them.
#[derive(Clone, Copy)]
pub struct CubeRule {
    size: u32,
    step: f32,
    most_steps: u32,
}

impl CubeRule {
    /// `None` where the reflector is searched as the eye sees it.
    pub fn new(values: &Values) -> Option<CubeRule> {
        values.is("reflector_map", "cube").then(|| CubeRule {
            size: values.u32("cube_size"),
            step: values.f32("step"),
            most_steps: values.u32("most_steps"),
        })
    }
}

/// WGSL `CubeSearch` of `shaders/virtual_objects/cube_search.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct CubeSearchUniform {
    row_x: [f32; 4],
    row_y: [f32; 4],
    row_z: [f32; 4],
    centre: [f32; 3],
    step: f32,
    size: u32,
    most_steps: u32,
    pad_a: u32,
    pad_b: u32,
}

/// The maps of one reflector.
struct CubeMap {
    position: Image,
    normal: Image,
    /// Where they are drawn from, the reflector's own space.
    centre: Vec3,
}

impl CubeMap {
    fn new(device: &Arc<Device>, size: u32, format: Format) -> Result<CubeMap> {
        let image = |name| Image::new(device, name, format, [size; 2], Shape::Cube);
        Ok(CubeMap {
            position: image("cube of reflector points")?,
            normal: image("cube of reflector normals")?,
            centre: Vec3::ZERO,
        })
    }
}

/// The maps of all reflectors, and the pipeline that draws them.
pub struct CubeMaps {
    rule: CubeRule,
    format: Format,
    surfaces: GraphicsPipeline,
    depth: Image,
    maps: BTreeMap<ObjectId, CubeMap>,
}

/// What a search of one reflector's maps binds.
pub struct BoundCube<'a> {
    map: &'a CubeMap,
    uniform: CubeSearchUniform,
}

impl CubeMaps {
    /// `format`: of points and normals, [`Format::Rgba32Float`] or [`Format::Rgba16Float`].
    ///
    /// # Errors
    /// [`crate::error::Error::Device`] where the device has no such images.
    pub fn new(device: &Arc<Device>, rule: CubeRule, format: Format) -> Result<CubeMaps> {
        let attachments = Attachments {
            colours: &[format, format],
            depth_stencil: true,
            depth: Depth::Farthest,
            stencil: Stencil::Off,
        };
        let file = "virtual_objects/cube_draw.wgsl";
        let size = [rule.size; 2];
        Ok(CubeMaps {
            rule,
            format,
            surfaces: GraphicsPipeline::new(device, file, &[], &attachments)?,
            depth: Image::new(device, "cube depth", Format::DepthStencil, size, Shape::Cube)?,
            maps: BTreeMap::new(),
        })
    }

    /// Draw the maps of a reflector, its closed partner where it has one, unless they hold its shape
    /// already: how it lies and where it is seen from makes no difference.
    pub fn draw(&mut self, frame: &mut Frame, scene: &GpuScene, object: ObjectId) -> Result<()> {
        let map = match self.maps.entry(object) {
            Entry::Occupied(_) if !scene.scene.wobbles(object) => return Ok(()),
            Entry::Occupied(known) => known.into_mut(),
            Entry::Vacant(new) => {
                new.insert(CubeMap::new(frame.device(), self.rule.size, self.format)?)
            }
        };
        map.centre = scene.scene.closed_centroid_of(scene.moment(), object);
        let uniform = CubeUniform::new(map.centre).with_edges(self.rule.size);
        let clear = Load::Clear([0.0; 4]);
        let pass = frame.pass("virtual-objects/cube").graphics(&self.surfaces);
        scene
            .bind(pass)
            .uniform("cube", &uniform)
            .colour("position", &map.position, clear)
            .colour("normal", &map.normal, clear)
            .depth_stencil(&self.depth, Load::Clear([1.0; 4]), Load::ClearWords([0; 4]))
            .draw_layers(6, |draw| scene.draw_closed(draw, object))
    }

    /// What a search of a reflector binds, where it is now; `None` before its maps are drawn.
    pub fn of(&self, scene: &GpuScene, object: ObjectId) -> Option<BoundCube<'_>> {
        let map = self.maps.get(&object)?;
        let [row_x, row_y, row_z] = scene.rows_of(object);
        let uniform = CubeSearchUniform {
            row_x,
            row_y,
            row_z,
            centre: map.centre.to_array(),
            step: self.rule.step,
            size: self.rule.size,
            most_steps: self.rule.most_steps,
            pad_a: 0,
            pad_b: 0,
        };
        Some(BoundCube { map, uniform })
    }
}

impl<'a> BoundCube<'a> {
    /// Bind what searches look at.
    pub fn bind<'f>(&self, pass: Pass<'f>) -> Pass<'f>
    where
        'a: 'f,
    {
        pass.storage_struct("cube_search", &self.uniform)
            .optional()
            .sample("cube_position", &self.map.position)
            .optional()
            .sample("cube_normal", &self.map.normal)
            .optional()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::assert_layout;

    #[test]
    #[rustfmt::skip]
    fn the_uniform_is_laid_out_as_its_wgsl_twin() {
        assert_layout!("virtual_objects/search.wgsl", "CubeSearch", CubeSearchUniform,
            row_x, row_y, row_z, centre, step, size, most_steps, pad_a, pad_b);
    }
}

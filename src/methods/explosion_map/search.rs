//! Searches: for each vertex of the scene the plane of the reflector that mirrors it.

use bytemuck::{Pod, Zeroable};

use super::map::{Map, SpheresUniform};
use super::reflector::Reflector;
use crate::error::Result;
use crate::gpu::{Buffer, ComputePipeline, Frame};
use crate::methods::Setup;
use crate::methods::source::Source;
use crate::scene::ObjectId;
use crate::stages::{CameraUniform, GpuScene, ReflectionRecord};

/// WGSL `Search` of `shaders/explosion_map/search.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct SearchUniform {
    total: u32,
    reflector: ObjectId,
    cap: u32,
    pad: u32,
}

/// Shader definitions that values stand for.
const DEFINES: &[(&str, &str, &str)] = &[
    ("cell", "walk", "CELL_WALK"),
    ("blend", "inverse", "BLEND_INVERSE"),
    ("image", "push", "IMAGE_PUSH"),
];

/// Pipeline of the search and its rule.
pub struct Search {
    pipeline: ComputePipeline,
    cap: u32,
}

impl Search {
    /// # Errors
    /// [`crate::error::Error::Shader`] where it does not compile.
    pub fn new(setup: &Setup) -> Result<Search> {
        let chosen = DEFINES.iter().filter(|(name, value, _)| setup.values.is(name, value));
        let mut defines = setup.mode.defines();
        defines.extend(chosen.map(|&(_, _, define)| (define, 1)));
        let pipeline = ComputePipeline::new(setup.device, "explosion_map/search.wgsl", &defines)?;
        Ok(Search { pipeline, cap: setup.values.u32("cap") })
    }

    /// Find the virtual vertex of every vertex in one reflector whose map was just filled.
    pub fn run(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        (camera, record): (&CameraUniform, &ReflectionRecord),
        (map, spheres, reflector): (&Map, &SpheresUniform, &Reflector),
        source: &Source,
        corners: &Buffer,
    ) -> Result<()> {
        let search = SearchUniform {
            total: source.count,
            reflector: reflector.object,
            cap: self.cap,
            pad: 0,
        };
        let pass = frame.pass("explosion-map/search").compute(&self.pipeline);
        record
            .bind_counters(scene.bind(pass))
            .uniform("camera", camera)
            .storage_struct("search", &search)
            .storage_struct("spheres", spheres)
            .buffer("vertices", &source.vertices)
            .buffer("owners", &source.owners)
            .buffer("rays", &map.rays)
            .buffer("neighbours", &reflector.neighbours)
            .optional()
            .sample("explosion_map", &map.cells)
            .buffer("corners", corners)
            .over(source.count)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::assert_layout;

    #[test]
    #[rustfmt::skip]
    fn the_uniform_is_laid_out_as_its_wgsl_twin() {
        assert_layout!("explosion_map/search.wgsl", "Search", SearchUniform, total, reflector, cap, pad);
    }
}

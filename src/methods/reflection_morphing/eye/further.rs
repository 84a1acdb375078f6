//! Chains of more than one reflector by rays at the eye: rays that leave one reflector are followed to the next,
//! and go on from there. Those of each trace are listed, and vertices projected by them, apart from all others,
//! and drawn as octrees' are (see `orders`).
//!
//! To rays that go on, the rays that arrive are what the eye's own are to the first: where they just miss the
//! next reflector they take part, so that bundles reach to the border of what that hides. Which reflectors rays meet is
//! known on the device alone, so all chains are tried; lists of those that no ray takes are empty.

use bytemuck::{Pod, Zeroable};

use super::bins::{Bins, BinsStruct, Mirror, RayStruct};
use crate::error::Result;
use crate::gpu::{Buffer, ComputePipeline, Defines, Format, Frame, Image, Shape};
use crate::methods::Setup;
use crate::methods::reflection_morphing::orders::{Drawing, Orders};
use crate::methods::reflection_morphing::trace::Trace;
use crate::methods::source::Source;
use crate::scene::{Lobe, ObjectId};
use crate::stages::{
    CameraUniform, GpuScene, ReflectionRecord, SceneTree, TreeKind, TreeLayout, TreeUpdate,
};

/// WGSL `Follow` of `shaders/reflection_morphing/eye_follow.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct FollowStruct {
    size: u32,
    reflector: ObjectId,
    pad: [u32; 2],
}

/// Rays of one order above the first, one of each texel.
struct Level {
    /// Where those of the order below meet reflectors.
    position: Image,
    normal: Image,
    rays: Buffer,
    /// Of each the point of the first reflector, and the metres from there to where it leaves the last.
    firsts: Buffer,
}

/// Pipelines and lists.
pub struct Further {
    /// The reflectors, and nothing else.
    tree: SceneTree,
    follow: ComputePipeline,
    /// Of traces of two reflectors, and of more.
    rays_of: [ComputePipeline; 2],
    project: ComputePipeline,
    orders: Orders,
    levels: Vec<Level>,
}

impl Further {
    /// `look_up` are the projections' defines.
    ///
    /// # Errors
    /// As of pipelines, images and lists, and where the device has no room for the reflectors' tree.
    pub fn new(setup: &Setup, look_up: Defines) -> Result<Further> {
        let &Setup { device, mode, values, .. } = setup;
        let kind = TreeKind::Binary(TreeUpdate::Refit);
        let layout = TreeLayout::new(&setup.scene.scene, kind, device.storage_limit())?;
        let pipeline = |file: &str, defines: &[Defines]| {
            let file = format!("reflection_morphing/{file}.wgsl");
            ComputePipeline::new(device, &file, &defines.concat())
        };
        let (further, thrice) = (&[("FURTHER", 1)][..], &[("THRICE", 1)][..]);
        let (bounces, map) = (values.u32("bounces"), values.u32("map"));
        let levels = (1..bounces).map(|_| Level::new(setup, map));
        Ok(Further {
            follow: pipeline("eye_follow", &[&mode.defines(), &layout.defines()])?,
            tree: SceneTree::of_reflectors(device, layout)?,
            rays_of: [
                pipeline("eye_rays", &[&mode.defines(), further])?,
                pipeline("eye_rays", &[&mode.defines(), further, thrice])?,
            ],
            project: pipeline("eye_project", &[look_up, further])?,
            orders: Orders::new(device, mode, setup.size, bounces)?,
            levels: levels.collect::<Result<_>>()?,
        })
    }

    /// Have the reflectors' tree follow them.
    pub fn prepare(&mut self, frame: &mut Frame, scene: &GpuScene) -> Result<()> {
        self.tree.prepare(frame, scene, "reflection-morphing")
    }

    /// Draw what traces show that begin with the first reflector of `trace`, whose rays and corners are at hand.
    pub fn run(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        bins: &Bins,
        to: Drawing,
        trace: Trace,
    ) -> Result<()> {
        let mirrors = scene.scene.reflectors().into_iter();
        let cubes = mirrors.map(|object| {
            let points = scene.scene.closed_points_of(scene.moment(), object);
            bins.cubes(&points, &Mirror { object, lobe: Lobe::Reflected })
        });
        let cubes: Vec<BinsStruct> = cubes.collect();
        self.go_on(frame, scene, (bins, &cubes), to, trace)
    }

    /// Draw what is shown by traces that go on from one whose rays and corners are at hand.
    fn go_on(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        (bins, cubes): (&Bins, &[BinsStruct]),
        to: Drawing,
        trace: Trace,
    ) -> Result<()> {
        let (seen, found) = ((&to.view.camera, to.record), (to.source, to.corners));
        self.orders.show(frame, scene, to, trace)?;
        self.follow(frame, scene, bins, to.record, trace)?;
        for cubes_of in cubes.iter().filter(|cubes| cubes.reflector != trace.last) {
            let longer = trace.on(&scene.scene, cubes_of.reflector);
            self.find(frame, scene, (bins, cubes_of), seen, longer, found)?;
            self.orders.draw(frame, scene, to, longer)?;
            if longer.order as usize <= self.levels.len() {
                self.go_on(frame, scene, (bins, cubes), to, longer)?;
            }
        }
        Ok(())
    }

    /// Find where a trace shows each vertex, that of one reflector less having been followed.
    pub fn find(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        (bins, cubes): (&Bins, &BinsStruct),
        (camera, record): (&CameraUniform, &ReflectionRecord),
        trace: Trace,
        (source, corners): (&Source, &Buffer),
    ) -> Result<()> {
        self.leave(frame, scene, (bins, cubes), trace)?;
        let level = &self.levels[trace.order as usize - 2];
        bins.list(frame, cubes, &level.rays, record)?;
        let pass = frame.pass("reflection-morphing/project").compute(&self.project);
        let pass = record.bind_counters(scene.bind(pass)).storage_struct("bins", cubes);
        bins.bind(pass)
            .buffer("rays", &level.rays)
            .buffer("firsts", &level.firsts)
            .uniform("camera", camera)
            .buffer("vertices", &source.vertices)
            .buffer("owners", &source.owners)
            .buffer("corners", corners)
            .over(source.count)
    }

    /// Where the rays of an order's trace at hand are.
    fn rays_of_order<'a>(&'a self, bins: &'a Bins, order: u32) -> &'a Buffer {
        match order {
            1 => &bins.rays,
            order => &self.levels[order as usize - 2].rays,
        }
    }

    /// Find the reflectors that the rays of a trace, which are at hand, meet next.
    pub fn follow(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        bins: &Bins,
        record: &ReflectionRecord,
        trace: Trace,
    ) -> Result<()> {
        let next = &self.levels[trace.order as usize - 1];
        let follow = FollowStruct { size: bins.size, reflector: trace.last, pad: [0; 2] };
        let pass = frame.pass("reflection-morphing/follow").compute(&self.follow);
        let pass = record.bind_counters(scene.bind(pass));
        self.tree
            .bind(pass)
            .storage_struct("follow", &follow)
            .buffer("leaving", self.rays_of_order(bins, trace.order))
            .store("met_position", &next.position)
            .store("met_normal", &next.normal)
            .over_pixels([bins.size; 2])
    }

    /// Trace the rays of a trace from its last reflector on.
    fn leave(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        (bins, cubes): (&Bins, &BinsStruct),
        trace: Trace,
    ) -> Result<()> {
        let order = trace.order as usize;
        let level = &self.levels[order - 2];
        let pipeline = &self.rays_of[usize::from(order > 2)];
        let pass = scene.bind(frame.pass("reflection-morphing/rays").compute(pipeline));
        let pass = pass
            .storage_struct("bins", cubes)
            .sample("mirror_position", &level.position)
            .sample("mirror_normal", &level.normal)
            .buffer("arriving_rays", self.rays_of_order(bins, trace.order - 1))
            .buffer("rays", &level.rays)
            .buffer("firsts", &level.firsts);
        let pass = match order {
            2 => pass,
            order => pass.buffer("firsts_before", &self.levels[order - 3].firsts),
        };
        pass.over_pixels([bins.size; 2])
    }
}

impl Level {
    fn new(setup: &Setup, size: u32) -> Result<Level> {
        let device = setup.device;
        let texels = u64::from(size) * u64::from(size);
        let image = |name| Image::new(device, name, Format::Rgba32Float, [size; 2], Shape::Flat);
        let rays = size_of::<RayStruct>() as u64;
        Ok(Level {
            position: image("reflectors met, points")?,
            normal: image("reflectors met, normals")?,
            rays: Buffer::storage(device, "rays that went on", rays * texels)?,
            firsts: Buffer::storage(device, "where rays left first", 16 * texels)?,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::assert_layout;

    #[test]
    #[rustfmt::skip]
    fn the_struct_is_laid_out_as_its_wgsl_twin() {
        assert_layout!("reflection_morphing/eye_follow.wgsl", "Follow", FollowStruct, size, reflector, pad);
    }
}

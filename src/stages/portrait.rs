//! Portraits: pictures of one object each, as image-based stand-ins need them (Popescu et al. 2006,
//! slides 10 to 14: "fast construction").
//!
//! A texel holds the surface point its centre sees, the normal and the colour there, all in the object's
//! own space and without light; [`PortraitStage::light`] then lights all texels as the objects stand this
//! frame. So rigid motion costs nothing but that pass, and neither does a change of light (slide 39:
//! "rigid body transformations, color updates, and reflector updates do not require reconstruction").
//! What changes its shape has to be taken again.

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use glam::{Affine3A, Vec2, Vec3};

use super::{GpuScene, shrink};
use crate::error::Result;
use crate::gpu::{
    Attachments, ComputePipeline, Depth, Device, Format, Frame, GraphicsPipeline, Image, Load,
    Pass, Sampler, Shape, Stencil,
};
use crate::scene::{Moment, ObjectId, Scene};

/// Albedo, point, normal, ids.
const FORMATS: [Format; 4] =
    [Format::Rgba16Float, Format::Rgba32Float, Format::Rgba32Float, Format::Rg32Uint];
/// Of an eye before the picture's plane: the nearest share of its distance at which it sees anything.
const NEAREST: f32 = 0.05;
/// Room before the nearest and behind the farthest point, so that neither lies on a plane that clips: the
/// farthest would be taken for nothing.
const ROOM: f32 = 1.001;
/// No picture is thinner, metres.
const THINNEST: f32 = 1e-4;

/// WGSL `Portrait` of `shaders/bindings/portrait.wgsl`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct PortraitUniform {
    row_x: [f32; 4],
    row_y: [f32; 4],
    row_z: [f32; 4],
    centre: [f32; 3],
    half_width: f32,
    right: [f32; 3],
    half_height: f32,
    up: [f32; 3],
    eye_distance: f32,
    towards: [f32; 3],
    reach: f32,
}

/// How rays meet a picture's eye.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Sight {
    /// As from infinitely far away.
    Parallel,
    /// In a point; parallel where that is inside or too near what is pictured.
    Central,
}

/// How a picture looks at its object; in the object's own space, metres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PortraitView {
    /// Middle of the picture, on its plane.
    pub centre: Vec3,
    /// Unit: to the right, up, and towards the eye; right-handed.
    pub axes: [Vec3; 3],
    /// Half the picture's width and height.
    pub half: Vec2,
    /// What is pictured lies up to this far before and behind the plane.
    pub reach: f32,
    /// Of the eye before the plane; 0 for parallel rays.
    pub eye_distance: f32,
}

impl PortraitView {
    /// A picture of some points as large as it can show them, facing `eye`, its plane through the middle
    /// of their box.
    pub fn facing(points: &[Vec3], eye: Vec3, sight: Sight) -> PortraitView {
        let (low, high) = bounds(points);
        let centre = 0.5 * (low + high);
        let distance = (eye - centre).length();
        let towards = (eye - centre).try_normalize().unwrap_or(Vec3::Z);
        Self::fitted(points, centre, towards, if sight == Sight::Central { distance } else { 0.0 })
    }

    /// A picture along the thinnest side of the points' box, its plane on the side towards `eye`, under
    /// parallel rays: the thing itself, where that is flat.
    pub fn flat(points: &[Vec3], eye: Vec3) -> PortraitView {
        let (low, high) = bounds(points);
        let (centre, half) = (0.5 * (low + high), 0.5 * (high - low));
        let axis = Vec3::AXES[half.min_position()];
        let towards = if axis.dot(eye - centre) < 0.0 { -axis } else { axis };
        let mut view = Self::fitted(points, centre, towards, 0.0);
        let thickness = half.min_element();
        view.centre += thickness * towards;
        view.reach += thickness;
        view
    }

    /// The thinnest side of the points' box over the one next to it: 0 for what is flat, 1 for a cube.
    pub fn flatness(points: &[Vec3]) -> f32 {
        let (low, high) = bounds(points);
        let mut sides = (high - low).to_array();
        sides.sort_unstable_by(f32::total_cmp);
        sides[0] / sides[1].max(THINNEST)
    }

    fn fitted(points: &[Vec3], middle: Vec3, towards: Vec3, eye_distance: f32) -> PortraitView {
        // Looking along the upright, anything level is as good.
        let hint = if towards.y.abs() < 0.99 { Vec3::Y } else { Vec3::NEG_Z };
        let right = hint.cross(towards).normalize_or(Vec3::X);
        let up = towards.cross(right);
        let in_axes = |p: &Vec3| {
            let q = *p - middle;
            Vec3::new(q.dot(right), q.dot(up), q.dot(towards))
        };
        let reach = ROOM * points.iter().map(|p| in_axes(p).z.abs()).fold(THINNEST, f32::max);
        let axes = [right, up, towards];
        if reach < (1.0 - NEAREST) * eye_distance {
            // The eye stays straight before the middle.
            let half = points.iter().map(in_axes).fold(Vec2::splat(THINNEST), |half, q| {
                half.max(q.truncate().abs() * eye_distance / (eye_distance - q.z))
            });
            return PortraitView { centre: middle, axes, half, reach, eye_distance };
        }
        let empty = (Vec2::INFINITY, Vec2::NEG_INFINITY);
        let (low, high) = points
            .iter()
            .map(|p| in_axes(p).truncate())
            .fold(empty, |(a, b), q| (a.min(q), b.max(q)));
        let off = 0.5 * (low + high);
        let half = (0.5 * (high - low)).max(Vec2::splat(THINNEST));
        let centre = middle + off.x * right + off.y * up;
        PortraitView { centre, axes, half, reach, eye_distance: 0.0 }
    }

    /// Angle, radians, between two pictures' lines of sight.
    pub fn turned(&self, other: &PortraitView) -> f32 {
        self.axes[2].angle_between(other.axes[2])
    }

    /// For shaders, in an object's pose given by the rows of world from own space.
    pub fn uniform(&self, [row_x, row_y, row_z]: [[f32; 4]; 3]) -> PortraitUniform {
        let [right, up, towards] = self.axes.map(|axis| axis.to_array());
        PortraitUniform {
            row_x,
            row_y,
            row_z,
            centre: self.centre.to_array(),
            half_width: self.half.x,
            right,
            half_height: self.half.y,
            up,
            eye_distance: self.eye_distance,
            towards,
            reach: self.reach,
        }
    }
}

fn bounds(points: &[Vec3]) -> (Vec3, Vec3) {
    let empty = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let (low, high) = points.iter().fold(empty, |(low, high), &p| (low.min(p), high.max(p)));
    if points.is_empty() { (Vec3::ZERO, Vec3::ZERO) } else { (low, high) }
}

/// The points of an object, or of a group, whose parts all have one pose, in own space: what a view is
/// fitted to.
pub fn own_points(scene: &Scene, moment: &Moment, objects: &[ObjectId]) -> Vec<Vec3> {
    let of = |&object: &ObjectId| scene.mesh_at(moment, object).positions.clone();
    objects.iter().flat_map(of).collect()
}

/// An object's own space from the world.
pub fn own_from_world(moment: &Moment, object: ObjectId) -> Affine3A {
    moment.poses[object as usize].inverse()
}

/// One picture taken: what of, and how.
struct Sitting {
    object: ObjectId,
    view: PortraitView,
}

/// The images of some portraits, one a layer, all of one size. Own space is that of the first object of
/// each. A texel shows what its centre sees; where that is nothing, all is 0.
pub struct Portraits {
    /// Fourth channel: 1 where the object is.
    pub albedo: Image,
    /// Lit by [`PortraitStage::light`], times its cover, which is the fourth channel; with mip levels.
    pub radiance: Image,
    /// Own space. Fourth: how far before the picture's plane, metres.
    pub point: Image,
    /// Unit, own space, on the eye's side. Fourth: 1 where the outside is seen.
    pub normal: Image,
    /// Object and triangle; only where the albedo's fourth channel is 1.
    pub ids: Image,
    depth: Image,
    /// Texels along a side.
    pub size: u32,
    taken: Vec<Option<Sitting>>,
}

impl Portraits {
    /// `count` layers of `size` texels a side, `levels` mip levels for light.
    ///
    /// # Errors
    /// [`crate::error::Error::Device`] where the device has no memory or no images for that many.
    pub fn new(
        device: &Arc<Device>,
        name: &str,
        size: u32,
        count: u32,
        levels: u32,
    ) -> Result<Portraits> {
        let layers = Shape::Array(count.max(1));
        let image = |what: &str, format, shape, levels| {
            Image::with_levels(device, &format!("{name} {what}"), format, [size; 2], shape, levels)
        };
        Ok(Portraits {
            albedo: image("albedo", FORMATS[0], layers, 1)?,
            radiance: image("radiance", Format::Rgba16Float, layers, levels)?,
            point: image("point", FORMATS[1], layers, 1)?,
            normal: image("normal", FORMATS[2], layers, 1)?,
            ids: image("ids", FORMATS[3], layers, 1)?,
            depth: image("depth", Format::DepthStencil, Shape::Flat, 1)?,
            size,
            taken: (0..count).map(|_| None).collect(),
        })
    }

    /// How a layer was last taken.
    pub fn view(&self, layer: u32) -> Option<&PortraitView> {
        self.taken[layer as usize].as_ref().map(|sitting| &sitting.view)
    }

    /// Every layer as shaders want it, its object as it stands this frame; zeros where none was taken.
    pub fn uniforms(&self, scene: &GpuScene) -> Vec<PortraitUniform> {
        let of = |sitting: &Sitting| sitting.view.uniform(scene.rows_of(sitting.object));
        self.taken.iter().map(|taken| taken.as_ref().map(of).unwrap_or_default()).collect()
    }

    /// Bind what a shader wants of them, by these names.
    pub fn bind<'f>(&'f self, pass: Pass<'f>) -> Pass<'f> {
        pass.sample("portrait_radiance", &self.radiance)
            .optional()
            .sample("portrait_albedo", &self.albedo)
            .optional()
            .sample("portrait_point", &self.point)
            .optional()
            .sample("portrait_normal", &self.normal)
            .optional()
            .sample("portrait_ids", &self.ids)
            .optional()
            .sampler("linear_filter", Sampler::Linear)
            .optional()
    }
}

/// Pipelines that take and light portraits.
pub struct PortraitStage {
    take: GraphicsPipeline,
    light: ComputePipeline,
    shrink: ComputePipeline,
}

impl PortraitStage {
    pub fn new(device: &Arc<Device>) -> Result<PortraitStage> {
        let attachments = Attachments {
            colours: &FORMATS,
            depth_stencil: true,
            depth: Depth::Nearest,
            stencil: Stencil::Off,
        };
        Ok(PortraitStage {
            take: GraphicsPipeline::new(device, "stages/portrait.wgsl", &[], &attachments)?,
            light: ComputePipeline::new(device, "stages/portrait_light.wgsl", &[])?,
            shrink: ComputePipeline::new(device, "stages/shrink.wgsl", &[])?,
        })
    }

    /// Take the picture of an object, or of a group, whose parts all have one pose, into a layer. `name` begins the
    /// pass's name. [`PortraitStage::light`] has to follow before its light is looked up.
    pub fn take(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        name: &str,
        (target, layer): (&mut Portraits, u32),
        objects: &[ObjectId],
        view: PortraitView,
    ) -> Result<()> {
        let Some(&object) = objects.first() else { return Ok(()) };
        target.taken[layer as usize] = Some(Sitting { object, view });
        let (target, clear) = (&*target, Load::Clear([0.0; 4]));
        let pass = frame.pass(&format!("{name}/portrait")).graphics(&self.take);
        scene
            .bind(pass)
            .uniform("portrait", &view.uniform(scene.rows_of(object)))
            .colour_from("albedo", &target.albedo, layer, clear)
            .colour_from("point", &target.point, layer, clear)
            .colour_from("normal", &target.normal, layer, clear)
            .colour_from("ids", &target.ids, layer, Load::ClearWords([0; 4]))
            .depth_stencil(&target.depth, clear, Load::ClearWords([0; 4]))
            .draw(|draw| scene.draw(draw, |object| objects.contains(&object)))
    }

    /// Light all portraits as their objects stand this frame, and make the mip levels of that light.
    pub fn light(
        &self,
        frame: &mut Frame,
        scene: &GpuScene,
        name: &str,
        target: &Portraits,
    ) -> Result<()> {
        let layers = target.radiance.shape.layers();
        let portraits = frame.upload(&target.uniforms(scene))?;
        let pass = frame.pass(&format!("{name}/portrait-light")).compute(&self.light);
        scene
            .bind(pass)
            .sample("albedo", &target.albedo)
            .sample("normal", &target.normal)
            .store("radiance", &target.radiance)
            .slice("portraits", portraits)
            .over_pixels([target.size, target.size * layers])?;
        shrink(frame, &self.shrink, name, &target.radiance)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::assert_layout;

    #[test]
    #[rustfmt::skip]
    fn a_portrait_is_laid_out_as_its_wgsl_twin() {
        assert_layout!("stages/portrait.wgsl", "Portrait", PortraitUniform,
            row_x, row_y, row_z, centre, half_width, right, half_height, up, eye_distance, towards,
            reach);
    }

    /// The corners of a box.
    fn corners(half: Vec3, centre: Vec3) -> Vec<Vec3> {
        let sign = |i: u32, bit: u32| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
        (0..8).map(|i| centre + half * Vec3::new(sign(i, 0), sign(i, 1), sign(i, 2))).collect()
    }

    #[test]
    fn a_view_faces_its_eye_and_shows_every_point() {
        let centre = Vec3::new(1.0, 2.0, 3.0);
        let points = corners(Vec3::new(0.5, 0.25, 0.125), centre);
        for eye in [Vec3::new(5.0, 2.0, 3.0), Vec3::new(1.0, 9.0, 3.0), Vec3::new(0.0, 0.0, 7.0)] {
            for sight in [Sight::Parallel, Sight::Central] {
                let view = PortraitView::facing(&points, eye, sight);
                let [right, up, towards] = view.axes;
                assert!(towards.abs_diff_eq((eye - centre).normalize(), 1e-6));
                assert!(right.cross(up).abs_diff_eq(towards, 1e-6), "right-handed");
                let mut widest = Vec2::ZERO;
                for &point in &points {
                    let q = point - view.centre;
                    let depth = q.dot(towards);
                    assert!(depth.abs() < 0.9995 * view.reach, "inside, not on a plane that clips");
                    let spread = match sight {
                        Sight::Parallel => 1.0,
                        Sight::Central => view.eye_distance / (view.eye_distance - depth),
                    };
                    widest = widest.max(spread * Vec2::new(q.dot(right), q.dot(up)).abs());
                }
                assert!(widest.abs_diff_eq(view.half, 1e-4), "{widest} in {}", view.half);
            }
        }
    }

    #[test]
    fn an_eye_too_near_sees_by_parallel_rays() {
        let points = corners(Vec3::splat(0.5), Vec3::ZERO);
        let view = PortraitView::facing(&points, Vec3::new(0.4, 0.0, 0.0), Sight::Central);
        assert_eq!(view.eye_distance, 0.0);
    }

    #[test]
    fn a_flat_thing_is_its_own_picture() {
        let points = corners(Vec3::new(4.0, 0.01, 3.0), Vec3::new(0.0, -0.01, 0.0));
        assert!(PortraitView::flatness(&points) < 0.01);
        assert_eq!(PortraitView::flatness(&corners(Vec3::ONE, Vec3::ONE)), 1.0);
        let above = PortraitView::flat(&points, Vec3::new(20.0, 1.0, 0.0));
        assert!(above.axes[2].abs_diff_eq(Vec3::Y, 1e-6) && above.centre.y.abs() < 1e-6);
        let below = PortraitView::flat(&points, Vec3::new(20.0, -1.0, 0.0));
        assert!(below.axes[2].abs_diff_eq(Vec3::NEG_Y, 1e-6));
        assert!((below.centre.y + 0.02).abs() < 1e-6);
        let mut half = above.half.to_array();
        half.sort_unstable_by(f32::total_cmp);
        assert_eq!(half, [3.0, 4.0]);
    }
}

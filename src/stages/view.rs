//! One view: what a method is given besides the scene.

use bytemuck::{Pod, Zeroable};
use glam::{Mat4, Vec2, Vec3, Vec4, Vec4Swizzles};

use super::{DirectView, Footprint};
use crate::error::Result;
use crate::geometry::{Camera, Projection};
use crate::gpu::{Frame, Pass};
use crate::scene::{Lobe, ObjectId};

/// WGSL `Camera` of `shaders/common/camera.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub struct CameraUniform {
    clip_from_world: [[f32; 4]; 4],
    eye: [f32; 3],
    orthographic: u32,
    forward: [f32; 3],
    pad: u32,
    right: [f32; 3],
    half_width: f32,
    up: [f32; 3],
    half_height: f32,
}

/// Tangent of the widest half angle a fitted camera opens to.
const WIDEST: f32 = 4.0;
/// What a fitted camera shows beyond the points, as a share.
const MARGIN: f32 = 0.01;

impl CameraUniform {
    /// World position of the eye.
    pub fn eye(&self) -> Vec3 {
        Vec3::from_array(self.eye)
    }

    /// Unit direction from a world point to the eye.
    pub fn towards_eye(&self, point: Vec3) -> Vec3 {
        let back = -Vec3::from_array(self.forward);
        if self.orthographic == 1 {
            back
        } else {
            (self.eye() - point).try_normalize().unwrap_or(back)
        }
    }

    /// The camera for an image of `size` pixels.
    pub fn new(camera: &Camera, size: [u32; 2]) -> CameraUniform {
        let [right, up, back] = camera.axes();
        let aspect = size[0] as f32 / size[1] as f32;
        let (orthographic, half_height) = match camera.projection {
            Projection::Perspective { fov_y } => (0, (0.5 * fov_y).tan()),
            Projection::Orthographic { height } => (1, 0.5 * height),
        };
        CameraUniform {
            clip_from_world: camera.clip_from_world(size).to_cols_array_2d(),
            eye: camera.eye.to_array(),
            orthographic,
            forward: (-back).to_array(),
            pad: 0,
            right: right.to_array(),
            half_width: aspect * half_height,
            up: up.to_array(),
            half_height,
        }
    }

    /// The camera with its image widened about the middle, so that it shows `factor` times the width
    /// and height.
    pub fn widened(mut self, factor: f32) -> CameraUniform {
        self.half_width *= factor;
        self.half_height *= factor;
        for column in &mut self.clip_from_world {
            column[0] /= factor;
            column[1] /= factor;
        }
        self
    }

    /// A camera at the same eye that shows some world points as large as it can. `None` where one of
    /// them is beside or behind the eye.
    pub fn fitted(&self, points: &[Vec3]) -> Option<CameraUniform> {
        let parallel = self.orthographic == 1;
        let eye = self.eye();
        let (low, high) = points
            .iter()
            .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(a, b), p| (a.min(*p), b.max(*p)));
        let centre = 0.5 * (low + high);
        let own_forward = Vec3::from_array(self.forward);
        let forward = if parallel { own_forward } else { (centre - eye).try_normalize()? };
        let [own_right, own_up] = [self.right, self.up].map(Vec3::from_array);
        // Looking along the view's own up, its forward is as good.
        let hint = if forward.cross(own_up).length() > 0.1 { own_up } else { own_forward };
        let right = forward.cross(hint).try_normalize().unwrap_or(own_right);
        let up = right.cross(forward);
        // Parallel rays may start anywhere.
        let origin = if parallel { centre - forward * (centre - eye).dot(forward) } else { eye };
        let (mut half, mut near, mut far) = (Vec2::ZERO, f32::INFINITY, 0.0f32);
        for &point in points {
            let away = point - origin;
            let depth = away.dot(forward);
            let across = Vec2::new(away.dot(right), away.dot(up)).abs();
            let across = if parallel { across } else { across / depth.max(1e-9) };
            (half, near, far) = (half.max(across), near.min(depth), far.max(depth));
        }
        if near <= 0.0 || half.max_element() > WIDEST {
            return None;
        }
        half = (half * (1.0 + MARGIN)).max(Vec2::splat(1e-6));
        (near, far) = (near * (1.0 - MARGIN), far * (1.0 + MARGIN));
        let depth = (near - far).recip();
        // Rows of clip from world, reversed depth, y down.
        let row = |axis: Vec3| axis.extend(-axis.dot(origin));
        let ahead = row(forward);
        let (z, w) = if parallel {
            (depth * ahead - far * depth * Vec4::W, Vec4::W)
        } else {
            (near * (depth * ahead - far * depth * Vec4::W), ahead)
        };
        let rows = Mat4::from_cols(row(right) / half.x, -row(up) / half.y, z, w);
        Some(CameraUniform {
            clip_from_world: rows.transpose().to_cols_array_2d(),
            eye: origin.to_array(),
            forward: forward.to_array(),
            right: right.to_array(),
            half_width: half.x,
            up: up.to_array(),
            half_height: half.y,
            ..*self
        })
    }

    /// The same camera with its far plane at infinity or, where rays are parallel, `beyond` metres
    /// further off.
    pub fn deepened(mut self, beyond: f32) -> CameraUniform {
        let mut rows = Mat4::from_cols_array_2d(&self.clip_from_world).transpose();
        let (eye, forward) = (self.eye(), Vec3::from_array(self.forward));
        // Of the depth in clip space, linear in the distance ahead: its slope, and its value at the eye.
        let (slope, at_eye) = (rows.z_axis.xyz().dot(forward), rows.z_axis.dot(eye.extend(1.0)));
        let (slope, at_eye) = if self.orthographic == 1 {
            let [near, far] = [(1.0 - at_eye) / slope, beyond - at_eye / slope];
            ((near - far).recip(), far / (far - near))
        } else {
            (0.0, at_eye / (1.0 - slope))
        };
        rows.z_axis = (slope * forward).extend(at_eye - slope * forward.dot(eye));
        self.clip_from_world = rows.transpose().to_cols_array_2d();
        self
    }

    /// Where world points are on the image, -1 to 1, y down; `None` behind the eye.
    pub fn project(&self, point: Vec3) -> Option<Vec2> {
        let clip = Mat4::from_cols_array_2d(&self.clip_from_world) * point.extend(1.0);
        (clip.w > 0.0).then(|| clip.xy() / clip.w)
    }
}

/// The view a method fills the record for.
pub struct View<'a> {
    pub camera: CameraUniform,
    /// Width and height in pixels.
    pub size: [u32; 2],
    pub direct: &'a DirectView,
    pub footprint: &'a Footprint,
    /// The reflectors the method is asked for; it writes their pixels only.
    pub reflectors: &'a [ObjectId],
    /// The lobe of theirs that the record is for.
    pub lobe: Lobe,
    /// The last call was neither for the frame before this one nor for this one: what was learnt from it
    /// is void.
    pub cut: bool,
}

impl<'a> View<'a> {
    /// Bind what a shader wants of the camera and the footprint, pixel list included.
    pub fn bind<'f>(&self, pass: Pass<'f>) -> Pass<'f>
    where
        'a: 'f,
    {
        let footprint = self.footprint;
        pass.uniform("camera", &self.camera)
            .optional()
            .sample("reflector_id", &footprint.reflector)
            .optional()
            .sample("reflector_position", &footprint.position)
            .optional()
            .sample("reflector_normal", &footprint.normal)
            .optional()
            .buffer("pixels", &footprint.pixels)
            .optional()
            .uniform("lobe", &(self.lobe as u32))
            .optional()
    }

    /// Make the footprint's pixel list that of these reflectors, as far as they are asked for.
    pub fn list_pixels(
        &self,
        frame: &mut Frame,
        scene: &super::GpuScene,
        reflectors: &[ObjectId],
    ) -> Result<()> {
        self.footprint.list_pixels(frame, scene, &self.asked(reflectors))
    }

    /// Those of these reflectors that the view asks for.
    pub fn asked(&self, reflectors: &[ObjectId]) -> Vec<ObjectId> {
        let asked = reflectors.iter().filter(|object| self.reflectors.contains(object));
        asked.copied().collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::assert_layout;

    #[test]
    fn a_widened_camera_shows_the_same_ray_nearer_the_middle() {
        let camera = Camera {
            eye: Vec3::new(1.0, 2.0, 3.0),
            target: Vec3::new(0.2, 0.5, -0.3),
            up: Vec3::Y,
            projection: Projection::Perspective { fov_y: 1.0 },
            near: 0.05,
            far: 100.0,
        };
        let (size, pixel) = ([64, 48], Vec2::new(50.5, 7.5));
        let ndc = 2.0 * pixel / Vec2::new(64.0, 48.0) - 1.0;
        let point = camera.ray(size, pixel).at(3.0);
        let uniform = CameraUniform::new(&camera, size);
        assert!(uniform.project(point).unwrap().abs_diff_eq(ndc, 1e-5));
        let wide = uniform.widened(1.5);
        assert!(wide.project(point).unwrap().abs_diff_eq(ndc / 1.5, 1e-5));
        assert!((wide.half_width / uniform.half_width - 1.5).abs() < 1e-6);
        assert_eq!(uniform.project(camera.eye - (camera.target - camera.eye)), None);
    }

    #[test]
    fn a_deepened_camera_keeps_places_and_near_plane_and_sees_further() {
        let projections =
            [Projection::Perspective { fov_y: 1.0 }, Projection::Orthographic { height: 2.0 }];
        for projection in projections {
            let (eye, target, up) = (Vec3::new(1.0, 2.0, 3.0), Vec3::new(0.2, 0.5, -0.3), Vec3::Y);
            let camera = Camera { eye, target, up, projection, near: 0.5, far: 4.0 };
            let uniform = CameraUniform::new(&camera, [64, 48]);
            let deep = uniform.deepened(50.0);
            let ahead = (target - eye).normalize();
            let depth = |camera: &CameraUniform, away: f32| {
                let matrix = Mat4::from_cols_array_2d(&camera.clip_from_world);
                let clip = matrix * (eye + away * ahead).extend(1.0);
                clip.z / clip.w
            };
            assert!((depth(&deep, 0.5) - 1.0).abs() < 1e-5);
            assert!(depth(&uniform, 30.0) < 0.0);
            assert!(depth(&deep, 53.0) > 0.0 && depth(&deep, 53.0) < depth(&deep, 30.0));
            let point = Vec3::new(0.3, 0.4, 0.1);
            let places = [uniform.project(point).unwrap(), deep.project(point).unwrap()];
            assert!(places[0].abs_diff_eq(places[1], 1e-6));
        }
    }

    #[test]
    #[rustfmt::skip]
    fn the_camera_is_laid_out_as_its_wgsl_twin() {
        assert_layout!("stages/direct_view.wgsl", "Camera", CameraUniform,
            clip_from_world, eye, orthographic, forward, pad, right, half_width, up, half_height);
    }
}

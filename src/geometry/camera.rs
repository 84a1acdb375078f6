//! The camera: pixels to rays, points to pixels.
//!
//! Right-handed world, y up. Pixel coordinates have their origin at the top left corner of the
//! image and pixel centres at +0.5. Clip space is Vulkan's (y down) with reversed depth: 1 at
//! `near`, 0 at `far`.

use glam::camera::rh::{proj::vulkan, view::look_at_mat4};
use glam::{Mat4, Vec2, Vec3, Vec4Swizzles};

use super::Ray;

#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Projection {
    /// Vertical opening angle in radians.
    Perspective { fov_y: f32 },
    /// Height of the image in metres.
    Orthographic { height: f32 },
}

/// Where the picture is taken from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    pub eye: Vec3,
    pub target: Vec3,
    pub up: Vec3,
    pub projection: Projection,
    /// Nearest and farthest depth drawn, metres.
    pub near: f32,
    pub far: f32,
}

impl Camera {
    /// Camera axes in the world: right, up, and backward (from target to eye).
    pub fn axes(&self) -> [Vec3; 3] {
        let back = (self.eye - self.target).normalize();
        let right = self.up.cross(back).normalize();
        [right, back.cross(right), back]
    }

    /// World to camera space (right, up, backward).
    pub fn view_from_world(&self) -> Mat4 {
        look_at_mat4(self.eye, self.target, self.up)
    }

    /// World to clip space for an image of `size` pixels.
    pub fn clip_from_world(&self, size: [u32; 2]) -> Mat4 {
        let aspect = size[0] as f32 / size[1] as f32;
        // near and far exchanged: reversed depth.
        let clip_from_view = match self.projection {
            Projection::Perspective { fov_y } => {
                vulkan::perspective(fov_y, aspect, self.far, self.near)
            }
            Projection::Orthographic { height } => {
                let (w, h) = (0.5 * height * aspect, 0.5 * height);
                vulkan::orthographic(-w, w, -h, h, self.far, self.near)
            }
        };
        clip_from_view * self.view_from_world()
    }

    /// The eye ray through a pixel position of an image of `size` pixels.
    pub fn ray(&self, size: [u32; 2], pixel: Vec2) -> Ray {
        let [right, up, back] = self.axes();
        let aspect = size[0] as f32 / size[1] as f32;
        let x = (2.0 * pixel.x / size[0] as f32 - 1.0) * aspect;
        let y = 1.0 - 2.0 * pixel.y / size[1] as f32;
        match self.projection {
            Projection::Perspective { fov_y } => {
                let h = (0.5 * fov_y).tan();
                let direction = (x * h * right + y * h * up - back).normalize();
                Ray { origin: self.eye, direction }
            }
            Projection::Orthographic { height } => {
                let offset = 0.5 * height * (x * right + y * up);
                Ray { origin: self.eye + offset, direction: -back }
            }
        }
    }

    /// Pixel position of a world point, or `None` behind the camera.
    pub fn project(&self, size: [u32; 2], point: Vec3) -> Option<Vec2> {
        let clip = self.clip_from_world(size) * point.extend(1.0);
        if clip.w <= 0.0 {
            return None;
        }
        let ndc = clip.xy() / clip.w;
        let extent = Vec2::new(size[0] as f32, size[1] as f32);
        Some((0.5 * ndc + Vec2::splat(0.5)) * extent)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cameras() -> [Camera; 2] {
        let camera = Camera {
            eye: Vec3::new(1.0, 2.0, 3.0),
            target: Vec3::new(0.2, 0.5, -0.3),
            up: Vec3::Y,
            projection: Projection::Perspective { fov_y: 1.0 },
            near: 0.05,
            far: 100.0,
        };
        [camera, Camera { projection: Projection::Orthographic { height: 4.0 }, ..camera }]
    }

    #[test]
    fn projecting_a_point_of_a_pixels_ray_gives_the_pixel() {
        for camera in cameras() {
            for pixel in [Vec2::new(0.5, 0.5), Vec2::new(31.25, 7.75), Vec2::new(63.5, 47.5)] {
                let point = camera.ray([64, 48], pixel).at(3.7);
                let back = camera.project([64, 48], point).unwrap();
                assert!(back.abs_diff_eq(pixel, 1e-3), "{pixel} came back as {back}");
            }
        }
    }

    #[test]
    fn depth_is_reversed() {
        for camera in cameras() {
            let clip = camera.clip_from_world([64, 64]);
            let [_, _, back] = camera.axes();
            for (distance, expected) in [(camera.near, 1.0), (camera.far, 0.0)] {
                let depth = clip.project_point3(camera.eye - distance * back).z;
                assert!((depth - expected).abs() < 1e-4, "{distance} m has depth {depth}");
            }
        }
    }
}

//! Which direction of the map stands for a mirrored ray: itself, or one that a proxy gives.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use super::super::Values;
use crate::scene::{Moment, ObjectId, Scene};

/// WGSL `Params` of `shaders/environment_map/sight.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub struct Params {
    centre: [f32; 3],
    radius: f32,
    low: [f32; 3],
    pad_a: u32,
    high: [f32; 3],
    pad_b: u32,
}

/// The proxy of a case.
pub struct Sight {
    /// Of the proxy sphere, metres; 0 fits it to the scene.
    radius: f32,
}

impl Sight {
    pub fn new(values: &Values) -> Sight {
        Sight { radius: values.f32("proxy_radius") }
    }

    /// Shader definitions of what imports `environment_map::sight`.
    pub fn defines(values: &Values) -> Vec<(&'static str, u32)> {
        match (values.get("index"), values.get("proxy")) {
            ("surface", _) => vec![("INDEX_SURFACE", 1)],
            (_, "sphere") => vec![("PROXY_SPHERE", 1)],
            (_, "box") => vec![("PROXY_BOX", 1)],
            _ => Vec::new(),
        }
    }

    /// For a map taken from `centre`.
    pub fn params(&self, scene: &Scene, moment: &Moment, centre: Vec3) -> Params {
        let [low, high] = surroundings(scene, moment).map(|corner| corner - centre);
        let sides = low.abs() + high.abs();
        let radius = if self.radius > 0.0 { self.radius } else { sides.element_sum() / 6.0 };
        let (centre, low, high) = (centre.to_array(), low.to_array(), high.to_array());
        Params { centre, radius, low, high, ..Params::zeroed() }
    }
}

/// The box of everything but the reflectors.
fn surroundings(scene: &Scene, moment: &Moment) -> [Vec3; 2] {
    let diffuse = (0..scene.objects.len() as ObjectId).filter(|&o| !scene.is_reflector(o));
    let (low, high) = scene.bounds_of(moment, &diffuse.collect::<Vec<_>>());
    [low, high]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::assert_layout;
    use crate::scene;

    #[test]
    #[rustfmt::skip]
    fn parameters_are_laid_out_as_their_wgsl_twin() {
        assert_layout!("environment_map/reflect.wgsl", "Params", Params,
            centre, radius, low, pad_a, high, pad_b);
    }

    #[test]
    fn a_room_is_its_own_proxy() {
        let room = scene::load("patow-room").unwrap();
        let params = Sight { radius: 0.0 }.params(&room, &room.at(0), Vec3::ZERO);
        let half = Vec3::new(4.0, 3.0, 4.0);
        assert!(Vec3::from(params.low).abs_diff_eq(-half, 1e-5));
        assert!(Vec3::from(params.high).abs_diff_eq(half, 1e-5));
        assert!((params.radius - 11.0 / 3.0).abs() < 1e-6);
        let forced = Sight { radius: 2.5 }.params(&room, &room.at(0), Vec3::X);
        assert!(forced.radius == 2.5 && (forced.low[0] + 5.0).abs() < 1e-5);
    }
}

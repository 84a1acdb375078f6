//! The one shading function. Its twin on the GPU is `shaders/bindings/scene.wgsl`: the formulas,
//! and the order of their operations, are the same.

use glam::{Vec2, Vec3};

use crate::geometry::latlong;

use super::{Environment, Image, Material, ObjectId, Pattern, Scene};

/// Light a surface sends out, without what its mirror reflects: albedo times light.
///
/// `normal_ws` has unit length and points to the side the ray arrives from; `uv` are the mesh's
/// texture coordinates there. `sunlit`: nothing stands between the sun and the surface.
pub fn shade(scene: &Scene, object: ObjectId, normal_ws: Vec3, uv: Vec2, sunlit: bool) -> Vec3 {
    let light = &scene.lighting;
    let cosine = if sunlit { normal_ws.dot(light.towards_sun).max(0.0) } else { 0.0 };
    albedo(scene, scene.material_of(object), uv) * (light.ambient + light.sun * cosine)
}

/// Diffuse albedo of a material at texture coordinates.
pub fn albedo(scene: &Scene, material: &Material, uv: Vec2) -> Vec3 {
    match material.pattern {
        Pattern::Colour(colour) => colour,
        Pattern::Checker { even, odd, size } => {
            let cell = (uv / size).floor();
            let parity = cell.x + cell.y - 2.0 * (0.5 * (cell.x + cell.y)).floor();
            if parity == 0.0 { even } else { odd }
        }
        Pattern::Grid { ground, lines, size, line } => {
            let nearest = (uv / size + 0.5).floor();
            let distance = (uv - nearest * size).abs();
            if distance.min_element() < 0.5 * line { lines } else { ground }
        }
        Pattern::Image { image, size } => {
            let uv = uv / size;
            bilinear(&scene.images[image], Vec2::new(uv.x, 1.0 - uv.y), Edge::Wrap)
        }
    }
}

/// Radiance that arrives from infinitely far away along the unit vector towards it.
pub fn environment(scene: &Scene, direction: Vec3) -> Vec3 {
    match scene.environment {
        Environment::Colour(colour) => colour,
        Environment::Gradient { zenith, horizon, nadir } => {
            let end = if direction.y >= 0.0 { zenith } else { nadir };
            horizon + (end - horizon) * direction.y.abs()
        }
        Environment::LatLong { image } => {
            bilinear(&scene.images[image], latlong::place(direction), Edge::Clamp)
        }
    }
}

/// What lies above the top and below the bottom row of an image. Columns always wrap.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Edge {
    Wrap,
    Clamp,
}

/// Bilinear look-up between texel centres; (0, 0) is the upper left corner of the image.
pub fn bilinear(image: &Image, uv: Vec2, rows: Edge) -> Vec3 {
    let (width, height) = (image.width as i32, image.height as i32);
    let at = uv * Vec2::new(width as f32, height as f32) - 0.5;
    let base = at.floor();
    let f = at - base;
    let (x, y) = (base.x as i32, base.y as i32);
    let texel = |x: i32, y: i32| {
        let column = x.rem_euclid(width);
        let row = match rows {
            Edge::Wrap => y.rem_euclid(height),
            Edge::Clamp => y.clamp(0, height - 1),
        };
        image.texels[(row * width + column) as usize]
    };
    let upper = texel(x, y) * (1.0 - f.x) + texel(x + 1, y) * f.x;
    let lower = texel(x, y + 1) * (1.0 - f.x) + texel(x + 1, y + 1) * f.x;
    upper * (1.0 - f.y) + lower * f.y
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::{Camera, Mesh, Projection};
    use crate::scene::{CameraPath, Lighting, Motion, Object};
    use glam::Affine3A;

    /// One object of one material under one environment.
    fn scene(pattern: Pattern, environment: Environment, images: Vec<Image>) -> Scene {
        let projection = Projection::Perspective { fov_y: 1.0 };
        let (eye, target, up) = (Vec3::Z, Vec3::ZERO, Vec3::Y);
        let camera = Camera { eye, target, up, projection, near: 0.1, far: 1.0 };
        Scene {
            name: "test".to_owned(),
            about: String::new(),
            hash: String::new(),
            frames: 1,
            rate_hz: 24.0,
            camera: CameraPath::Keys(vec![(0.0, camera)]),
            objects: vec![Object {
                name: "one".to_owned(),
                group: "one".to_owned(),
                mesh: 0,
                closed: None,
                material: 0,
                surface: None,
                motion: Motion::Still(Affine3A::IDENTITY),
                impostor: Default::default(),
            }],
            wobbles: Default::default(),
            meshes: vec![Mesh::default()],
            materials: vec![Material {
                name: "only".to_owned(),
                pattern,
                mirror: None,
                glass: None,
            }],
            images,
            environment,
            lighting: Lighting {
                ambient: Vec3::splat(0.25),
                towards_sun: Vec3::Y,
                sun: Vec3::new(1.0, 0.5, 0.0),
                shadows: true,
            },
            bounces: 1,
        }
    }

    fn albedo_at(scene: &Scene, u: f32, v: f32) -> Vec3 {
        albedo(scene, &scene.materials[0], Vec2::new(u, v))
    }

    const BLACK: Environment = Environment::Colour(Vec3::ZERO);

    #[test]
    fn light_is_ambient_plus_the_cosine_to_the_sun() {
        let scene = scene(Pattern::Colour(Vec3::splat(0.5)), BLACK, vec![]);
        let slanted = Vec3::new(0.8, 0.6, 0.0);
        let at = |normal, sunlit| shade(&scene, 0, normal, Vec2::ZERO, sunlit);
        assert!(at(slanted, true).abs_diff_eq(0.5 * Vec3::new(0.85, 0.55, 0.25), 1e-6));
        assert_eq!(at(Vec3::NEG_Y, true), Vec3::splat(0.125), "no light from behind");
        assert_eq!(at(Vec3::Y, false), Vec3::splat(0.125), "nor in the shade");
    }

    #[test]
    fn checkers_change_colour_at_every_edge_also_below_zero() {
        let checker = Pattern::Checker { even: Vec3::X, odd: Vec3::Y, size: Vec2::new(0.5, 2.0) };
        let scene = scene(checker, BLACK, vec![]);
        for (u, v, expected) in [
            (0.1, 0.1, Vec3::X),
            (0.6, 0.1, Vec3::Y),
            (0.6, 2.1, Vec3::X),
            (-0.1, 0.1, Vec3::Y),
            (-0.1, -0.1, Vec3::X),
            (-0.6, 0.1, Vec3::X),
        ] {
            assert_eq!(albedo_at(&scene, u, v), expected, "at ({u}, {v})");
        }
    }

    #[test]
    fn grid_lines_are_centred_on_the_multiples_of_the_size() {
        let size = Vec2::new(1.0, 0.5);
        let grid = Pattern::Grid { ground: Vec3::X, lines: Vec3::Y, size, line: 0.1 };
        let scene = scene(grid, BLACK, vec![]);
        for (u, v, expected) in [
            (0.5, 0.25, Vec3::X),
            (0.96, 0.25, Vec3::Y),
            (1.04, 0.25, Vec3::Y),
            (1.06, 0.25, Vec3::X),
            (-0.96, 0.25, Vec3::Y),
            (0.5, 0.54, Vec3::Y),
            (0.5, 0.56, Vec3::X),
        ] {
            assert_eq!(albedo_at(&scene, u, v), expected, "at ({u}, {v})");
        }
    }

    /// Two by two texels: 1 2 above 3 4.
    fn four() -> Image {
        Image { width: 2, height: 2, texels: [1.0, 2.0, 3.0, 4.0].map(Vec3::splat).to_vec() }
    }

    #[test]
    fn images_stand_upright_are_filtered_and_repeat() {
        let image = Pattern::Image { image: 0, size: Vec2::new(4.0, 2.0) };
        let scene = scene(image, BLACK, vec![four()]);
        for (u, v, expected) in [
            (1.0, 1.5, 1.0),
            (3.0, 1.5, 2.0),
            (1.0, 0.5, 3.0),
            (3.0, 0.5, 4.0),
            (2.0, 1.5, 1.5),
            (2.0, 1.0, 2.5),
            (0.0, 1.5, 1.5),
            (1.0, 2.0, 2.0),
            (-1.0, 3.5, 2.0),
        ] {
            assert!((albedo_at(&scene, u, v).x - expected).abs() < 1e-6, "at ({u}, {v})");
        }
    }

    #[test]
    fn clamped_rows_hold_at_top_and_bottom_while_columns_wrap() {
        let image = four();
        let at = |u, v| bilinear(&image, Vec2::new(u, v), Edge::Clamp).x;
        assert_eq!((at(0.25, 0.0), at(0.75, 1.0)), (1.0, 4.0));
        assert_eq!((at(0.0, 0.25), at(1.0, 0.25)), (1.5, 1.5));
    }

    #[test]
    fn latitude_and_longitude_have_minus_z_in_the_middle() {
        for (direction, u, v) in [
            (Vec3::NEG_Z, 0.5, 0.5),
            (Vec3::X, 0.75, 0.5),
            (Vec3::NEG_X, 0.25, 0.5),
            (Vec3::new(0.0, 0.5f32.sqrt(), -(0.5f32.sqrt())), 0.5, 0.25),
        ] {
            assert!(latlong::place(direction).abs_diff_eq(Vec2::new(u, v), 1e-6), "{direction}");
        }
        assert_eq!(latlong::place(Vec3::Y).y, 0.0);
        assert_eq!(latlong::place(Vec3::NEG_Y).y, 1.0);
        let sky =
            scene(Pattern::Colour(Vec3::ZERO), Environment::LatLong { image: 0 }, vec![four()]);
        assert!((environment(&sky, Vec3::NEG_Z).x - 2.5).abs() < 1e-6);
    }

    #[test]
    fn gradients_pass_through_their_three_colours() {
        let gradient = Environment::Gradient { zenith: Vec3::X, horizon: Vec3::Y, nadir: Vec3::Z };
        let scene = scene(Pattern::Colour(Vec3::ZERO), gradient, vec![]);
        for (direction, expected) in [
            (Vec3::Y, Vec3::X),
            (Vec3::X, Vec3::Y),
            (Vec3::NEG_Y, Vec3::Z),
            (Vec3::new(0.8, 0.6, 0.0), Vec3::new(0.6, 0.4, 0.0)),
            (Vec3::new(0.8, -0.6, 0.0), Vec3::new(0.0, 0.4, 0.6)),
        ] {
            assert!(environment(&scene, direction).abs_diff_eq(expected, 1e-6), "{direction}");
        }
    }
}

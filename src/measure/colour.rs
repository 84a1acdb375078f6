//! Errors of the picture's colours over the pixels of the reflectors.

use glam::Vec3;
use nv_flip::{FlipImageFloat, FlipImageRgb8};

use crate::geometry::{Camera, Projection};

/// Linear radiance is multiplied by this, cut at one and encoded as sRGB before PSNR and FLIP.
pub const EXPOSURE: f32 = 1.0;

/// Added to the squared reference, so that black pixels do not decide the relative error.
const RELATIVE_FLOOR: f64 = 1e-2;

/// The fixed tone mapping: exposure, clamp, sRGB curve, 8 bits.
pub fn tone_map(linear: Vec3) -> [u8; 3] {
    displayed(linear).to_array().map(|value| (255.0 * value).round() as u8)
}

/// The same before rounding, 0 to 1.
pub fn displayed(linear: Vec3) -> Vec3 {
    linear.map(|value| {
        let value = (EXPOSURE * value).clamp(0.0, 1.0);
        if value <= 0.003_130_8 { 12.92 * value } else { 1.055 * value.powf(1.0 / 2.4) - 0.055 }
    })
}

/// Mean over pixels and channels of the squared difference, relative to the squared reference.
pub fn relative_mse(pairs: impl Iterator<Item = [Vec3; 2]>) -> f64 {
    mean(pairs.map(|[reference, tested]| {
        let reference = reference.as_dvec3();
        let difference = tested.as_dvec3() - reference;
        (difference * difference / (reference * reference + RELATIVE_FLOOR)).element_sum() / 3.0
    }))
}

/// Peak signal to noise ratio in decibels after [`tone_map`]; `None` where nothing differs.
pub fn psnr(pairs: impl Iterator<Item = [Vec3; 2]>) -> Option<f64> {
    let squared = mean(pairs.map(|[reference, tested]| {
        let channels = tone_map(reference).into_iter().zip(tone_map(tested));
        channels.map(|(a, b)| f64::from(a.abs_diff(b)).powi(2)).sum::<f64>() / 3.0
    }));
    (squared > 0.0).then(|| 10.0 * (255.0 * 255.0 / squared).log10())
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0u64), |(sum, count), value| (sum + value, count + 1));
    if count == 0 { 0.0 } else { sum / count as f64 }
}

/// FLIP (Andersson et al., HPG 2020) of two tone-mapped images, a value a pixel between 0 and 1.
pub fn flip_map(
    size: [u32; 2],
    reference: &[Vec3],
    tested: &[Vec3],
    pixels_per_degree: f32,
) -> Vec<f32> {
    flip(size, reference, tested, pixels_per_degree).to_vec()
}

/// The same in the colours FLIP's authors draw it with: black for no difference, through red, to
/// light yellow.
pub fn flip_picture(
    size: [u32; 2],
    reference: &[Vec3],
    tested: &[Vec3],
    pixels_per_degree: f32,
) -> Vec<[u8; 3]> {
    let errors = flip(size, reference, tested, pixels_per_degree);
    let bytes = errors.apply_color_lut(&nv_flip::magma_lut()).to_vec();
    bytes.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect()
}

fn flip(size: [u32; 2], reference: &[Vec3], tested: &[Vec3], ppd: f32) -> FlipImageFloat {
    let image = |pixels: &[Vec3]| {
        let bytes: Vec<u8> = pixels.iter().flat_map(|&pixel| tone_map(pixel)).collect();
        FlipImageRgb8::with_data(size[0], size[1], &bytes)
    };
    nv_flip::flip(image(reference), image(tested), ppd)
}

/// Pixels that one degree of the camera's field of view covers at the image's centre. An
/// orthographic image has no such angle and is taken to be seen on FLIP's default display.
pub fn pixels_per_degree(camera: &Camera, size: [u32; 2]) -> f32 {
    match camera.projection {
        Projection::Perspective { fov_y } => {
            let pixel = f32::atan(2.0 * (0.5 * fov_y).tan() / size[1] as f32);
            1.0 / pixel.to_degrees()
        }
        Projection::Orthographic { .. } => nv_flip::DEFAULT_PIXELS_PER_DEGREE,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn psnr_of_a_known_difference() {
        let [reference, tested] = [Vec3::ZERO, Vec3::ONE];
        assert_eq!(psnr([[reference, reference]].into_iter()), None);
        assert_eq!(psnr([[reference, tested]].into_iter()), Some(0.0));
        let half = psnr([[reference, tested], [reference, reference]].into_iter());
        assert!((half.unwrap() - 10.0 * 2f64.log10()).abs() < 1e-9);
    }

    #[test]
    fn relative_mse_of_a_known_difference() {
        let pair = [Vec3::splat(0.5), Vec3::new(0.5, 0.5, 0.6)];
        let expected = 0.1f64.powi(2) / (0.25 + RELATIVE_FLOOR) / 3.0;
        assert!((relative_mse([pair].into_iter()) - expected).abs() < 1e-6);
    }

    #[test]
    fn the_tone_map_is_srgb() {
        assert_eq!(tone_map(Vec3::new(0.0, 0.215_861, 7.0)), [0, 128, 255]);
        assert_eq!(tone_map(Vec3::new(-1.0, f32::NAN, f32::INFINITY)), [0, 0, 255]);
    }

    #[test]
    fn flip_is_zero_on_equal_images_and_not_on_others() {
        let size = [16, 16];
        let grey = vec![Vec3::splat(0.3); 256];
        let mut spot = grey.clone();
        spot[8 * 16 + 8] = Vec3::X;
        assert!(flip_map(size, &grey, &grey, 20.0).iter().all(|&error| error == 0.0));
        let errors = flip_map(size, &grey, &spot, 20.0);
        assert!(errors[8 * 16 + 8] > 0.1);
        assert!(errors[0] < errors[8 * 16 + 8]);
    }

    #[test]
    fn a_degree_covers_the_pixels_the_field_of_view_says() {
        let camera = Camera {
            eye: Vec3::ZERO,
            target: Vec3::NEG_Z,
            up: Vec3::Y,
            projection: Projection::Perspective { fov_y: 60f32.to_radians() },
            near: 0.1,
            far: 10.0,
        };
        // tan 30 deg is 0.57735: half the 720 rows over it is the focal length in pixels.
        let expected = (1f32.to_radians()) * 360.0 / 0.577_35;
        assert!((pixels_per_degree(&camera, [1280, 720]) - expected).abs() < 1e-2);
    }
}

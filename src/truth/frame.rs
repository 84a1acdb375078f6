//! A whole frame of truth.

use glam::{UVec2, Vec2, Vec3, Vec4};
use rayon::prelude::*;

use super::{Chain, Tracer};
use crate::geometry::Ray;
use crate::scene::{FrameRecord, Ids, NO_OBJECT, ObjectId, shading};

/// Pixels of a tile's side: small enough to balance the load, large enough to stay in the caches.
const TILE: u32 = 16;

/// One pixel of a [`FrameRecord`].
struct Pixel {
    colour: Vec3,
    depth: f32,
    reflector: ObjectId,
    position: Vec3,
    normal: Vec3,
    radiance: Vec3,
    point: Vec4,
    last: Vec4,
    ids: Ids,
}

impl Pixel {
    const BACKGROUND: Pixel = Pixel {
        colour: Vec3::ZERO,
        depth: f32::INFINITY,
        reflector: NO_OBJECT,
        position: Vec3::ZERO,
        normal: Vec3::ZERO,
        radiance: Vec3::ZERO,
        point: Vec4::ZERO,
        last: Vec4::ZERO,
        ids: Ids::MISSING,
    };
}

impl Tracer<'_> {
    /// Trace an image of `size` pixels on all cores. The same at any number of threads.
    pub fn frame(&self, size: [u32; 2]) -> FrameRecord {
        let tiles = UVec2::from(size).map(|side| side.div_ceil(TILE));
        let traced: Vec<(UVec2, Vec<Pixel>)> = (0..tiles.x * tiles.y)
            .into_par_iter()
            .with_max_len(1)
            .map(|tile| {
                let corner = TILE * UVec2::new(tile % tiles.x, tile / tiles.x);
                let end = (corner + TILE).min(size.into());
                (corner, pixels(corner, end).map(|pixel| self.pixel(size, pixel)).collect())
            })
            .collect();
        let mut frame = FrameRecord::new(size);
        for (corner, tile) in traced {
            let end = (corner + TILE).min(size.into());
            for (at, pixel) in pixels(corner, end).zip(tile) {
                store(&mut frame, (at.y * size[0] + at.x) as usize, pixel);
            }
        }
        frame
    }

    /// The record of a pixel's centre, and its picture.
    fn pixel(&self, size: [u32; 2], at: UVec2) -> Pixel {
        let ray = self.moment.camera.ray(size, at.as_vec2() + 0.5);
        let mut pixel = self.centre(&ray);
        let side = f64::from(self.options.spp).sqrt().ceil() as u32;
        if side > 1 {
            let strata = pixels(UVec2::ZERO, UVec2::splat(side));
            let sum: Vec3 = strata
                .map(|cell| at.as_vec2() + (cell.as_vec2() + 0.5) / side as f32)
                .map(|position| self.colour(size, position))
                .sum();
            pixel.colour = sum / (side * side) as f32;
        }
        pixel
    }

    fn colour(&self, size: [u32; 2], position: Vec2) -> Vec3 {
        let ray = self.moment.camera.ray(size, position);
        match self.look(&ray) {
            Some(hit) => self.leaving(&hit, ray.direction, self.bounces()),
            None => shading::environment(self.scene, ray.direction),
        }
    }

    fn centre(&self, ray: &Ray) -> Pixel {
        let Some(hit) = self.look(ray) else {
            let colour = shading::environment(self.scene, ray.direction);
            return Pixel { colour, ..Pixel::BACKGROUND };
        };
        let camera = &self.moment.camera;
        let [_, _, back] = camera.axes();
        let seen = Pixel {
            colour: self.diffuse(&hit),
            depth: (camera.eye - hit.point).dot(back),
            ..Pixel::BACKGROUND
        };
        if self.mirror(&hit).is_none() {
            return seen;
        }
        let chain = self.chain(hit, ray.direction);
        Pixel {
            colour: self.composite(&hit, chain.radiance),
            reflector: hit.object,
            position: hit.point,
            normal: hit.normal,
            radiance: chain.radiance,
            point: chain.point(),
            last: last(&chain),
            ids: chain.ids(),
            ..seen
        }
    }
}

fn last(chain: &Chain) -> Vec4 {
    chain.last().hit.point.extend(chain.path)
}

/// Row-major positions from `corner` to before `end`.
fn pixels(corner: UVec2, end: UVec2) -> impl Iterator<Item = UVec2> {
    (corner.y..end.y).flat_map(move |y| (corner.x..end.x).map(move |x| UVec2::new(x, y)))
}

fn store(frame: &mut FrameRecord, index: usize, pixel: Pixel) {
    frame.colour[index] = pixel.colour;
    frame.depth[index] = pixel.depth;
    frame.reflector[index] = pixel.reflector;
    frame.position[index] = pixel.position;
    frame.normal[index] = pixel.normal;
    frame.record.radiance[index] = pixel.radiance;
    frame.record.point[index] = pixel.point;
    frame.record.last[index] = pixel.last;
    frame.record.ids[index] = pixel.ids;
}

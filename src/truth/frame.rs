//! A whole frame of truth.

use glam::{UVec2, Vec2, Vec3, Vec4};
use rayon::prelude::*;

use super::{Chain, Tracer};
use crate::geometry::Ray;
use crate::scene::{FrameRecord, Ids, Lobe, NO_OBJECT, ObjectId, ReflectionRecord, shading};

/// Pixels of a tile's side: small enough to balance the load, large enough to stay in the caches.
const TILE: u32 = 16;

/// One pixel of a [`FrameRecord`].
struct Pixel {
    colour: Vec3,
    depth: f32,
    object: ObjectId,
    reflector: ObjectId,
    position: Vec3,
    normal: Vec3,
    reflected: Answer,
    refracted: Answer,
}

/// One pixel of a [`ReflectionRecord`].
struct Answer {
    radiance: Vec3,
    point: Vec4,
    last: Vec4,
    ids: Ids,
}

impl Answer {
    const MISSING: Answer =
        Answer { radiance: Vec3::ZERO, point: Vec4::ZERO, last: Vec4::ZERO, ids: Ids::MISSING };

    fn of(chain: &Chain) -> Self {
        Answer {
            radiance: chain.radiance,
            point: chain.point(),
            last: chain.last().hit.point.extend(chain.path),
            ids: chain.ids(),
        }
    }

    fn store(self, record: &mut ReflectionRecord, index: usize) {
        record.radiance[index] = self.radiance;
        record.point[index] = self.point;
        record.last[index] = self.last;
        record.ids[index] = self.ids;
    }
}

impl Pixel {
    const BACKGROUND: Pixel = Pixel {
        colour: Vec3::ZERO,
        depth: f32::INFINITY,
        object: NO_OBJECT,
        reflector: NO_OBJECT,
        position: Vec3::ZERO,
        normal: Vec3::ZERO,
        reflected: Answer::MISSING,
        refracted: Answer::MISSING,
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
        if self.scene.refracts() {
            frame.refracted = Some(ReflectionRecord::missing(frame.reflector.len()));
        }
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
            let strata = pixels(UVec2::ZERO, UVec2::splat(side)).zip(0..);
            let sum: Vec3 = strata
                .map(|(cell, index)| {
                    let within = cell.as_vec2() + jitter(at, index);
                    self.colour(size, at.as_vec2() + within / side as f32)
                })
                .sum();
            pixel.colour = sum / (side * side) as f32;
        }
        pixel
    }

    fn colour(&self, size: [u32; 2], position: Vec2) -> Vec3 {
        let ray = self.moment.camera.ray(size, position);
        match self.look(&ray) {
            Some(hit) => self.seen(&hit, ray.direction),
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
            object: hit.object,
            ..Pixel::BACKGROUND
        };
        if !self.scene.is_reflector(hit.object) {
            return seen;
        }
        let [reflected, refracted] = [Lobe::Reflected, Lobe::Refracted].map(|lobe| {
            let chain = self.chain(hit, ray.direction, lobe);
            chain.map_or(Answer::MISSING, |chain| Answer::of(&chain))
        });
        Pixel {
            colour: self.composite(&hit, ray.direction, |lobe| match lobe {
                Lobe::Reflected => {
                    let material = self.scene.material_of(hit.object);
                    material.faded(reflected.last.w) * reflected.radiance
                }
                Lobe::Refracted => refracted.radiance,
            }),
            reflector: hit.object,
            position: hit.point,
            normal: hit.normal,
            reflected,
            refracted,
            ..seen
        }
    }
}

/// A place in the unit square for a sample of a pixel, the same in every run. The integer hash is
/// Wellons's lowbias32 (2018).
fn jitter(pixel: UVec2, sample: u32) -> Vec2 {
    let hash = |mut x: u32| {
        x = (x ^ x >> 16).wrapping_mul(0x7feb_352d);
        x = (x ^ x >> 15).wrapping_mul(0x846c_a68b);
        x ^ x >> 16
    };
    let seed = hash(pixel.x ^ hash(pixel.y ^ hash(sample)));
    // 24 bits fill a float below one.
    let unit = |bits: u32| (bits >> 8) as f32 / (1u32 << 24) as f32;
    Vec2::new(unit(seed), unit(hash(seed ^ 1)))
}

/// Row-major positions from `corner` to before `end`.
fn pixels(corner: UVec2, end: UVec2) -> impl Iterator<Item = UVec2> {
    (corner.y..end.y).flat_map(move |y| (corner.x..end.x).map(move |x| UVec2::new(x, y)))
}

fn store(frame: &mut FrameRecord, index: usize, pixel: Pixel) {
    frame.colour[index] = pixel.colour;
    frame.depth[index] = pixel.depth;
    frame.object[index] = pixel.object;
    frame.reflector[index] = pixel.reflector;
    frame.position[index] = pixel.position;
    frame.normal[index] = pixel.normal;
    pixel.reflected.store(&mut frame.record, index);
    if let Some(record) = &mut frame.refracted {
        pixel.refracted.store(record, index);
    }
}

//! The reflection record: for every pixel a reflector covers, which scene point its mirror shows.
//!
//! Methods fill one on the GPU, the truth fills one on the CPU; both use the same words, so a
//! readback is a copy and `measure` compares like with like.

use glam::{Vec3, Vec4};

use super::{NO_OBJECT, ObjectId};

/// What the answer is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Status {
    /// Nothing was found, or nobody looked.
    Missing = 0,
    /// A surface point of the scene.
    Found = 1,
    /// A direction of the environment.
    Environment = 2,
}

/// Who found it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Source {
    Method = 0,
    FallbackEnvironment = 1,
    FallbackRay = 2,
}

/// Which way the light left the first reflector.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u32)]
pub enum Lobe {
    Reflected = 0,
    Refracted = 1,
}

/// The identity of one record, packed as the GPU stores it (RGBA32_UINT):
/// object, triangle, trace (8 bits a bounce, 1 + the reflector's rank among the scene's
/// reflectors, first bounce lowest), and order | lobe << 8 | status << 12 | source << 16 | flag << 20.
#[derive(Clone, Copy, Debug, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub struct Ids {
    /// Object shown; [`NO_OBJECT`] where none is.
    pub object: ObjectId,
    /// Triangle of that object's mesh.
    pub triangle: u32,
    pub trace: u32,
    pub bits: u32,
}

/// How many bounces the packed trace can tell apart.
pub const TRACE_BOUNCES: u32 = 4;

impl Ids {
    pub const MISSING: Ids = Ids { object: NO_OBJECT, triangle: 0, trace: 0, bits: 0 };

    pub fn new(object: ObjectId, triangle: u32, trace: u32, order: u32, status: Status) -> Self {
        Ids { object, triangle, trace, bits: order | (status as u32) << 12 }
    }

    /// The same for a chain that leaves the first reflector by `lobe`.
    pub fn by(self, lobe: Lobe) -> Self {
        Ids { bits: self.bits & !(0xf << 8) | (lobe as u32) << 8, ..self }
    }

    /// Number of reflectors met.
    pub fn order(self) -> u32 {
        self.bits & 0xff
    }

    pub fn lobe(self) -> Lobe {
        if self.bits >> 8 & 0xf == 1 { Lobe::Refracted } else { Lobe::Reflected }
    }

    pub fn status(self) -> Status {
        match self.bits >> 12 & 0xf {
            1 => Status::Found,
            2 => Status::Environment,
            _ => Status::Missing,
        }
    }

    pub fn source(self) -> Source {
        match self.bits >> 16 & 0xf {
            1 => Source::FallbackEnvironment,
            2 => Source::FallbackRay,
            _ => Source::Method,
        }
    }

    /// The method doubts its answer.
    pub fn flag(self) -> bool {
        self.bits >> 20 & 1 == 1
    }

    /// The trace with one more reflector, given by its rank; beyond [`TRACE_BOUNCES`] it stays.
    pub fn extended(trace: u32, order: u32, rank: u32) -> u32 {
        if order >= TRACE_BOUNCES { trace } else { trace | ((rank + 1) & 0xff) << (8 * order) }
    }
}

/// One specular chain a pixel, row-major, row 0 on top. Meaningful where a reflector is.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ReflectionRecord {
    /// Light arriving at the reflector point R along the chain: throughput of later bounces
    /// included, tint, Fresnel and attenuation of the first not.
    pub radiance: Vec<Vec3>,
    /// The scene point whose colour is shown, w = 1; or a unit direction, w = 0.
    pub point: Vec<Vec4>,
    /// Where the last bounce happened (R itself at order 1); w is the path length from R to S in
    /// metres, infinite for the environment.
    pub last: Vec<Vec4>,
    pub ids: Vec<Ids>,
}

impl ReflectionRecord {
    /// A record in which nothing was found.
    pub fn missing(pixels: usize) -> Self {
        ReflectionRecord {
            radiance: vec![Vec3::ZERO; pixels],
            point: vec![Vec4::ZERO; pixels],
            last: vec![Vec4::ZERO; pixels],
            ids: vec![Ids::MISSING; pixels],
        }
    }
}

/// Everything one frame of one case leaves behind for measuring; all images are row-major, row 0
/// on top, `size[0] * size[1]` long.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrameRecord {
    /// Width and height in pixels.
    pub size: [u32; 2],
    /// The finished picture, linear.
    pub colour: Vec<Vec3>,
    /// Distance from the camera's plane through the eye, metres; infinite on the background.
    pub depth: Vec<f32>,
    /// Object seen directly; [`NO_OBJECT`] on the background.
    pub object: Vec<ObjectId>,
    /// Reflector seen; [`NO_OBJECT`] elsewhere.
    pub reflector: Vec<ObjectId>,
    /// R: the reflector's surface point, where there is one.
    pub position: Vec<Vec3>,
    /// N: the reflector's unit shading normal there, on the side of the eye.
    pub normal: Vec<Vec3>,
    /// The chains that the reflectors mirror.
    pub record: ReflectionRecord,
    /// The chains that glass lets through; only of scenes that have any.
    pub refracted: Option<ReflectionRecord>,
}

impl FrameRecord {
    /// An empty frame: background everywhere, nothing found.
    pub fn new(size: [u32; 2]) -> Self {
        let pixels = (size[0] * size[1]) as usize;
        FrameRecord {
            size,
            colour: vec![Vec3::ZERO; pixels],
            depth: vec![f32::INFINITY; pixels],
            object: vec![NO_OBJECT; pixels],
            reflector: vec![NO_OBJECT; pixels],
            position: vec![Vec3::ZERO; pixels],
            normal: vec![Vec3::ZERO; pixels],
            record: ReflectionRecord::missing(pixels),
            refracted: None,
        }
    }

    /// The record of a lobe, where the scene has it.
    pub fn lobe(&self, lobe: Lobe) -> Option<&ReflectionRecord> {
        match lobe {
            Lobe::Reflected => Some(&self.record),
            Lobe::Refracted => self.refracted.as_ref(),
        }
    }

    /// The pixels that see a reflector, in rising order.
    pub fn reflector_pixels(&self) -> Vec<usize> {
        (0..self.reflector.len()).filter(|&pixel| self.reflector[pixel] != NO_OBJECT).collect()
    }
}

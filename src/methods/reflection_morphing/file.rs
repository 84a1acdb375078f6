//! Ray octrees on disk: "The octree is linearized and saved as a binary file for fast loading" (Martin &
//! Popescu 2004, section 4.2).

use std::fs;
use std::path::{Path, PathBuf};

use glam::Vec3;

use crate::error::Result;
use crate::geometry::ray_octree::{Extent, RayOctree};
use crate::scene::{Moment, Scene};
use crate::truth::Cache;

/// Raised whenever tracing, building or the file's layout changes what a file holds.
const VERSION: u32 = 1;

const MAGIC: [u8; 8] = *b"mbrays\n\0";

/// What an octree depends on, but for the place it is seen from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Recipe {
    /// Texels along a side of the ray map's faces.
    pub map: u32,
    /// How often a cell may be split.
    pub depth: u32,
    /// Reflections along a ray.
    pub layers: u32,
    /// Rays end at diffuse objects that never move.
    pub still: bool,
}

impl Recipe {
    /// A hash of all that the octree of a location follows from.
    pub fn key(&self, scene: &Scene, moment: &Moment, location: Vec3) -> blake3::Hash {
        let mirrors = scene.reflectors();
        let poses: Vec<_> = mirrors.iter().map(|&mirror| moment.poses[mirror as usize]).collect();
        let waves = mirrors.iter().any(|&mirror| scene.wobbles(mirror)).then_some(moment.time);
        let hash = &scene.hash;
        blake3::hash(format!("{hash} {poses:?} {waves:?} {location:?} {self:?}").as_bytes())
    }
}

/// The file of a scene's octree with such a key.
pub fn path(cache: &Cache, scene: &Scene, key: &blake3::Hash) -> PathBuf {
    cache.folder().join(format!("{}-{}.rays", scene.name, &key.to_hex()[..32]))
}

/// The octree in a file, `None` where there is no file.
///
/// # Errors
/// In words, what is wrong with a file that is there.
pub fn load(path: &Path, key: &blake3::Hash) -> Result<Option<RayOctree>, &'static str> {
    match fs::read(path) {
        Ok(bytes) => decode(&bytes, key).map(Some),
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => Ok(None),
        Err(_) => Err("it cannot be read"),
    }
}

/// Magic, version, key, the lengths of the four arrays, the box, the arrays as they lie in memory, and a
/// checksum of it all.
pub fn encode(octree: &RayOctree, key: &blake3::Hash) -> Vec<u8> {
    let RayOctree { extent, cells, starts, lists, segments } = octree;
    let lengths = [cells.len(), starts.len(), lists.len(), segments.len()].map(|n| n as u32);
    let mut bytes = MAGIC.to_vec();
    bytes.extend_from_slice(bytemuck::bytes_of(&VERSION));
    bytes.extend_from_slice(key.as_bytes());
    bytes.extend_from_slice(bytemuck::bytes_of(&lengths));
    bytes.extend_from_slice(bytemuck::bytes_of(extent));
    bytes.extend_from_slice(bytemuck::cast_slice(cells));
    bytes.extend_from_slice(bytemuck::cast_slice(starts));
    bytes.extend_from_slice(bytemuck::cast_slice(lists));
    bytes.extend_from_slice(bytemuck::cast_slice(segments));
    let checksum = blake3::hash(&bytes);
    bytes.extend_from_slice(checksum.as_bytes());
    bytes
}

/// # Errors
/// In words, for anything but a whole, undamaged octree of this version with that key.
pub fn decode(bytes: &[u8], key: &blake3::Hash) -> Result<RayOctree, &'static str> {
    const SHORT: &str = "it is cut short";
    let body = bytes.strip_prefix(&MAGIC).ok_or("it holds no rays")?;
    if !body.starts_with(bytemuck::bytes_of(&VERSION)) {
        return Err("it is of another version");
    }
    let (whole, checksum) = bytes.split_last_chunk::<32>().ok_or(SHORT)?;
    if blake3::hash(whole) != blake3::Hash::from_bytes(*checksum) {
        return Err("its checksum is wrong");
    }
    let mut body = Reader(&whole[MAGIC.len() + size_of_val(&VERSION)..]);
    if body.values::<u8>(32).ok_or(SHORT)? != key.as_bytes() {
        return Err("it was made from something else");
    }
    let lengths: Vec<u32> = body.values(4).ok_or(SHORT)?;
    let extent: Vec<Extent> = body.values(1).ok_or(SHORT)?;
    let octree = RayOctree {
        extent: extent[0],
        cells: body.values(lengths[0] as usize).ok_or(SHORT)?,
        starts: body.values(lengths[1] as usize).ok_or(SHORT)?,
        lists: body.values(lengths[2] as usize).ok_or(SHORT)?,
        segments: body.values(lengths[3] as usize).ok_or(SHORT)?,
    };
    if body.0.is_empty() && octree.is_sound() { Ok(octree) } else { Err("it is no octree") }
}

struct Reader<'a>(&'a [u8]);

impl Reader<'_> {
    fn values<T: bytemuck::Pod>(&mut self, count: usize) -> Option<Vec<T>> {
        let (head, rest) = self.0.split_at_checked(count.checked_mul(size_of::<T>())?)?;
        self.0 = rest;
        // The bytes of a file need not be aligned.
        Some(bytemuck::pod_collect_to_vec(head))
    }
}

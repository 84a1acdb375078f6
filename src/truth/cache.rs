//! Truths kept on disk, so that a view is traced once; also the folder of all that is kept.

use std::path::{Path, PathBuf};
use std::{env, fs};

use glam::{Vec3, Vec4};

use super::Tracer;
use crate::error::{Error, Result};
use crate::scene::{FrameRecord, Ids, ReflectionRecord};

/// Raised whenever the tracer, the shading or the file's layout changes what a frame holds.
const VERSION: u32 = 5;

const MAGIC: [u8; 8] = *b"mbtruth\n";

/// A folder of traced frames, one file each, named by a hash of everything a frame depends on.
pub struct Cache {
    folder: PathBuf,
}

impl Cache {
    /// The user's cache: `MIRRORBENCH_CACHE`, else `mirrorbench` in `XDG_CACHE_HOME` or `~/.cache`.
    ///
    /// # Errors
    /// When none of the three variables is set.
    pub fn of_user() -> Result<Self> {
        let set = |name| env::var_os(name).filter(|value| !value.is_empty()).map(PathBuf::from);
        set("MIRRORBENCH_CACHE")
            .or_else(|| Some(set("XDG_CACHE_HOME")?.join("mirrorbench")))
            .or_else(|| Some(set("HOME")?.join(".cache/mirrorbench")))
            .map(Cache::new)
            .ok_or_else(|| {
                let hint = "set MIRRORBENCH_CACHE to a folder, or HOME";
                Error::Output(format!("there is no place to keep what was traced: {hint}"))
            })
    }

    pub fn new(folder: impl Into<PathBuf>) -> Self {
        Cache { folder: folder.into() }
    }

    /// The frame `tracer` traces at `size`, from the cache where it is whole, else traced and kept.
    ///
    /// # Errors
    /// When the traced frame cannot be written.
    pub fn frame(&self, tracer: &Tracer, size: [u32; 2]) -> Result<FrameRecord> {
        let path = self.path(tracer, size);
        if let Some(frame) = fs::read(&path).ok().and_then(|bytes| decode(&bytes, size)) {
            return Ok(frame);
        }
        let frame = tracer.frame(size);
        self.keep(&path, &encode(&frame))?;
        Ok(frame)
    }

    /// Where the frame is kept.
    pub fn path(&self, tracer: &Tracer, size: [u32; 2]) -> PathBuf {
        let (scene, moment, options) = (tracer.scene(), tracer.moment(), tracer.options());
        // The moment is what the frame number means, so a camera moved by hand is told apart too.
        let inputs = format!("{VERSION} {} {moment:?} {size:?} {options:?}", scene.hash);
        let key = blake3::hash(inputs.as_bytes()).to_hex();
        self.folder.join(format!("{}-{}.truth", scene.name, &key[..32]))
    }

    /// Where files are kept.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Write a file of the folder: beside the target, then renamed, so that a reader sees the whole file or
    /// none.
    ///
    /// # Errors
    /// [`Error::Output`], with the path.
    pub fn keep(&self, path: &Path, bytes: &[u8]) -> Result<()> {
        let partial = path.with_extension(format!("{}.partial", std::process::id()));
        fs::create_dir_all(&self.folder)
            .and_then(|()| fs::write(&partial, bytes))
            .and_then(|()| fs::rename(&partial, path))
            .inspect_err(|_| drop(fs::remove_file(&partial)))
            .map_err(|cause| Error::output(path, cause))
    }
}

/// Magic, size, the images one after the other as they lie in memory, and a checksum of it all.
/// Position, normal and record of pixels without a reflector are left out.
fn encode(frame: &FrameRecord) -> Vec<u8> {
    let mut bytes = MAGIC.to_vec();
    bytes.extend_from_slice(bytemuck::bytes_of(&frame.size));
    bytes.extend_from_slice(bytemuck::cast_slice(&frame.colour));
    bytes.extend_from_slice(bytemuck::cast_slice(&frame.depth));
    bytes.extend_from_slice(bytemuck::cast_slice(&frame.object));
    bytes.extend_from_slice(bytemuck::cast_slice(&frame.reflector));
    let mask = frame.reflector_pixels();
    append(&mut bytes, &frame.position, &mask);
    append(&mut bytes, &frame.normal, &mask);
    for record in [Some(&frame.record), frame.refracted.as_ref()].into_iter().flatten() {
        append(&mut bytes, &record.radiance, &mask);
        append(&mut bytes, &record.point, &mask);
        append(&mut bytes, &record.last, &mask);
        append(&mut bytes, &record.ids, &mask);
    }
    let checksum = blake3::hash(&bytes);
    bytes.extend_from_slice(checksum.as_bytes());
    bytes
}

fn append<T: bytemuck::Pod>(bytes: &mut Vec<u8>, image: &[T], mask: &[usize]) {
    for &pixel in mask {
        bytes.extend_from_slice(bytemuck::bytes_of(&image[pixel]));
    }
}

/// `None` for anything but a whole, undamaged frame of that size.
fn decode(bytes: &[u8], size: [u32; 2]) -> Option<FrameRecord> {
    let (body, checksum) = bytes.split_last_chunk::<32>()?;
    if blake3::hash(body) != blake3::Hash::from_bytes(*checksum) {
        return None;
    }
    let mut body = Reader(body.strip_prefix(&MAGIC)?);
    if body.values::<u32>(2)? != size {
        return None;
    }
    let mut frame = FrameRecord::new(size);
    let pixels = frame.colour.len();
    frame.colour = body.values(pixels)?;
    frame.depth = body.values(pixels)?;
    frame.object = body.values(pixels)?;
    frame.reflector = body.values(pixels)?;
    let mask = frame.reflector_pixels();
    body.scatter::<Vec3>(&mut frame.position, &mask)?;
    body.scatter::<Vec3>(&mut frame.normal, &mask)?;
    body.record(&mut frame.record, &mask)?;
    if !body.0.is_empty() {
        let mut refracted = ReflectionRecord::missing(pixels);
        body.record(&mut refracted, &mask)?;
        frame.refracted = Some(refracted);
    }
    body.0.is_empty().then_some(frame)
}

struct Reader<'a>(&'a [u8]);

impl Reader<'_> {
    fn values<T: bytemuck::Pod>(&mut self, count: usize) -> Option<Vec<T>> {
        let (head, rest) = self.0.split_at_checked(count * size_of::<T>())?;
        self.0 = rest;
        // The bytes of a file need not be aligned.
        Some(bytemuck::pod_collect_to_vec(head))
    }

    fn record(&mut self, record: &mut ReflectionRecord, mask: &[usize]) -> Option<()> {
        let ReflectionRecord { radiance, point, last, ids } = record;
        self.scatter::<Vec3>(radiance, mask)?;
        self.scatter::<Vec4>(point, mask)?;
        self.scatter::<Vec4>(last, mask)?;
        self.scatter::<Ids>(ids, mask)
    }

    fn scatter<T: bytemuck::Pod>(&mut self, image: &mut [T], mask: &[usize]) -> Option<()> {
        let values = self.values(mask.len())?;
        for (&pixel, value) in mask.iter().zip(values) {
            image[pixel] = value;
        }
        Some(())
    }
}

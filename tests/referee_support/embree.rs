//! Embree, asked through `tools/referees/embree.py`.

use std::env;
use std::io::{BufReader, Read, Write};
use std::path::PathBuf;
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::time::Duration;

use glam::Vec3;
use mirrorbench::geometry::Ray;

/// Names the Python that has the packages of `tools/requirements.txt`; else that of `.venv`.
const PYTHON_VARIABLE: &str = "MIRRORBENCH_PYTHON";

/// A running `tools/referees/embree.py`; ends with its value.
pub struct Embree {
    process: Child,
    requests: Option<ChildStdin>,
    replies: BufReader<ChildStdout>,
}

/// The nearest triangle on a ray.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EmbreeHit {
    pub triangle: u32,
    /// In lengths of the ray's direction.
    pub t: f32,
}

impl Embree {
    /// Starts Embree; `robust` is its slower mode that lets no ray through a shared edge.
    pub fn start(robust: bool) -> Embree {
        let root = PathBuf::from(env!("CARGO_MANIFEST_DIR"));
        let python = env::var_os(PYTHON_VARIABLE)
            .map_or_else(|| root.join(".venv/bin/python"), PathBuf::from);
        let mut process = Command::new(&python)
            .arg(root.join("tools/referees/embree.py"))
            .args(robust.then_some("--robust"))
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()
            .unwrap_or_else(|cause| panic!("cannot run {}: {cause}; {HINT}", python.display()));
        let requests = process.stdin.take();
        let replies = BufReader::new(process.stdout.take().unwrap());
        Embree { process, requests, replies }
    }

    /// Replaces the triangles traced.
    pub fn load(&mut self, triangles: &[[Vec3; 3]]) {
        self.send(b'M', triangles.len(), &[bytemuck::cast_slice(triangles)]);
        assert_eq!(self.receive::<u32>(1), [triangles.len() as u32]);
    }

    /// The nearest triangle on each ray from distance 0 on, and how long Embree itself took.
    pub fn trace(&mut self, rays: &[Ray]) -> (Duration, Vec<Option<EmbreeHit>>) {
        let origins: Vec<Vec3> = rays.iter().map(|ray| ray.origin).collect();
        let directions: Vec<Vec3> = rays.iter().map(|ray| ray.direction).collect();
        let arrays = [bytemuck::cast_slice(&origins), bytemuck::cast_slice(&directions)];
        self.send(b'R', rays.len(), &arrays);
        let [nanoseconds] = self.receive::<u64>(1)[..] else { unreachable!() };
        let triangles = self.receive::<i32>(rays.len());
        let distances = self.receive::<f32>(rays.len());
        let hits = triangles.into_iter().zip(distances);
        let hits = hits.map(|(id, t)| Some(EmbreeHit { triangle: u32::try_from(id).ok()?, t }));
        (Duration::from_nanos(nanoseconds), hits.collect())
    }

    fn send(&mut self, request: u8, count: usize, arrays: &[&[u8]]) {
        let mut message = vec![request];
        message.extend((count as u32).to_le_bytes());
        arrays.iter().for_each(|array| message.extend(*array));
        let pipe = self.requests.as_mut().unwrap();
        pipe.write_all(&message).unwrap_or_else(|cause| panic!("{cause}; {HINT}"));
    }

    fn receive<T: bytemuck::Pod>(&mut self, count: usize) -> Vec<T> {
        let mut values = vec![T::zeroed(); count];
        let bytes = bytemuck::cast_slice_mut(&mut values);
        self.replies.read_exact(bytes).unwrap_or_else(|cause| panic!("{cause}; {HINT}"));
        values
    }
}

const HINT: &str = "Embree comes with the Python package `embreex`: run tools/setup, \
    or name a Python that has it in MIRRORBENCH_PYTHON";

impl Drop for Embree {
    fn drop(&mut self) {
        // The end of its input ends the program.
        drop(self.requests.take());
        drop(self.process.wait());
    }
}

//! What forward methods reflect: every object's vertices in one list, cut as finely as asked.

use std::sync::Arc;

use crate::error::{Error, Result};
use crate::geometry::Mesh;
use crate::geometry::subdivide::{Subdivided, subdivide};
use crate::gpu::{Buffer, Device, Draw, Frame};
use crate::scene::{ObjectId, Scene};
use crate::stages::{GpuScene, Vertex};

/// More triangles than this in one object are a mistyped edge length.
const MAX_TRIANGLES: usize = 4 << 20;

/// The scene's vertices, each object with its own; the index buffer counts in the same list.
pub struct Source {
    /// Replaces the scene's `vertices`: object space.
    pub vertices: Buffer,
    /// Whose vertex each is.
    pub owners: Buffer,
    /// The triangle of the scene each triangle lies in.
    pub triangles: Buffer,
    /// Where each object's triangles begin in `triangles`.
    pub first_triangles: Buffer,
    pub count: u32,
    /// Three a triangle, into `vertices`.
    pub indices: Buffer,
    pub triangle_count: u32,
    /// First index and index count of each object.
    ranges: Vec<(u32, u32)>,
    /// Where each object's vertices begin.
    first_vertices: Vec<u32>,
}

/// The lists before they are uploaded.
#[derive(Default)]
pub struct Lists {
    pub vertices: Vec<Vertex>,
    pub owners: Vec<ObjectId>,
    triangles: Vec<u32>,
    first_triangles: Vec<u32>,
    pub indices: Vec<u32>,
    ranges: Vec<(u32, u32)>,
    first_vertices: Vec<u32>,
}

impl Lists {
    /// Diffuse objects cut to edges of `edge` metres, where that is above 0: "The scene loader
    /// subdivides geometry which is too large (typically too long and/or thin)" (Estalella et al.
    /// 2006, section 6).
    ///
    /// # Errors
    /// [`Error::Usage`] where that gives too many triangles.
    pub fn new(scene: &Scene, edge: f32) -> Result<Lists> {
        let mut lists = Lists::default();
        for object in 0..scene.objects.len() as ObjectId {
            let mesh = scene.mesh_of(object);
            // What wobbles keeps its vertices, which are denser than its waves.
            if edge > 0.0 && !scene.is_reflector(object) && !scene.wobbles(object) {
                let Some(Subdivided { mesh, sources }) = subdivide(mesh, edge, MAX_TRIANGLES)
                else {
                    return Err(Error::Usage(format!(
                        "subdivide={edge} cuts `{}` into over {MAX_TRIANGLES} triangles; \
                         valid: a longer edge, or 0 for none",
                        scene.objects[object as usize].name
                    )));
                };
                lists.append(object, &mesh, sources.into_iter());
            } else {
                lists.append(object, mesh, 0..mesh.triangles.len() as u32);
            }
        }
        Ok(lists)
    }

    fn append(&mut self, object: ObjectId, mesh: &Mesh, sources: impl Iterator<Item = u32>) {
        let base = self.vertices.len() as u32;
        let first = self.indices.len() as u32;
        self.first_vertices.push(base);
        self.vertices.extend(Vertex::of(mesh));
        self.owners.resize(self.vertices.len(), object);
        self.first_triangles.push(self.triangles.len() as u32);
        self.triangles.extend(sources);
        self.indices.extend(mesh.triangles.iter().flatten().map(|i| i + base));
        self.ranges.push((first, self.indices.len() as u32 - first));
    }

    /// # Errors
    /// [`Error::Device`] with the numbers when a list is beyond the device's limits.
    pub fn upload(&self, device: &Arc<Device>) -> Result<Source> {
        Ok(Source {
            vertices: Buffer::with_data(device, "reflected vertices", &self.vertices)?,
            owners: Buffer::with_data(device, "reflected vertices' objects", &self.owners)?,
            triangles: Buffer::with_data(device, "reflected triangles", &self.triangles)?,
            first_triangles: Buffer::with_data(device, "reflected objects", &self.first_triangles)?,
            count: self.vertices.len() as u32,
            triangle_count: self.triangles.len() as u32,
            indices: Buffer::with_data(device, "reflected indices", &self.indices)?,
            ranges: self.ranges.clone(),
            first_vertices: self.first_vertices.clone(),
        })
    }
}

impl Source {
    /// Move the vertices of what wobbles to where the scene's are now. `name` begins the pass's name.
    pub fn pose(&self, frame: &mut Frame, scene: &GpuScene, name: &str) -> Result<()> {
        for (object, &first) in self.first_vertices.iter().enumerate() {
            if let Some(vertices) = scene.deformed(object as ObjectId) {
                let offset = u64::from(first) * size_of::<Vertex>() as u64;
                frame.pass(&format!("{name}/vertices")).copy(&self.vertices, offset, vertices)?;
            }
        }
        Ok(())
    }

    /// Draw all but one object; the instance index is the object id.
    pub fn draw(&self, draw: &mut Draw, except: ObjectId) {
        for (object, &(first, count)) in self.ranges.iter().enumerate() {
            let object = object as ObjectId;
            if object != except {
                draw.indexed(&self.indices, first, count, object);
            }
        }
    }
}

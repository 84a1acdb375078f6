//! The scene on the GPU: geometry, materials and images once, poses and what changes its shape each
//! frame.

use std::collections::BTreeMap;
use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use glam::{Affine3A, Vec3};
use half::f16;

use crate::error::Result;
use crate::geometry::Mesh;
use crate::gpu::{Buffer, Device, Draw, Frame, MeshTriangles, Pass, Slice};
use crate::scene::{Environment, Material, Moment, ObjectId, Pattern, Scene};

/// WGSL `Vertex` of `shaders/bindings/scene.wgsl`; object space.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub struct Vertex {
    position: [f32; 3],
    u: f32,
    normal: [f32; 3],
    v: f32,
}

impl Vertex {
    /// Object space.
    pub fn position(&self) -> Vec3 {
        Vec3::from_array(self.position)
    }

    /// The vertices of a mesh, in order.
    pub fn of(mesh: &Mesh) -> impl Iterator<Item = Vertex> {
        let attributes = mesh.positions.iter().zip(&mesh.normals).zip(&mesh.uvs);
        attributes.map(|((p, n), uv)| Vertex {
            position: p.to_array(),
            u: uv.x,
            normal: n.to_array(),
            v: uv.y,
        })
    }
}

/// WGSL `Object`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub struct ObjectEntry {
    row_x: [f32; 4],
    row_y: [f32; 4],
    row_z: [f32; 4],
    material: u32,
    rank: u32,
    selected: u32,
    first_index: u32,
}

/// WGSL `Material`.
#[derive(Clone, Copy, Default, Pod, Zeroable)]
#[repr(C)]
pub struct MaterialEntry {
    first: [f32; 3],
    pattern: u32,
    second: [f32; 3],
    line: f32,
    tint: [f32; 3],
    reflectance: f32,
    size: [f32; 2],
    image: u32,
    index: f32,
    fade_distance: f32,
    fade_floor: f32,
    fresnel: u32,
    pad: u32,
}

/// WGSL `ImageInfo`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
pub struct ImageEntry {
    offset: u32,
    width: u32,
    height: u32,
    pad: u32,
}

/// WGSL `Light`.
#[derive(Clone, Copy, Default, Pod, Zeroable)]
#[repr(C)]
pub struct LightUniform {
    ambient: [f32; 3],
    environment: u32,
    towards_sun: [f32; 3],
    image: u32,
    sun: [f32; 3],
    pad_a: u32,
    zenith: [f32; 3],
    pad_b: u32,
    horizon: [f32; 3],
    pad_c: u32,
    nadir: [f32; 3],
    pad_d: u32,
}

/// A scene uploaded to a device.
pub struct GpuScene {
    pub scene: Arc<Scene>,
    vertices: Buffer,
    indices: Buffer,
    materials: Buffer,
    images: Buffer,
    texels: Buffer,
    light: LightUniform,
    /// First vertex of each mesh.
    first_vertices: Vec<u32>,
    /// First index and index count of each mesh.
    ranges: Vec<(u32, u32)>,
    /// Whether each mesh has an inside.
    closed: Vec<bool>,
    moment: Moment,
    /// This frame's vertices of each mesh that wobbles, and all poses: set by [`GpuScene::pose`].
    deformed: BTreeMap<usize, Vec<Vertex>>,
    objects: Option<Slice>,
}

impl GpuScene {
    /// # Errors
    /// [`crate::error::Error::Device`] with the numbers when a buffer is beyond the device's limits.
    pub fn new(device: &Arc<Device>, scene: &Arc<Scene>) -> Result<GpuScene> {
        let mut vertices = Vec::with_capacity(scene.meshes.iter().map(|m| m.positions.len()).sum());
        let mut indices: Vec<u32> = Vec::new();
        let mut ranges = Vec::with_capacity(scene.meshes.len());
        let mut first_vertices = Vec::with_capacity(scene.meshes.len());
        for mesh in &scene.meshes {
            let base = vertices.len() as u32;
            let first = indices.len() as u32;
            first_vertices.push(base);
            vertices.extend(Vertex::of(mesh));
            indices.extend(mesh.triangles.iter().flatten().map(|i| i + base));
            ranges.push((first, indices.len() as u32 - first));
        }
        let materials: Vec<_> = scene.materials.iter().map(material_entry).collect();
        let (images, texels) = image_entries(scene);
        Ok(GpuScene {
            vertices: Buffer::with_data(device, "scene vertices", &vertices)?,
            indices: Buffer::with_data(device, "scene indices", &indices)?,
            materials: Buffer::with_data(device, "scene materials", &materials)?,
            images: Buffer::with_data(device, "scene images", &images)?,
            texels: Buffer::with_data(device, "scene texels", &texels)?,
            light: light_uniform(scene),
            first_vertices,
            ranges,
            closed: scene.meshes.iter().map(Mesh::is_closed).collect(),
            moment: scene.at(0),
            deformed: BTreeMap::new(),
            objects: None,
            scene: scene.clone(),
        })
    }

    /// The moment this frame shows.
    pub fn moment(&self) -> &Moment {
        &self.moment
    }

    /// Upload the poses of a moment for the frame being recorded, and the vertices of what wobbles:
    /// those the truth traces, so displaced on the processor (`scene/deform`) and copied
    /// (`scene/vertices`).
    pub fn pose(&mut self, frame: &mut Frame, moment: &Moment) -> Result<()> {
        self.moment = moment.clone();
        self.objects = Some(self.upload_objects(frame, &[])?);
        for (&mesh, wobble) in &self.scene.wobbles {
            let vertices: Vec<Vertex> = frame.cpu("scene/deform", || {
                Ok(Vertex::of(&wobble.at(&self.scene.meshes[mesh], moment.time)).collect())
            })?;
            let offset = u64::from(self.first_vertices[mesh]) * size_of::<Vertex>() as u64;
            frame.pass("scene/vertices").copy(&self.vertices, offset, &vertices)?;
            self.deformed.insert(mesh, vertices);
        }
        Ok(())
    }

    /// The object's vertices where its surface is this frame; none for what keeps its shape.
    pub fn deformed(&self, object: ObjectId) -> Option<&[Vertex]> {
        self.deformed.get(&self.scene.objects[object as usize].mesh).map(Vec::as_slice)
    }

    /// The objects with some reflectors marked as selected, for passes meant for those alone.
    pub fn selection(&self, frame: &mut Frame, reflectors: &[ObjectId]) -> Result<Slice> {
        self.upload_objects(frame, reflectors)
    }

    fn upload_objects(&self, frame: &mut Frame, selected: &[ObjectId]) -> Result<Slice> {
        let mut rank = 0;
        let entries: Vec<_> = (0..self.scene.objects.len())
            .map(|index| {
                let id = index as ObjectId;
                let [row_x, row_y, row_z] = rows(&self.moment.poses[index]);
                let entry = ObjectEntry {
                    row_x,
                    row_y,
                    row_z,
                    material: self.scene.objects[index].material as u32,
                    rank,
                    selected: u32::from(selected.contains(&id)),
                    first_index: self.range(id).0,
                };
                rank += u32::from(self.scene.is_reflector(id));
                entry
            })
            .collect();
        frame.upload(&entries)
    }

    /// The objects that have an inside.
    pub fn closed(&self) -> Vec<ObjectId> {
        (0..self.scene.objects.len() as ObjectId).filter(|&object| self.is_closed(object)).collect()
    }

    /// Bind what a shader wants of the scene.
    pub fn bind<'f>(&self, pass: Pass<'f>) -> Pass<'f> {
        let pass = pass
            .buffer("vertices", &self.vertices)
            .optional()
            .buffer("materials", &self.materials)
            .optional()
            .buffer("images", &self.images)
            .optional()
            .buffer("texels", &self.texels)
            .optional()
            .uniform("light", &self.light)
            .optional()
            .buffer("indices", &self.indices)
            .optional();
        match self.objects {
            Some(objects) => pass.slice("objects", objects).optional(),
            None => pass,
        }
    }

    /// Rows of world from an object's own space, this frame.
    pub fn rows_of(&self, object: ObjectId) -> [[f32; 4]; 3] {
        rows(&self.moment.poses[object as usize])
    }

    /// First index and index count of an object.
    fn range(&self, object: ObjectId) -> (u32, u32) {
        self.ranges[self.scene.objects[object as usize].mesh]
    }

    /// Whether an object's own mesh is watertight.
    pub fn is_closed(&self, object: ObjectId) -> bool {
        self.closed[self.scene.objects[object as usize].mesh]
    }

    /// First index and index count of an object, or of the closed partner it has.
    pub fn closed_range(&self, object: ObjectId) -> (u32, u32) {
        let closed = self.scene.objects[object as usize].closed;
        closed.map_or(self.range(object), |mesh| self.ranges[mesh])
    }

    /// The triangles of each mesh, in object space.
    pub fn meshes(&self) -> Vec<MeshTriangles<'_>> {
        let mesh = |&(first_index, index_count): &(u32, u32)| MeshTriangles {
            vertices: &self.vertices,
            stride: size_of::<Vertex>() as u32,
            indices: &self.indices,
            first_index,
            index_count,
        };
        self.ranges.iter().map(mesh).collect()
    }

    /// Shader definitions of passes that follow light through the scene.
    pub fn defines(&self) -> Vec<(&'static str, u32)> {
        if self.scene.refracts() { vec![("GLASS", 1)] } else { Vec::new() }
    }

    /// Draw the objects a filter lets through; the instance index is the object id.
    pub fn draw(&self, draw: &mut Draw, wanted: impl Fn(ObjectId) -> bool) {
        for object in 0..self.scene.objects.len() as ObjectId {
            if wanted(object) {
                self.draw_object(draw, object);
            }
        }
    }

    pub fn draw_object(&self, draw: &mut Draw, object: ObjectId) {
        let (first, count) = self.range(object);
        draw.indexed(&self.indices, first, count, object);
    }

    /// Draw an object, or the closed partner it has.
    pub fn draw_closed(&self, draw: &mut Draw, object: ObjectId) {
        let (first, count) = self.closed_range(object);
        draw.indexed(&self.indices, first, count, object);
    }
}

/// Rows of an affine transform.
fn rows(pose: &Affine3A) -> [[f32; 4]; 3] {
    let [x, y, z] = [pose.matrix3.x_axis, pose.matrix3.y_axis, pose.matrix3.z_axis];
    let t = pose.translation;
    [[x.x, y.x, z.x, t.x], [x.y, y.y, z.y, t.y], [x.z, y.z, z.z, t.z]]
}

/// `pattern` is one of the shader's `PATTERN_` numbers.
fn material_entry(material: &Material) -> MaterialEntry {
    let mut entry = MaterialEntry { size: [1.0; 2], reflectance: -1.0, ..Default::default() };
    match material.pattern {
        Pattern::Colour(colour) => entry.first = colour.to_array(),
        Pattern::Checker { even, odd, size } => {
            entry.pattern = 1;
            entry.first = even.to_array();
            entry.second = odd.to_array();
            entry.size = size.to_array();
        }
        Pattern::Grid { ground, lines, size, line } => {
            entry.pattern = 2;
            entry.first = ground.to_array();
            entry.second = lines.to_array();
            entry.size = size.to_array();
            entry.line = line;
        }
        Pattern::Image { image, size } => {
            entry.pattern = 3;
            entry.image = image as u32;
            entry.size = size.to_array();
        }
    }
    if let Some(mirror) = material.mirror {
        entry.tint = mirror.tint.to_array();
        entry.reflectance = mirror.reflectance;
        entry.fresnel = u32::from(mirror.fresnel);
        if let Some(fade) = mirror.fade {
            (entry.fade_distance, entry.fade_floor) = (fade.distance, fade.floor);
        }
    }
    if let Some(glass) = material.glass {
        entry.tint = glass.tint.to_array();
        entry.index = glass.index;
    }
    entry
}

/// All images behind one another, two words a texel: halves r, g and b.
fn image_entries(scene: &Scene) -> (Vec<ImageEntry>, Vec<[u32; 2]>) {
    let mut texels: Vec<[u32; 2]> = Vec::new();
    let mut entries = Vec::with_capacity(scene.images.len());
    for image in &scene.images {
        let offset = texels.len() as u32;
        entries.push(ImageEntry { offset, width: image.width, height: image.height, pad: 0 });
        texels.extend(image.texels.iter().map(|t| {
            let half = |v: f32| u32::from(f16::from_f32(v).to_bits());
            [half(t.x) | half(t.y) << 16, half(t.z)]
        }));
    }
    (entries, texels)
}

/// `environment` is one of the shader's `ENVIRONMENT_` numbers.
fn light_uniform(scene: &Scene) -> LightUniform {
    let light = &scene.lighting;
    let mut uniform = LightUniform {
        ambient: light.ambient.to_array(),
        towards_sun: light.towards_sun.to_array(),
        sun: light.sun.to_array(),
        ..Default::default()
    };
    let colours = |u: &mut LightUniform, zenith: Vec3, horizon: Vec3, nadir: Vec3| {
        u.zenith = zenith.to_array();
        u.horizon = horizon.to_array();
        u.nadir = nadir.to_array();
    };
    match scene.environment {
        Environment::Colour(colour) => colours(&mut uniform, colour, colour, colour),
        Environment::Gradient { zenith, horizon, nadir } => {
            uniform.environment = 1;
            colours(&mut uniform, zenith, horizon, nadir);
        }
        Environment::LatLong { image } => {
            uniform.environment = 2;
            uniform.image = image as u32;
        }
    }
    uniform
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::assert_layout;

    #[test]
    #[rustfmt::skip]
    fn structs_are_laid_out_as_their_wgsl_twins() {
        assert_layout!("stages/direct_view.wgsl", "Vertex", Vertex, position, u, normal, v);
        assert_layout!("stages/direct_view.wgsl", "Object", ObjectEntry,
            row_x, row_y, row_z, material, rank, selected, first_index);
        assert_layout!("stages/direct_view.wgsl", "Material", MaterialEntry,
            first, pattern, second, line, tint, reflectance, size, image, index, fade_distance,
            fade_floor, fresnel, pad);
        assert_layout!("stages/direct_view.wgsl", "ImageInfo", ImageEntry,
            offset, width, height, pad);
        assert_layout!("stages/background.wgsl", "Light", LightUniform,
            ambient, environment, towards_sun, image, sun, pad_a, zenith, pad_b, horizon, pad_c,
            nadir, pad_d);
    }
}

//! Acceleration structures: what the device's own ray queries search.
//!
//! Two levels, as Vulkan has them: one structure a mesh, built from its triangles in object space,
//! again only where they change, and one over the meshes where they stand, built anew when they move. No face is culled.
//! Unless a placement is opaque, a shader sees every candidate and accepts or refuses it by its own
//! rule: a mirrored ray must not meet the triangle it starts on.

use std::slice;
use std::sync::Arc;

use ash::vk;
use bytemuck::{Pod, Zeroable};
use glam::{Affine3A, Mat4};

use super::buffer::Owner;
use super::{Buffer, Device, Pass};
use crate::error::{Error, Result};

type Geometry = vk::AccelerationStructureGeometryKHR<'static>;

/// Custom indices have 24 bits.
const MAX_INDEX: u32 = (1 << 24) - 1;

/// Alignment of an instance array's address, bytes.
pub(super) const INSTANCE_ALIGNMENT: u64 = 16;

/// The triangles of one mesh: a range of an index buffer.
#[derive(Clone, Copy)]
pub struct MeshTriangles<'b> {
    /// Positions: three floats at the start of every `stride` bytes.
    pub vertices: &'b Buffer,
    /// A multiple of 4.
    pub stride: u32,
    /// 32-bit indices into all of `vertices`.
    pub indices: &'b Buffer,
    pub first_index: u32,
    pub index_count: u32,
}

/// A mesh somewhere in the world. Several may share a mesh.
#[derive(Clone, Copy, Debug)]
pub struct Placement {
    /// Position in the list the structure was made from.
    pub mesh: usize,
    /// World from object space; rigid, so that a face's side is the same in both.
    pub pose: Affine3A,
    /// What shaders read as `instance_custom_data`; below 2^24.
    pub index: u32,
    /// A ray meets the placement where its `cull_mask` has a bit of this; 0 hides it.
    pub mask: u8,
    /// Rays meet its triangles without asking the shader, which is quicker: for what no ray
    /// starts on.
    pub opaque: bool,
}

/// `VkAccelerationStructureInstanceKHR`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Entry {
    rows: [[f32; 4]; 3],
    index_and_mask: u32,
    flags: u32,
    mesh: vk::DeviceAddress,
}

/// One structure and its memory.
struct Level {
    device: Arc<Device>,
    raw: vk::AccelerationStructureKHR,
    address: vk::DeviceAddress,
    storage: Buffer,
    /// Bytes a build needs besides.
    scratch: u64,
}

/// Both levels and the triangles they were made from; frames that build or search them hold this
/// until their submit is done.
pub(super) struct Levels {
    meshes: Vec<Level>,
    top: Level,
    /// The top level is built each frame, so its scratch memory stays.
    top_scratch: Buffer,
    /// Vertices and indices, which a build of the meshes reads.
    _triangles: Vec<Arc<Owner>>,
}

/// Meshes that rays of shaders can meet: `acceleration_structure` in WGSL.
pub struct Acceleration {
    name: String,
    levels: Arc<Levels>,
    triangles: Vec<(Geometry, vk::AccelerationStructureBuildRangeInfoKHR)>,
    max_placements: u32,
    state: State,
}

/// How far the recorded builds have come.
#[derive(PartialEq)]
enum State {
    Empty,
    Built,
    Placed,
}

impl Acceleration {
    /// Memory for these meshes and up to `placements` of them. [`Pass::build`] builds the meshes,
    /// [`Pass::place`] the level above.
    ///
    /// # Errors
    /// [`Error::Device`] where the device traces no rays, a limit is exceeded, or memory is out.
    pub fn new(
        device: &Arc<Device>,
        name: &str,
        meshes: &[MeshTriangles],
        placements: u32,
    ) -> Result<Acceleration> {
        let rays = device.ray_query()?;
        let largest = meshes.iter().map(|m| m.index_count / 3).max().unwrap_or(0);
        let limits = [
            (largest, rays.max_triangles, "triangles in a mesh"),
            (placements, rays.max_placements, "placed meshes"),
        ];
        if let Some((n, max, what)) = limits.iter().find(|(n, max, _)| u64::from(*n) > *max) {
            let device = &device.info().name;
            return Err(Error::Device(format!("{name} has {n} {what}, {device} allows {max}")));
        }
        let triangles: Vec<_> = meshes.iter().map(|m| (m.geometry(), m.range())).collect();
        let mut levels = Vec::with_capacity(meshes.len());
        for (index, (geometry, range)) in triangles.iter().enumerate() {
            let name = format!("{name} mesh {index}");
            levels.push(Level::new(device, &name, geometry, range.primitive_count)?);
        }
        let top = Level::new(device, &format!("{name} placements"), &instances(0), placements)?;
        let scratch = format!("{name} placements scratch");
        let top_scratch = Buffer::scratch(device, &scratch, top.scratch, rays.scratch_alignment)?;
        let owners = meshes.iter().flat_map(|m| [&m.vertices.owner, &m.indices.owner]);
        let _triangles = owners.cloned().collect();
        Ok(Acceleration {
            name: name.to_owned(),
            levels: Arc::new(Levels { meshes: levels, top, top_scratch, _triangles }),
            triangles,
            max_placements: placements,
            state: State::Empty,
        })
    }

    /// Device memory held, bytes. While the meshes are built they take scratch memory besides.
    pub fn bytes(&self) -> u64 {
        let Levels { meshes, top, top_scratch, .. } = &*self.levels;
        let levels = meshes.iter().chain([top]);
        levels.map(|level| level.storage.bytes()).sum::<u64>() + top_scratch.bytes()
    }

    /// The levels, once they are in place.
    pub(super) fn placed(&self) -> Result<Arc<Levels>, String> {
        match self.state {
            State::Placed => Ok(self.levels.clone()),
            _ => Err(format!("`{}` has not been placed", self.name)),
        }
    }

    fn entries(&self, placements: &[Placement]) -> Result<Vec<Entry>, String> {
        if placements.len() > self.max_placements as usize {
            return Err(format!(
                "{} placements, `{}` was made for {}",
                placements.len(),
                self.name,
                self.max_placements
            ));
        }
        placements.iter().map(|placement| self.entry(placement)).collect()
    }

    fn entry(&self, placement: &Placement) -> Result<Entry, String> {
        let &Placement { mesh, pose, index, mask, opaque } = placement;
        let meshes = &self.levels.meshes;
        let level = meshes.get(mesh).ok_or_else(|| {
            format!("`{}` has no mesh {mesh} to place, it has {}", self.name, meshes.len())
        })?;
        if index > MAX_INDEX {
            return Err(format!("placement index {index} is above {MAX_INDEX}"));
        }
        let [x, y, z, _] = Mat4::from(pose).transpose().to_cols_array_2d();
        // Nothing to flip: corners clockwise in left-handed coordinates, Vulkan's front, run
        // counter-clockwise in ours.
        let mut flags = vk::GeometryInstanceFlagsKHR::TRIANGLE_FACING_CULL_DISABLE;
        if opaque {
            flags |= vk::GeometryInstanceFlagsKHR::FORCE_OPAQUE;
        }
        Ok(Entry {
            rows: [x, y, z],
            index_and_mask: index | u32::from(mask) << 24,
            flags: flags.as_raw() << 24,
            mesh: level.address,
        })
    }
}

impl Levels {
    pub fn top(&self) -> vk::AccelerationStructureKHR {
        self.top.raw
    }
}

impl MeshTriangles<'_> {
    fn geometry(&self) -> Geometry {
        let count = self.vertices.bytes() / u64::from(self.stride);
        let triangles = vk::AccelerationStructureGeometryTrianglesDataKHR::default()
            .vertex_format(vk::Format::R32G32B32_SFLOAT)
            .vertex_data(vk::DeviceOrHostAddressConstKHR {
                device_address: self.vertices.address(),
            })
            .vertex_stride(self.stride.into())
            .max_vertex(count.saturating_sub(1) as u32)
            .index_type(vk::IndexType::UINT32)
            .index_data(vk::DeviceOrHostAddressConstKHR { device_address: self.indices.address() });
        vk::AccelerationStructureGeometryKHR::default()
            .geometry_type(vk::GeometryTypeKHR::TRIANGLES)
            .geometry(vk::AccelerationStructureGeometryDataKHR { triangles })
    }

    fn range(&self) -> vk::AccelerationStructureBuildRangeInfoKHR {
        vk::AccelerationStructureBuildRangeInfoKHR::default()
            .primitive_count(self.index_count / 3)
            .primitive_offset(4 * self.first_index)
    }
}

fn instances(entries: vk::DeviceAddress) -> Geometry {
    let instances = vk::AccelerationStructureGeometryInstancesDataKHR::default()
        .data(vk::DeviceOrHostAddressConstKHR { device_address: entries });
    vk::AccelerationStructureGeometryKHR::default()
        .geometry_type(vk::GeometryTypeKHR::INSTANCES)
        .geometry(vk::AccelerationStructureGeometryDataKHR { instances })
}

/// How a structure is built. Traced far more often than built, both kinds are built for tracing.
fn build_info(geometry: &Geometry) -> vk::AccelerationStructureBuildGeometryInfoKHR<'_> {
    use vk::AccelerationStructureTypeKHR as Type;
    let top = geometry.geometry_type == vk::GeometryTypeKHR::INSTANCES;
    vk::AccelerationStructureBuildGeometryInfoKHR::default()
        .ty(if top { Type::TOP_LEVEL } else { Type::BOTTOM_LEVEL })
        .flags(vk::BuildAccelerationStructureFlagsKHR::PREFER_FAST_TRACE)
        .mode(vk::BuildAccelerationStructureModeKHR::BUILD)
        .geometries(slice::from_ref(geometry))
}

impl Level {
    /// Room for up to `primitives` triangles or placements.
    fn new(
        device: &Arc<Device>,
        name: &str,
        geometry: &Geometry,
        primitives: u32,
    ) -> Result<Level> {
        let functions = &device.ray_query()?.functions;
        let info = build_info(geometry);
        let mut sizes = vk::AccelerationStructureBuildSizesInfoKHR::default();
        let on_device = vk::AccelerationStructureBuildTypeKHR::DEVICE;
        // SAFETY: one geometry and one count; addresses do not matter for sizes.
        unsafe {
            functions.get_acceleration_structure_build_sizes(
                on_device,
                &info,
                &[primitives],
                &mut sizes,
            );
        }
        let storage = Buffer::structure(device, name, sizes.acceleration_structure_size)?;
        let create = vk::AccelerationStructureCreateInfoKHR::default()
            .buffer(storage.raw)
            .size(sizes.acceleration_structure_size)
            .ty(info.ty);
        // SAFETY: the buffer is as large as was just asked for, and lives as long as the level.
        let raw = unsafe { functions.create_acceleration_structure(&create, None) }
            .map_err(|e| device.fail("vkCreateAccelerationStructureKHR", name, e))?;
        device.name(raw, name);
        let address =
            vk::AccelerationStructureDeviceAddressInfoKHR::default().acceleration_structure(raw);
        // SAFETY: the structure was just made.
        let address = unsafe { functions.get_acceleration_structure_device_address(&address) };
        let scratch = sizes.build_scratch_size;
        Ok(Level { device: device.clone(), raw, address, storage, scratch })
    }
}

impl Drop for Level {
    fn drop(&mut self) {
        if let Ok(rays) = self.device.ray_query() {
            // SAFETY: frames hold the levels until their submit was waited for; the memory goes
            // after this.
            unsafe { rays.functions.destroy_acceleration_structure(self.raw, None) };
        }
    }
}

impl Pass<'_> {
    /// Build every mesh of a structure.
    pub fn build(self, structure: &mut Acceleration) -> Result<()> {
        let all: Vec<usize> = (0..structure.levels.meshes.len()).collect();
        self.build_meshes(structure, &all)
    }

    /// Build some meshes anew whose vertices have changed, by their positions in the list the structure
    /// was made from.
    ///
    /// # Errors
    /// [`Error::Shader`] where the structure has not been built or has no such mesh.
    pub fn rebuild(self, structure: &mut Acceleration, meshes: &[usize]) -> Result<()> {
        let count = structure.levels.meshes.len();
        if structure.state == State::Empty || meshes.iter().any(|&mesh| mesh >= count) {
            return Err(self.wrong(format_args!(
                "`{}` has {count} meshes, built or not: {meshes:?} cannot be built anew",
                structure.name
            )));
        }
        self.build_meshes(structure, meshes)
    }

    fn build_meshes(self, structure: &mut Acceleration, meshes: &[usize]) -> Result<()> {
        let device = self.frame.device().clone();
        let rays = device.ray_query()?;
        let levels = &structure.levels;
        let align = |bytes: u64| bytes.next_multiple_of(rays.scratch_alignment);
        let total = meshes.iter().map(|&mesh| align(levels.meshes[mesh].scratch)).sum();
        let name = format!("{} scratch", structure.name);
        let scratch = Buffer::scratch(&device, &name, total, rays.scratch_alignment)?;
        let mut free = align(scratch.address());
        let mut infos = Vec::with_capacity(meshes.len());
        for &mesh in meshes {
            let ((geometry, _), level) = (&structure.triangles[mesh], &levels.meshes[mesh]);
            let scratch = vk::DeviceOrHostAddressKHR { device_address: free };
            let info = build_info(geometry).dst_acceleration_structure(level.raw);
            infos.push(info.scratch_data(scratch));
            free += align(level.scratch);
        }
        let ranges: Vec<_> =
            meshes.iter().map(|&mesh| slice::from_ref(&structure.triangles[mesh].1)).collect();
        self.frame.keep(scratch.owner.clone());
        self.frame.keep(levels.clone());
        self.record(None, |pass| {
            let commands = pass.frame.commands;
            if !infos.is_empty() {
                // SAFETY: recording; the frame keeps structures, triangles and scratch memory, of
                // which each build has its own part.
                unsafe {
                    rays.functions.cmd_build_acceleration_structures(commands, &infos, &ranges);
                }
            }
            Ok(())
        })?;
        // Meshes built anew must be placed anew.
        structure.state = State::Built;
        Ok(())
    }

    /// Build the level above the meshes: what stands where from this pass on.
    pub fn place(self, structure: &mut Acceleration, placements: &[Placement]) -> Result<()> {
        if structure.state == State::Empty {
            return Err(self.wrong(format_args!("`{}` has not been built", structure.name)));
        }
        let device = self.frame.device().clone();
        let rays = device.ray_query()?;
        let levels = structure.levels.clone();
        let entries = structure.entries(placements).map_err(|what| self.wrong(what))?;
        let entries = self.frame.upload(&entries)?;
        let geometry = instances(device.address(entries.buffer) + entries.offset);
        let scratch = levels.top_scratch.address().next_multiple_of(rays.scratch_alignment);
        let info = build_info(&geometry)
            .dst_acceleration_structure(levels.top.raw)
            .scratch_data(vk::DeviceOrHostAddressKHR { device_address: scratch });
        let range = vk::AccelerationStructureBuildRangeInfoKHR::default()
            .primitive_count(placements.len() as u32);
        self.frame.keep(levels);
        self.record(None, |pass| {
            let (commands, info) = (pass.frame.commands, slice::from_ref(&info));
            // SAFETY: recording; the frame keeps the levels and holds the uploaded entries.
            unsafe {
                rays.functions.cmd_build_acceleration_structures(commands, info, &[&[range]]);
            }
            Ok(())
        })?;
        structure.state = State::Placed;
        Ok(())
    }
}

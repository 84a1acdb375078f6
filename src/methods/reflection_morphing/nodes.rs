//! The eight ray octrees round the eye, brought to the device as the eye goes from cell to cell.

use std::collections::{BTreeMap, BTreeSet};
use std::ops::Range;
use std::sync::Arc;

use glam::IVec3;

use super::file::{self, Recipe};
use super::grid::{Corner, Grid};
use super::ray_map::RayMapper;
use crate::error::Result;
use crate::geometry::ray_bundle::RayTable;
use crate::geometry::ray_octree::{Extent, RayOctree, RaySegment};
use crate::gpu::{Buffer, Device};
use crate::scene::{Moment, Scene};
use crate::truth::Cache;

/// An octree on the device.
pub struct Node {
    place: IVec3,
    pub extent: Extent,
    pub cells: Buffer,
    pub starts: Buffer,
    pub lists: Buffer,
    pub segments: Buffer,
    pub segment_count: u32,
    /// The ray map; where no look-up needs it, empty.
    pub map: Buffer,
    /// Those of its rays, each with the places among them that hold all of its own.
    traces: BTreeMap<u32, Range<u32>>,
    /// Those by which the still vertices were looked up in it.
    pub asked: BTreeSet<u32>,
}

/// Those of one sampling cell.
pub struct Nodes {
    recipe: Recipe,
    grid: Grid,
    /// Where octrees are kept; none of reflectors that move, as no later frame would want them.
    files: Option<Cache>,
    /// Look-ups go from ray to ray of the map.
    mapped: bool,
    pub slots: [Option<Node>; 8],
}

impl Node {
    /// The places among its rays that hold all of a trace.
    pub fn rays_of(&self, trace: u32) -> Range<u32> {
        self.traces.get(&trace).cloned().unwrap_or(0..0)
    }
}

impl Nodes {
    pub fn new(recipe: Recipe, grid: Grid, files: Option<Cache>, mapped: bool) -> Nodes {
        Nodes { recipe, grid, files, mapped, slots: Default::default() }
    }

    /// Texels along a side of the ray maps' faces.
    pub fn map(&self) -> u32 {
        self.recipe.map
    }

    /// Whether any of them has rays of a trace.
    pub fn know(&self, trace: u32) -> bool {
        self.slots.iter().flatten().any(|node| node.traces.contains_key(&trace))
    }

    /// Forget all: the reflectors are others.
    pub fn clear(&mut self) {
        self.slots = Default::default();
    }

    /// Whether a corner's octree is not the one in its slot.
    pub fn lacks(&self, slot: usize, corner: &Corner) -> bool {
        self.slots[slot].as_ref().is_none_or(|node| node.place != corner.node)
    }

    /// Load or build the octrees of a cell that are not there.
    pub fn fetch(
        &mut self,
        device: &Arc<Device>,
        (scene, moment): (&Scene, &Moment),
        corners: &[Corner; 8],
    ) -> Result<()> {
        let mut mapper = None;
        for (slot, corner) in corners.iter().enumerate() {
            if self.lacks(slot, corner) {
                // What is there goes first, so that there are never more than eight.
                self.slots[slot] = None;
                let octree = self.octree(scene, moment, corner.node, &mut mapper)?;
                self.slots[slot] = Some(self.upload(device, corner.node, &octree)?);
            }
        }
        Ok(())
    }

    /// From its file, or built and kept there.
    fn octree<'s>(
        &self,
        scene: &'s Scene,
        moment: &Moment,
        node: IVec3,
        mapper: &mut Option<RayMapper<'s>>,
    ) -> Result<RayOctree> {
        let location = self.grid.location(node);
        let Recipe { map, depth, layers, still } = self.recipe;
        let mut build = || {
            let mapper = mapper.get_or_insert_with(|| RayMapper::new(scene, moment, still));
            RayOctree::new(mapper.extent, mapper.trace(location, map, layers), depth)
        };
        let Some(files) = &self.files else { return Ok(build()) };
        let key = self.recipe.key(scene, moment, location);
        let path = file::path(files, scene, &key);
        match file::load(&path, &key) {
            Ok(Some(octree)) => return Ok(octree),
            Ok(None) => {}
            Err(cause) => eprintln!("{}: {cause}; built anew", path.display()),
        }
        let octree = build();
        files.keep(&path, &file::encode(&octree, &key))?;
        Ok(octree)
    }

    fn upload(&self, device: &Arc<Device>, place: IVec3, octree: &RayOctree) -> Result<Node> {
        let Recipe { map, layers, .. } = self.recipe;
        let table = self.mapped.then(|| RayTable::new(&octree.segments, map, layers).places);
        Ok(Node {
            place,
            extent: octree.extent,
            cells: Buffer::with_data(device, "octree cells", &octree.cells)?,
            starts: Buffer::with_data(device, "octree leaves", &octree.starts)?,
            lists: Buffer::with_data(device, "octree lists", &octree.lists)?,
            segments: Buffer::with_data(device, "octree rays", &octree.segments)?,
            segment_count: octree.segments.len() as u32,
            map: Buffer::with_data(device, "ray map", &table.unwrap_or_default())?,
            traces: ranges(&octree.segments),
            asked: BTreeSet::new(),
        })
    }
}

/// Where the rays of each trace are: those of an order lie together.
fn ranges(segments: &[RaySegment]) -> BTreeMap<u32, Range<u32>> {
    let mut ranges: BTreeMap<u32, Range<u32>> = BTreeMap::new();
    for (place, segment) in (0..).zip(segments) {
        ranges.entry(segment.trace).or_insert(place..place).end = place + 1;
    }
    ranges
}

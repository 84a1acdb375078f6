//! Ray maps, ray octrees, their files and the sampling grid (Martin & Popescu 2004, sections 3 and 4).

use std::fs;

use glam::{DVec3, IVec3, Vec3};
use mirrorbench::geometry::alhazen::reflected_point;
use mirrorbench::geometry::random::SplitMix64;
use mirrorbench::geometry::ray_octree::{Extent, LEAF, RayOctree, RaySegment};
use mirrorbench::geometry::{cube, optics};
use mirrorbench::methods::reflection_morphing::file::{self, Recipe};
use mirrorbench::methods::reflection_morphing::grid::Grid;
use mirrorbench::methods::reflection_morphing::ray_map::RayMapper;
use mirrorbench::scene;
use mirrorbench::truth::Cache;

const RECIPE: Recipe = Recipe { map: 48, depth: 4, layers: 1, still: false };
const LOCATION: Vec3 = Vec3::new(0.0, 1.5, 4.0);

/// The octree of a scene's map.
fn octree(name: &str, recipe: Recipe) -> RayOctree {
    let scene = scene::load(name).unwrap();
    let mapper = RayMapper::new(&scene, &scene.at(0), false);
    RayOctree::new(mapper.extent, mapper.trace(LOCATION, recipe.map, recipe.layers), recipe.depth)
}

#[test]
fn rays_leave_a_sphere_by_the_law_of_reflection_and_end_on_the_scenes_box() {
    let scene = scene::load("columns").unwrap();
    let mapper = RayMapper::new(&scene, &scene.at(0), false);
    let (segments, size) = (mapper.trace(LOCATION, 48, 1), 48);
    assert!(segments.len() > 100, "{} rays", segments.len());
    assert!(segments.is_sorted_by_key(|segment| segment.texel));
    for segment in segments {
        let (row, column) = (segment.texel / size, segment.texel % size);
        let uv = glam::UVec2::new(column, row % size).as_vec2() + 0.5;
        let incident = cube::direction(row / size, uv / size as f32).normalize();
        let seen = (segment.start - LOCATION).normalize();
        assert!(seen.abs_diff_eq(incident, 1e-5), "texel {}", segment.texel);
        let normal = (segment.start - Vec3::Y).normalize();
        let way = (segment.end - segment.start).normalize();
        // The mesh's normals are interpolated.
        assert!(way.abs_diff_eq(optics::reflect(incident, normal), 0.01));
        assert_eq!(segment.trace, 1);
        let [low, high] = [mapper.extent.low, mapper.extent.high];
        let gap = (segment.end - low).min(high - segment.end).min_element();
        assert!(gap.abs() < 1e-4, "{gap} m from the box");
    }
}

#[test]
fn a_second_layer_begins_where_the_first_ends_and_remembers_both_mirrors() {
    let scene = scene::load("two-spheres").unwrap();
    let mapper = RayMapper::new(&scene, &scene.at(0), false);
    let (segments, texels) = (mapper.trace(LOCATION, 64, 2), 6 * 64 * 64);
    let second = segments.iter().filter(|segment| segment.texel >= texels);
    let mut traces = Vec::new();
    for segment in second {
        let first = segments.iter().find(|first| first.texel + texels == segment.texel).unwrap();
        assert!(first.end.abs_diff_eq(segment.start, 1e-5));
        assert_eq!(segment.trace & 0xff, first.trace);
        traces.push(segment.trace);
    }
    traces.sort_unstable();
    traces.dedup();
    assert_eq!(traces, [1 << 8 | 2, 2 << 8 | 1]);
}

#[test]
fn still_objects_left_in_end_rays_and_hide_the_mirror() {
    let scene = scene::load("columns").unwrap();
    let moment = scene.at(0);
    let [out, left_in] =
        [false, true].map(|still| RayMapper::new(&scene, &moment, still).trace(LOCATION, 128, 1));
    assert!(left_in.len() < out.len(), "{} of {} rays", left_in.len(), out.len());
    let length = |ray: &RaySegment| ray.start.distance(ray.end);
    let (mut cut, cube) = (0, moment.poses[scene.objects.len() - 1]);
    for ray in &left_in {
        let whole = out.iter().find(|whole| whole.texel == ray.texel).unwrap();
        assert_eq!(whole.start, ray.start);
        assert!(length(ray) < length(whole) + 1e-4);
        cut += usize::from(length(ray) < length(whole) - 0.1);
    }
    // The floor and the columns; the cube moves, so rays go through it.
    assert!(cut > 100, "{cut} rays end early");
    let towards_cube =
        left_in.iter().filter(|ray| ray.distance_squared(cube.translation.into()) < 0.01);
    assert!(towards_cube.clone().count() > 0);
    let beyond = |ray: &RaySegment| ray.end.distance(cube.translation.into()) > 0.3;
    assert!(towards_cube.clone().all(beyond));
}

#[test]
fn from_inside_a_closed_mirror_nothing_is_seen() {
    let scene = scene::load("columns").unwrap();
    let mapper = RayMapper::new(&scene, &scene.at(0), false);
    assert_eq!(mapper.trace(Vec3::Y, 16, 1), []);
}

/// An octree that is built as the paper says, one ray after the other.
enum Inserted {
    Leaf(Vec<u32>),
    Inner(Vec<Inserted>),
}

impl Inserted {
    fn insert(&mut self, extent: Extent, segments: &[RaySegment], ray: u32, depth: u32) {
        let RaySegment { start, end, trace, .. } = segments[ray as usize];
        if extent.clip(start, end - start, 1.0).is_none() {
            return;
        }
        match self {
            Inserted::Inner(children) => {
                for (which, child) in (0..).zip(children) {
                    child.insert(part(extent, which), segments, ray, depth - 1);
                }
            }
            Inserted::Leaf(list) => {
                let conflict = list.iter().any(|&other| segments[other as usize].trace == trace);
                list.push(ray);
                if conflict && depth > 0 {
                    let pushed = std::mem::take(list);
                    *self = Inserted::Inner((0..8).map(|_| Inserted::Leaf(Vec::new())).collect());
                    for ray in pushed {
                        self.insert(extent, segments, ray, depth);
                    }
                }
            }
        }
    }

    fn leaf(&self, extent: Extent, point: Vec3) -> &[u32] {
        match self {
            Inserted::Leaf(list) => list,
            Inserted::Inner(children) => {
                let which = (0..8).find(|&which| part(extent, which).contains(point)).unwrap();
                children[which as usize].leaf(part(extent, which), point)
            }
        }
    }

    fn leaves(&self) -> usize {
        match self {
            Inserted::Leaf(_) => 1,
            Inserted::Inner(children) => children.iter().map(Inserted::leaves).sum(),
        }
    }
}

/// One of eight: bits 0 to 2 choose the upper half along x, y and z.
fn part(Extent { low, high }: Extent, which: u32) -> Extent {
    let half = 0.5 * (high - low);
    let low = low + half * Vec3::from_array([0, 1, 2].map(|axis| (which >> axis & 1) as f32));
    Extent { low, high: low + half }
}

#[test]
fn building_at_once_gives_what_inserting_one_by_one_does() {
    for (scene, layers) in [("columns", 1), ("two-spheres", 2)] {
        let built = octree(scene, Recipe { layers, ..RECIPE });
        let RayOctree { extent, segments, .. } = &built;
        let mut inserted = Inserted::Leaf(Vec::new());
        // In another order, too.
        for ray in (0..segments.len() as u32).rev() {
            inserted.insert(*extent, segments, ray, RECIPE.depth);
        }
        assert!(built.is_sound());
        let leaves = built.cells.iter().filter(|&&cell| cell & LEAF != 0).count();
        assert_eq!([built.load().leaves, leaves], [inserted.leaves(); 2], "{scene}");
        let mut random = SplitMix64::new(3);
        let mut filled = 0;
        for _ in 0..3000 {
            let point = random.within(extent.low, extent.high);
            let mut expected = inserted.leaf(*extent, point).to_vec();
            expected.sort_unstable_by_key(|&ray| (segments[ray as usize].trace, ray));
            assert_eq!(built.leaf(point), expected, "{scene} at {point}");
            filled += usize::from(!expected.is_empty());
        }
        assert!(filled > 300, "{filled} leaves with rays");
    }
}

#[test]
fn a_leaf_knows_the_nearest_ray_unless_it_runs_through_another() {
    // The ray nearest to a point need not cross the point's own leaf: rays are farther from each other, or the
    // leaf smaller, the more of them are missed. So it is in the paper; what a leaf finds is never nearer.
    for (map, [low, high]) in [(32, [0.3, 0.6]), (64, [0.4, 0.6]), (128, [0.5, 0.7])] {
        let octree = octree("columns", Recipe { map, depth: 5, ..RECIPE });
        let mut random = SplitMix64::new(7);
        let (mut asked, mut same, mut none) = (0, 0, 0);
        while asked < 10_000 {
            // Where there is something to be seen: over the floor, in front of the mirror.
            let point = random.within(Vec3::new(-3.0, 0.0, 1.0), Vec3::new(3.0, 3.0, 4.0));
            let exact = octree.nearest_of_all(point, 1).unwrap();
            asked += 1;
            let distance = |ray: u32| octree.segments[ray as usize].distance_squared(point);
            match octree.nearest(point, 1) {
                None => none += 1,
                Some(ray) if distance(ray) == distance(exact) => same += 1,
                Some(ray) => assert!(distance(ray) > distance(exact)),
            }
        }
        let [same, none] = [same, none].map(|n: u32| f64::from(n) / f64::from(asked));
        assert!((low..=high).contains(&same), "map {map}: the same ray in {same}, none in {none}");
    }
}

#[test]
fn points_outside_and_traces_unknown_find_nothing() {
    let octree = octree("columns", RECIPE);
    assert_eq!(octree.nearest(octree.extent.high + 1.0, 1), None);
    assert_eq!(octree.nearest(Vec3::new(f32::NAN, 1.0, 1.0), 1), None);
    let point = Vec3::new(0.0, 1.0, 2.0);
    assert!(octree.nearest(point, 1).is_some());
    assert_eq!((octree.nearest(point, 2), octree.nearest_of_all(point, 2)), (None, None));
}

#[test]
fn files_give_back_what_was_built_and_nothing_else() {
    let (octree, key) = (octree("columns", RECIPE), blake3::hash(b"key"));
    let whole = file::encode(&octree, &key);
    assert_eq!(file::decode(&whole, &key).unwrap(), octree);
    assert_eq!(
        file::decode(&whole, &blake3::hash(b"other")),
        Err("it was made from something else")
    );
    let mut random = SplitMix64::new(11);
    for _ in 0..400 {
        let mut flipped = whole.clone();
        flipped[random.below(whole.len())] ^= 1 << random.below(8);
        assert!(file::decode(&flipped, &key).is_err());
        assert!(file::decode(&whole[..random.below(whole.len())], &key).is_err());
    }
    let mut newer = whole.clone();
    newer[8] += 1;
    assert_eq!(file::decode(&newer, &key), Err("it is of another version"));
}

#[test]
fn lengths_that_lie_are_refused_even_with_a_right_checksum() {
    let (octree, key) = (octree("columns", RECIPE), blake3::hash(b"key"));
    let whole = file::encode(&octree, &key);
    let body = &whole[..whole.len() - 32];
    let sealed = |bytes: &[u8]| [bytes, blake3::hash(bytes).as_bytes()].concat();
    assert!(file::decode(&sealed(body), &key).is_ok());
    let mut random = SplitMix64::new(13);
    let places: Vec<_> = (0..400).map(|_| 84 + random.below(body.len() - 84)).collect();
    for at in (44..60).chain(places) {
        let mut lying = body.to_vec();
        lying[at] = !lying[at];
        // Where it is read none the less, every look-up ends in it.
        if let Ok(octree) = file::decode(&sealed(&lying), &key) {
            assert!(at >= 84, "byte {at}");
            for _ in 0..20 {
                octree.nearest(random.within(octree.extent.low, octree.extent.high), 1);
            }
        }
    }
}

#[test]
fn whatever_changes_the_octree_changes_its_file() {
    let (columns, other) = (scene::load("columns").unwrap(), scene::load("two-spheres").unwrap());
    let moment = columns.at(0);
    let mut turned = moment.clone();
    let mirror = columns.reflectors()[0] as usize;
    turned.poses[mirror].translation.x += 0.1;
    let keys = [
        RECIPE.key(&columns, &moment, LOCATION),
        RECIPE.key(&columns, &moment, LOCATION + Vec3::X),
        RECIPE.key(&columns, &turned, LOCATION),
        RECIPE.key(&other, &other.at(0), LOCATION),
        Recipe { map: 49, ..RECIPE }.key(&columns, &moment, LOCATION),
        Recipe { depth: 5, ..RECIPE }.key(&columns, &moment, LOCATION),
        Recipe { layers: 2, ..RECIPE }.key(&columns, &moment, LOCATION),
        Recipe { still: true, ..RECIPE }.key(&columns, &moment, LOCATION),
    ];
    for (index, key) in keys.iter().enumerate() {
        assert!(!keys[..index].contains(key), "key {index}");
    }
    // Diffuse objects and the eye may move.
    assert_eq!(RECIPE.key(&columns, &columns.at(9), LOCATION), keys[0]);
}

#[test]
fn a_file_that_is_not_there_is_no_fault_and_one_that_cannot_be_read_is() {
    let folder = tempfile::tempdir().unwrap();
    let cache = Cache::new(folder.path());
    let scene = scene::load("columns").unwrap();
    let key = RECIPE.key(&scene, &scene.at(0), LOCATION);
    let path = file::path(&cache, &scene, &key);
    assert_eq!(file::load(&path, &key), Ok(None));
    fs::create_dir(&path).unwrap();
    assert_eq!(file::load(&path, &key), Err("it cannot be read"));
}

#[test]
fn the_eye_lies_among_its_nodes_and_they_keep_their_places() {
    let grid = Grid { cell: 0.4 };
    let mut random = SplitMix64::new(17);
    for _ in 0..500 {
        let eye = random.within(Vec3::splat(-5.0), Vec3::splat(5.0));
        let corners = grid.cell_of(eye).corners();
        let weights: f32 = corners.iter().map(|corner| corner.weight).sum();
        assert!((weights - 1.0).abs() < 1e-5);
        // Trilinear interpolation gives back what is linear.
        let sum: Vec3 =
            corners.iter().map(|corner| corner.weight * grid.location(corner.node)).sum();
        assert!(sum.abs_diff_eq(eye, 1e-4), "{sum} for {eye}");
        let step = grid.cell * Vec3::Z;
        for (here, next) in corners.iter().zip(grid.cell_of(eye + step).corners()) {
            let moved = next.node - here.node;
            assert!(moved == IVec3::ZERO || moved == IVec3::new(0, 0, 2), "{moved}");
        }
    }
    let node = IVec3::new(-1, 3, 8);
    let at_node = grid.cell_of(grid.location(node)).corners();
    let nearest = at_node.iter().max_by(|a, b| a.weight.total_cmp(&b.weight)).unwrap();
    assert!(nearest.weight > 0.999 && nearest.node == node);
}

#[test]
fn interpolation_errs_by_the_square_of_the_cell() {
    // With exact points at the nodes, in pixels of a view 720 high that is open by 60 degrees.
    let pixels = 720.0 / (2.0 * 30f64.to_radians().tan());
    let cells = [0.25, 0.5, 1.0, 2.0];
    let errors = cells.map(|cell| {
        let (grid, mut random) = (Grid { cell }, SplitMix64::new(19));
        let (mut sum, mut count) = (0.0, 0);
        for _ in 0..4000 {
            // Over a whole cell of the coarsest grid, so that each is met everywhere.
            let eye = random.within(Vec3::new(-1.0, 0.6, 3.0), Vec3::new(1.0, 2.6, 5.0));
            let seen =
                random.within(Vec3::new(-2.0, 0.0, 1.2), Vec3::new(2.0, 2.5, 2.5)).as_dvec3();
            let point = |eye: Vec3| reflected_point(DVec3::Y, 1.0, eye.as_dvec3(), seen);
            let corners = grid.cell_of(eye).corners();
            let interpolated = corners.iter().try_fold(DVec3::ZERO, |sum, corner| {
                Some(sum + f64::from(corner.weight) * point(grid.location(corner.node))?)
            });
            let Some((exact, interpolated)) = point(eye).zip(interpolated) else { continue };
            let [a, b] = [exact, interpolated].map(|p| (p - eye.as_dvec3()).normalize());
            sum += pixels * a.cross(b).length();
            count += 1;
        }
        assert!(count > 1000, "{count} points are seen by all nodes");
        sum / f64::from(count)
    });
    let rise = (errors[3] / errors[0]).log2() / (cells[3] / cells[0]).log2() as f64;
    assert!((1.7..2.3).contains(&rise), "{errors:?} px rise by the power {rise}");
    assert!((0.3..3.0).contains(&errors[3]), "{errors:?} px");
}

//! Reflection points against the exact ones, on the device: what searches find in the G-buffer of a
//! finely cut sphere, held against Alhazen's root; of an ellipsoid in `ellipsoid`.

mod cube;
mod ellipsoid;
mod roots;
mod scan;

use std::sync::Arc;

use glam::{DAffine3, DVec3, Vec2, Vec3, Vec4};

use super::cube::CubeMaps;
use super::rule::Rule;
use super::search::{Found, Mirror, Search};
use super::source::{Lists, Source};
use crate::geometry::alhazen::reflected_point;
use crate::geometry::shapes::sphere;
use crate::gpu::{Device, Format, Frame};
use crate::methods::reflected::Corner;
use crate::methods::{Case, METHODS, Values};
use crate::scene::{self, Moment, ObjectId, Scene};
use crate::stages::{CameraUniform, GBuffer, GpuScene, RecordMode, ReflectionRecord};

/// The scene `columns` with a sphere so fine that its facets cannot be told from it.
fn columns() -> (Scene, ObjectId) {
    let mut scene = scene::load("columns").unwrap();
    let reflector = scene.reflectors()[0];
    let mesh = scene.objects[reflector as usize].mesh;
    scene.meshes[mesh] = sphere(1.0, 1024, 512);
    (scene, reflector)
}

/// The values of a case of virtual objects.
fn values(case: &str) -> Values {
    let case = Case::parse(case, &METHODS.iter().collect::<Vec<_>>()).unwrap();
    case.parts[0].values.clone()
}

/// The exact reflection point of a reflector about its own origin, of an eye and a point seen in it.
type Exact = Box<dyn Fn(DVec3, DVec3) -> Option<DVec3>>;

/// Everything one reflector's search needs.
struct Bench {
    device: Arc<Device>,
    scene: GpuScene,
    reflector: ObjectId,
    exact: Exact,
    lists: Lists,
    source: Source,
    found: Found,
    gbuffer: GBuffer,
    rule: Rule,
    search: Search,
    record: ReflectionRecord,
}

const VIEW: [u32; 2] = [320, 240];

impl Bench {
    fn new(case: &str) -> Bench {
        let (scene, reflector) = columns();
        let exact = Box::new(|eye, v| reflected_point(DVec3::ZERO, 1.0, eye, v));
        Bench::of(case, scene, reflector, exact)
    }

    fn of(case: &str, scene: Scene, reflector: ObjectId, exact: Exact) -> Bench {
        let rule = Rule::new(&values(case));
        let texels = rule.texture_size(VIEW);
        let device = Device::open("auto", true).unwrap();
        let lists = Lists::new(&scene, rule.edge).unwrap();
        let source = lists.upload(&device).unwrap();
        Bench {
            scene: GpuScene::new(&device, &Arc::new(scene)).unwrap(),
            found: Found::new(&device, source.count, 1, 0).unwrap(),
            gbuffer: GBuffer::new(&device, texels, rule.format).unwrap(),
            search: Search::new(&device, &rule, RecordMode::Full, texels).unwrap(),
            record: ReflectionRecord::new(&device, VIEW, RecordMode::Full, 1).unwrap(),
            rule,
            reflector,
            exact,
            lists,
            source,
            device,
        }
    }

    /// The camera of the textures.
    fn camera(&self, moment: &Moment) -> CameraUniform {
        let camera = CameraUniform::new(&moment.camera, VIEW);
        if !self.rule.fitted {
            return camera;
        }
        camera.fitted(&self.scene.scene.closed_points_of(moment, self.reflector)).unwrap()
    }

    /// Where a world point is on the textures, in texels.
    fn place(&self, camera: &CameraUniform, point: Vec3) -> Option<Vec2> {
        let [width, height] = self.gbuffer.size.map(|n| n as f32);
        Some((0.5 * camera.project(point)? + 0.5) * Vec2::new(width, height))
    }

    /// Search at a moment; the places found, in texels, and the counters. A vertex is drawn behind its
    /// reflection point as the eye sees it, if pushed there; in the plane of a texel otherwise.
    fn run(&mut self, moment: &Moment, cut: bool) -> (Vec<Vec2>, Vec<u32>) {
        let camera = self.camera(moment);
        let mut frame = Frame::new(&self.device).unwrap();
        frame.begin().unwrap();
        self.scene.pose(&mut frame, moment).unwrap();
        self.record.clear(&mut frame).unwrap();
        self.gbuffer.draw(&mut frame, &self.scene, "test", self.reflector, &camera).unwrap();
        let cubes = self.rule.cube.map(|rule| {
            let mut cubes = CubeMaps::new(&self.device, rule, self.rule.format).unwrap();
            cubes.draw(&mut frame, &self.scene, self.reflector).unwrap();
            cubes
        });
        let mirror = Mirror {
            object: self.reflector,
            place: 0,
            vertices: self.source.count,
            gbuffer: &self.gbuffer,
            cube: cubes.as_ref().and_then(|cubes| cubes.of(&self.scene, self.reflector)),
            camera: &camera,
            cut,
            index: 1.0,
            first: None,
        };
        let Bench { scene, source, found, search, record, .. } = self;
        search.run(&mut frame, scene, source, found, &mirror, record).unwrap();
        frame.submit().unwrap();
        let counters = self.record.counters(0).unwrap();
        if self.rule.clips {
            let corners: Vec<Corner> = self.found.corners.read().unwrap();
            let nowhere = Vec2::splat(f32::NAN);
            let place = |c: &Corner| self.place(&camera, c.image.into()).unwrap_or(nowhere);
            return (corners.iter().map(place).collect(), counters);
        }
        let texels: Vec<u32> = self.found.texels.read().unwrap();
        let centre = |t: u32| Vec2::new((t & 0xffff) as f32, (t >> 16) as f32) + 0.5;
        (texels.into_iter().map(centre).collect(), counters)
    }

    /// Where the exact reflection point of each vertex that is not hidden is, in texels.
    fn roots(&self, moment: &Moment) -> Vec<(usize, Vec2)> {
        let pose = moment.poses[self.reflector as usize];
        let world = DAffine3 {
            matrix3: glam::Mat3::from(pose.matrix3).as_dmat3(),
            translation: Vec3::from(pose.translation).as_dvec3(),
        };
        let own = world.inverse();
        let eye = own.transform_point3(moment.camera.eye.as_dvec3());
        let camera = self.camera(moment);
        let vertices = self.lists.vertices.iter().zip(&self.lists.owners).enumerate();
        let root = |(i, (vertex, &owner)): (usize, (&crate::stages::Vertex, &ObjectId))| {
            if owner == self.reflector {
                return None;
            }
            let pose = moment.poses[owner as usize];
            let v = pose.transform_point3(vertex.position());
            let root = (self.exact)(eye, own.transform_point3(v.as_dvec3()))?;
            Some((i, self.place(&camera, world.transform_point3(root).as_vec3())?))
        };
        vertices.filter_map(root).collect()
    }

    /// Which texels show the reflector.
    fn mask(&self) -> Vec<bool> {
        const HALF_ONE: u16 = 0x3c00;
        let positions = &self.gbuffer.position;
        if self.rule.format == Format::Rgba16Float {
            return positions
                .read::<[u16; 4]>()
                .unwrap()
                .iter()
                .map(|p| p[3] == HALF_ONE)
                .collect();
        }
        positions.read::<Vec4>().unwrap().iter().map(|p| p.w == 1.0).collect()
    }
}

/// Distances of the texels found from the exact points, in texels along the worse axis, in rising
/// order: where the eight texels round the root's show the reflector too, and at its rim.
fn errors(bench: &Bench, moment: &Moment, texels: &[Vec2]) -> [Vec<f32>; 2] {
    errors_of(bench, moment, texels, |_| true)
}

/// The same of some vertices.
fn errors_of(
    bench: &Bench,
    moment: &Moment,
    texels: &[Vec2],
    counts: impl Fn(usize) -> bool,
) -> [Vec<f32>; 2] {
    let mask = bench.mask();
    let shows = |x: i32, y: i32| {
        let [width, height] = bench.gbuffer.size.map(|n| n as i32);
        (0..width).contains(&x) && (0..height).contains(&y) && mask[(y * width + x) as usize]
    };
    let (mut inside, mut rim) = (Vec::new(), Vec::new());
    for (i, root) in bench.roots(moment).into_iter().filter(|&(i, _)| counts(i)) {
        let [x, y] = root.as_ivec2().to_array();
        let is_inside = (-1..=1).all(|dx| (-1..=1).all(|dy| shows(x + dx, y + dy)));
        let error = (texels[i] - root).abs().max_element();
        if is_inside { inside.push(error) } else { rim.push(error) }
    }
    assert!(inside.len() > 3000, "only {} vertices have a root", inside.len());
    inside.sort_by(f32::total_cmp);
    rim.sort_by(f32::total_cmp);
    [inside, rim]
}

#[test]
fn on_a_sphere_the_published_search_ends_within_a_texel_of_the_root() {
    for case in ["virtual-objects", "virtual-objects:pattern=eight"] {
        let mut bench = Bench::new(case);
        let moment = bench.scene.scene.at(0);
        let (texels, counters) = bench.run(&moment, true);
        let [inside, rim] = errors(&bench, &moment, &texels);
        let most = inside[inside.len() - 1];
        assert!(most <= 1.0, "{case}: {most} texels from the root");
        // The four of the crosshair cannot follow a slanted rim, where texels outside are no way.
        let [typical, worst] = [rim[rim.len() * 9 / 10], rim[rim.len() - 1]];
        assert!(typical < 1.1 && worst < 5.0, "{case}: at the rim {typical} and {worst}");
        // One search for each vertex of the others; four or eight neighbours a step.
        let others = bench.lists.owners.iter().filter(|&&o| o != bench.reflector).count();
        let [searches, steps, evaluations, most, hidden] = counters[..5] else { panic!() };
        assert_eq!(searches as usize, others);
        let a_step = if case.contains("eight") { 8 } else { 4 };
        assert!(evaluations <= searches + a_step * steps && evaluations > 3 * steps);
        assert!(most * searches > steps && hidden > 0 && hidden < searches);
    }
}

#[test]
fn on_a_sphere_the_revised_search_ends_within_a_fiftieth_of_a_texel() {
    // Vertices as many as the published rule's, for the same test.
    let mut bench = Bench::new("virtual-objects@revised:subdivide=0.25");
    let moment = bench.scene.scene.at(0);
    let (places, counters) = bench.run(&moment, true);
    let [inside, rim] = errors(&bench, &moment, &places);
    let [p95, worst] = [inside[inside.len() * 95 / 100], inside[inside.len() - 1]];
    assert!(p95 < 0.02 && worst < 0.2, "{p95} and {worst} texels from the root");
    let worst = rim[rim.len() - 1];
    // Between the outermost texels' centres and the rim there is nothing to step on.
    assert!(worst < 3.0, "{worst} texels from the root at the rim");
    // From coarse to fine: far fewer looks than a walk from the middle.
    let [searches, _, evaluations, ..] = counters[..] else { panic!() };
    assert!(evaluations < 80 * searches, "{evaluations} texels looked at in {searches} searches");
}

#[test]
fn last_frames_texels_shorten_the_search_until_a_cut() {
    let mut bench = Bench::new("virtual-objects");
    let moments = [0, 1].map(|frame| bench.scene.scene.at(frame));
    let steps = |(_, counters): (Vec<Vec2>, Vec<u32>)| counters[1];
    let cold = steps(bench.run(&moments[0], true));
    let warm = steps(bench.run(&moments[1], false));
    let cut = steps(bench.run(&moments[1], true));
    assert!(4 * warm < cold, "{warm} steps after {cold}");
    assert!(2 * cut > cold, "{cut} steps after a cut");
    // Warm or cold, the same texels win, but for ties.
    let (again, _) = bench.run(&moments[1], false);
    let [inside, _] = errors(&bench, &moments[1], &again);
    let worst = inside[inside.len() - 1];
    assert!(worst <= 1.0, "{worst} texels from the root when warm");
}

#[test]
fn a_reflector_out_of_view_gives_nothing_to_search() {
    let mut bench = Bench::new("virtual-objects");
    let mut moment = bench.scene.scene.at(0);
    moment.camera.target = 2.0 * moment.camera.eye - moment.camera.target;
    let (_, counters) = bench.run(&moment, true);
    assert_eq!(counters[..5], [0; 5]);
}

//! Reflection points against the closed form, on the device: what searches find in the G-buffer of a
//! finely cut sphere, held against Alhazen's root.

use std::sync::Arc;

use glam::{DVec3, Vec2, Vec4};

use super::search::{Found, Mirror, Search};
use super::source::{Lists, Source};
use crate::geometry::alhazen::reflected_point;
use crate::geometry::shapes::sphere;
use crate::gpu::{Device, Format, Frame};
use crate::methods::{Case, METHODS, Values};
use crate::scene::{self, Moment, ObjectId, Scene};
use crate::stages::{CameraUniform, GBuffer, GpuScene, RecordMode, ReflectionRecord};

/// The scene `columns` with a sphere so fine that its facets cannot be told from it.
fn columns() -> (Scene, ObjectId) {
    let mut scene = scene::load("columns").unwrap();
    let reflector = scene.reflectors()[0];
    let mesh = scene.objects[reflector as usize].mesh;
    scene.meshes[mesh] = sphere(1.0, 512, 256);
    (scene, reflector)
}

/// The values of a case of virtual objects.
fn values(case: &str) -> Values {
    let case = Case::parse(case, &METHODS.iter().collect::<Vec<_>>()).unwrap();
    case.parts[0].values.clone()
}

/// Everything one reflector's search needs.
struct Bench {
    device: Arc<Device>,
    scene: GpuScene,
    reflector: ObjectId,
    lists: Lists,
    source: Source,
    found: Found,
    gbuffer: GBuffer,
    search: Search,
    record: ReflectionRecord,
}

const VIEW: [u32; 2] = [320, 240];

impl Bench {
    fn new(case: &str) -> Bench {
        let (scene, reflector) = columns();
        let values = values(case);
        let device = Device::open("auto", true).unwrap();
        let lists = Lists::new(&scene, values.f32("subdivide")).unwrap();
        let source = lists.upload(&device).unwrap();
        Bench {
            scene: GpuScene::new(&device, &Arc::new(scene)).unwrap(),
            found: Found::new(&device, source.count, 1).unwrap(),
            gbuffer: GBuffer::new(&device, VIEW, Format::Rgba32Float).unwrap(),
            search: Search::new(&device, &values, RecordMode::Full).unwrap(),
            record: ReflectionRecord::new(&device, VIEW, RecordMode::Full).unwrap(),
            reflector,
            lists,
            source,
            device,
        }
    }

    /// Search at a moment; the texels found and the counters.
    fn run(&mut self, moment: &Moment, cut: bool) -> (Vec<Vec2>, Vec<u32>) {
        let camera = CameraUniform::new(&moment.camera, VIEW);
        let mut frame = Frame::new(&self.device).unwrap();
        frame.begin().unwrap();
        self.scene.pose(&mut frame, moment).unwrap();
        self.record.clear(&mut frame).unwrap();
        self.gbuffer.draw(&mut frame, &self.scene, "test", self.reflector, &camera).unwrap();
        let mirror = Mirror {
            object: self.reflector,
            place: 0,
            gbuffer: &self.gbuffer,
            camera: &camera,
            cut,
        };
        let Bench { scene, source, found, search, record, .. } = self;
        search.run(&mut frame, scene, source, found, &mirror, record).unwrap();
        frame.submit().unwrap();
        let texels: Vec<u32> = self.found.texels.read().unwrap();
        let centre = |t: u32| Vec2::new((t & 0xffff) as f32, (t >> 16) as f32) + 0.5;
        (texels.into_iter().map(centre).collect(), self.record.counters().unwrap())
    }

    /// Where the closed form has the reflection point of each vertex that is not hidden, in texels.
    fn roots(&self, moment: &Moment) -> Vec<(usize, Vec2)> {
        let centre = DVec3::new(0.0, 1.0, 0.0);
        let eye = moment.camera.eye.as_dvec3();
        let vertices = self.lists.vertices.iter().zip(&self.lists.owners).enumerate();
        let root = |(i, (vertex, &owner)): (usize, (&crate::stages::Vertex, &ObjectId))| {
            if owner == self.reflector {
                return None;
            }
            let pose = moment.poses[owner as usize];
            let v = pose.transform_point3(vertex.position());
            let root = reflected_point(centre, 1.0, eye, v.as_dvec3())?;
            Some((i, moment.camera.project(VIEW, root.as_vec3())?))
        };
        vertices.filter_map(root).collect()
    }
}

/// Distances of the texels found from the closed form, in texels along the worse axis, in rising
/// order: where the eight texels round the root's show the reflector too, and at its rim.
fn errors(bench: &Bench, moment: &Moment, texels: &[Vec2]) -> [Vec<f32>; 2] {
    let mask: Vec<Vec4> = bench.gbuffer.position.read().unwrap();
    let shows = |x: i32, y: i32| {
        let [width, height] = VIEW.map(|n| n as i32);
        (0..width).contains(&x)
            && (0..height).contains(&y)
            && mask[(y * width + x) as usize].w == 1.0
    };
    let (mut inside, mut rim) = (Vec::new(), Vec::new());
    for (i, root) in bench.roots(moment) {
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

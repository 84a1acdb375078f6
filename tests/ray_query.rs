//! Rays traced by the device itself against the tree on the CPU: the same triangles, the same rule
//! about which of them count. Where the device traces none, the request is refused.

mod gpu_support;

use bytemuck::{Pod, Zeroable};
use glam::{Affine3A, Vec2, Vec3};
use gpu_support::Session;
use mirrorbench::geometry::Ray;
use mirrorbench::geometry::bvh::Bvh;
use mirrorbench::geometry::optics::{face_forward, reflect};
use mirrorbench::gpu::{
    Acceleration, Buffer, ComputePipeline, Device, Frame, MeshTriangles, Placement,
};
use mirrorbench::scene::{self, Moment, NO_OBJECT, ObjectId, Scene};

const SIZE: [u32; 2] = [96, 72];

/// Of so many rays one may meet another triangle: along shared edges and where surfaces touch.
const RAYS_PER_DISAGREEMENT: usize = 1000;

/// Largest difference of two distances to one triangle, relative.
const SAME_DISTANCE: f32 = 2e-5;

/// Largest difference of a corner's weight.
const SAME_WEIGHTS: f32 = 2e-3;

/// WGSL `FAR`.
const FAR: f32 = 3e38;

/// WGSL `TestRay`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct TestRay {
    origin: Vec3,
    object: u32,
    direction: Vec3,
    triangle: u32,
    outside: u32,
    pad: [u32; 3],
}

/// WGSL `TestHit`.
#[derive(Clone, Copy, Debug, Pod, Zeroable)]
#[repr(C)]
struct TestHit {
    distance: f32,
    object: u32,
    triangle: u32,
    front: u32,
    weights: Vec2,
}

impl TestRay {
    /// From free space.
    fn free(ray: Ray) -> TestRay {
        Self::leaving(ray, NO_OBJECT, 0, 0)
    }

    fn leaving(ray: Ray, object: u32, triangle: u32, outside: u32) -> TestRay {
        let Ray { origin, direction } = ray;
        TestRay { origin, object, direction, triangle, outside, pad: [0; 3] }
    }

    fn ray(&self) -> Ray {
        Ray { origin: self.origin, direction: self.direction }
    }
}

/// A scene's triangles in world space and whose they are.
struct World {
    bvh: Bvh,
    owners: Vec<(ObjectId, u32)>,
}

impl World {
    fn new(scene: &Scene, poses: &[Affine3A]) -> World {
        let (mut triangles, mut owners) = (Vec::new(), Vec::new());
        for (id, pose) in poses.iter().enumerate() {
            let mesh = scene.mesh_of(id as ObjectId);
            for index in 0..mesh.triangles.len() {
                triangles.push(mesh.corners(index).map(|corner| pose.transform_point3(corner)));
                owners.push((id as ObjectId, index as u32));
            }
        }
        World { bvh: Bvh::new(&triangles), owners }
    }

    /// The rule of `truth::Hit`.
    fn nearest(&self, ray: &TestRay) -> Option<TestHit> {
        let accept = |index: u32, front: bool| {
            let (object, triangle) = self.owners[index as usize];
            object != ray.object || (triangle != ray.triangle && front == (ray.outside != 0))
        };
        let hit = self.bvh.nearest(&ray.ray(), [0.0, f32::INFINITY], accept)?;
        let (object, triangle) = self.owners[hit.triangle as usize];
        let (distance, front, weights) = (hit.t, u32::from(hit.front), hit.barycentrics);
        Some(TestHit { distance, object, triangle, front, weights })
    }
}

/// A scene's meshes on the device, and a shader that traces.
struct Traced {
    structure: Acceleration,
    pipeline: ComputePipeline,
    frame: Frame,
}

impl Traced {
    fn new(session: &Session, scene: &Scene) -> Traced {
        let device = session.device();
        let (mut vertices, mut indices, mut ranges) = (Vec::new(), Vec::new(), Vec::new());
        for mesh in &scene.meshes {
            let base = vertices.len() as u32;
            // Scene vertices have 32 bytes, position first.
            vertices
                .extend(mesh.positions.iter().map(|p| [p.x, p.y, p.z, 9.0, 9.0, 9.0, 9.0, 9.0]));
            ranges.push((indices.len() as u32, 3 * mesh.triangles.len() as u32));
            indices.extend(mesh.triangles.iter().flatten().map(|i| i + base));
        }
        let vertices = Buffer::with_data(device, "vertices", &vertices).unwrap();
        let indices = Buffer::with_data(device, "indices", &indices).unwrap();
        let mesh = |&(first_index, index_count)| MeshTriangles {
            vertices: &vertices,
            stride: 32,
            indices: &indices,
            first_index,
            index_count,
        };
        let meshes: Vec<_> = ranges.iter().map(mesh).collect();
        let objects = scene.objects.len() as u32;
        let mut structure = Acceleration::new(device, "scene", &meshes, objects).unwrap();
        let pipeline = ComputePipeline::new(device, "tests/ray_query.wgsl", &[]).unwrap();
        let mut frame = Frame::new(device).unwrap();
        frame.begin().unwrap();
        frame.pass("test/build").build(&mut structure).unwrap();
        let recorded = frame.submit().unwrap();
        assert_eq!(recorded.passes[0].name, "test/build");
        Traced { structure, pipeline, frame }
    }

    fn trace(&mut self, placements: &[Placement], rays: &[TestRay]) -> Vec<TestHit> {
        let device = self.frame.device().clone();
        let given = Buffer::with_data(&device, "rays", rays).unwrap();
        let bytes = size_of::<TestHit>() as u64 * rays.len() as u64;
        let hits = Buffer::storage(&device, "hits", bytes).unwrap();
        self.frame.begin().unwrap();
        self.frame.pass("test/place").place(&mut self.structure, placements).unwrap();
        self.frame
            .pass("test/trace")
            .compute(&self.pipeline)
            .acceleration("scene_structure", &self.structure)
            .buffer("rays", &given)
            .buffer("hits", &hits)
            .over(rays.len() as u32)
            .unwrap();
        let recorded = self.frame.submit().unwrap();
        let names: Vec<_> = recorded.passes.iter().map(|p| p.name.as_str()).collect();
        assert_eq!(names, ["test/place", "test/trace"]);
        hits.read().unwrap()
    }
}

fn placements(scene: &Scene, poses: &[Affine3A]) -> Vec<Placement> {
    let place = |(object, &pose): (usize, _)| Placement {
        mesh: scene.objects[object].mesh,
        pose,
        index: object as u32,
        mask: 1,
        opaque: false,
    };
    poses.iter().enumerate().map(place).collect()
}

fn eye_rays(moment: &Moment) -> Vec<TestRay> {
    let pixels =
        (0..SIZE[1]).flat_map(|y| (0..SIZE[0]).map(move |x| Vec2::new(x as f32, y as f32)));
    pixels.map(|p| TestRay::free(moment.camera.ray(SIZE, p + 0.5))).collect()
}

/// The rays mirrored by the interpolated normals wherever `rays` end, mirror or not.
fn mirrored(
    scene: &Scene,
    poses: &[Affine3A],
    rays: &[TestRay],
    hits: &[Option<TestHit>],
) -> Vec<TestRay> {
    let met = rays.iter().zip(hits).filter_map(|(ray, hit)| Some((ray, (*hit)?)));
    met.map(|(ray, hit)| {
        let mesh = scene.mesh_of(hit.object);
        let corners = mesh.triangles[hit.triangle as usize].map(|corner| corner as usize);
        let Vec2 { x: v, y: w } = hit.weights;
        let weigh =
            |of: &[Vec3]| (1.0 - v - w) * of[corners[0]] + v * of[corners[1]] + w * of[corners[2]];
        let pose = &poses[hit.object as usize];
        let normal = pose.transform_vector3(weigh(&mesh.normals)).normalize();
        let direction = reflect(ray.direction, face_forward(normal, ray.direction));
        let ray = Ray { origin: pose.transform_point3(weigh(&mesh.positions)), direction };
        TestRay::leaving(ray, hit.object, hit.triangle, hit.front)
    })
    .collect()
}

/// How many rays met something else than on the CPU.
fn disagreements(expected: &[Option<TestHit>], found: &[TestHit]) -> usize {
    let differs = |(expected, found): (&Option<TestHit>, &TestHit)| match expected {
        None => found.distance < FAR,
        Some(hit) => {
            let off = (hit.distance - found.distance).abs() > SAME_DISTANCE * hit.distance.max(1.0);
            let weights = hit.weights.abs_diff_eq(found.weights, SAME_WEIGHTS);
            let ids = |h: &TestHit| (h.object, h.triangle, h.front);
            ids(hit) != ids(found) || off || !weights
        }
    };
    expected.iter().zip(found).filter(|&pair| differs(pair)).count()
}

fn agrees(name: &str, expected: &[Option<TestHit>], found: &[TestHit]) {
    assert!(expected.len() > 300, "{name}: only {} rays", expected.len());
    let (differ, allowed) =
        (disagreements(expected, found), expected.len() / RAYS_PER_DISAGREEMENT);
    assert!(differ <= allowed, "{name}: {differ} of {} rays", expected.len());
}

/// Eye rays, then rays mirrored once and twice, which start on surfaces and must
/// not meet the triangle they start on nor the wrong faces of its object.
fn compare(session: &Session, name: &str) {
    let scene = scene::load(name).unwrap();
    let moment = scene.at(0);
    let world = World::new(&scene, &moment.poses);
    let mut traced = Traced::new(session, &scene);
    let placements = placements(&scene, &moment.poses);
    let mut rays = eye_rays(&moment);
    for order in 0..3 {
        let expected: Vec<_> = rays.iter().map(|ray| world.nearest(ray)).collect();
        let found = traced.trace(&placements, &rays);
        agrees(&format!("{name}, order {order}"), &expected, &found);
        // Mirrored rays need the rule: taken as rays in free space they meet where they start.
        if order > 0 {
            let free: Vec<_> = rays.iter().map(|ray| TestRay::free(ray.ray())).collect();
            let caught = disagreements(&expected, &traced.trace(&placements, &free));
            assert!(caught > rays.len() / 20, "{name}, order {order}: only {caught} caught");
        }
        rays = mirrored(&scene, &moment.poses, &rays, &expected);
    }
    compare_opaque(name, &scene, &mut traced);
}

/// Rays that start on mirrors only find the same where all else is opaque.
fn compare_opaque(name: &str, scene: &Scene, traced: &mut Traced) {
    let moment = scene.at(0);
    let world = World::new(scene, &moment.poses);
    let eye = eye_rays(&moment);
    let hits: Vec<_> = eye.iter().map(|ray| world.nearest(ray)).collect();
    let mut rays = mirrored(scene, &moment.poses, &eye, &hits);
    rays.retain(|ray| scene.is_reflector(ray.object));
    let expected: Vec<_> = rays.iter().map(|ray| world.nearest(ray)).collect();
    let mut placed = placements(scene, &moment.poses);
    for placement in &mut placed {
        placement.opaque = !scene.is_reflector(placement.index);
    }
    agrees(&format!("{name}, opaque"), &expected, &traced.trace(&placed, &rays));
}

/// What moved is met where it stands now, what is masked out is not met at all.
fn compare_moved(session: &Session) {
    let scene = scene::load("two-spheres").unwrap();
    let moment = scene.at(0);
    let rays = eye_rays(&moment);
    let mut traced = Traced::new(session, &scene);
    let mut poses = moment.poses.clone();
    for (turn, pose) in poses.iter_mut().enumerate() {
        let turn = Affine3A::from_rotation_y(0.3 * turn as f32);
        *pose = Affine3A::from_translation(Vec3::new(0.1, 0.2, 0.3)) * turn * *pose;
    }
    let nearest = |poses: &[Affine3A]| -> Vec<_> {
        let world = World::new(&scene, poses);
        rays.iter().map(|ray| world.nearest(ray)).collect()
    };
    let placed = placements(&scene, &moment.poses);
    agrees("still", &nearest(&moment.poses), &traced.trace(&placed, &rays));
    let mut placed = placements(&scene, &poses);
    agrees("moved", &nearest(&poses), &traced.trace(&placed, &rays));
    for placement in &mut placed[1..] {
        placement.mask = 0;
    }
    agrees("alone", &nearest(&poses[..1]), &traced.trace(&placed, &rays));
}

fn unplaced(frame: &mut Frame, structure: &mut Acceleration, placements: &[Placement], word: &str) {
    let error = frame.pass("test/place").place(structure, placements).unwrap_err();
    let text = error.to_string();
    assert!(text.contains("test/place") && text.contains(word), "{text}");
}

/// Misuse is an error that says what is wrong, and the memory is counted and given back.
fn misuse_and_memory(session: &Session) {
    let device = session.device();
    let before = device.allocated_bytes();
    let corners = [[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
    let vertices = Buffer::with_data(device, "vertices", &corners).unwrap();
    let indices = Buffer::with_data(device, "indices", &[0u32, 1, 2]).unwrap();
    let mesh = MeshTriangles {
        vertices: &vertices,
        stride: 12,
        indices: &indices,
        first_index: 0,
        index_count: 3,
    };
    let buffers = device.allocated_bytes();
    let mut structure = Acceleration::new(device, "one", &[mesh], 1).unwrap();
    assert!(structure.bytes() > 0);
    assert!(device.allocated_bytes() >= buffers + structure.bytes());
    let pipeline = ComputePipeline::new(device, "tests/ray_query.wgsl", &[]).unwrap();
    let mut frame = Frame::new(device).unwrap();
    frame.begin().unwrap();
    let good = Placement { mesh: 0, pose: Affine3A::IDENTITY, index: 0, mask: 1, opaque: false };
    unplaced(&mut frame, &mut structure, &[good], "has not been built");
    frame.pass("test/build").build(&mut structure).unwrap();
    unplaced(&mut frame, &mut structure, &[good, good], "2 placements");
    unplaced(&mut frame, &mut structure, &[Placement { mesh: 1, ..good }], "no mesh 1");
    unplaced(&mut frame, &mut structure, &[Placement { index: 1 << 24, ..good }], "16777216");
    let pass = frame.pass("test/trace").compute(&pipeline);
    let error = pass.acceleration("scene_structure", &structure).over(1).unwrap_err();
    assert!(error.to_string().contains("has not been placed"), "{error}");
    drop((structure, vertices, indices, frame));
    assert_eq!(device.allocated_bytes(), before);
}

#[test]
fn ray_queries_find_what_the_tree_on_the_cpu_finds_or_are_refused() {
    let session = Session::open();
    if session.device().has_ray_query() {
        for name in ["two-spheres", "columns", "teapot"] {
            compare(&session, name);
        }
        compare_moved(&session);
        misuse_and_memory(&session);
    } else {
        refused(session.device());
    }
}

fn refused(device: &std::sync::Arc<Device>) {
    let asked = [
        device.require_ray_query().err(),
        Acceleration::new(device, "scene", &[], 1).err(),
        ComputePipeline::new(device, "tests/ray_query.wgsl", &[]).err(),
    ];
    for error in asked {
        let error = error.unwrap();
        assert_eq!(error.exit_code(), 3);
        let text = error.to_string();
        for word in [&device.info().name, "no ray query", "backend=software"] {
            assert!(text.contains(word), "{text}");
        }
    }
}

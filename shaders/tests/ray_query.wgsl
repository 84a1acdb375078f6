// Traces an array of rays, for the test that holds ray queries against the tree on the CPU.

#import bindings::rays::Start
#import bindings::structure::trace

struct TestRay {
    origin: vec3<f32>,
    object: u32,
    direction: vec3<f32>,
    triangle: u32,
    outside: u32,
    pad_a: u32,
    pad_b: u32,
    pad_c: u32,
}

struct TestHit {
    distance: f32,
    object: u32,
    triangle: u32,
    front: u32,
    weights: vec2<f32>,
}

@group(0) @binding(0) var<storage, read> rays: array<TestRay>;
@group(0) @binding(1) var<storage, read_write> hits: array<TestHit>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&rays) {
        return;
    }
    let ray = rays[id.x];
    let start = Start(ray.object, ray.triangle, ray.outside != 0u);
    let hit = trace(ray.origin, ray.direction, start);
    hits[id.x] = TestHit(hit.distance, hit.object, hit.triangle, u32(hit.front), hit.weights);
}

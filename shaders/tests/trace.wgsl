// Traces rays through the scene's tree, for the test that holds it against the processor's.
#import bindings::rays::{FAR, Start, surface_point}
#ifdef TREE_WIDE
#import bindings::wide_tree::trace
#else
#import bindings::tree::trace
#endif

// Origin; direction; object, triangle and side of the surface it starts on, as numbers.
struct Ray {
    origin: vec4<f32>,
    direction: vec4<f32>,
    start: vec4<u32>,
}
@group(0) @binding(0) var<storage, read> rays: array<Ray>;
struct Met {
    // 1 where something is met, object, triangle, 1 for its front.
    ids: vec4<u32>,
    // And the distance.
    position: vec4<f32>,
}
@group(0) @binding(1) var<storage, read_write> met: array<Met>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&rays) {
        return;
    }
    let ray = rays[id.x];
    let start = Start(ray.start.x, ray.start.y, ray.start.z == 1u);
    let hit = trace(ray.origin.xyz, ray.direction.xyz, start);
    if hit.distance == FAR {
        return;
    }
    let point = surface_point(hit, ray.direction.xyz);
    met[id.x].ids = vec4(1u, hit.object, hit.triangle, select(0u, 1u, hit.front));
    met[id.x].position = vec4(point.position, hit.distance);
}

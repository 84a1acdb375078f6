// The points of one reflector where vertices are seen from one sampling location (MORPH_VERTEX of Martin &
// Popescu 2004, section 6, first step).
#import bindings::record::count
#import bindings::scene::{objects, vertices, world_position}
#import reflection_morphing::octree::nearest
#import reflection_morphing::bundle::seen

struct LookUp {
    // Vertices in `asked`.
    total: u32,
    // Of the location in `points`.
    first: u32,
    reflector: u32,
    pad: u32,
}
@group(0) @binding(0) var<storage, read> look_up: LookUp;
@group(0) @binding(1) var<storage, read> owners: array<u32>;
@group(0) @binding(2) var<storage, read> asked: array<u32>;
// w: 1 and the metres from there to the vertex along the trace, below zero where the vertex lies beside all
// bundles of rays; 0 where it is not seen.
@group(0) @binding(3) var<storage, read_write> points: array<vec4<f32>>;

const LOOK_UPS: u32 = 0u;
const RAYS: u32 = 1u;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= look_up.total {
        return;
    }
    let vertex = asked[id.x];
    let owner = owners[vertex];
    if owner == look_up.reflector {
        return;
    }
    let position = world_position(objects[owner], vertices[vertex].position);
    let found = nearest(position);
    var out = vec4(0.0);
    if found.found {
        let at = seen(position, found.ray);
        if at.known {
            out = vec4(at.point, select(-1.0, 1.0, at.within) * (1.0 + at.way));
        }
    }
    points[look_up.first + vertex] = out;
    count(LOOK_UPS, 1u);
    count(RAYS, found.examined);
}

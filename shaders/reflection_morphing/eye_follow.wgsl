// Where the rays that leave one reflector meet the next one, as textures of its points and normals: to rays that go
// on from there these are what the drawn ones of a first reflector are. Rays know nothing of diffuse objects ("the
// scene without the diffuse objects", Martin & Popescu 2004, section 4.1).
#import bindings::rays::{FAR, Start, surface_point}
#import bindings::record::count
#import bindings::scene::objects
#import bindings::tree::trace
#import reflection_morphing::eye_bins::{EyeRay, KIND, RAY_NONE}

struct Follow {
    // Of the textures, texels a side.
    size: u32,
    // The reflector that the rays leave.
    reflector: u32,
    pad: vec2<u32>,
}
@group(0) @binding(0) var<storage, read> follow: Follow;
@group(0) @binding(1) var<storage, read> leaving: array<EyeRay>;
// w: 1 + the object met; 0 where none is.
@group(0) @binding(2) var met_position: texture_storage_2d<rgba32float, write>;
@group(0) @binding(3) var met_normal: texture_storage_2d<rgba32float, write>;

const FOLLOWED: u32 = 5u;
// What a ray starts beyond its own point by, metres a metre: past the triangle it leaves, whichever that is.
const BEYOND: f32 = 1e-4;
const NO_TRIANGLE: u32 = 0xffffffffu;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= vec2(follow.size)) {
        return;
    }
    let ray = leaving[id.y * follow.size + id.x];
    var position = vec4(0.0);
    var normal = vec4(0.0);
    if (ray.kind & KIND) != RAY_NONE {
        count(FOLLOWED, 1u);
        let origin = ray.origin + BEYOND * (1.0 + length(ray.origin)) * ray.direction;
        let hit = trace(origin, ray.direction, Start(follow.reflector, NO_TRIANGLE, true));
        if hit.distance != FAR {
            let met = surface_point(hit, ray.direction);
            position = vec4(met.position, 1.0 + f32(met.object));
            normal = vec4(met.normal, 0.0);
        }
    }
    textureStore(met_position, id.xy, position);
    textureStore(met_normal, id.xy, normal);
}

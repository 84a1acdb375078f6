// Rays through the structure that the device itself builds and searches (gpu/acceleration.rs).
// Rust twin: truth/surfaces.rs for the rule about which triangles a ray can meet.
enable wgpu_ray_query;
#define_import_path bindings::structure

#import bindings::rays::{FAR, RayHit, Start, ray_work}

@group(0) @binding(48) var scene_structure: acceleration_structure;

const EVERY_PLACEMENT: u32 = 0xffu;

// The nearest triangle a ray meets. The direction has unit length.
//
// Each triangle of an object that rays start on is a candidate, in any order and some perhaps twice;
// the search goes on behind those that are not confirmed. Other objects are opaque: met at once.
fn trace(origin: vec3<f32>, direction: vec3<f32>, start: Start) -> RayHit {
    ray_work.rays += 1u;
    var query: ray_query;
    let ray = RayDesc(RAY_FLAG_NONE, EVERY_PLACEMENT, 0.0, FAR, origin, direction);
    rayQueryInitialize(&query, scene_structure, ray);
    while rayQueryProceed(&query) {
        let candidate = rayQueryGetCandidateIntersection(&query);
        let own = candidate.instance_custom_data == start.object
            && (candidate.primitive_index == start.triangle
                || candidate.front_face != start.outside);
        if !own {
            rayQueryConfirmIntersection(&query);
        }
    }
    let hit = rayQueryGetCommittedIntersection(&query);
    if hit.kind != RAY_QUERY_INTERSECTION_TRIANGLE {
        return RayHit(FAR, 0u, 0u, vec2(0.0), false);
    }
    let object = hit.instance_custom_data;
    return RayHit(hit.t, object, hit.primitive_index, hit.barycentrics, hit.front_face);
}

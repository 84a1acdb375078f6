// Chains of mirrors and glass followed by rays (Whitted 1980): through one of the scene's trees,
// or by the device's own ray queries.
// Rust twin: truth/chain.rs, whose recursion is a stack of rays here.
#define_import_path bindings::whitted

#import bindings::departure::{depart, is_heaviest}
#import bindings::scene::{environment, materials, objects, shade}
#import bindings::rays::{FAR, Start, surface_point}
#ifdef RAY_QUERY
#import bindings::structure::trace
#else ifdef TREE_WIDE
#import bindings::wide_tree::trace
#else
#import bindings::tree::trace
#endif
#import bindings::view::MirrorPoint
#import common::record::{Chain, NO_OBJECT, STATUS_ENVIRONMENT, STATUS_FOUND, extended_trace, trace_of}

// Light that counts for less in the picture is not followed.
const FAINT: f32 = 1.0 / 4096.0;

// A ray still to be followed.
struct Ray {
    origin: vec3<f32>,
    direction: vec3<f32>,
    // What of its light reaches the first reflector's point.
    throughput: vec3<f32>,
    start: Start,
    // Bounces it may still make beyond where it starts.
    left: u32,
}

// Rays that wait: glass splits light in two at each of at most 16 bounces, a mirror does not.
#ifdef GLASS
const WAITING: u32 = 17u;
#else
const WAITING: u32 = 1u;
#endif

// The chain that leaves a reflector's point, over at most `bounces` reflectors, that one included.
// With glass on the way the radiance is the sum over all ways on, and the chain the heaviest.
fn traced_chain(at: MirrorPoint, bounces: u32) -> Chain {
    var chain: Chain;
    chain.lobe = at.lobe;
    chain.order = 1u;
    chain.trace = trace_of(objects[at.reflector].rank);
    let outside = at.front == (at.lobe == 0u);
    let start = Start(at.reflector, at.triangle, outside);
    var ray = Ray(at.position, at.outgoing, vec3(1.0), start, bounces - 1u);
    var on_chain = true;
    var path = 0.0;
    var waiting: array<Ray, WAITING>;
    var count = 0u;
    loop {
        let hit = trace(ray.origin, ray.direction, ray.start);
        if hit.distance == FAR {
            chain.radiance += ray.throughput * environment(ray.direction);
            if on_chain {
                chain.point = vec4(ray.direction, 0.0);
                // Infinitely far.
                chain.last = vec4(ray.origin, bitcast<f32>(0x7f800000u));
                chain.object = NO_OBJECT;
                chain.status = STATUS_ENVIRONMENT;
                on_chain = false;
            }
        } else {
            let met = surface_point(hit, ray.direction);
            let object = objects[met.object];
            let material = materials[object.material];
            chain.radiance += ray.throughput * shade(material, met.normal, met.uv);
            path += distance(ray.origin, met.position);
            var followed = false;
            var next: Ray;
            if ray.left > 0u {
                for (var lobe = 0u; lobe < 2u; lobe += 1u) {
                    let way = depart(material, lobe, ray.direction, met.normal, met.front);
                    if !way.exists {
                        continue;
                    }
                    let start_on = Start(met.object, met.triangle, met.front == (lobe == 0u));
                    let throughput = ray.throughput * way.weight;
                    let on = Ray(met.position, way.direction, throughput, start_on, ray.left - 1u);
                    if on_chain && is_heaviest(lobe, way.share) {
                        next = on;
                        followed = true;
                    } else if max(throughput.x, max(throughput.y, throughput.z)) >= FAINT {
                        waiting[count] = on;
                        count += 1u;
                    }
                }
            }
            if followed {
                chain.trace = extended_trace(chain.trace, chain.order, object.rank);
                chain.order += 1u;
                ray = next;
                continue;
            }
            if on_chain {
                chain.point = vec4(met.position, 1.0);
                chain.last = vec4(ray.origin, path);
                chain.object = met.object;
                chain.triangle = met.triangle;
                chain.status = STATUS_FOUND;
                on_chain = false;
            }
        }
        if count == 0u {
            return chain;
        }
        count -= 1u;
        ray = waiting[count];
    }
    return chain;
}

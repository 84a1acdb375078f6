enable primitive_index;
// The virtual objects of one reflector, drawn through its stencil; each fragment carries the scene
// point it shows (Estalella et al. 2006, section 3). Those of other forward methods, too.
#import bindings::record::{RecordTargets, record_targets}
#import bindings::scene::objects
#import bindings::surface::{Surface, surface_colour, surface_vertex}
#import common::record::found_chain
#import virtual_objects::corner::{Corner, HIDDEN, LOST, status_of}
#import virtual_objects::residual::{
    camera, displacement, reflector_id, reflector_normal, reflector_position
}
#ifdef REFRACTED
#import bindings::departure::LOBE_REFRACTED
#endif
#ifdef HIDDEN_CLIP
#import virtual_objects::drawn::drawn
#endif
#ifdef SECOND
#import virtual_objects::twice::{second_of, twice_at}
#endif

struct Reflected {
    // The reflector that shows them, and the one whose pixels they are drawn in: the same, or the one
    // that shows that reflector.
    reflector: u32,
    // Vertices of the scene.
    vertices: u32,
    // Pixels a fragment may be from where it belongs without a flag; 0: none are flagged.
    residual: f32,
    first: u32,
}
@group(0) @binding(0) var<uniform> reflected: Reflected;
@group(0) @binding(1) var<storage, read> corners: array<Corner>;
// The scene's triangle each triangle lies in, and where each object's begin.
@group(0) @binding(2) var<storage, read> source_triangles: array<u32>;
@group(0) @binding(3) var<storage, read> first_triangles: array<u32>;
#ifdef HIDDEN_CLIP
@group(0) @binding(4) var<storage, read> owners: array<u32>;
@group(0) @binding(5) var<storage, read> source_indices: array<u32>;
#endif

struct VirtualSurface {
    @builtin(position) clip: vec4<f32>,
    // Of the source: what is shown.
    @location(0) position: vec3<f32>,
    @location(1) normal: vec3<f32>,
    @location(2) uv: vec2<f32>,
    @location(3) @interpolate(flat) object: u32,
    // 1 where the vertex is hidden; far below 0 where it is lost.
    @location(4) hidden: f32,
}

#ifdef HIDDEN_CLIP
// A corner's own surface: a vertex, or what lies between its triangle's vertices.
fn corner_surface(corner: u32, source: u32, object: u32) -> Surface {
    if corner < reflected.vertices {
        return surface_vertex(corner, object);
    }
    let a = surface_vertex(source_indices[3u * source], object);
    let b = surface_vertex(source_indices[3u * source + 1u], object);
    let c = surface_vertex(source_indices[3u * source + 2u], object);
    var out = a;
    out.position = corners[corner].position;
    let one = b.position - a.position;
    let other = c.position - a.position;
    let across = cross(one, other);
    let within = out.position - a.position;
    let weights = vec2(dot(cross(within, other), across), dot(cross(one, within), across))
        / max(dot(across, across), 1e-30);
    out.normal += weights.x * (b.normal - a.normal) + weights.y * (c.normal - a.normal);
    out.uv += weights.x * (b.uv - a.uv) + weights.y * (c.uv - a.uv);
    return out;
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> VirtualSurface {
    let t = drawn.triangles[index / 3u];
    let object = owners[source_indices[3u * t.w]];
    let corner = t[index % 3u];
    let source = corner_surface(corner, t.w, object);
    let clip = camera.clip_from_world * vec4(corners[corner].image, 1.0);
    return VirtualSurface(clip, source.position, source.normal, source.uv, object, 0.0);
}
#else
@vertex
fn vertex(
    @builtin(vertex_index) index: u32,
    @builtin(instance_index) object: u32,
) -> VirtualSurface {
    let source = surface_vertex(index, object);
    let clip = camera.clip_from_world * vec4(corners[index].image, 1.0);
    let status = status_of(corners[index]);
    let hidden = select(select(0.0, 1.0, status == HIDDEN), -1e6, status == LOST);
    return VirtualSurface(clip, source.position, source.normal, source.uv, object, hidden);
}
#endif

// All three corners are hidden where the share of hidden corners is 1, but for rounding.
const ALL_HIDDEN: f32 = 0.9999;

@fragment
fn fragment(
    in: VirtualSurface,
    @builtin(primitive_index) primitive: u32,
    @builtin(front_facing) front: bool,
) -> RecordTargets {
    let pixel = vec2<u32>(in.clip.xy);
    // Two reflectors may share a stencil value; the id image decides.
    if textureLoad(reflector_id, pixel, 0).x != reflected.first {
        discard;
    }
#ifndef TWO_SIDED
    // A mirror turns the winding round, so what looks like a front is a back or was never mirrored.
#ifdef REFRACTED
    let is_back = !front;
#else
    let is_back = front;
#endif
    if is_back {
        discard;
    }
#endif
#ifndef DRAW_HIDDEN
    if in.hidden > ALL_HIDDEN {
        discard;
    }
#endif
    // What has a lost corner has no shape.
    if in.hidden < 0.0 {
        discard;
    }
#ifdef HIDDEN_DROPPED
    if in.hidden > 0.0 {
        discard;
    }
#endif
    var bounce = textureLoad(reflector_position, pixel, 0).xyz;
#ifdef HIDDEN_CUT
    // A mirror shows nothing that lies behind it.
    if dot(in.position - bounce, textureLoad(reflector_normal, pixel, 0).xyz) < 0.0 {
        discard;
    }
#endif
#ifdef SECOND
    let twice = twice_at(pixel, reflected.first, bounce);
    if !twice.is_shown || twice.second != reflected.reflector {
        discard;
    }
    bounce = twice.position;
#endif
    let source = Surface(in.clip, in.position, in.normal, in.uv, in.object);
    let colour = surface_colour(source, in.position - bounce);
    let rank = objects[reflected.reflector].rank;
#ifdef HIDDEN_CLIP
    let triangle = source_triangles[drawn.triangles[primitive].w];
#else
    let triangle = source_triangles[first_triangles[in.object] + primitive];
#endif
    var chain = found_chain(colour, in.position, bounce, in.object, triangle, rank);
    if reflected.residual > 0.0 {
        chain.flag = displacement(pixel, in.position) > reflected.residual;
    }
#ifdef REFRACTED
    chain.lobe = LOBE_REFRACTED;
#endif
#ifdef SECOND
    chain = second_of(chain, twice);
#endif
    return record_targets(chain);
}

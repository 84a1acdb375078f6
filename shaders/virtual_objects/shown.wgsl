enable primitive_index;
// The mirrors that one mirror shows: which, where and with which normal. For every pixel of the view, or
// one of them alone for every texel of the first mirror's textures.
//
// The first mirror's virtual objects say which triangle is seen; the ray mirrored at P1 meets it at P2, so
// what the two obey is the law of reflection, whatever error the virtual triangle is drawn with.
#import bindings::departure::{LOBE_REFLECTED, depart, is_heaviest}
#import bindings::scene::{
    materials, objects, shade, vertices, world_direction, world_position
}
#import common::camera::{Camera, arriving, facing, seen_normal}
#import virtual_objects::corner::Corner
#import virtual_objects::drawn::drawn

struct Shown {
    // The reflector it is seen in.
    first: u32,
    // The one reflector that textures show.
    second: u32,
    pad_a: u32,
    pad_b: u32,
}
@group(0) @binding(0) var<uniform> shown: Shown;
@group(0) @binding(1) var<storage, read> corners: array<Corner>;
@group(0) @binding(4) var<storage, read> owners: array<u32>;
@group(0) @binding(5) var<storage, read> source_indices: array<u32>;
@group(0) @binding(30) var<uniform> camera: Camera;
@group(0) @binding(36) var first_position: texture_2d<f32>;
@group(0) @binding(37) var first_normal: texture_2d<f32>;
#ifdef SHOWN_IN_VIEW
@group(0) @binding(31) var reflector_id: texture_2d<u32>;
#endif

struct Virtual {
    @builtin(position) clip: vec4<f32>,
    // Of the source.
    @location(0) position: vec3<f32>,
}

@vertex
fn vertex(@builtin(vertex_index) index: u32) -> Virtual {
    let corner = corners[drawn.triangles[index / 3u][index % 3u]];
    return Virtual(camera.clip_from_world * vec4(corner.image, 1.0), corner.position);
}

struct Mirror {
    // P2; the fourth is 0 where no mirror is shown, 1 in textures, and 1 + the object in the view.
    @location(0) position: vec4<f32>,
    // N2, on the side of P1.
    @location(1) normal: vec4<f32>,
#ifdef SHOWN_IN_VIEW
    // The light of the mirror's own surface.
    @location(2) light: vec4<f32>,
#endif
}

// A point of a triangle of the scene.
struct Met {
    position: vec3<f32>,
    normal: vec3<f32>,
    uv: vec2<f32>,
}

// Weights of corners may be beyond 0 and 1 by this much before the ray is taken to miss the triangle.
const BESIDE: f32 = 0.5;

// Where a ray meets a source triangle's plane, or the given point of it where it does so far away.
fn meeting(origin: vec3<f32>, direction: vec3<f32>, source: u32, object: u32, near: vec3<f32>) -> Met {
    let pose = objects[object];
    let a = vertices[source_indices[3u * source]];
    let b = vertices[source_indices[3u * source + 1u]];
    let c = vertices[source_indices[3u * source + 2u]];
    let corner = world_position(pose, a.position);
    let ab = world_position(pose, b.position) - corner;
    let ac = world_position(pose, c.position) - corner;
    let plane = cross(ab, ac);
    let along = dot(corner - origin, plane) / dot(direction, plane);
    var p = origin + along * direction;
    var second = dot(cross(p - corner, ac), plane) / dot(plane, plane);
    var third = dot(cross(ab, p - corner), plane) / dot(plane, plane);
    let least = min(min(second, third), 1.0 - second - third);
    if !(along > 0.0 && least > -BESIDE) {
        p = near;
        second = dot(cross(p - corner, ac), plane) / dot(plane, plane);
        third = dot(cross(ab, p - corner), plane) / dot(plane, plane);
    }
    let normal = a.normal + second * (b.normal - a.normal) + third * (c.normal - a.normal);
    let uv = vec2(a.u, a.v) + second * vec2(b.u - a.u, b.v - a.v) + third * vec2(c.u - a.u, c.v - a.v);
    return Met(p, world_direction(pose, normal), uv);
}

@fragment
fn fragment(in: Virtual, @builtin(primitive_index) primitive: u32) -> Mirror {
    let pixel = vec2<u32>(in.clip.xy);
    let source = drawn.triangles[primitive].w;
    let object = owners[source_indices[3u * source]];
    let first = textureLoad(first_position, pixel, 0);
#ifdef SHOWN_IN_VIEW
    if textureLoad(reflector_id, pixel, 0).x != shown.first {
        discard;
    }
#else
    if object != shown.second || first.w != 1.0 {
        discard;
    }
#endif
    let mirrored = reflect(arriving(camera, first.xyz), textureLoad(first_normal, pixel, 0).xyz);
    let met = meeting(first.xyz, mirrored, source, object, in.position);
    let incident = normalize(met.position - first.xyz);
#ifdef SHOWN_IN_VIEW
    let material = materials[objects[object].material];
    let n = facing(met.normal, incident);
    let way = depart(material, LOBE_REFLECTED, incident, n, true);
    if !way.exists || material.index > 0.0 || !is_heaviest(LOBE_REFLECTED, way.share) {
        // In front of mirrors, and no mirror.
        return Mirror(vec4(0.0), vec4(0.0), vec4(0.0));
    }
    let light = shade(material, n, met.uv);
    return Mirror(vec4(met.position, 1.0 + f32(object)), vec4(n, 0.0), vec4(light, 0.0));
#else
    return Mirror(vec4(met.position, 1.0), vec4(seen_normal(met.normal, incident), 0.0));
#endif
}

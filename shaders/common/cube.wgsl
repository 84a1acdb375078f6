// Cube maps by hand, after the Vulkan specification's "Cube Map Face Selection".
// Rust twin: geometry/cube.rs.
#define_import_path common::cube

struct CubeTexel {
    face: u32,
    // 0 to 1 over the face, row 0 on top.
    uv: vec2<f32>,
}

// Where a direction (any length but 0) meets the cube.
fn cube_texel(d: vec3<f32>) -> CubeTexel {
    let a = abs(d);
    var face = select(0u, 1u, d.x < 0.0);
    if a.z >= a.x && a.z >= a.y {
        face = select(4u, 5u, d.z < 0.0);
    } else if a.y >= a.x {
        face = select(2u, 3u, d.y < 0.0);
    }
    let on_face = cube_face_plane(face, d);
    return CubeTexel(face, 0.5 * (on_face.xy / on_face.z + 1.0));
}

// A direction in the axes of a face: right, down, outwards.
fn cube_face_plane(face: u32, d: vec3<f32>) -> vec3<f32> {
    switch face {
        case 0u: { return vec3(-d.z, -d.y, d.x); }
        case 1u: { return vec3(d.z, -d.y, -d.x); }
        case 2u: { return vec3(d.x, d.z, d.y); }
        case 3u: { return vec3(d.x, -d.z, -d.y); }
        case 4u: { return vec3(d.x, -d.y, d.z); }
        default: { return vec3(-d.x, -d.y, -d.z); }
    }
}

// The direction (not of unit length) of a position on a face.
fn cube_direction(face: u32, uv: vec2<f32>) -> vec3<f32> {
    let s = 2.0 * uv - 1.0;
    switch face {
        case 0u: { return vec3(1.0, -s.y, -s.x); }
        case 1u: { return vec3(-1.0, -s.y, s.x); }
        case 2u: { return vec3(s.x, 1.0, s.y); }
        case 3u: { return vec3(s.x, -1.0, -s.y); }
        case 4u: { return vec3(s.x, -s.y, 1.0); }
        default: { return vec3(-s.x, -s.y, -1.0); }
    }
}

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
    var face = 0u;
    var major = a.x;
    var s = vec2<f32>();
    if a.z >= a.x && a.z >= a.y {
        face = select(4u, 5u, d.z < 0.0);
        major = a.z;
        s = vec2(select(d.x, -d.x, d.z < 0.0), -d.y);
    } else if a.y >= a.x {
        face = select(2u, 3u, d.y < 0.0);
        major = a.y;
        s = vec2(d.x, select(d.z, -d.z, d.y < 0.0));
    } else {
        face = select(0u, 1u, d.x < 0.0);
        s = vec2(select(-d.z, d.z, d.x < 0.0), -d.y);
    }
    return CubeTexel(face, 0.5 * (s / major + 1.0));
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

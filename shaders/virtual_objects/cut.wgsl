// What is left of triangles with one or two hidden corners: cut along the border of what the reflector
// hides.
#import virtual_objects::corner::is_seen
#import virtual_objects::find::{border_between, border_corner}
#import virtual_objects::spans::{CUT_CORNERS, corners, cuts, draw}

// The border is sought from the one seen corner towards the edge of the hidden two, or from the edge of
// the seen two towards the hidden one.
@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= atomicLoad(&cuts.total) {
        return;
    }
    let first = cuts.triangles[id.x].place;
    let source = cuts.triangles[id.x].triangle.w;
    var t = cuts.triangles[id.x].triangle.xyz;
    let seen = vec3(is_seen(corners[t.x]), is_seen(corners[t.y]), is_seen(corners[t.z]));
    let is_one = u32(seen.x) + u32(seen.y) + u32(seen.z) == 1u;
    // Turned so that the first corner, the apex, is unlike the other two.
    if seen.y == is_one {
        t = t.yzx;
    } else if seen.z == is_one {
        t = t.zxy;
    }
    let at_apex = corners[t.x].position;
    let at_left = corners[t.y].position;
    let at_right = corners[t.z].position;
    for (var i = 0u; i < CUT_CORNERS; i += 1u) {
        let base = mix(at_left, at_right, f32(i) / f32(CUT_CORNERS - 1u));
        let outside = select(base, at_apex, is_one);
        let inside = select(at_apex, base, is_one);
        corners[first + i] = border_corner(mix(outside, inside, border_between(outside, inside)));
    }
    let half = CUT_CORNERS / 2u;
    for (var i = 0u; i + 1u < CUT_CORNERS; i += 1u) {
        if is_one {
            draw(vec3(t.x, first + i, first + i + 1u), source);
        } else {
            draw(vec3(select(t.y, t.z, i >= half), first + i + 1u, first + i), source);
        }
    }
    if !is_one {
        draw(vec3(t.y, t.z, first + half), source);
    }
}

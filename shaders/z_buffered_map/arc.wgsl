// The pixels of reflection plane and map, three ways: steps of t in equation (1), lines in the
// map's own pixels, and the paper's implementation, which begins with one and ends with the other.
#define_import_path z_buffered_map::arc

#import bindings::layers::{MapTexel, layered_map}
#import common::cube::cube_texel
#import common::reflection_plane::{direction_at, in_face, on_face}
#import common::texel_line::{TexelLine, line_between, next_bresenham, next_touched, touched_texels}
#import z_buffered_map::search::{Search, examine, texel_of}

fn next_texel(line: ptr<function, TexelLine>) -> bool {
#ifdef LINE_TOUCHED
    return next_touched(line);
#else
    return next_bresenham(line);
#endif
}

// Lines have ends in texels.
fn search_line(search: ptr<function, Search>, face: u32, start: vec2<f32>, end: vec2<f32>) {
    var line = line_between(start, end, layered_map.size);
    loop {
        examine(search, MapTexel(face, line.cell));
        if !next_texel(&line) {
            break;
        }
    }
}

// Section 3, "search in the P' space": steps of t alone. `reflector` is W in the unit that t is
// counted in.
fn search_vectors(search: ptr<function, Search>, reflector: vec3<f32>, steps: u32) {
    for (var i = 0u; i <= steps; i += 1u) {
        examine(search, texel_of(direction_at((*search).b, reflector, f32(i) / f32(steps))));
    }
}

// Section 3: "the intersections of the plane with the faces of the cube must be calculated, and a
// line drawing algorithm should be used to index the pixels".
fn search_image(search: ptr<function, Search>) {
    let size = f32(layered_map.size);
    for (var face = 0u; face < 6u; face += 1u) {
        let part = on_face(in_face(face, (*search).b), in_face(face, (*search).w));
        if part.exists {
            search_line(search, face, size * part.start, size * part.end);
        }
    }
}

// Section 5, figure 7: steps of t until the face of W is reached, and there a line.
fn search_hybrid(search: ptr<function, Search>, reflector: vec3<f32>, steps: u32) {
    let goal = cube_texel(reflector);
    // Fig. 7, line 1: Actual <- B (that is, t <- 0)
    var actual = cube_texel((*search).b);
    var i = 0u;
    // Fig. 7, line 2: While faces of the reflection map indexed by Actual and W are not the same do
    while actual.face != goal.face && i <= steps {
        // Fig. 7, line 3: Get pixel indexed by Actual.
        let last = vec2(i32(layered_map.size) - 1);
        let place = min(vec2<i32>(actual.uv * f32(layered_map.size)), last);
        examine(search, MapTexel(actual.face, place));
        // Fig. 7, line 6: Increment t and use Equation (1) to get new Actual.
        i += 1u;
        actual = cube_texel(direction_at((*search).b, reflector, f32(i) / f32(steps)));
    }
    // Fig. 7, line 7: both vectors index the same face, so
    // Fig. 7, line 8: Do the DDA traversal in that plane, between the pixels of Actual and W.
    let size = f32(layered_map.size);
    search_line(search, goal.face, size * actual.uv, size * goal.uv);
}

// How many texels of the map the arc touches.
fn arc_texels(b: vec3<f32>, w: vec3<f32>) -> u32 {
    var count = 0u;
    let size = f32(layered_map.size);
    for (var face = 0u; face < 6u; face += 1u) {
        let part = on_face(in_face(face, b), in_face(face, w));
        if part.exists {
            count += touched_texels(line_between(size * part.start, size * part.end, layered_map.size));
        }
    }
    return count;
}

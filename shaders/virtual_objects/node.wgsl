// A point of the reflected scene and everywhere the reflector shows it. Rust twin:
// methods/virtual_objects/roots.rs.
#define_import_path virtual_objects::node

const MOST_ROOTS: u32 = 8u;
// In place of a number of roots: not sought yet; and of the reflector itself, which it does not reflect.
const UNSOUGHT: u32 = 0xffffffffu;
const OWN: u32 = 0xfffffffeu;

struct Node {
    // World.
    position: vec3<f32>,
    // Of the roots that follow, or one of the above.
    number: u32,
    // Place in texels; the determinant of the law's slopes there as a share of the sum of their squares,
    // whose sign tells the branch; 0.
    roots: array<vec4<f32>, 8>,
    // Where the search goes on, as `Cursor` has it, the level from below; 1 in the fourth once it has ended.
    cursor: vec4<u32>,
}

// Whether two roots may be one.
fn is_same(a: vec4<f32>, b: vec4<f32>) -> bool {
    return a.z * b.z > 0.0 && distance(a.xy, b.xy) < 0.5;
}

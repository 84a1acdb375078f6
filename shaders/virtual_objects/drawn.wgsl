// The triangles halving left to draw, as those who draw them read the list that spans.wgsl writes.
#define_import_path virtual_objects::drawn

struct Drawn {
    arguments: vec4<u32>,
    made: vec4<u32>,
    // Three corners, and the scene's triangle they lie in.
    triangles: array<vec4<u32>>,
}
@group(0) @binding(6) var<storage, read> drawn: Drawn;

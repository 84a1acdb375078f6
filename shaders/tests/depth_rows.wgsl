// Looks for lines in a depth image, to test where they are found.
#import depth_impostors::rows::{ImageLine, march, search_rows, segment_reads, texel_reads}

// Two a line: where it starts and ends, in texels and height; the jump that is a silhouette in the first's w.
@group(0) @binding(10) var<storage, read> inputs: array<vec4<f32>>;
// One a line: the place; 1 for a hit, 2 for behind, 4 for a row, added up; what was read.
@group(0) @binding(11) var<storage, read_write> outputs: array<vec4<f32>>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let start = inputs[2u * id.x];
    let line = ImageLine(start.xyz, inputs[2u * id.x + 1u].xyz);
#ifdef MARCH
    let found = march(line, 0u, start.w);
#else
    let found = search_rows(line, 0u, start.w);
#endif
    let said = select(0.0, 1.0, found.hit) + select(0.0, 2.0, found.behind)
        + select(0.0, 4.0, found.row_exists);
    outputs[id.x] = vec4(found.place, said, f32(segment_reads + texel_reads));
}

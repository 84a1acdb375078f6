// Searches rays in a distance impostor, to test what they meet.
#import distance_impostor::search::search

// Two a ray: where it starts, from the map's centre; its unit direction.
@group(0) @binding(10) var<storage, read> inputs: array<vec4<f32>>;
// One a ray: the direction to look up; 1 in w where it is doubtful.
@group(0) @binding(11) var<storage, read_write> outputs: array<vec4<f32>>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let met = search(inputs[2u * id.x].xyz, inputs[2u * id.x + 1u].xyz);
    outputs[id.x] = vec4(met.direction, select(0.0, 1.0, met.doubtful));
}

// What a search of the map keeps while it examines texels: the best predictor of each layer
// (Patow 1995, figure 4 and the inner loop of figure 7).
#define_import_path z_buffered_map::search

#import bindings::layers::{MapTexel, layer_inverse_depth, layered_map, texel_direction}
#import common::cube::cube_texel
#import common::reflection_plane::{deviation, direction_at}

// Layers of the map.
#ifdef LAYERS
const LAYERS: u32 = #{LAYERS}u;
#else
const LAYERS: u32 = 1u;
#endif

struct Search {
    // Unit mirrored direction.
    b: vec3<f32>,
    // Reflector point, relative to the map's centre.
    w: vec3<f32>,
    // Deviation and texel of each layer's best predictor; 4 where it has none.
    best: array<f32, LAYERS>,
    texel: array<MapTexel, LAYERS>,
#ifdef RECORD_FULL
    // Texels examined, and how often the one examined just before again.
    examined: u32,
    repeated: u32,
    // Words read of the map.
    fetches: u32,
    last: MapTexel,
#endif
}

fn start_search(b: vec3<f32>, w: vec3<f32>) -> Search {
    var search: Search;
    search.b = b;
    search.w = w;
    for (var layer = 0u; layer < LAYERS; layer += 1u) {
        search.best[layer] = 4.0;
    }
#ifdef RECORD_FULL
    search.last.face = 6u;
#endif
    return search;
}

// The texel that a direction indexes.
fn texel_of(direction: vec3<f32>) -> MapTexel {
    let at = cube_texel(direction);
    let size = i32(layered_map.size);
    let place = vec2<i32>(at.uv * f32(size));
    return MapTexel(at.face, clamp(place, vec2(0), vec2(size - 1)));
}

fn examine(search: ptr<function, Search>, texel: MapTexel) {
#ifdef RECORD_FULL
    let last = (*search).last;
    let again = last.face == texel.face && all(last.place == texel.place);
    (*search).repeated += u32(again);
    (*search).examined += 1u;
    (*search).last = texel;
#endif
    // Fig. 4, line 7: Find P' from pixel position.
    let p = texel_direction(texel);
    // Fig. 7, line 4: For each entry in the current pixel depth list do
    for (var layer = 0u; layer < LAYERS; layer += 1u) {
        // Fig. 4, line 8: Get alpha' from the reflection map (and then calculate S').
        // S' = alpha' P' with alpha' = |P'| / inverse and P' of unit length.
        let inverse = layer_inverse_depth(texel, layer);
#ifdef RECORD_FULL
        (*search).fetches += 1u;
#endif
        if inverse == 0.0 {
            // The list ends.
            break;
        }
        // S' - W, times the texel's depth: that spares a division and changes no angle.
        let angle = deviation((*search).b, p - inverse * (*search).w);
        // Fig. 4, line 9: if pixel currently indexed has a smaller angle than previous ones
        // Fig. 7, line 5: Inspect depth and keep value if better than the respective previous one.
        if angle < (*search).best[layer] {
            // Fig. 4, line 11: keep new pixel.
            (*search).best[layer] = angle;
            (*search).texel[layer] = texel;
        }
    }
}

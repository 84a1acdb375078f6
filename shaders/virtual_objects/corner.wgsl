// A corner of the reflected scene: where it is, and where the reflector shows it. Rust twin:
// methods/virtual_objects/search.rs.
#define_import_path virtual_objects::corner

struct Corner {
    // World.
    position: vec3<f32>,
    pad: u32,
    // V', world.
    image: vec3<f32>,
    // The texel found, halves: x | y << 14 | status << 28 | branch << 30.
    found: u32,
}

// The reflector shows it at `image`.
const SHOWN: u32 = 0u;
// Behind the reflector: region C of Estalella et al. 2006, figure 4.
const HIDDEN: u32 = 1u;
// On the border of what is behind: it is its own image.
const BORDER: u32 = 2u;
// No reflection point was found.
const LOST: u32 = 3u;

fn packed_found(place: vec2<f32>, status: u32) -> u32 {
    let halves = vec2<u32>(clamp(2.0 * place, vec2(0.0), vec2(16383.0)));
    return halves.x | (halves.y << 14u) | (status << 28u);
}

fn place_of(corner: Corner) -> vec2<f32> {
    let halves = vec2(corner.found & 0x3fffu, (corner.found >> 14u) & 0x3fffu);
    return 0.5 * vec2<f32>(halves);
}

fn status_of(corner: Corner) -> u32 {
    return (corner.found >> 28u) & 3u;
}

// Whether it has an image.
fn is_seen(corner: Corner) -> bool {
    return status_of(corner) == SHOWN || status_of(corner) == BORDER;
}

// The branch of a corner that has several: whether the determinant of the law's slopes is above 0.
fn packed_turn(positive: bool) -> u32 {
    return select(0u, 1u << 30u, positive);
}

fn is_turned(corner: Corner) -> bool {
    return (corner.found & (1u << 30u)) != 0u;
}

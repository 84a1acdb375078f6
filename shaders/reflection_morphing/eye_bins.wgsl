// The rays that leave one reflector as the eye sees it, in bundles of four neighbours, and the cells that list
// the bundles which cross them: what ray octrees are to sampling locations (Martin & Popescu 2004, section 4),
// at the eye itself.
//
// Cells are those of cubes about the reflector, each of twice the size of the one within it and cut into as many
// cells: rays part as they go.
#define_import_path reflection_morphing::eye_bins

// One of a texel of the reflector's textures.
struct EyeRay {
    // Where it leaves the reflector, world.
    origin: vec3<f32>,
    // `RAY_NONE`, `RAY_LEAVES` or `RAY_PASSES`; and `TORN`.
    kind: u32,
    // Unit.
    direction: vec3<f32>,
    // To where it leaves the scene's box, metres.
    length: f32,
}

const RAY_NONE: u32 = 0u;
// Leaves the reflector.
const RAY_LEAVES: u32 = 1u;
// The eye's own ray, close by the rim of what it sees of a reflector that light grazes there.
const RAY_PASSES: u32 = 2u;
const KIND: u32 = 3u;
// Added where the reflector is not of one piece between this texel and the next ones, right and below.
const TORN: u32 = 4u;

struct Bins {
    // All that is reflected is in here, world.
    low: vec3<f32>,
    // Of the textures, texels a side.
    size: u32,
    high: vec3<f32>,
    // Of each cube, cells a side: a power of 2.
    side: u32,
    // Of all cubes, world.
    centre: vec3<f32>,
    // Half a side of the least.
    half: f32,
    levels: u32,
    // Entries that lists have room for.
    room: u32,
    reflector: u32,
    // Which way light leaves it.
    lobe: u32,
}
@group(0) @binding(40) var<storage, read> bins: Bins;

// Cells whose lists a workgroup adds up.
const BLOCK: u32 = 1024u;

struct Bundle {
    // Of four rays, row by row.
    origins: array<vec3<f32>, 4>,
    directions: array<vec3<f32>, 4>,
    // False where any lacks.
    is_whole: bool,
}

fn bundle_between(a: EyeRay, b: EyeRay, c: EyeRay, d: EyeRay) -> Bundle {
    let kinds = vec4(a.kind & KIND, b.kind & KIND, c.kind & KIND, d.kind & KIND);
    return Bundle(
        array(a.origin, b.origin, c.origin, d.origin),
        array(a.direction, b.direction, c.direction, d.direction),
        all(kinds != vec4(RAY_NONE)) && any(kinds == vec4(RAY_LEAVES)) && (a.kind & TORN) == 0u,
    );
}

// Bundles along a side of a sheaf; cells list sheaves.
const SHEAF: u32 = 4u;

// What all rays of a sheaf lie between, with the same length from the reflector: l metres from it those are
// in the box from `low` + l `low_slope` to `high` + l `high_slope`.
struct Sheaf {
    low: vec3<f32>,
    // 0 without any.
    rays: u32,
    high: vec3<f32>,
    // Of the longest, metres.
    length: f32,
    low_slope: vec3<f32>,
    pad_a: u32,
    high_slope: vec3<f32>,
    pad_b: u32,
}

// Along a side of the textures.
fn sheaves_a_side() -> u32 {
    return (bins.size - 1u + SHEAF - 1u) / SHEAF;
}

// The texel of a sheaf's first bundle.
fn corner_of(sheaf: u32) -> vec2<u32> {
    let side = sheaves_a_side();
    return SHEAF * vec2(sheaf % side, sheaf / side);
}

// The least cube that holds a point so far from the middle, along the axis along which that is farthest; the
// last one where none does.
fn level_of(away: f32) -> u32 {
    var level = 0u;
    var half = bins.half;
    while away > half && level + 1u < bins.levels {
        half *= 2.0;
        level += 1u;
    }
    return level;
}

fn half_of(level: u32) -> f32 {
    return bins.half * f32(1u << level);
}

fn cells_a_level() -> u32 {
    return bins.side * bins.side * bins.side;
}

// Along each axis, the cell of a level's cube that an offset from the middle is in, or is nearest to.
fn cell_at(offset: vec3<f32>, level: u32) -> vec3<i32> {
    let place = (0.5 * offset / half_of(level) + 0.5) * f32(bins.side);
    return vec3<i32>(clamp(floor(place), vec3(0.0), vec3(f32(bins.side) - 1.0)));
}

fn index_of(cell: vec3<i32>, level: u32) -> u32 {
    let c = vec3<u32>(cell);
    return ((level * bins.side + c.z) * bins.side + c.y) * bins.side + c.x;
}

fn farthest(offset: vec3<f32>) -> f32 {
    let away = abs(offset);
    return max(away.x, max(away.y, away.z));
}

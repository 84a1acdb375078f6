// What the passes that build rotated rows are told, and the heights they work on.
#define_import_path depth_impostors::build

// Not a uniform, as loops depend on it.
struct Build {
    // Texels along a side of the depth image: rows of a map and samples of a row. A multiple of 8.
    size: u32,
    // Maps in all, over a half turn.
    angles: u32,
    // Most a row is simplified to.
    segments: u32,
    // Which depth image.
    layer: u32,
    // Maps of this pass: the first, and how many.
    first_map: u32,
    maps: u32,
    // Heights: a row is simplified no further; neighbours farther apart have a silhouette between them.
    tolerance: f32,
    jump: f32,
}
@group(0) @binding(0) var<storage, read> build: Build;

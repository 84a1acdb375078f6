// One triangle over the whole image, for passes that draw every pixel.
#define_import_path common::cover

// Its corners for vertex indices 0 to 2, -1 to 1 within the image, y down.
fn cover(index: u32) -> vec2<f32> {
    return vec2(f32(index & 1u), f32(index >> 1u)) * 4.0 - 1.0;
}

// The texels of a line on a cube face, from its start to its end, in whole numbers: either all it
// touches (Amanatides & Woo 1987; Musgrave's "modified DDA" to Patow 1995, section 3) or those of
// Bresenham's line (1965) between the same ends. Rust twin: geometry/texel_line.rs.
#define_import_path common::texel_line

// A walk along a line; `cell` is the texel it is on.
struct TexelLine {
    cell: vec2<i32>,
    // Steps still to go on each axis, and their direction.
    left: vec2<i32>,
    step: vec2<i32>,
    // Touched: how far along the line the next border of each axis is, and how far borders are apart.
    border: vec2<f32>,
    apart: vec2<f32>,
    // Bresenham: the steps of each axis in all, and his error.
    total: vec2<i32>,
    error: i32,
}

// Ends in texels, within 0 to `size`.
fn line_between(start: vec2<f32>, end: vec2<f32>, size: u32) -> TexelLine {
    let last = vec2(i32(size) - 1);
    var line: TexelLine;
    line.cell = min(vec2<i32>(start), last);
    let steps = min(vec2<i32>(end), last) - line.cell;
    line.step = sign(steps);
    line.left = abs(steps);
    // Without length on an axis there are no steps on it, and neither number is asked for.
    let length = max(abs(end - start), vec2(1e-20));
    let cell = vec2<f32>(line.cell);
    let ahead = select(start - cell, cell + 1.0 - start, steps > vec2(0));
    line.border = ahead / length;
    line.apart = 1.0 / length;
    line.total = line.left;
    line.error = line.left.x - line.left.y;
    return line;
}

// To the next texel the line touches; false behind its last.
fn next_touched(line: ptr<function, TexelLine>) -> bool {
    let left = (*line).left;
    if left.x == 0 && left.y == 0 {
        return false;
    }
    // Counted steps, not positions, end the walk: rounding cannot lead it past the last texel.
    if left.y == 0 || (left.x > 0 && (*line).border.x < (*line).border.y) {
        (*line).cell.x += (*line).step.x;
        (*line).left.x -= 1;
        (*line).border.x += (*line).apart.x;
    } else {
        (*line).cell.y += (*line).step.y;
        (*line).left.y -= 1;
        (*line).border.y += (*line).apart.y;
    }
    return true;
}

// To the next texel of Bresenham's line; false behind its last.
fn next_bresenham(line: ptr<function, TexelLine>) -> bool {
    let left = (*line).left;
    if left.x == 0 && left.y == 0 {
        return false;
    }
    let total = (*line).total;
    let error = 2 * (*line).error;
    if error >= -total.y {
        (*line).error -= total.y;
        (*line).cell.x += (*line).step.x;
        (*line).left.x -= 1;
    }
    if error <= total.x {
        (*line).error += total.x;
        (*line).cell.y += (*line).step.y;
        (*line).left.y -= 1;
    }
    return true;
}

// How many texels the line touches.
fn touched_texels(line: TexelLine) -> u32 {
    return u32(line.left.x + line.left.y + 1);
}

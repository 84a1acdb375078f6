//! The texels of a line on a cube face, in whole numbers, from its start to its end.
//!
//! All it touches: J. Amanatides and A. Woo, "A fast voxel traversal algorithm for ray tracing",
//! Eurographics 1987, which is Musgrave's "modified DDA" to Patow 1995, section 3. Or those of the
//! line of J. E. Bresenham, "Algorithm for computer control of a digital plotter", 1965, between the
//! same ends. Shader twin: `shaders/common/texel_line.wgsl`.

use glam::{IVec2, Vec2};

/// Which texels stand for a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Texels {
    /// Every one it touches.
    Touched,
    /// One a step along the longer axis.
    Bresenham,
}

/// A walk along a line. As an iterator it gives each texel once, the first included.
#[derive(Clone, Copy, Debug)]
pub struct TexelLine {
    texels: Texels,
    /// The texel to give next, while there is one.
    cell: Option<IVec2>,
    left: IVec2,
    step: IVec2,
    border: Vec2,
    apart: Vec2,
    total: IVec2,
    error: i32,
}

impl TexelLine {
    /// From `start` to `end`, in texels, each within 0 to `size`.
    pub fn new(texels: Texels, start: Vec2, end: Vec2, size: u32) -> TexelLine {
        let last = IVec2::splat(size as i32 - 1);
        let cell = start.as_ivec2().min(last);
        let steps = end.as_ivec2().min(last) - cell;
        let length = (end - start).abs().max(Vec2::splat(1e-20));
        let from = start - cell.as_vec2();
        let ahead = Vec2::select(steps.cmpgt(IVec2::ZERO), 1.0 - from, from);
        TexelLine {
            texels,
            cell: Some(cell),
            left: steps.abs(),
            step: steps.signum(),
            border: ahead / length,
            apart: 1.0 / length,
            total: steps.abs(),
            error: steps.x.abs() - steps.y.abs(),
        }
    }

    /// How many texels the line touches.
    pub fn touched(&self) -> u32 {
        (self.total.x + self.total.y + 1) as u32
    }

    fn step_x(&mut self, cell: &mut IVec2) {
        cell.x += self.step.x;
        self.left.x -= 1;
        self.border.x += self.apart.x;
    }

    fn step_y(&mut self, cell: &mut IVec2) {
        cell.y += self.step.y;
        self.left.y -= 1;
        self.border.y += self.apart.y;
    }

    fn advance(&mut self, mut cell: IVec2) -> IVec2 {
        match self.texels {
            // Counted steps, not positions, end the walk: rounding cannot lead it past the last.
            Texels::Touched => {
                if self.left.y == 0 || (self.left.x > 0 && self.border.x < self.border.y) {
                    self.step_x(&mut cell);
                } else {
                    self.step_y(&mut cell);
                }
            }
            Texels::Bresenham => {
                let error = 2 * self.error;
                if error >= -self.total.y {
                    self.error -= self.total.y;
                    self.step_x(&mut cell);
                }
                if error <= self.total.x {
                    self.error += self.total.x;
                    self.step_y(&mut cell);
                }
            }
        }
        cell
    }
}

impl Iterator for TexelLine {
    type Item = IVec2;

    fn next(&mut self) -> Option<IVec2> {
        let cell = self.cell?;
        let more = self.left != IVec2::ZERO;
        self.cell = more.then(|| self.advance(cell));
        Some(cell)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const SIZE: u32 = 40;

    fn point() -> impl Strategy<Value = Vec2> {
        let whole = (0u32..=SIZE, 0u32..=SIZE).prop_map(|(x, y)| Vec2::new(x as f32, y as f32));
        let any = (0.0..SIZE as f32, 0.0..SIZE as f32).prop_map(|(x, y)| Vec2::new(x, y));
        prop_oneof![3 => any, 1 => whole]
    }

    proptest! {
        #[test]
        fn every_texel_the_line_crosses_is_touched_once(start in point(), end in point()) {
            let line = TexelLine::new(Texels::Touched, start, end, SIZE);
            let cells: Vec<_> = line.collect();
            prop_assert_eq!(cells.len() as u32, line.touched());
            for pair in cells.windows(2) {
                let step = (pair[1] - pair[0]).abs();
                prop_assert_eq!(step.x + step.y, 1, "{:?}", pair);
            }
            for i in 0..=1000 {
                let at = start.lerp(end, i as f32 / 1000.0);
                let inside = (at - at.floor() - 0.5).abs().max_element() < 0.499;
                let cell = at.as_ivec2();
                prop_assert!(!inside || cells.contains(&cell), "{} is left out", cell);
            }
        }

        #[test]
        fn bresenham_joins_the_same_ends_with_one_texel_a_step(start in point(), end in point()) {
            let line = |texels| TexelLine::new(texels, start, end, SIZE).collect::<Vec<_>>();
            let (cells, touched) = (line(Texels::Bresenham), line(Texels::Touched));
            prop_assert_eq!((cells.first(), cells.last()), (touched.first(), touched.last()));
            let (first, last) = (cells[0], cells[cells.len() - 1]);
            let steps = (last - first).abs().max_element();
            prop_assert_eq!(cells.len() as i32, steps + 1);
            let along = (last - first).as_vec2().normalize_or_zero();
            for cell in cells {
                let off = (cell - first).as_vec2().perp_dot(along).abs();
                prop_assert!(off <= 0.5 + 1e-4, "{} is {} off", cell, off);
            }
        }
    }
}

//! A row of heights as a few segments.

use super::{Limits, MOST_SEGMENTS, Packed, Segment};

/// Some neighbouring samples that one segment stands for.
#[derive(Clone, Copy, Default)]
struct Piece {
    first: u32,
    last: u32,
    /// The largest error of its segment in 65535ths, 0 once that is within the tolerance; and where.
    error: u32,
    worst: u32,
    is_new: bool,
}

/// The pieces of a row from left to right.
struct Pieces {
    list: [Piece; MOST_SEGMENTS as usize],
    count: usize,
}

/// Simplify a row into `segments`, at most as many as that has; how many they are.
///
/// Silhouettes first: each run of samples of one surface is a piece (once there are as many as may be, the
/// last runs on over what is left). Then, again and again, the pieces that err at least half as much as the
/// worst are split where they err most.
pub fn simplify(samples: &[f32], limits: Limits, segments: &mut [Packed]) -> u32 {
    let most = segments.len().min(MOST_SEGMENTS as usize);
    let mut pieces = runs(samples, limits.jump, most);
    while pieces.count > 0 && pieces.count < most {
        for piece in &mut pieces.list[..pieces.count] {
            if piece.is_new {
                measure(piece, samples, limits.tolerance);
            }
        }
        let errors = pieces.list[..pieces.count].iter().map(|piece| piece.error);
        let largest = errors.max().unwrap_or(0);
        if largest == 0 {
            break;
        }
        pieces.split(largest, most);
    }
    for (i, segment) in segments[..pieces.count].iter_mut().enumerate() {
        *segment = pieces.segment(i, samples).packed(samples.len() as u32);
    }
    pieces.count as u32
}

/// Stretches of samples without a silhouette between them.
fn runs(samples: &[f32], jump: f32, most: usize) -> Pieces {
    let mut pieces = Pieces { list: [Piece::default(); MOST_SEGMENTS as usize], count: 0 };
    let mut before = 0.0;
    for (i, &height) in (0..).zip(samples) {
        if height > 0.0 {
            let parted = before == 0.0 || (height - before).abs() > jump;
            if pieces.count == 0 || parted && pieces.count < most {
                pieces.list[pieces.count] = Piece { first: i, is_new: true, ..Piece::default() };
                pieces.count += 1;
            }
            pieces.list[pieces.count - 1].last = i;
        }
        before = height;
    }
    pieces
}

fn measure(piece: &mut Piece, samples: &[f32], tolerance: f32) {
    let (first, last) = (piece.first, piece.last);
    let start = samples[first as usize];
    let slope = (samples[last as usize] - start) / (last - first).max(1) as f32;
    let (mut largest, mut worst) = (tolerance, first);
    for i in first + 1..last {
        let error = (samples[i as usize] - (start + slope * (i - first) as f32)).abs();
        if error > largest {
            (largest, worst) = (error, i);
        }
    }
    piece.error = if worst == first { 0 } else { (65535.0 * largest).max(1.0) as u32 };
    (piece.worst, piece.is_new) = (worst, false);
}

impl Pieces {
    /// Split the pieces that err at least half as much as the worst, from the left on while there is room.
    fn split(&mut self, largest: u32, most: usize) {
        let errs = |piece: &Piece| 2 * piece.error >= largest;
        let erring = self.list[..self.count].iter().filter(|&piece| errs(piece)).count();
        let splits = erring.min(most - self.count);
        let mut spared = erring - splits;
        // From the right, so that each piece goes to its place at once.
        let mut to = self.count + splits;
        for from in (0..self.count).rev() {
            let piece = self.list[from];
            if errs(&piece) && spared == 0 {
                to -= 2;
                let part = |first, last| Piece { first, last, is_new: true, ..Piece::default() };
                self.list[to] = part(piece.first, piece.worst);
                self.list[to + 1] = part(piece.worst, piece.last);
            } else {
                spared -= usize::from(errs(&piece));
                to -= 1;
                self.list[to] = piece;
            }
        }
        self.count += splits;
    }

    fn segment(&self, i: usize, samples: &[f32]) -> Segment {
        let piece = self.list[i];
        let joined = |j: usize, sample: u32, of: fn(&Piece) -> u32| {
            j < self.count && of(&self.list[j]) == sample
        };
        let before = joined(i.wrapping_sub(1), piece.first, |p| p.last);
        let after = joined(i + 1, piece.last, |p| p.first);
        Segment::over([piece.first, piece.last], [before, after], samples)
    }
}

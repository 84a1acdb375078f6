//! A row as a few segments in one sweep over its samples: what the device builds (Popescu et al. 2006, slide 50,
//! future work). Shader twin: `shaders/depth_impostors/simplify.wgsl`.

use super::{Limits, MOST_SEGMENTS, Packed, Segment};

/// How much more a row may err when it has too many pieces, at least.
const MORE: f32 = 1.3;
/// And of what would do if a piece's error went with the square of its length.
const SHARE: f32 = 0.5;

/// Samples that one segment stands for, both its ends among them.
#[derive(Clone, Copy)]
struct Piece {
    first: u32,
    last: u32,
}

/// A piece being made: the slopes that keep its segment within the tolerance of all that it passes.
struct Open {
    piece: Piece,
    start: f32,
    low: f32,
    high: f32,
}

impl Open {
    fn at(first: u32, samples: &[f32]) -> Open {
        let piece = Piece { first, last: first };
        Open { piece, start: samples[first as usize], low: f32::NEG_INFINITY, high: f32::INFINITY }
    }

    /// Go on to a sample, if that leaves all before it within the tolerance.
    fn takes(&mut self, sample: u32, samples: &[f32], tolerance: f32) -> bool {
        let run = (sample - self.piece.first) as f32;
        let rise = samples[sample as usize] - self.start;
        if run * self.low > rise || rise > run * self.high {
            return false;
        }
        self.low = self.low.max((rise - tolerance) / run);
        self.high = self.high.min((rise + tolerance) / run);
        self.piece.last = sample;
        true
    }
}

/// Simplify a row into `segments`, at most as many as that has; how many they are. `simplify` splits the row; this
/// joins its samples, which takes the same time whatever the number of segments.
///
/// From left to right, each piece is as long as its segment stays within the tolerance of the samples; it ends at
/// silhouettes. While there are too many, pieces are joined likewise, with a larger tolerance. (Once silhouettes
/// alone are too many, the last piece runs on over what is left.)
pub fn sweep(samples: &[f32], limits: Limits, segments: &mut [Packed]) -> u32 {
    let most = segments.len().min(MOST_SEGMENTS as usize);
    let (mut pieces, runs) = first_pieces(samples, limits);
    let mut tolerance = limits.tolerance;
    while pieces.len() > most.max(runs) {
        let times = pieces.len() as f32 / most as f32;
        tolerance *= (SHARE * times * times).max(MORE);
        join(&mut pieces, samples, tolerance);
    }
    if pieces.len() > most {
        pieces[most - 1].last = pieces[pieces.len() - 1].last;
        pieces.truncate(most);
    }
    for (i, segment) in segments[..pieces.len()].iter_mut().enumerate() {
        let Piece { first, last } = pieces[i];
        let before = i.checked_sub(1).is_some_and(|i| pieces[i].last == first);
        let after = pieces.get(i + 1).is_some_and(|piece| piece.first == last);
        *segment =
            Segment::over([first, last], [before, after], samples).packed(samples.len() as u32);
    }
    pieces.len() as u32
}

/// The longest pieces within the tolerance, and how many stretches without a silhouette they make up.
fn first_pieces(samples: &[f32], limits: Limits) -> (Vec<Piece>, usize) {
    let (mut pieces, mut runs) = (Vec::new(), 0);
    let mut open: Option<Open> = None;
    let mut before = 0.0;
    for (i, &height) in (0..).zip(samples) {
        let parted = before == 0.0 || (height - before).abs() > limits.jump;
        if height == 0.0 || parted {
            pieces.extend(open.take().map(|open| open.piece));
            if height > 0.0 {
                open = Some(Open::at(i, samples));
                runs += 1;
            }
        } else if let Some(piece) = &mut open
            && !piece.takes(i, samples, limits.tolerance)
        {
            pieces.push(piece.piece);
            *piece = Open::at(i - 1, samples);
            piece.takes(i, samples, limits.tolerance);
        }
        before = height;
    }
    pieces.extend(open.map(|open| open.piece));
    (pieces, runs)
}

/// Join neighbouring pieces, where the ends between them are within the tolerance of what joins them.
fn join(pieces: &mut Vec<Piece>, samples: &[f32], tolerance: f32) {
    let mut joined: Vec<Piece> = Vec::new();
    let mut open: Option<Open> = None;
    for &Piece { first, last } in pieces.iter() {
        let goes_on = open
            .as_mut()
            .is_some_and(|open| open.piece.last == first && open.takes(last, samples, tolerance));
        if !goes_on {
            joined.extend(open.take().map(|open| open.piece));
            let mut piece = Open::at(first, samples);
            if last > first {
                piece.takes(last, samples, tolerance);
            }
            open = Some(piece);
        }
    }
    joined.extend(open.map(|open| open.piece));
    *pieces = joined;
}

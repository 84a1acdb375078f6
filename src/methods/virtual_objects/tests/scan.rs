//! All reflection points by a dense scan: every patch between four texel centres is tried, in double
//! precision, without the pyramid. It shares with the search what a patch is, and nothing else.

use glam::{DVec2, DVec3, IVec2, Vec4};

/// N . H of a reflection point, in texels of the law's slopes, is above this: behind the reflector on the eye
/// ray to a point H is 0, which fulfils the law and is no reflection.
const GRAZING: f64 = 0.05;

/// Points and normals of a reflector's textures.
pub struct Scan {
    size: IVec2,
    eye: DVec3,
    /// World; whether the reflector is there.
    points: Vec<(DVec3, bool)>,
    normals: Vec<DVec3>,
    pieces: Vec<Piece>,
}

/// A patch as far as it goes: from a texel's centre, and a texel beyond sides without a neighbour.
struct Piece {
    corner: IVec2,
    low: DVec2,
    high: DVec2,
    /// Points and normals at its four ends.
    ends: [(DVec3, DVec3); 4],
}

/// A reflection point.
#[derive(Clone, Copy, Debug)]
pub struct Root {
    /// Texels.
    pub place: DVec2,
    /// The determinant of the law's slopes as a share of the sum of their squares.
    pub fold: f64,
}

/// N x H, how it changes by a texel, and N . H.
struct Law {
    left: DVec3,
    x: DVec3,
    y: DVec3,
    towards: f64,
    normal: DVec3,
}

impl Law {
    fn fold(&self) -> f64 {
        let scale = self.x.length_squared() + self.y.length_squared();
        self.x.cross(self.y).dot(self.normal) / scale.max(1e-30)
    }
}

impl Scan {
    pub fn new(size: [u32; 2], eye: DVec3, points: &[Vec4], normals: &[Vec4]) -> Scan {
        let mut scan = Scan {
            size: IVec2::from(size.map(|n| n as i32)),
            eye,
            points: points.iter().map(|p| (p.truncate().as_dvec3(), p.w == 1.0)).collect(),
            normals: normals.iter().map(|n| n.truncate().as_dvec3()).collect(),
            pieces: Vec::new(),
        };
        let corners =
            (0..scan.size.y).flat_map(|y| (0..scan.size.x).map(move |x| IVec2::new(x, y)));
        let pieces = corners.filter(|&c| scan.is_piece(c)).map(|c| scan.piece(c)).collect();
        scan.pieces = pieces;
        scan
    }

    /// Patches that show the reflector.
    pub fn patches(&self) -> usize {
        self.pieces.len()
    }

    fn index(&self, texel: IVec2) -> usize {
        (texel.y * self.size.x + texel.x) as usize
    }

    /// Whether four texels are one part of the reflector, with neither leap nor crease between them.
    fn is_piece(&self, corner: IVec2) -> bool {
        let inside = corner.cmpge(IVec2::ZERO).all() && (corner + 1).cmplt(self.size).all();
        let joined = |a: IVec2, b: IVec2| {
            let [(p_a, shown_a), (p_b, shown_b)] = [a, b].map(|t| self.points[self.index(t)]);
            let [n_a, n_b] = [a, b].map(|t| self.normals[self.index(t)]);
            let edge = p_b - p_a;
            let leap = (n_a + n_b).dot(edge).abs();
            shown_a && shown_b && leap <= 0.2 * edge.length() && n_a.dot(n_b) > 0.5
        };
        let [x, y] = [corner + IVec2::X, corner + IVec2::Y];
        let over = corner + 1;
        inside && joined(corner, x) && joined(corner, y) && joined(x, over) && joined(y, over)
    }

    fn piece(&self, corner: IVec2) -> Piece {
        let beyond = |side: IVec2| if self.is_piece(corner + side) { 0.0 } else { 1.0 };
        let low = -DVec2::new(beyond(-IVec2::X), beyond(-IVec2::Y));
        let high = 1.0 + DVec2::new(beyond(IVec2::X), beyond(IVec2::Y));
        let ends = [low, DVec2::new(high.x, low.y), DVec2::new(low.x, high.y), high];
        let end = |f: DVec2| {
            let [p, n] = self.surface(corner, f).map(|s| s[0]);
            (p, n.normalize())
        };
        Piece { corner, low, high, ends: ends.map(end) }
    }

    /// Point and normal, the latter of any length, and how they change by a texel.
    fn surface(&self, corner: IVec2, f: DVec2) -> [[DVec3; 3]; 2] {
        let texels =
            [corner, corner + IVec2::X, corner + IVec2::Y, corner + 1].map(|t| self.index(t));
        let bilinear = |[a, b, c, d]: [DVec3; 4]| {
            let (x, y) = ((b - a).lerp(d - c, f.y), (c - a).lerp(d - b, f.x));
            [a.lerp(c, f.y) + f.x * x, x, y]
        };
        [bilinear(texels.map(|t| self.points[t].0)), bilinear(texels.map(|t| self.normals[t]))]
    }

    fn law(&self, piece: &Piece, f: DVec2, v: DVec3) -> Law {
        let [[p, p_x, p_y], [n, n_x, n_y]] = self.surface(piece.corner, f);
        // Of the unit normal: n has not quite that length.
        let unit = n.normalize();
        let [n_x, n_y] = [n_x, n_y].map(|s| (s - unit * unit.dot(s)) / n.length());
        let turn = |to: DVec3, slope: DVec3| {
            let (away, unit) = (to.length(), to.normalize());
            (unit * unit.dot(slope) - slope) / away
        };
        let [to_eye, to_v] = [self.eye - p, v - p];
        let h = to_eye.normalize() + to_v.normalize();
        let [h_x, h_y] = [p_x, p_y].map(|slope| turn(to_eye, slope) + turn(to_v, slope));
        Law {
            left: unit.cross(h),
            x: n_x.cross(h) + unit.cross(h_x),
            y: n_y.cross(h) + unit.cross(h_y),
            towards: unit.dot(h),
            normal: unit,
        }
    }

    /// Whether the law's left side may vanish in a patch: none of its parts keeps away from 0 at all four
    /// ends by more than twice what it changes between them.
    fn may_hold(&self, piece: &Piece, v: DVec3) -> bool {
        let mut low = DVec3::INFINITY;
        let mut high = DVec3::NEG_INFINITY;
        let mut towards = f64::NEG_INFINITY;
        for (p, n) in piece.ends {
            let h = (self.eye - p).normalize() + (v - p).normalize();
            let left = n.cross(h);
            low = low.min(left);
            high = high.max(left);
            towards = towards.max(n.dot(h));
        }
        let margin = 2.0 * (high - low) + 1e-9;
        towards > 0.0
            && (low - margin).cmple(DVec3::ZERO).all()
            && (high + margin).cmpge(DVec3::ZERO).all()
    }

    /// Newton's steps in a patch; `None` where they leave it by more than `margin` texels or end nowhere.
    fn root(&self, piece: &Piece, begin: DVec2, v: DVec3, margin: f64) -> Option<Root> {
        let mut f = begin;
        for _ in 0..60 {
            let law = self.law(piece, f, v);
            let (a, b, c) = (law.x.length_squared(), law.x.dot(law.y), law.y.length_squared());
            let damping = 1e-12 * (a + c);
            let g = DVec2::new(law.x.dot(law.left), law.y.dot(law.left));
            let determinant = (a + damping) * (c + damping) - b * b;
            let step = DVec2::new(b * g.y - (c + damping) * g.x, b * g.x - (a + damping) * g.y)
                / determinant;
            f += step * (0.7 / step.length()).min(1.0);
            if (f - piece.low).min_element() < -2.0 || (piece.high - f).min_element() < -2.0 {
                return None;
            }
            if step.length() < 1e-10 {
                let law = self.law(piece, f, v);
                let slopes = (law.x.length_squared() + law.y.length_squared()).sqrt();
                let holds = law.left.length() < 1e-9 && law.towards > GRAZING * slopes;
                let inside = (f - piece.low).min_element() >= -margin
                    && (piece.high - f).min_element() >= -margin;
                let place = piece.corner.as_dvec2() + 0.5 + f;
                return (holds && inside).then(|| Root { place, fold: law.fold() });
            }
        }
        None
    }

    /// All roots of a vertex, and others up to `margin` texels beside the patch they belong to.
    pub fn roots(&self, v: DVec3, margin: f64) -> Vec<Root> {
        let mut roots: Vec<Root> = Vec::new();
        for piece in self.pieces.iter().filter(|piece| self.may_hold(piece, v)) {
            for start in 0..9 {
                let share = DVec2::new(f64::from(start % 3), f64::from(start / 3)) * 0.45 + 0.05;
                let begin = piece.low + share * (piece.high - piece.low);
                let Some(root) = self.root(piece, begin, v, margin) else { continue };
                if roots.iter().all(|r| r.place.distance(root.place) > 1e-6) {
                    roots.push(root);
                }
            }
        }
        roots
    }
}

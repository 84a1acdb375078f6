//! A sine that travels over a mesh: every vertex goes out and in along the surface's normal.

use std::collections::HashMap;
use std::f32::consts::TAU;

use glam::Vec3;

use super::Mesh;

/// The height of a wave over a surface at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wave {
    /// Metres.
    pub amplitude: f32,
    /// Metres from crest to crest.
    pub wavelength: f32,
    /// The way the crests travel; unit length.
    pub towards: Vec3,
}

impl Wave {
    /// Metres along the normal over a point at rest, `turns` periods after the start.
    pub fn height(&self, point: Vec3, turns: f32) -> f32 {
        self.amplitude * self.phase(point, turns).sin()
    }

    /// How the height changes with the point.
    pub fn gradient(&self, point: Vec3, turns: f32) -> Vec3 {
        self.amplitude * TAU / self.wavelength * self.phase(point, turns).cos() * self.towards
    }

    fn phase(&self, point: Vec3, turns: f32) -> f32 {
        TAU * (point.dot(self.towards) / self.wavelength - turns)
    }
}

/// How a mesh can be displaced: which way each vertex goes, and how that way turns over the surface.
#[derive(Clone, Debug)]
pub struct Relief {
    /// Unit vectors, equal where positions are, so that nothing tears at a seam or a crease.
    ways: Vec<Vec3>,
    /// By vertex, what the way gains on each metre along the two tangents of its normal.
    bends: Vec<[Vec3; 2]>,
}

/// Two vertices at one place belong to the same smooth surface when the cosine of the angle between
/// their normals is above this.
const SMOOTH: f32 = 0.999;

/// The bits of a position.
type Place = [u32; 3];

/// From a vertex to another of the same triangle.
struct Edge {
    /// Of the surface at the vertex.
    normal: Vec3,
    along: Vec3,
    /// What the way gains.
    turn: Vec3,
}

impl Relief {
    /// The way is the normal; at a crease the mean of those that meet there. How it turns is fitted to
    /// the edges around a vertex: exactly so on spheres, cylinders and planes, elsewhere up to
    /// the square of an edge where the edges around are even.
    pub fn new(mesh: &Mesh) -> Relief {
        let mut sums: HashMap<Place, Vec3> = HashMap::new();
        for (vertex, &normal) in (0..).zip(&mesh.normals) {
            *sums.entry(mesh.place(vertex)).or_default() += normal;
        }
        let way = |(vertex, &normal): (u32, &Vec3)| {
            sums[&mesh.place(vertex)].try_normalize().unwrap_or(normal)
        };
        let ways: Vec<Vec3> = (0..).zip(&mesh.normals).map(way).collect();
        let edges = edges(mesh, &ways);
        let bends = (0..mesh.normals.len() as u32).map(|vertex| {
            let around = edges.get(&mesh.place(vertex)).map_or(&[][..], Vec::as_slice);
            bend(mesh.normals[vertex as usize], ways[vertex as usize], around)
        });
        Relief { bends: bends.collect(), ways }
    }

    /// The mesh under a wave, `turns` periods after its start. The normals are those of the displaced
    /// surface: with P = p + h m and tangents t of the surface at rest, dP/dt = t + (dh/dt) m + h dm/dt,
    /// and the normal is the product of two of these.
    pub fn displaced(&self, mesh: &Mesh, wave: &Wave, turns: f32) -> Mesh {
        let mut displaced = mesh.clone();
        let vertices = displaced.positions.iter_mut().zip(&mut displaced.normals);
        for ((position, normal), (way, bend)) in vertices.zip(self.ways.iter().zip(&self.bends)) {
            let (height, gradient) =
                (wave.height(*position, turns), wave.gradient(*position, turns));
            let (first, second) = normal.any_orthonormal_pair();
            let moved = |t: Vec3, bend: Vec3| t + gradient.dot(t) * *way + height * bend;
            let across = moved(first, bend[0]).cross(moved(second, bend[1]));
            *normal = across.try_normalize().unwrap_or(*normal);
            *position += height * *way;
        }
        displaced
    }
}

/// All edges by the place they leave from.
fn edges(mesh: &Mesh, ways: &[Vec3]) -> HashMap<Place, Vec<Edge>> {
    let mut edges: HashMap<Place, Vec<Edge>> = HashMap::new();
    for triangle in &mesh.triangles {
        for k in 0..3 {
            let [from, next, last] = [0, 1, 2].map(|step| triangle[(k + step) % 3]);
            let leaving = edges.entry(mesh.place(from)).or_default();
            leaving.extend([next, last].map(|to| {
                let (from, to) = (from as usize, to as usize);
                Edge {
                    normal: mesh.normals[from],
                    along: mesh.positions[to] - mesh.positions[from],
                    turn: ways[to] - ways[from],
                }
            }));
        }
    }
    edges
}

/// What the way gains along the tangents of `normal`, in the least squares of the edges around, the
/// short ones counting most. Nothing where all edges run one way.
fn bend(normal: Vec3, way: Vec3, around: &[Edge]) -> [Vec3; 2] {
    let (first, second) = normal.any_orthonormal_pair();
    let (mut aa, mut ab, mut bb) = (0.0, 0.0, 0.0);
    let [mut a_turn, mut b_turn] = [Vec3::ZERO; 2];
    for edge in around.iter().filter(|edge| edge.normal.dot(normal) > SMOOTH) {
        let weight = edge.along.length_squared().recip();
        let [a, b] = [edge.along.dot(first), edge.along.dot(second)];
        aa += weight * a * a;
        ab += weight * a * b;
        bb += weight * b * b;
        a_turn += weight * a * edge.turn;
        b_turn += weight * b * edge.turn;
    }
    let determinant = aa * bb - ab * ab;
    if determinant <= 1e-4 * (aa + bb) * (aa + bb) {
        return [Vec3::ZERO; 2];
    }
    // A unit vector turns across itself only; what is left along it is the chord of its arc.
    let bends = [bb * a_turn - ab * b_turn, aa * b_turn - ab * a_turn];
    bends.map(|bend| (bend / determinant).reject_from_normalized(way))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::shapes::{Sweep, cuboid, cylinder, sphere, torus};

    const WAVE: Wave = Wave { amplitude: 0.1, wavelength: 0.7, towards: Vec3::Y };

    #[test]
    fn a_wave_travels_by_its_length_each_period() {
        let wave = Wave { towards: Vec3::new(0.6, 0.0, 0.8), ..WAVE };
        let point = Vec3::new(0.3, -2.0, 0.4);
        for turns in [0.0, 0.3, 0.9] {
            let later = point + wave.wavelength * 0.25 * wave.towards;
            let [here, there] = [wave.height(point, turns), wave.height(later, turns + 0.25)];
            assert!((here - there).abs() < 1e-6);
            let step = 1e-3;
            for axis in Vec3::AXES {
                let [low, high] = [-step, step].map(|s| wave.height(point + s * axis, turns));
                let slope = (high - low) / (2.0 * step);
                assert!((wave.gradient(point, turns).dot(axis) - slope).abs() < 1e-3);
            }
        }
        assert_eq!(wave.height(wave.wavelength * 0.25 * wave.towards, 0.0), 0.1);
    }

    /// The normal of a displaced parametric surface, by central differences in double precision.
    fn normal_of(surface: impl Fn(f64, f64) -> glam::DVec3, u: f64, v: f64) -> Vec3 {
        let step = 1e-5;
        let du = surface(u + step, v) - surface(u - step, v);
        let dv = surface(u, v + step) - surface(u, v - step);
        du.cross(dv).normalize().as_vec3()
    }

    #[test]
    fn a_sphere_under_a_wave_is_the_closed_form() {
        let (radius, turns) = (1.3, 0.2);
        let rest = sphere(radius, 48, 24);
        let waving = Relief::new(&rest).displaced(&rest, &WAVE, turns);
        for ((p, n), (q, m)) in rest
            .positions
            .iter()
            .zip(&rest.normals)
            .zip(waving.positions.iter().zip(&waving.normals))
        {
            let height = 0.1 * (TAU * (p.y / 0.7 - turns)).sin();
            assert!(q.abs_diff_eq((radius + height) * *n, 1e-5), "{q}");
            // For r(y) about the centre: tangential gradient over (1 + h / r).
            let slope = 0.1 * TAU / 0.7 * (TAU * (p.y / 0.7 - turns)).cos();
            let gradient = slope * (Vec3::Y - n.y * *n);
            let expected = (*n - gradient / (1.0 + height / radius)).normalize();
            assert!(m.abs_diff_eq(expected, 2e-5), "{m} for {expected} at {p}");
        }
        assert_eq!(waving.triangles, rest.triangles);
        assert!(waving.is_closed(), "no seam opens");
    }

    #[test]
    fn normals_on_a_torus_err_by_the_square_of_an_edge() {
        let turns = 0.6;
        let wave = Wave { towards: Vec3::X, ..WAVE };
        let surface = |u: f64, v: f64| {
            let out = glam::DVec3::new(u.cos(), 0.0, -u.sin());
            let normal = v.cos() * out + v.sin() * glam::DVec3::Y;
            let point = out + 0.35 * normal;
            let phase = std::f64::consts::TAU * (point.x / 0.7 - turns);
            point + 0.1 * phase.sin() * normal
        };
        let worst = |slices: u32| {
            let sweep = Sweep { slices, angle: TAU };
            let rest = torus(1.0, 0.35, slices / 2, sweep);
            let waving = Relief::new(&rest).displaced(&rest, &wave, turns as f32);
            let off = |(p, normal): (&Vec3, &Vec3)| {
                let u = f64::from(f32::atan2(-p.z, p.x));
                let v = f64::from(f32::atan2(p.y, p.x.hypot(p.z) - 1.0));
                normal_of(surface, u, v).angle_between(*normal)
            };
            rest.positions.iter().zip(&waving.normals).map(off).fold(0.0, f32::max)
        };
        let [coarse, fine] = [32, 64].map(worst);
        assert!(coarse < 0.02 && fine < 0.3 * coarse, "{coarse} {fine}");
    }

    #[test]
    fn creases_do_not_tear() {
        for rest in [cuboid(Vec3::ONE), cylinder(0.5, 1.0, true, 24)] {
            let waving = Relief::new(&rest).displaced(&rest, &WAVE, 0.1);
            assert!(waving.is_closed() && waving.positions != rest.positions);
            assert!(waving.normals.iter().all(|n| (n.length() - 1.0).abs() < 1e-5));
        }
    }
}

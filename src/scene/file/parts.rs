//! The `shape` of an object: one mesh, or several parts of a file with their own materials.

use std::f32::consts::{PI, TAU};

use glam::{Vec2, Vec3};

use super::format::{
    CurveKind, CylinderFile, EllipsoidFile, ObjFile, PatchesFile, PlaneFile, RevolutionFile,
    ShapeFile, Span, SphereFile, TorusFile,
};
use super::source::Source;
use super::values::Turn;
use super::{obj, patches};
use crate::error::Result;
use crate::geometry::Mesh;
use crate::geometry::shapes::{
    Stretch, Sweep, arc_steps, bezier_profile, cuboid, cylinder, ellipsoid, plane,
    polyline_profile, revolution, sphere, torus,
};
use crate::scene::Surface;

/// A mesh of an object.
#[derive(Clone)]
pub struct Part {
    /// Appended to the object's name after a dot; `None` where the object is one part.
    pub name: Option<String>,
    pub mesh: Mesh,
    pub surface: Option<Surface>,
    pub material: PartMaterial,
}

/// What a part is made of.
#[derive(Clone)]
pub enum PartMaterial {
    /// The object's `material`.
    Objects,
    /// A material of the scene, and where it is named.
    Named(String, Span),
    /// A diffuse colour from the mesh file.
    Diffuse { name: String, colour: Vec3 },
}

/// Steps about the axis and along the profile where a scene file names none.
const SLICES: u32 = 64;
const STACKS: u32 = 32;
/// More steps than this are a mistyped `edge`.
const MAX_STEPS: u32 = 4096;

/// The parts of a shape; `span` is where it stands in the scene file.
pub fn parts(source: &mut Source, shape: &ShapeFile, span: &Span) -> Result<Vec<Part>> {
    let part = match shape {
        ShapeFile::Obj(file) => return obj_parts(source, file),
        ShapeFile::Patches(file) => return patch_parts(source, file),
        ShapeFile::Sphere(file) => sphere_part(file, &Steps { source, span })?,
        ShapeFile::Ellipsoid(file) => ellipsoid_part(file, &Steps { source, span })?,
        // Without curves the mesh is exact.
        ShapeFile::Box(file) => whole(cuboid(Vec3::from(file.size.map(|s| s.0))), None),
        ShapeFile::Plane(file) => plane_part(file),
        ShapeFile::Cylinder(file) => cylinder_part(file, &Steps { source, span })?,
        ShapeFile::Torus(file) => torus_part(file, &Steps { source, span })?,
        ShapeFile::Revolution(file) => whole(revolution_mesh(file, &Steps { source, span })?, None),
    };
    Ok(vec![part])
}

fn whole(mesh: Mesh, surface: Option<Surface>) -> Part {
    Part { name: None, mesh, surface, material: PartMaterial::Objects }
}

/// How finely a shape is cut.
struct Steps<'a> {
    source: &'a Source,
    span: &'a Span,
}

impl Steps<'_> {
    /// Steps of an arc of `radius` metres and `angle` radians: as counted, or as `edge` makes them.
    fn arc(
        &self,
        radius: f32,
        angle: f32,
        edge: Option<f32>,
        count: Option<u32>,
        default: u32,
    ) -> Result<u32> {
        match (edge, count) {
            (Some(_), Some(_)) => {
                Err(self.error("`edge` and a number of steps; valid: one of the two"))
            }
            (None, count) => Ok(count.unwrap_or(default)),
            (Some(edge), None) => {
                let steps = arc_steps(radius, angle, edge);
                if steps <= MAX_STEPS {
                    return Ok(steps);
                }
                let least = radius * angle / MAX_STEPS as f32;
                Err(self.error(format!("edge = {edge} is out of range; valid: {least} or more")))
            }
        }
    }

    fn error(&self, message: impl std::fmt::Display) -> crate::error::Error {
        self.source.error(self.span, message)
    }
}

fn sphere_part(file: &SphereFile, steps: &Steps) -> Result<Part> {
    let radius = file.radius.0;
    let edge = file.edge.map(|e| e.0);
    let slices = steps.arc(radius, TAU, edge, file.slices.map(|s| s.0), SLICES)?;
    let stacks = steps.arc(radius, PI, edge, file.stacks.map(|s| s.0), STACKS)?;
    Ok(whole(sphere(radius, slices, stacks), Some(Surface::Sphere { radius })))
}

fn ellipsoid_part(file: &EllipsoidFile, steps: &Steps) -> Result<Part> {
    let radii = Vec3::from(file.radii.map(|r| r.0));
    let edge = file.edge.map(|e| e.0);
    let round = radii.x.max(radii.z);
    let slices = steps.arc(round, TAU, edge, file.slices.map(|s| s.0), SLICES)?;
    let stacks = steps.arc(radii.max_element(), PI, edge, file.stacks.map(|s| s.0), STACKS)?;
    Ok(whole(ellipsoid(radii, slices, stacks), Some(Surface::Ellipsoid { radii })))
}

fn plane_part(file: &PlaneFile) -> Part {
    let size = Vec2::from(file.size.map(|s| s.0));
    whole(plane(size), Some(Surface::Rectangle { size }))
}

fn cylinder_part(file: &CylinderFile, steps: &Steps) -> Result<Part> {
    let (radius, height, capped) = (file.radius.0, file.height.0, file.capped);
    let edge = file.edge.map(|e| e.0);
    let slices = steps.arc(radius, TAU, edge, file.slices.map(|s| s.0), SLICES)?;
    let surface = Surface::Cylinder { radius, height, capped };
    Ok(whole(cylinder(radius, height, capped, slices), Some(surface)))
}

fn torus_part(file: &TorusFile, steps: &Steps) -> Result<Part> {
    let (ring, tube, edge) = (file.ring.0, file.tube.0, file.edge.map(|e| e.0));
    if tube >= ring {
        return Err(
            steps.error(format!("tube = {tube} is out of range; valid: below ring = {ring}"))
        );
    }
    let angle = sweep_angle(file.sweep_deg);
    let slices = steps.arc(ring + tube, angle, edge, file.slices.map(|s| s.0), SLICES)?;
    let stacks = steps.arc(tube, TAU, edge, file.stacks.map(|s| s.0), STACKS)?;
    let surface = (angle == TAU).then_some(Surface::Torus { ring, tube });
    Ok(whole(torus(ring, tube, stacks, Sweep { slices, angle }), surface))
}

/// Radians; exactly a full turn closes the surface.
fn sweep_angle(Turn(degrees): Turn) -> f32 {
    if degrees < 360.0 { degrees.to_radians() } else { TAU }
}

fn revolution_mesh(file: &RevolutionFile, steps: &Steps) -> Result<Mesh> {
    let points: Vec<Vec2> = file.profile.iter().map(|p| Vec2::new(p[0].0, p[1].0)).collect();
    if let Some(point) = points.iter().find(|p| p.x < 0.0) {
        return Err(
            steps.error(format!("profile radius {} is out of range; valid: 0 or more", point.x))
        );
    }
    let widest = points.iter().fold(0.0, |widest: f32, p| widest.max(p.x));
    let edge = file.edge.map(|e| e.0);
    let angle = sweep_angle(file.sweep_deg);
    let slices = steps.arc(widest, angle, edge, file.slices.map(|s| s.0), SLICES)?;
    let profile = profile(file, &points, steps)?;
    let mesh = revolution(&profile, Sweep { slices, angle });
    if mesh.triangles.is_empty() {
        return Err(steps.error("profile encloses no area; valid: radii above 0"));
    }
    Ok(mesh)
}

fn profile(file: &RevolutionFile, points: &[Vec2], steps: &Steps) -> Result<Vec<Stretch>> {
    let count = points.len();
    match file.curve {
        CurveKind::Polyline if count < 2 => {
            Err(steps.error(format!("profile has {count} points; valid: 2 or more")))
        }
        CurveKind::Polyline if points.windows(2).any(|p| p[0] == p[1]) => {
            Err(steps
                .error("profile repeats a point; valid: points that differ from the one before"))
        }
        CurveKind::Polyline => Ok(polyline_profile(points)),
        CurveKind::Bezier if count < 4 || count % 3 != 1 => {
            Err(steps.error(format!("profile has {count} points; valid: 4, 7, 10, ...")))
        }
        CurveKind::Bezier => {
            let cuts = file.stacks.map_or(STACKS, |s| s.0);
            Ok(bezier_profile(points, cuts))
        }
    }
}

fn obj_parts(source: &mut Source, file: &ObjFile) -> Result<Vec<Part>> {
    let meshes = obj::read(source, file)?;
    if let Some((unknown, named)) =
        file.materials.iter().find(|(name, _)| meshes.iter().all(|m| m.material != **name))
    {
        let valid: Vec<&str> = meshes.iter().map(|m| m.material.as_str()).collect();
        let message = format!(
            "no material `{unknown}` in {}; valid: {}",
            file.file.get_ref(),
            valid.join(", ")
        );
        return Err(source.error(&named.span(), message));
    }
    let part = |found: obj::ObjMesh| {
        let material = match file.materials.get(&found.material) {
            Some(named) => PartMaterial::Named(named.get_ref().clone(), named.span()),
            None => PartMaterial::Diffuse {
                name: format!("{}:{}", file.file.get_ref(), found.material),
                colour: found.diffuse,
            },
        };
        Part { name: Some(found.material), mesh: found.mesh, surface: None, material }
    };
    Ok(meshes.into_iter().map(part).collect())
}

fn patch_parts(source: &mut Source, file: &PatchesFile) -> Result<Vec<Part>> {
    let parts = patches::read(source, file)?;
    let part = |(name, mesh)| Part { name: Some(name), ..whole(mesh, None) };
    Ok(parts.into_iter().map(part).collect())
}

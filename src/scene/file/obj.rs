//! Wavefront OBJ files through tobj: one mesh a material, normals made where the file has none.

use std::collections::BTreeMap;

use glam::{Vec2, Vec3};

use super::format::ObjFile;
use super::obj_check::check;
use super::smooth::{Corner, smoothed};
use super::source::{Asset, Source};
use crate::error::Result;
use crate::geometry::Mesh;

/// The triangles of one material.
pub struct ObjMesh {
    /// As the file names it; [`NO_MATERIAL`] where it names none.
    pub material: String,
    /// Kd of the material library.
    pub diffuse: Vec3,
    pub mesh: Mesh,
}

const NO_MATERIAL: &str = "default";
/// Albedo where a file gives no Kd.
const GREY: Vec3 = Vec3::splat(0.6);

/// Reads the meshes of a file, ordered by material name.
pub fn read(source: &mut Source, request: &ObjFile) -> Result<Vec<ObjMesh>> {
    let span = request.file.span();
    let asset = source.asset(request.file.get_ref(), &span)?;
    let text = asset.text()?;
    let libraries = read_libraries(source, request, &asset, &check(&asset, text)?)?;
    let options = tobj::LoadOptions {
        triangulate: true,
        ignore_points: true,
        ignore_lines: true,
        ..Default::default()
    };
    let (models, materials) = tobj::load_obj_buf(&mut text.as_bytes(), &options, |path| {
        let name = path.to_string_lossy();
        let library = libraries.get(name.as_ref()).ok_or(tobj::LoadError::OpenFileFailed)?;
        tobj::load_mtl_buf(&mut library.as_slice())
    })
    .map_err(|cause| asset.error(None, cause))?;
    let materials = materials.map_err(|cause| asset.error(None, cause))?;

    let mut corners: BTreeMap<Option<usize>, Vec<[Corner; 3]>> = BTreeMap::new();
    for model in &models {
        corners.entry(model.mesh.material_id).or_default().extend(triangles(&model.mesh));
    }
    let crease = request.crease_deg.0.to_radians();
    let mut meshes = Vec::new();
    for (id, triangles) in corners {
        let material = id.and_then(|id| materials.get(id));
        meshes.push(ObjMesh {
            material: material.map_or(NO_MATERIAL.to_owned(), |m| m.name.clone()),
            diffuse: material.and_then(|m| m.diffuse).map_or(GREY, Vec3::from),
            mesh: smoothed(&triangles, crease),
        });
    }
    meshes.retain(|found| !found.mesh.triangles.is_empty());
    if meshes.is_empty() {
        return Err(asset.error(None, "no triangles; valid: at least one face"));
    }
    meshes.sort_by(|a, b| a.material.cmp(&b.material));
    Ok(meshes)
}

/// The material libraries an OBJ file names, found beside it, by their names.
fn read_libraries(
    source: &mut Source,
    request: &ObjFile,
    obj: &Asset,
    named: &[(usize, String)],
) -> Result<BTreeMap<String, Vec<u8>>> {
    let folder = request.file.get_ref().rsplit_once('/').map_or("", |(folder, _)| folder);
    let mut libraries = BTreeMap::new();
    for (line, name) in named {
        let path = if folder.is_empty() { name.clone() } else { format!("{folder}/{name}") };
        let library = source.asset(&path, &request.file.span()).map_err(|_| {
            obj.error(Some(*line), format!("no material library `{name}` beside it"))
        })?;
        libraries.insert(name.clone(), library.bytes);
    }
    Ok(libraries)
}

/// The corners of a tobj mesh's triangles.
fn triangles(mesh: &tobj::Mesh) -> Vec<[Corner; 3]> {
    let point = |list: &[f32], index: u32| {
        let at = 3 * index as usize;
        Vec3::new(list[at], list[at + 1], list[at + 2])
    };
    let corner = |place: usize| Corner {
        position: point(&mesh.positions, mesh.indices[place]),
        normal: mesh.normal_indices.get(place).map(|&i| point(&mesh.normals, i)),
        uv: mesh.texcoord_indices.get(place).map_or(Vec2::ZERO, |&i| {
            Vec2::new(mesh.texcoords[2 * i as usize], mesh.texcoords[2 * i as usize + 1])
        }),
    };
    (0..mesh.indices.len() / 3).map(|t| [3 * t, 3 * t + 1, 3 * t + 2].map(corner)).collect()
}

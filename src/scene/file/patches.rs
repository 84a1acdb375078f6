//! Files of Bezier patches, such as the Utah teapot.

use glam::Vec3;
use serde::Deserialize;

use super::format::PatchesFile;
use super::source::{Asset, Source};
use crate::error::Result;
use crate::geometry::Mesh;
use crate::geometry::bezier::{Patch, tessellate};

/// The JSON file: control points with z up, patches as indices into them, consecutive runs of
/// patches as parts.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PatchFile {
    #[serde(rename = "note")]
    _note: String,
    parts: Vec<PartRun>,
    patches: Vec<[usize; 16]>,
    points: Vec<[f32; 3]>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PartRun {
    name: String,
    patches: usize,
}

/// The parts of a patch file by name, turned to y up.
pub fn read(source: &mut Source, request: &PatchesFile) -> Result<Vec<(String, Mesh)>> {
    let asset = source.asset(request.file.get_ref(), &request.file.span())?;
    let file: PatchFile = serde_json::from_slice(&asset.bytes)
        .map_err(|cause| asset.error(Some(cause.line()), cause))?;
    let patches = resolve(&asset, &file)?;
    let counted: usize = file.parts.iter().map(|part| part.patches).sum();
    if counted != patches.len() {
        let message = format!("the parts count {counted} patches; valid: {}", patches.len());
        return Err(asset.error(None, message));
    }
    let mut rest = patches.as_slice();
    let mut meshes = Vec::new();
    for part in file.parts {
        let (own, others) = rest.split_at(part.patches);
        rest = others;
        let mesh = tessellate(own, request.steps.0);
        if mesh.triangles.is_empty() || mesh.normals.iter().any(|n| !n.is_finite()) {
            return Err(asset.error(None, format!("part `{}` has patches without area", part.name)));
        }
        meshes.push((part.name, mesh));
    }
    Ok(meshes)
}

fn resolve(asset: &Asset, file: &PatchFile) -> Result<Vec<Patch>> {
    let count = file.points.len();
    let mut patches = Vec::with_capacity(file.patches.len());
    for (number, indices) in file.patches.iter().enumerate() {
        if let Some(index) = indices.iter().find(|&&index| index >= count) {
            let message = format!("patch {number} names point {index}; valid: 0 to {}", count - 1);
            return Err(asset.error(None, message));
        }
        patches.push(indices.map(|index| {
            let [x, y, z] = file.points[index];
            Vec3::new(x, z, -y)
        }));
    }
    Ok(patches)
}

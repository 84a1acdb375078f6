//! The parts of a case: methods, each with the reflectors it serves.

use std::sync::Arc;

use super::engine::RunOptions;
use crate::error::{Error, Result};
use crate::gpu::Device;
use crate::methods::{Case, MethodInfo, ReflectionMethod, Selected, Setup};
use crate::scene::{Lobe, Moment, ObjectId};
use crate::stages::GpuScene;

/// A method and the reflectors it serves.
pub(super) struct Part {
    pub info: &'static MethodInfo,
    pub method: Box<dyn ReflectionMethod>,
    pub reflectors: Vec<ObjectId>,
    /// Those of them that are of glass.
    pub glass: Vec<ObjectId>,
    /// Names of the method's counters in results, in its order.
    pub counters: Vec<String>,
    /// The moment it was last prepared for.
    pub prepared: Option<Moment>,
}

/// Make the methods of a case, each for the reflectors its pattern serves.
///
/// # Errors
/// [`Error::Usage`] where a part serves none of the scene's reflectors or its method does not fit
/// them, [`Error::Shader`], [`Error::Device`].
pub(super) fn make(
    device: &Arc<Device>,
    scene: &GpuScene,
    case: &Case,
    registry: &[&'static MethodInfo],
    options: &RunOptions,
) -> Result<Vec<Part>> {
    let mut served = vec![Vec::new(); case.parts.len()];
    for object in scene.scene.reflectors() {
        if let Some(part) = case.part_for(&scene.scene.objects[object as usize].name) {
            served[part].push(object);
        }
    }
    let parts = case.parts.iter().zip(served);
    parts
        .map(|(selected, reflectors)| {
            if reflectors.is_empty() {
                return Err(serves_none(scene, selected));
            }
            let info = registry.iter().find(|info| info.id == selected.method);
            let made = info.and_then(|info| info.new.map(|new| (*info, new)));
            let Some((info, new)) = made else {
                return Err(Error::Usage(format!("{} does not run on a GPU", selected.method)));
            };
            let method = new(&Setup {
                device,
                scene,
                variant: selected.variant,
                values: &selected.values,
                mode: options.record,
                size: options.size,
                reflectors: &reflectors,
            })?;
            let glass = scene.scene.with_lobe(Lobe::Refracted);
            let glass =
                reflectors.iter().filter(|mirror| glass.contains(mirror)).copied().collect();
            let counters = info.counters.iter().map(|name| case.column(selected, name)).collect();
            Ok(Part { info, method, reflectors, glass, counters, prepared: None })
        })
        .collect()
}

fn serves_none(scene: &GpuScene, selected: &Selected) -> Error {
    let name = |object: ObjectId| scene.scene.objects[object as usize].name.as_str();
    let names: Vec<_> = scene.scene.reflectors().into_iter().map(name).collect();
    Error::Usage(format!(
        "no reflector of scene {} matches `{}`; it has: {}",
        scene.scene.name,
        selected.reflectors,
        names.join(", ")
    ))
}

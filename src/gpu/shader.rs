//! Shaders: WGSL with imports, compiled at start-up to SPIR-V, and what they bind.
//!
//! Files under `shaders/` that start with `#define_import_path` are modules others import. Those of
//! `shaders/includes` are text that others end with, by a last line `#include FILE`: entry points
//! cannot be imported. The rest are entry files. All are embedded in the binary; a shader folder on disk replaces them.

use std::borrow::Cow;
use std::collections::HashMap;
use std::path::PathBuf;

use naga::valid::{Capabilities, ModuleInfo};
use naga_oil::compose::{
    ComposableModuleDescriptor, Composer, ComposerError, NagaModuleDescriptor, ShaderDefValue,
    get_preprocessor_data,
};

use crate::error::{Error, Result};

include!(concat!(env!("OUT_DIR"), "/embedded_shaders.rs"));

/// Shader definitions: `#ifdef NAME` sees the name, `#{NAME}` the value.
pub type Defines<'a> = &'a [(&'static str, u32)];

/// What a shader variable is, as far as binding it goes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BindingKind {
    /// Size of the WGSL struct in bytes.
    Uniform {
        bytes: u64,
    },
    Buffer {
        writable: bool,
    },
    Texture {
        array: bool,
        cube: bool,
    },
    Storage {
        array: bool,
    },
    Sampler,
    /// What ray queries search; only devices with ray query have it.
    Acceleration,
}

/// A shader variable to bind: its WGSL name, its number in group 0, its kind.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Binding {
    pub name: String,
    pub number: u32,
    pub kind: BindingKind,
}

/// One compiled file: SPIR-V with all its entry points, and its bindings.
pub(super) struct Compiled {
    pub spirv: Vec<u32>,
    pub bindings: Vec<Binding>,
    /// Whether there is a `var<immediate>`.
    pub has_immediate: bool,
    /// Workgroup size of each entry point, zero for graphics stages.
    pub entries: Vec<(String, [u32; 3])>,
}

/// Compiles shader files.
pub struct Shaders {
    composer: Composer,
    sources: Vec<(String, Cow<'static, str>)>,
}

impl Shaders {
    /// The embedded shaders, or those of `folder`.
    ///
    /// # Errors
    /// [`Error::Shader`] when a file cannot be read, or a shared module does not compile.
    pub fn new(folder: Option<PathBuf>) -> Result<Shaders> {
        let mut sources: Vec<(String, Cow<'static, str>)> =
            EMBEDDED.iter().map(|&(name, text)| (name.to_owned(), Cow::Borrowed(text))).collect();
        if let Some(folder) = folder {
            for (name, text) in &mut sources {
                let path = folder.join(&*name);
                let read = std::fs::read_to_string(&path)
                    .map_err(|e| Error::Shader(format!("{}: {e}", path.display())))?;
                *text = Cow::Owned(read);
            }
        }
        include(&mut sources)?;
        let composer = Composer::default().with_capabilities(capabilities());
        let mut shaders = Shaders { composer, sources };
        shaders.add_modules()?;
        Ok(shaders)
    }

    /// The entry files, for tests that compile every one.
    pub fn entry_files(&self) -> Vec<String> {
        let entry = |text: &str| get_preprocessor_data(text).0.is_none();
        self.sources.iter().filter(|(_, t)| entry(t)).map(|(n, _)| n.clone()).collect()
    }

    /// Add the shared modules, each after those it imports.
    fn add_modules(&mut self) -> Result<()> {
        let mut waiting: Vec<(usize, Vec<String>)> = Vec::new();
        let mut names = Vec::new();
        for (index, (_, text)) in self.sources.iter().enumerate() {
            let (name, imports, _) = get_preprocessor_data(text);
            if let Some(name) = name {
                names.push(name);
                waiting.push((index, imports.into_iter().map(|i| i.import).collect()));
            }
        }
        while !waiting.is_empty() {
            let before = waiting.len();
            let composer = &self.composer;
            // An import names a module, or an item of one: `common::ray` or `common::ray::at`.
            let of = |import: &str, module: &str| {
                import
                    .strip_prefix(module)
                    .is_some_and(|rest| rest.is_empty() || rest.starts_with("::"))
            };
            let ready = |imports: &[String]| {
                imports.iter().all(|import| {
                    names.iter().all(|name| !of(import, name) || composer.contains_module(name))
                })
            };
            let (now, later): (Vec<_>, Vec<_>) =
                waiting.into_iter().partition(|(_, imports)| ready(imports));
            for (index, _) in now {
                let (file, text) = &self.sources[index];
                let descriptor = ComposableModuleDescriptor {
                    source: text,
                    file_path: &format!("shaders/{file}"),
                    ..Default::default()
                };
                if let Err(error) = self.composer.add_composable_module(descriptor) {
                    return Err(explain(&self.composer, &error));
                }
            }
            waiting = later;
            if waiting.len() == before {
                let files: Vec<_> =
                    waiting.iter().map(|(i, _)| self.sources[*i].0.as_str()).collect();
                return Err(Error::Shader(format!(
                    "shader imports in a cycle: {}",
                    files.join(", ")
                )));
            }
        }
        Ok(())
    }

    /// The composed naga module of an entry file.
    pub fn module(&mut self, file: &str, defines: Defines) -> Result<naga::Module> {
        let Some((_, text)) = self.sources.iter().find(|(name, _)| name == file) else {
            return Err(Error::Shader(format!("no shader file shaders/{file}")));
        };
        let shader_defs: HashMap<_, _> =
            defines.iter().map(|&(n, v)| (n.to_owned(), ShaderDefValue::UInt(v))).collect();
        let descriptor = NagaModuleDescriptor {
            source: text,
            file_path: &format!("shaders/{file}"),
            shader_defs,
            ..Default::default()
        };
        let mut module = match self.composer.make_naga_module(descriptor) {
            Ok(module) => module,
            Err(error) => return Err(explain(&self.composer, &error)),
        };
        // Imports bring in whole modules; what no entry point uses would have to be bound.
        naga::compact::compact(&mut module, naga::compact::KeepUnused::No);
        Ok(module)
    }

    /// Whether an entry file compiles and reflects.
    pub fn check(&mut self, file: &str, defines: Defines) -> Result<Vec<Binding>> {
        Ok(self.compile(file, defines)?.bindings)
    }

    /// Compile an entry file to SPIR-V.
    pub(super) fn compile(&mut self, file: &str, defines: Defines) -> Result<Compiled> {
        let module = self.module(file, defines)?;
        let wrong = |e: &dyn std::fmt::Display| Error::Shader(format!("shaders/{file}: {e}"));
        let info = naga::valid::Validator::new(Default::default(), capabilities())
            .validate(&module)
            .map_err(|e| {
                Error::Shader(e.emit_to_string_with_path("", &format!("shaders/{file} (composed)")))
            })?;
        let spirv = write_spirv(&module, &info).map_err(|e| wrong(&e))?;
        let bindings = reflect(&module).map_err(|e| wrong(&e))?;
        let entries =
            module.entry_points.iter().map(|e| (e.name.clone(), e.workgroup_size)).collect();
        let mut spaces = module.global_variables.iter().map(|(_, v)| v.space);
        let has_immediate = spaces.any(|s| s == naga::AddressSpace::Immediate);
        Ok(Compiled { spirv, bindings, has_immediate, entries })
    }
}

/// Put the text of files under `includes/` where others ask for it.
fn include(sources: &mut Vec<(String, Cow<'static, str>)>) -> Result<()> {
    let (included, mut rest): (Vec<_>, Vec<_>) =
        sources.drain(..).partition(|(name, _)| name.starts_with("includes/"));
    for (name, text) in &mut rest {
        let Some((own, wanted)) = text.split_once("#include ") else { continue };
        let wanted = wanted.trim();
        let Some((_, ending)) = included.iter().find(|(name, _)| name == wanted) else {
            return Err(Error::Shader(format!("shaders/{name} includes no file `{wanted}`")));
        };
        *text = Cow::Owned(format!("{own}{ending}"));
    }
    *sources = rest;
    Ok(())
}

/// What the device is required to have, and no more: a shader beyond it fails here, by name. Only
/// ray queries are left to [`Device::require_ray_query`](super::Device::require_ray_query), when a
/// pipeline is made.
fn capabilities() -> Capabilities {
    Capabilities::PRIMITIVE_INDEX
        | Capabilities::EARLY_DEPTH_TEST
        | Capabilities::IMMEDIATES
        | Capabilities::SHADER_FLOAT16_IN_FLOAT32
        | Capabilities::RAY_QUERY
}

fn explain(composer: &Composer, error: &ComposerError) -> Error {
    Error::Shader(error.emit_to_string(composer))
}

fn write_spirv(module: &naga::Module, info: &ModuleInfo) -> Result<Vec<u32>, String> {
    use naga::back::spv;
    // Numbers as written; a variable without one is an error rather than a guess.
    let bound = module.global_variables.iter().filter_map(|(_, v)| v.binding);
    let binding_map = bound
        .map(|at| {
            let (descriptor_set, binding) = (at.group, at.binding);
            (at, spv::BindingInfo { descriptor_set, binding, binding_array_size: None })
        })
        .collect();
    let options = spv::Options {
        binding_map,
        lang_version: (1, 4),
        // Native Vulkan clip space; names for validation messages and captures.
        flags: spv::WriterFlags::DEBUG,
        fake_missing_bindings: false,
        // These cost time that belongs to no paper's method; every loop here ends by itself, every
        // ray query is initialised.
        force_loop_bounding: false,
        ray_query_initialization_tracking: false,
        zero_initialize_workgroup_memory: spv::ZeroInitializeWorkgroupMemoryMode::None,
        ..Default::default()
    };
    spv::write_vec(module, info, &options, None).map_err(|e| e.to_string())
}

/// The variables of group 0, by number.
fn reflect(module: &naga::Module) -> Result<Vec<Binding>, String> {
    let mut bindings = Vec::new();
    for (_, variable) in module.global_variables.iter() {
        let Some(at) = &variable.binding else { continue };
        let full = variable.name.as_deref().unwrap_or("");
        // naga_oil marks names of imported modules; the plain name is what the file says.
        let name = full.split("X_naga_oil").next().unwrap_or(full).to_owned();
        if at.group != 0 {
            return Err(format!("`{name}` is in group {}, but only group 0 is bound", at.group));
        }
        let kind = kind_of(module, variable)
            .ok_or_else(|| format!("`{name}` has a type that cannot be bound"))?;
        bindings.push(Binding { name, number: at.binding, kind });
    }
    bindings.sort_by_key(|b| b.number);
    if let Some(twice) = bindings.windows(2).find(|w| w[0].number == w[1].number) {
        return Err(format!(
            "`{}` and `{}` have the same binding {}",
            twice[0].name, twice[1].name, twice[0].number
        ));
    }
    Ok(bindings)
}

fn kind_of(module: &naga::Module, variable: &naga::GlobalVariable) -> Option<BindingKind> {
    use naga::{AddressSpace, ImageClass, ImageDimension, TypeInner};
    match (variable.space, &module.types[variable.ty].inner) {
        (AddressSpace::Uniform, inner) => {
            Some(BindingKind::Uniform { bytes: u64::from(inner.size(module.to_ctx())) })
        }
        (AddressSpace::Storage { access }, _) => {
            Some(BindingKind::Buffer { writable: access.contains(naga::StorageAccess::STORE) })
        }
        (AddressSpace::Handle, &TypeInner::Image { dim, arrayed, class }) => {
            let cube = dim == ImageDimension::Cube;
            Some(match class {
                ImageClass::Storage { .. } => BindingKind::Storage { array: arrayed },
                _ => BindingKind::Texture { array: arrayed, cube },
            })
        }
        (AddressSpace::Handle, TypeInner::Sampler { .. }) => Some(BindingKind::Sampler),
        (AddressSpace::Handle, TypeInner::AccelerationStructure { .. }) => {
            Some(BindingKind::Acceleration)
        }
        _ => None,
    }
}

//! Pipelines, written out: which shader, which attachments, which depth and stencil tests.

use std::ffi::CString;
use std::sync::Arc;

use ash::vk;

use super::shader::Compiled;
use super::{Binding, BindingKind, Defines, Device, Format};
use crate::error::{Error, Result};

/// A shader's bindings as Vulkan objects: one push-descriptor set.
pub(super) struct Layout {
    device: Arc<Device>,
    set: vk::DescriptorSetLayout,
    pub raw: vk::PipelineLayout,
    pub bindings: Vec<Binding>,
    pub stages: vk::ShaderStageFlags,
    /// Whether the shader has a `var<immediate>`, of one word.
    pub has_immediate: bool,
}

pub(super) fn descriptor_type(kind: BindingKind) -> vk::DescriptorType {
    match kind {
        BindingKind::Uniform { .. } => vk::DescriptorType::UNIFORM_BUFFER,
        BindingKind::Buffer { .. } => vk::DescriptorType::STORAGE_BUFFER,
        BindingKind::Texture { .. } => vk::DescriptorType::SAMPLED_IMAGE,
        BindingKind::Storage { .. } => vk::DescriptorType::STORAGE_IMAGE,
        BindingKind::Sampler => vk::DescriptorType::SAMPLER,
        BindingKind::Acceleration => vk::DescriptorType::ACCELERATION_STRUCTURE_KHR,
    }
}

impl Layout {
    fn new(
        device: &Arc<Device>,
        name: &str,
        compiled: &mut Compiled,
        stages: vk::ShaderStageFlags,
    ) -> Result<Layout> {
        let bindings = std::mem::take(&mut compiled.bindings);
        let has_immediate = compiled.has_immediate;
        let descriptors: Vec<_> = bindings
            .iter()
            .map(|b| {
                vk::DescriptorSetLayoutBinding::default()
                    .binding(b.number)
                    .descriptor_type(descriptor_type(b.kind))
                    .descriptor_count(1)
                    .stage_flags(stages)
            })
            .collect();
        let info = vk::DescriptorSetLayoutCreateInfo::default()
            .flags(vk::DescriptorSetLayoutCreateFlags::PUSH_DESCRIPTOR_KHR)
            .bindings(&descriptors);
        // SAFETY: a live device and a complete description.
        let set = unsafe { device.raw.create_descriptor_set_layout(&info, None) }
            .map_err(|e| device.fail("vkCreateDescriptorSetLayout", name, e))?;
        let raw = vk::PipelineLayout::null();
        let device = device.clone();
        let mut layout = Layout { device, set, raw, bindings, stages, has_immediate };
        let device = &layout.device;
        let sets = [set];
        let ranges = [vk::PushConstantRange::default().stage_flags(stages).size(4)];
        let info = vk::PipelineLayoutCreateInfo::default()
            .set_layouts(&sets)
            .push_constant_ranges(&ranges[..usize::from(has_immediate)]);
        // SAFETY: as above; the set layout is alive.
        layout.raw = unsafe { device.raw.create_pipeline_layout(&info, None) }
            .map_err(|e| device.fail("vkCreatePipelineLayout", name, e))?;
        Ok(layout)
    }
}

impl Drop for Layout {
    fn drop(&mut self) {
        // SAFETY: pipelines and frames that used it are done.
        unsafe {
            self.device.raw.destroy_pipeline_layout(self.raw, None);
            self.device.raw.destroy_descriptor_set_layout(self.set, None);
        }
    }
}

/// A shader module that lives while a pipeline is made from it.
struct Module<'a> {
    device: &'a Device,
    raw: vk::ShaderModule,
}

impl<'a> Module<'a> {
    fn new(device: &'a Device, name: &str, compiled: &Compiled) -> Result<Self> {
        if compiled.bindings.iter().any(|b| b.kind == BindingKind::Acceleration) {
            device.require_ray_query()?;
        }
        let info = vk::ShaderModuleCreateInfo::default().code(&compiled.spirv);
        // SAFETY: naga validated the module and wrote the SPIR-V.
        let raw = unsafe { device.raw.create_shader_module(&info, None) }
            .map_err(|e| device.fail("vkCreateShaderModule", name, e))?;
        Ok(Module { device, raw })
    }
}

impl Drop for Module<'_> {
    fn drop(&mut self) {
        // SAFETY: pipelines keep what they need of a module.
        unsafe { self.device.raw.destroy_shader_module(self.raw, None) };
    }
}

fn entry_name(file: &str, compiled: &Compiled, entry: &str) -> Result<CString> {
    let known: Vec<_> = compiled.entries.iter().map(|(n, _)| n.as_str()).collect();
    match CString::new(entry) {
        Ok(name) if known.contains(&entry) => Ok(name),
        _ => Err(Error::Shader(format!(
            "shaders/{file} has no entry point `{entry}`; it has: {}",
            known.join(", ")
        ))),
    }
}

/// A pipeline and its layout; frames that use it hold it until their submit is done.
pub(super) struct Owner {
    pub raw: vk::Pipeline,
    pub layout: Layout,
}

impl Drop for Owner {
    fn drop(&mut self) {
        // SAFETY: no frame holds it any more, so the device no longer uses it.
        unsafe { self.layout.device.raw.destroy_pipeline(self.raw, None) };
    }
}

/// A compute shader, ready to run.
pub struct ComputePipeline {
    pub(super) owner: Arc<Owner>,
    pub(super) workgroup: [u32; 3],
}

impl ComputePipeline {
    /// Compile entry point `main` of a file under `shaders/`.
    pub fn new(device: &Arc<Device>, file: &str, defines: Defines) -> Result<ComputePipeline> {
        Self::with_entry(device, file, "main", defines)
    }

    /// Compile one entry point of a file whose entry points bind the same variables.
    pub fn with_entry(
        device: &Arc<Device>,
        file: &str,
        entry: &str,
        defines: Defines,
    ) -> Result<ComputePipeline> {
        let mut compiled = device.shaders().compile(file, defines)?;
        let name = entry_name(file, &compiled, entry)?;
        let module = Module::new(device, file, &compiled)?;
        let layout = Layout::new(device, file, &mut compiled, vk::ShaderStageFlags::COMPUTE)?;
        let stage = vk::PipelineShaderStageCreateInfo::default()
            .stage(vk::ShaderStageFlags::COMPUTE)
            .module(module.raw)
            .name(&name);
        let info = vk::ComputePipelineCreateInfo::default().stage(stage).layout(layout.raw);
        let cache = vk::PipelineCache::null();
        // SAFETY: module, entry point and layout belong together and are alive.
        let made = unsafe { device.raw.create_compute_pipelines(cache, &[info], None) }
            .map_err(|(_, e)| device.fail("vkCreateComputePipelines", file, e))?;
        device.name(made[0], file);
        let workgroup = compiled
            .entries
            .iter()
            .find(|(n, _)| n == entry)
            .map_or([1; 3], |(_, workgroup)| *workgroup);
        Ok(ComputePipeline { owner: Arc::new(Owner { raw: made[0], layout }), workgroup })
    }
}

/// The depth test. Depth is reversed: nearer is greater.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Depth {
    /// No depth attachment, or one that is left alone.
    Off,
    /// Keep the nearest.
    Nearest,
    /// Pass where the fragment is what the buffer already shows, or nearer; keep the nearest.
    NearestOrEqual,
    /// Keep the farthest.
    Farthest,
}

/// The stencil test. The reference is set while drawing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stencil {
    Off,
    /// Write the reference where the depth test passes.
    Mark,
    /// Draw only where the stencil equals the reference.
    Within,
}

/// What a graphics pipeline draws into and how it tests.
pub struct Attachments<'a> {
    /// In the order of the fragment shader's `@location`s.
    pub colours: &'a [Format],
    /// Whether a [`Format::DepthStencil`] image is attached.
    pub depth_stencil: bool,
    pub depth: Depth,
    pub stencil: Stencil,
}

/// A vertex and a fragment shader with fixed state: triangles, both sides, no blending.
pub struct GraphicsPipeline {
    pub(super) owner: Arc<Owner>,
}

impl GraphicsPipeline {
    /// Compile entry points `vertex` and `fragment` of a file under `shaders/`.
    pub fn new(
        device: &Arc<Device>,
        file: &str,
        defines: Defines,
        attachments: &Attachments,
    ) -> Result<GraphicsPipeline> {
        let mut compiled = device.shaders().compile(file, defines)?;
        let names =
            [entry_name(file, &compiled, "vertex")?, entry_name(file, &compiled, "fragment")?];
        let module = Module::new(device, file, &compiled)?;
        let both = vk::ShaderStageFlags::VERTEX | vk::ShaderStageFlags::FRAGMENT;
        let layout = Layout::new(device, file, &mut compiled, both)?;
        let flags = [vk::ShaderStageFlags::VERTEX, vk::ShaderStageFlags::FRAGMENT];
        let stages = [0, 1].map(|i| {
            vk::PipelineShaderStageCreateInfo::default()
                .stage(flags[i])
                .module(module.raw)
                .name(&names[i])
        });
        let raw = create_graphics(device, file, &stages, layout.raw, attachments)?;
        device.name(raw, file);
        let owner = Arc::new(Owner { raw, layout });
        Ok(GraphicsPipeline { owner })
    }
}

fn create_graphics(
    device: &Device,
    file: &str,
    stages: &[vk::PipelineShaderStageCreateInfo],
    layout: vk::PipelineLayout,
    attachments: &Attachments,
) -> Result<vk::Pipeline> {
    let vertex_input = vk::PipelineVertexInputStateCreateInfo::default();
    let assembly = vk::PipelineInputAssemblyStateCreateInfo::default()
        .topology(vk::PrimitiveTopology::TRIANGLE_LIST);
    let viewport =
        vk::PipelineViewportStateCreateInfo::default().viewport_count(1).scissor_count(1);
    let raster = vk::PipelineRasterizationStateCreateInfo::default()
        .polygon_mode(vk::PolygonMode::FILL)
        .cull_mode(vk::CullModeFlags::NONE)
        .line_width(1.0);
    let samples = vk::PipelineMultisampleStateCreateInfo::default()
        .rasterization_samples(vk::SampleCountFlags::TYPE_1);
    let blends = vec![
        vk::PipelineColorBlendAttachmentState::default()
            .color_write_mask(vk::ColorComponentFlags::RGBA);
        attachments.colours.len()
    ];
    let blend = vk::PipelineColorBlendStateCreateInfo::default().attachments(&blends);
    let depth_stencil = depth_stencil_state(attachments);
    let states = [
        vk::DynamicState::VIEWPORT,
        vk::DynamicState::SCISSOR,
        vk::DynamicState::STENCIL_REFERENCE,
    ];
    let dynamic = vk::PipelineDynamicStateCreateInfo::default().dynamic_states(&states);
    let formats: Vec<_> = attachments.colours.iter().map(|f| f.raw()).collect();
    let mut rendering =
        vk::PipelineRenderingCreateInfo::default().color_attachment_formats(&formats);
    if attachments.depth_stencil {
        let format = Format::DepthStencil.raw();
        rendering = rendering.depth_attachment_format(format).stencil_attachment_format(format);
    }
    let info = vk::GraphicsPipelineCreateInfo::default()
        .stages(stages)
        .vertex_input_state(&vertex_input)
        .input_assembly_state(&assembly)
        .viewport_state(&viewport)
        .rasterization_state(&raster)
        .multisample_state(&samples)
        .depth_stencil_state(&depth_stencil)
        .color_blend_state(&blend)
        .dynamic_state(&dynamic)
        .layout(layout)
        .push_next(&mut rendering);
    // SAFETY: every structure in `info` lives in this function, modules and layout in the caller.
    let made =
        unsafe { device.raw.create_graphics_pipelines(vk::PipelineCache::null(), &[info], None) };
    made.map(|m| m[0]).map_err(|(_, e)| device.fail("vkCreateGraphicsPipelines", file, e))
}

fn depth_stencil_state(
    attachments: &Attachments,
) -> vk::PipelineDepthStencilStateCreateInfo<'static> {
    let (test, compare) = match attachments.depth {
        Depth::Off => (false, vk::CompareOp::ALWAYS),
        Depth::Nearest => (true, vk::CompareOp::GREATER),
        Depth::NearestOrEqual => (true, vk::CompareOp::GREATER_OR_EQUAL),
        Depth::Farthest => (true, vk::CompareOp::LESS),
    };
    let (stencil, compare_stencil, pass) = match attachments.stencil {
        Stencil::Off => (false, vk::CompareOp::ALWAYS, vk::StencilOp::KEEP),
        Stencil::Mark => (true, vk::CompareOp::ALWAYS, vk::StencilOp::REPLACE),
        Stencil::Within => (true, vk::CompareOp::EQUAL, vk::StencilOp::KEEP),
    };
    let face = vk::StencilOpState::default()
        .compare_op(compare_stencil)
        .pass_op(pass)
        .compare_mask(0xff)
        .write_mask(0xff);
    vk::PipelineDepthStencilStateCreateInfo::default()
        .depth_test_enable(test)
        .depth_write_enable(test)
        .depth_compare_op(compare)
        .stencil_test_enable(stencil)
        .front(face)
        .back(face)
}

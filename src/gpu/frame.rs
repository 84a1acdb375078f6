//! A frame: passes recorded in order into one command buffer, submitted once and waited for.

use std::any::Any;
use std::ffi::CString;
use std::sync::Arc;
use std::time::{Duration, Instant};

use ash::vk;

use super::acceleration::INSTANCE_ALIGNMENT;
use super::buffer::Buffer;
use super::command::{allocate_commands, create_pool, submit_and_wait};
use super::pass::Pass;
use super::profiler::Profiler;
use super::{Device, Format, Image, PassTime, Slice};
use crate::error::{Error, Result};

/// Bytes of uniforms and small arrays one submit can hold.
const UPLOAD_BYTES: u64 = 8 << 20;

/// What is wanted of a pass and a variable, which may be an image.
type DumpFilter = Box<dyn Fn(&str, &str, bool) -> bool + Send>;

/// One image or buffer of a pass, as it was right after it.
pub struct Dump {
    pub pass: String,
    pub variable: String,
    pub kind: DumpKind,
    pub bytes: Vec<u8>,
}

/// What a dump holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum DumpKind {
    /// Rows packed, layer after layer.
    Image { format: Format, size: [u32; 2], layers: u32 },
    /// 32-bit words.
    Buffer,
}

/// What a submit leaves behind.
pub struct Recorded {
    /// One entry a pass or CPU scope, in the order of recording.
    pub passes: Vec<PassTime>,
    pub dumps: Vec<Dump>,
    /// CPU time the profiler took per GPU pass.
    pub profiler_time: Duration,
}

/// Records passes and submits them.
pub struct Frame {
    pub(super) device: Arc<Device>,
    pool: vk::CommandPool,
    pub(super) commands: vk::CommandBuffer,
    pub(super) profiler: Profiler,
    uploads: Buffer,
    used: u64,
    /// What the recorded commands use.
    kept: Vec<Arc<dyn Any + Send + Sync>>,
    dump_filter: Option<DumpFilter>,
    dumps: Vec<(Dump, Buffer)>,
    statistics: bool,
}

impl Frame {
    pub fn new(device: &Arc<Device>) -> Result<Frame> {
        let profiler = Profiler::new(device)?;
        let uploads = Buffer::upload_ring(device, UPLOAD_BYTES)?;
        let pool = create_pool(device, "frame")?;
        let mut frame = Frame {
            device: device.clone(),
            pool,
            commands: vk::CommandBuffer::null(),
            profiler,
            uploads,
            used: 0,
            kept: Vec::new(),
            dump_filter: None,
            dumps: Vec::new(),
            statistics: false,
        };
        frame.commands = allocate_commands(device, pool, "frame")?;
        Ok(frame)
    }

    pub fn device(&self) -> &Arc<Device> {
        &self.device
    }

    /// Count shader invocations from the next `begin` on; costs time, so off while timing.
    pub fn count_invocations(&mut self, on: bool) {
        self.statistics = on;
    }

    /// Copy out every image that passes write, and every buffer they use, where `filter` says so of the
    /// pass's name, the variable's, and whether it is an image.
    pub fn dump_where(&mut self, filter: impl Fn(&str, &str, bool) -> bool + Send + 'static) {
        self.dump_filter = Some(Box::new(filter));
    }

    /// Start recording; what an abandoned frame recorded is forgotten.
    pub fn begin(&mut self) -> Result<()> {
        self.profiler.reset(self.statistics);
        self.used = 0;
        self.kept.clear();
        self.dumps.clear();
        let info = vk::CommandBufferBeginInfo::default()
            .flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
        // SAFETY: the pool allows resetting, and the last submit was waited for.
        unsafe {
            let reset = vk::CommandBufferResetFlags::empty();
            self.device
                .raw
                .reset_command_buffer(self.commands, reset)
                .map_err(|e| self.device.fail("vkResetCommandBuffer", "frame", e))?;
            self.device
                .raw
                .begin_command_buffer(self.commands, &info)
                .map_err(|e| self.device.fail("vkBeginCommandBuffer", "frame", e))
        }
    }

    /// A pass: `name` is its label, its timer, its dump folder and part of every error about it.
    pub fn pass(&mut self, name: &str) -> Pass<'_> {
        Pass::new(self, name)
    }

    /// Work on the CPU, timed like a pass.
    pub fn cpu<T>(&mut self, name: &str, work: impl FnOnce() -> Result<T>) -> Result<T> {
        let start = Instant::now();
        let result = work();
        self.profiler.cpu(name, start.elapsed());
        result
    }

    /// Scopes recorded so far, to tell a burst's frames apart in [`Recorded::passes`].
    pub fn scopes(&self) -> usize {
        self.profiler.len()
    }

    /// Copy a small array to where shaders of this frame can read it.
    pub fn upload<T: bytemuck::Pod>(&mut self, data: &[T]) -> Result<Slice> {
        let bytes: &[u8] = bytemuck::cast_slice(data);
        let alignment = self.device.offset_alignment().max(INSTANCE_ALIGNMENT);
        let offset = self.used.next_multiple_of(alignment);
        // Vulkan binds no empty range.
        let length = (bytes.len() as u64).max(16);
        if offset + length > UPLOAD_BYTES {
            return Err(Error::Device(format!("over {UPLOAD_BYTES} bytes uploaded in one frame")));
        }
        self.uploads.write(offset, bytes)?;
        self.used = offset + length;
        Ok(Slice { buffer: self.uploads.raw, offset, bytes: length })
    }

    /// Hold something until the frame has been submitted and waited for.
    pub(super) fn keep(&mut self, used: Arc<dyn Any + Send + Sync>) {
        self.kept.push(used);
    }

    /// Copy an image out where that is wanted, after the pass that wrote it.
    pub(super) fn dump_image(&mut self, pass: &str, variable: &str, image: &Image) -> Result<()> {
        let layers = image.shape.layers();
        let kind = DumpKind::Image { format: image.format, size: image.size, layers };
        self.dump([pass, variable], kind, image.readback_bytes(), |commands, target| {
            image.copy_to(commands, target);
        })
    }

    /// The same of a buffer, or the part of it that the pass used.
    pub(super) fn dump_buffer(&mut self, pass: &str, variable: &str, slice: &Slice) -> Result<()> {
        let device = self.device.clone();
        self.dump([pass, variable], DumpKind::Buffer, slice.bytes, |commands, target| {
            let region = vk::BufferCopy::default().src_offset(slice.offset).size(slice.bytes);
            // SAFETY: recording; the pass bound the range, so it is inside a buffer that the frame keeps,
            // and the target is as long.
            unsafe { device.raw.cmd_copy_buffer(commands, slice.buffer, target.raw, &[region]) };
        })
    }

    fn dump(
        &mut self,
        [pass, variable]: [&str; 2],
        kind: DumpKind,
        bytes: u64,
        copy: impl FnOnce(vk::CommandBuffer, &Buffer),
    ) -> Result<()> {
        let is_image = kind != DumpKind::Buffer;
        if !self.dump_filter.as_ref().is_some_and(|wanted| wanted(pass, variable, is_image)) {
            return Ok(());
        }
        let name = format!("dump of {pass}/{variable}");
        let target = Buffer::readback(&self.device, &name, bytes)?;
        super::command::full_barrier(&self.device, self.commands);
        copy(self.commands, &target);
        let [pass, variable] = [pass, variable].map(str::to_owned);
        self.dumps.push((Dump { pass, variable, kind, bytes: Vec::new() }, target));
        Ok(())
    }

    pub(super) fn begin_label(&self, name: &str) {
        if let (Some(debug), Ok(text)) = (&self.device.debug_utils, CString::new(name)) {
            let label = vk::DebugUtilsLabelEXT::default().label_name(&text);
            // SAFETY: recording; `text` outlives the call.
            unsafe { debug.cmd_begin_debug_utils_label(self.commands, &label) };
        }
    }

    pub(super) fn end_label(&self) {
        if let Some(debug) = &self.device.debug_utils {
            // SAFETY: recording, after a matching begin.
            unsafe { debug.cmd_end_debug_utils_label(self.commands) };
        }
    }

    /// Submit what was recorded, wait, and collect the times.
    pub fn submit(&mut self) -> Result<Recorded> {
        super::command::full_barrier(&self.device, self.commands);
        // SAFETY: recording has begun; all passes have ended.
        unsafe { self.device.raw.end_command_buffer(self.commands) }
            .map_err(|e| self.device.fail("vkEndCommandBuffer", "frame", e))?;
        submit_and_wait(&self.device, "frame", self.commands)?;
        self.kept.clear();
        let mut dumps = Vec::with_capacity(self.dumps.len());
        for (mut dump, buffer) in self.dumps.drain(..) {
            dump.bytes = buffer.contents()?;
            dumps.push(dump);
        }
        Ok(Recorded {
            passes: self.profiler.results()?,
            dumps,
            profiler_time: self.profiler.own_per_pass(),
        })
    }
}

impl Drop for Frame {
    fn drop(&mut self) {
        // SAFETY: submits are waited for, and an abandoned recording was never submitted.
        unsafe { self.device.raw.destroy_command_pool(self.pool, None) };
    }
}

//! Commands outside frames: set-up copies and readbacks, each submitted alone and waited for.

use ash::vk;

use super::Device;
use crate::error::Result;

/// Record commands, submit them and wait. Writes are visible to the host and to later submits.
pub(super) fn run_once(
    device: &Device,
    what: &str,
    record: impl FnOnce(vk::CommandBuffer),
) -> Result<()> {
    let pool = CommandPool::new(device, what)?;
    let commands = pool.allocate(what)?;
    let fail = |call, e| device.fail(call, what, e);
    let begin =
        vk::CommandBufferBeginInfo::default().flags(vk::CommandBufferUsageFlags::ONE_TIME_SUBMIT);
    // SAFETY: the command buffer is fresh and used by this thread only.
    unsafe { device.raw.begin_command_buffer(commands, &begin) }
        .map_err(|e| fail("vkBeginCommandBuffer", e))?;
    full_barrier(device, commands);
    record(commands);
    full_barrier(device, commands);
    // SAFETY: recording has begun and ends here.
    unsafe { device.raw.end_command_buffer(commands) }
        .map_err(|e| fail("vkEndCommandBuffer", e))?;
    submit_and_wait(device, what, commands)
}

/// Submit one command buffer and wait until the device has finished it.
pub(super) fn submit_and_wait(
    device: &Device,
    what: &str,
    commands: vk::CommandBuffer,
) -> Result<()> {
    let buffers = [vk::CommandBufferSubmitInfo::default().command_buffer(commands)];
    let submits = [vk::SubmitInfo2::default().command_buffer_infos(&buffers)];
    // SAFETY: the command buffer is complete; one thread at a time submits, as each caller waits.
    unsafe {
        device
            .raw
            .queue_submit2(device.queue, &submits, vk::Fence::null())
            .map_err(|e| device.fail("vkQueueSubmit2", what, e))?;
        device
            .raw
            .queue_wait_idle(device.queue)
            .map_err(|e| device.fail("vkQueueWaitIdle", what, e))
    }
}

/// Everything before is finished and visible to everything after, the host included.
pub(super) fn full_barrier(device: &Device, commands: vk::CommandBuffer) {
    let all = vk::PipelineStageFlags2::ALL_COMMANDS;
    let access = vk::AccessFlags2::MEMORY_READ | vk::AccessFlags2::MEMORY_WRITE;
    let barriers = [vk::MemoryBarrier2::default()
        .src_stage_mask(all)
        .src_access_mask(vk::AccessFlags2::MEMORY_WRITE)
        .dst_stage_mask(all | vk::PipelineStageFlags2::HOST)
        .dst_access_mask(access)];
    let dependency = vk::DependencyInfo::default().memory_barriers(&barriers);
    // SAFETY: recording, outside a rendering scope.
    unsafe { device.raw.cmd_pipeline_barrier2(commands, &dependency) };
}

/// A command pool that lives for a scope.
pub(super) struct CommandPool<'a> {
    device: &'a Device,
    raw: vk::CommandPool,
}

impl<'a> CommandPool<'a> {
    fn new(device: &'a Device, what: &str) -> Result<Self> {
        Ok(CommandPool { device, raw: create_pool(device, what)? })
    }

    fn allocate(&self, what: &str) -> Result<vk::CommandBuffer> {
        allocate_commands(self.device, self.raw, what)
    }
}

impl Drop for CommandPool<'_> {
    fn drop(&mut self) {
        // SAFETY: its only submit has been waited for.
        unsafe { self.device.raw.destroy_command_pool(self.raw, None) };
    }
}

pub(super) fn create_pool(device: &Device, what: &str) -> Result<vk::CommandPool> {
    let info = vk::CommandPoolCreateInfo::default()
        .queue_family_index(device.queue_family)
        .flags(vk::CommandPoolCreateFlags::RESET_COMMAND_BUFFER);
    // SAFETY: a live device and a family it was created with.
    unsafe { device.raw.create_command_pool(&info, None) }
        .map_err(|e| device.fail("vkCreateCommandPool", what, e))
}

pub(super) fn allocate_commands(
    device: &Device,
    pool: vk::CommandPool,
    what: &str,
) -> Result<vk::CommandBuffer> {
    let info = vk::CommandBufferAllocateInfo::default().command_pool(pool).command_buffer_count(1);
    // SAFETY: the pool is alive; one buffer is asked for and one comes back.
    let buffers = unsafe { device.raw.allocate_command_buffers(&info) }
        .map_err(|e| device.fail("vkAllocateCommandBuffers", what, e))?;
    Ok(buffers[0])
}

//! Timestamps and pipeline statistics around every pass of a frame.

use std::sync::Arc;
use std::time::{Duration, Instant};

use ash::vk;

use super::Device;
use super::command::full_barrier;
use crate::error::{Error, Result};

/// Passes one submit can hold, bursts included.
const MAX_PASSES: u32 = 1 << 14;

/// Time of one pass.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PassTime {
    /// `method/step`, as given to `Frame::pass`.
    pub name: String,
    /// GPU milliseconds between the timestamps around the pass; 0 for a CPU scope.
    pub gpu_ms: f64,
    /// CPU milliseconds of a CPU scope; 0 for a GPU pass.
    pub cpu_ms: f64,
    /// Fragment and compute shader invocations, where counted.
    pub invocations: u64,
    /// When it began, milliseconds after the submit's first timestamp. A CPU scope has the time
    /// of the GPU pass before it: it ran while the frame was recorded.
    pub begin_ms: f64,
}

enum Scope {
    /// The pass's number among GPU passes.
    Gpu(u32),
    Cpu(Duration),
}

/// The query pools of a frame.
pub(super) struct Profiler {
    device: Arc<Device>,
    timestamps: vk::QueryPool,
    statistics: Option<vk::QueryPool>,
    scopes: Vec<(String, Scope)>,
    gpu_passes: u32,
    counting: bool,
    /// CPU time the profiler itself took since `reset`.
    own: Duration,
}

impl Profiler {
    pub fn new(device: &Arc<Device>) -> Result<Profiler> {
        use vk::QueryPipelineStatisticFlags as Flags;
        let pool = |kind, count, flags| {
            let info = vk::QueryPoolCreateInfo::default()
                .query_type(kind)
                .query_count(count)
                .pipeline_statistics(flags);
            // SAFETY: a live device and a complete description.
            unsafe { device.raw.create_query_pool(&info, None) }
                .map_err(|e| device.fail("vkCreateQueryPool", "profiler", e))
        };
        let mut profiler = Profiler {
            device: device.clone(),
            timestamps: pool(vk::QueryType::TIMESTAMP, 2 * MAX_PASSES, Flags::empty())?,
            statistics: None,
            scopes: Vec::new(),
            gpu_passes: 0,
            counting: false,
            own: Duration::ZERO,
        };
        if device.has_statistics {
            let flags = Flags::FRAGMENT_SHADER_INVOCATIONS | Flags::COMPUTE_SHADER_INVOCATIONS;
            profiler.statistics =
                Some(pool(vk::QueryType::PIPELINE_STATISTICS, MAX_PASSES, flags)?);
        }
        Ok(profiler)
    }

    /// Forget the last frame. `counting` turns the pipeline statistics on.
    pub fn reset(&mut self, counting: bool) {
        let pools = [(Some(self.timestamps), 2 * MAX_PASSES), (self.statistics, MAX_PASSES)];
        for (pool, count) in pools {
            if let Some(pool) = pool {
                // SAFETY: the last submit that used the pool has been waited for.
                unsafe { self.device.raw.reset_query_pool(pool, 0, count) };
            }
        }
        self.scopes.clear();
        self.gpu_passes = 0;
        self.counting = counting && self.statistics.is_some();
        self.own = Duration::ZERO;
    }

    /// Scopes recorded since `reset`.
    pub fn len(&self) -> usize {
        self.scopes.len()
    }

    /// CPU time of the profiler itself per GPU pass since `reset`.
    pub fn own_per_pass(&self) -> Duration {
        self.own / self.gpu_passes.max(1)
    }

    /// Start timing a pass: a timestamp, then a barrier so that nothing of the pass starts earlier.
    pub fn begin(&mut self, commands: vk::CommandBuffer, name: &str) -> Result<()> {
        let start = Instant::now();
        if self.gpu_passes == MAX_PASSES {
            return Err(Error::Device(format!(
                "pass `{name}`: over {MAX_PASSES} passes in a submit"
            )));
        }
        let query = self.gpu_passes;
        let raw = &self.device.raw;
        let stage = vk::PipelineStageFlags2::ALL_COMMANDS;
        // SAFETY: recording, outside a rendering scope; the queries are below the pool's count and
        // were reset.
        unsafe {
            raw.cmd_write_timestamp2(commands, stage, self.timestamps, 2 * query);
            full_barrier(&self.device, commands);
            if let (true, Some(pool)) = (self.counting, self.statistics) {
                raw.cmd_begin_query(commands, pool, query, vk::QueryControlFlags::empty());
            }
        }
        self.scopes.push((name.to_owned(), Scope::Gpu(query)));
        self.gpu_passes += 1;
        self.own += start.elapsed();
        Ok(())
    }

    /// Stop timing the pass begun last: a barrier, then a timestamp.
    pub fn end(&mut self, commands: vk::CommandBuffer) {
        let start = Instant::now();
        let query = self.gpu_passes - 1;
        let raw = &self.device.raw;
        let stage = vk::PipelineStageFlags2::ALL_COMMANDS;
        // SAFETY: as in `begin`, which began this query.
        unsafe {
            if let (true, Some(pool)) = (self.counting, self.statistics) {
                raw.cmd_end_query(commands, pool, query);
            }
            full_barrier(&self.device, commands);
            raw.cmd_write_timestamp2(commands, stage, self.timestamps, 2 * query + 1);
        }
        self.own += start.elapsed();
    }

    /// Note a CPU scope.
    pub fn cpu(&mut self, name: &str, time: Duration) {
        self.scopes.push((name.to_owned(), Scope::Cpu(time)));
    }

    /// The times of a finished submit, in the order of recording.
    pub fn results(&self) -> Result<Vec<PassTime>> {
        let count = self.gpu_passes as usize;
        let fail = |e| self.device.fail("vkGetQueryPoolResults", "profiler", e);
        let flags = vk::QueryResultFlags::TYPE_64 | vk::QueryResultFlags::WAIT;
        let mut ticks = vec![0u64; 2 * count];
        let mut invocations = vec![[0u64; 2]; count];
        if count > 0 {
            // SAFETY: these queries were written by a submit that has been waited for; the slices
            // hold one element a query.
            unsafe {
                self.device
                    .raw
                    .get_query_pool_results(self.timestamps, 0, &mut ticks, flags)
                    .map_err(fail)?;
                if let (true, Some(pool)) = (self.counting, self.statistics) {
                    self.device
                        .raw
                        .get_query_pool_results(pool, 0, &mut invocations, flags)
                        .map_err(fail)?;
                }
            }
        }
        let mask = self.device.timestamp_mask;
        let milliseconds = |from: u64, to: u64| {
            ((to & mask).wrapping_sub(from & mask) & mask) as f64
                * self.device.timestamp_period
                * 1e-6
        };
        let mut begin_ms = 0.0;
        Ok(self
            .scopes
            .iter()
            .map(|(name, scope)| {
                let mut time = PassTime { name: name.clone(), ..Default::default() };
                match *scope {
                    Scope::Gpu(query) => {
                        let q = query as usize;
                        begin_ms = milliseconds(ticks[0], ticks[2 * q]);
                        time.gpu_ms = milliseconds(ticks[2 * q], ticks[2 * q + 1]);
                        time.invocations = invocations[q].iter().sum();
                    }
                    Scope::Cpu(duration) => time.cpu_ms = duration.as_secs_f64() * 1e3,
                }
                time.begin_ms = begin_ms;
                time
            })
            .collect())
    }
}

impl Drop for Profiler {
    fn drop(&mut self) {
        // SAFETY: the last submit that used the pools has been waited for.
        unsafe {
            self.device.raw.destroy_query_pool(self.timestamps, None);
            if let Some(pool) = self.statistics {
                self.device.raw.destroy_query_pool(pool, None);
            }
        }
    }
}

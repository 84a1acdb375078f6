//! Times of frames as a Chrome trace, for ui.perfetto.dev and chrome://tracing.

use std::path::Path;

use serde_json::{Value, json};

use super::engine::{FrameTimes, PassTime};
use super::output::write_file;
use crate::error::Result;

const CPU: u32 = 1;
const GPU: u32 = 2;

/// The trace: GPU passes and CPU scopes on two tracks, counters below, frames end to end.
pub fn trace(frames: &[(u32, FrameTimes)]) -> Value {
    let mut events = vec![
        metadata(CPU, "process_name", "CPU"),
        metadata(CPU, "thread_name", "scopes"),
        metadata(GPU, "process_name", "GPU"),
        metadata(GPU, "thread_name", "passes"),
    ];
    let mut begin_ms = 0.0;
    for (number, times) in frames {
        let prepare_ms = end_ms(&times.prepare);
        let frame_ms = times.frame_gpu_ms.max(end_ms(&times.passes));
        let name = format!("frame {number}");
        events.push(span(GPU, &name, begin_ms, prepare_ms + frame_ms, json!({"frame": number})));
        events.extend(times.prepare.iter().map(|pass| event(pass, begin_ms)));
        events.extend(times.passes.iter().map(|pass| event(pass, begin_ms + prepare_ms)));
        events.extend(times.counters.iter().map(|(name, count)| {
            json!({
                "name": name, "ph": "C", "pid": GPU, "tid": 1, "ts": 1e3 * begin_ms,
                "args": {name: count},
            })
        }));
        begin_ms += prepare_ms + frame_ms;
    }
    json!({"displayTimeUnit": "ms", "traceEvents": events})
}

/// When the last pass of a list ends, on the list's own clock.
fn end_ms(passes: &[PassTime]) -> f64 {
    passes.iter().map(|pass| pass.begin_ms + pass.gpu_ms + pass.cpu_ms).fold(0.0, f64::max)
}

fn event(pass: &PassTime, offset_ms: f64) -> Value {
    let (pid, duration) = if pass.cpu_ms > 0.0 { (CPU, pass.cpu_ms) } else { (GPU, pass.gpu_ms) };
    let details = json!({"invocations": pass.invocations});
    span(pid, &pass.name, offset_ms + pass.begin_ms, duration, details)
}

/// A complete event; the format counts in microseconds.
fn span(pid: u32, name: &str, begin_ms: f64, duration_ms: f64, details: Value) -> Value {
    json!({
        "name": name, "ph": "X", "pid": pid, "tid": 1,
        "ts": 1e3 * begin_ms, "dur": 1e3 * duration_ms, "args": details,
    })
}

fn metadata(pid: u32, kind: &str, name: &str) -> Value {
    json!({"name": kind, "ph": "M", "pid": pid, "tid": 1, "args": {"name": name}})
}

/// Writes the trace.
///
/// # Errors
/// [`crate::error::Error::Output`].
pub fn write_trace(path: &Path, frames: &[(u32, FrameTimes)]) -> Result<()> {
    write_file(path, |file| Ok(serde_json::to_writer(file, &trace(frames))?))
}

#[cfg(test)]
mod tests {
    use super::super::rows::tests::pass;
    use super::*;

    #[test]
    fn frames_follow_each_other_and_passes_lie_within_them() {
        let scope = PassTime { cpu_ms: 2.0, gpu_ms: 0.0, ..pass("octree", 0.0, 0.0) };
        let gpu = |name: &str, begin| PassTime { cpu_ms: 0.0, ..pass(name, 1.0, begin) };
        let frame = FrameTimes {
            prepare: vec![scope],
            passes: vec![gpu("a", 0.0), gpu("b", 1.0)],
            frame_gpu_ms: 2.0,
            prepare_bytes: 0,
            counters: vec![("rays".into(), 7)],
        };
        let trace = trace(&[(3, frame.clone()), (4, frame)]);
        let events = trace["traceEvents"].as_array().unwrap();
        let named = |name: &str| -> Vec<(u64, f64, f64)> {
            let events = events.iter().filter(|e| e["name"] == name && e["ph"] == "X");
            let of = |e: &Value, key: &str| e[key].as_f64().unwrap();
            events.map(|e| (e["pid"].as_u64().unwrap(), of(e, "ts"), of(e, "dur"))).collect()
        };
        assert_eq!(named("frame 3"), [(2, 0.0, 4000.0)]);
        assert_eq!(named("frame 4"), [(2, 4000.0, 4000.0)]);
        assert_eq!(named("octree"), [(1, 0.0, 2000.0), (1, 4000.0, 2000.0)]);
        assert_eq!(named("b"), [(2, 3000.0, 1000.0), (2, 7000.0, 1000.0)]);
        assert_eq!(events.iter().filter(|e| e["ph"] == "C").count(), 2);
        assert_eq!(events.iter().filter(|e| e["ph"] == "M").count(), 4);
    }
}

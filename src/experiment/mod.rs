//! Running a case on a scene, and the results it leaves.

pub mod clock;
mod dump_file;
pub mod engine;
pub mod frame_file;
pub mod output;
pub mod results;
pub mod results_file;

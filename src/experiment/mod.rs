//! Running a case on a scene, and the results it leaves.

pub mod engine;
pub mod frame_file;
pub mod output;

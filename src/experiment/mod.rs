//! Running a case on a scene, and the results it leaves.

pub mod bench;
pub mod clock;
pub mod comparison;
pub mod diff;
mod dump_file;
pub mod engine;
pub mod evidence;
pub mod film;
pub mod frame_file;
pub mod lab;
pub mod output;
pub mod panels;
mod part;
pub mod path;
pub mod probe;
pub mod results;
pub mod results_file;
mod rows;
mod runner;
pub mod sweep;
pub mod timing;
pub mod trace;

//! How far a frame is from the truth, and how sure a timing is.

pub mod statistics;

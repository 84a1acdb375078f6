//! How far a record is from the truth, and how sure a timing is. Compares two CPU records and knows
//! no method.

pub mod accuracy;
pub mod colour;
mod displacement;
mod field;
mod judge;
pub mod ratio;
mod root;
pub mod statistics;
mod tree;

pub use accuracy::{Accuracy, BadShare, Class, Flip, Maps, Quantiles, accuracy};

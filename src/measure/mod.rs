//! How far a record is from the truth, how steady along a path, and how sure a timing is. Compares CPU
//! records and knows no method.

pub mod accuracy;
pub mod colour;
mod displacement;
mod drawn;
mod field;
mod groups;
mod judge;
mod mirrors;
pub mod ratio;
mod root;
pub mod stability;
pub mod statistics;
mod track;
mod trail;
mod tree;
mod usual;

pub use accuracy::{Accuracy, BadShare, Class, Flip, Maps, Quantiles, accuracy};
pub use groups::{
    GroupAccuracy, OrderAccuracy, ReflectorAccuracy, Second, SecondAccuracy, mean_by_order,
    mean_by_reflector, mean_by_second,
};
pub use stability::{Jitter, PathFrame, PathMeasure, Stability};

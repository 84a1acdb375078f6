//! How far a frame is from the truth, and how sure a timing is.

pub mod statistics;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// Stand-in until the measures are merged.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
pub struct Accuracy {
    pub bad_share: BTreeMap<String, f64>,
    pub covered: f64,
}

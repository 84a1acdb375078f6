//! mirrorbench: given a curved mirror, which scene point does each of its pixels show, and what
//! does finding it cost?
//!
//! The floors, bottom to top; an import never points up:
//! [`geometry`], [`scene`], [`truth`] and [`gpu`] side by side, [`stages`], [`methods`],
//! [`measure`], [`experiment`], [`cli`]. [`error`] is the ground they stand on.
#![deny(unsafe_code)]

pub mod error;

pub mod geometry;
pub mod scene;

#[allow(unsafe_code)] // the only floor that speaks to Vulkan
pub mod gpu;
pub mod truth;

pub mod stages;

pub mod methods;

pub mod measure;

pub mod experiment;

pub mod cli;

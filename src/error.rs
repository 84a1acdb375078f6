//! One error type for the whole crate; its kind decides the exit code a command ends with.

/// What went wrong, in words a user can act on.
///
/// The kinds are those a script wants to tell apart; [`Error::exit_code`] maps them.
#[derive(Debug, thiserror::Error)]
pub enum Error {
    /// A threshold the user asked for was not met.
    #[error("{0}")]
    Threshold(String),
    /// An unknown method, scene, key or value; the message lists what is valid.
    #[error("{0}")]
    Usage(String),
    /// No usable Vulkan device, or one that lacks a feature or a limit.
    #[error("{0}")]
    Device(String),
    /// A scene file or an asset is missing, malformed or out of range.
    #[error("{0}")]
    Scene(String),
    /// The Vulkan validation layers spoke up.
    #[error("{0}")]
    Validation(String),
    /// A result could not be written.
    #[error("{0}")]
    Output(String),
    /// A shader did not compile or bind: a fault of the program, or of an edited `--shader-dir`.
    #[error("{0}")]
    Shader(String),
}

pub type Result<T, E = Error> = std::result::Result<T, E>;

impl Error {
    /// The process exit code, documented in the README.
    pub fn exit_code(&self) -> u8 {
        match self {
            Error::Threshold(_) => 1,
            Error::Usage(_) => 2,
            Error::Device(_) => 3,
            Error::Scene(_) => 4,
            Error::Validation(_) => 5,
            Error::Output(_) => 6,
            Error::Shader(_) => 7,
        }
    }

    /// The error an output path gives: names the path and what the system said.
    pub fn output(path: &std::path::Path, cause: impl std::fmt::Display) -> Self {
        Error::Output(format!("cannot write {}: {cause}", path.display()))
    }
}

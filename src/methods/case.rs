//! A case: a configured method, written `METHOD[@VARIANT][:key=value,...]`.

use super::Values;

/// A parsed case: one selection, or a hybrid's list of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// The canonical text: variant named, parameters that differ from the defaults, table order.
    pub text: String,
    /// In order; the first whose pattern matches a reflector's name serves it.
    pub parts: Vec<Selected>,
}

/// A method for the reflectors whose names match a pattern.
#[derive(Clone, Debug, PartialEq)]
pub struct Selected {
    /// `*` and `?` wildcards; "*" for a case that is not a hybrid.
    pub reflectors: String,
    pub method: &'static str,
    pub variant: &'static str,
    pub values: Values,
}

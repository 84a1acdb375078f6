//! A method's parameters: one table gives the flag, the sweep key, `describe` and the check.

/// One parameter of a method.
pub struct Param {
    pub name: &'static str,
    pub kind: Kind,
    /// One default for all variants, or one a variant in the order of `MethodInfo::variants`.
    pub defaults: &'static [&'static str],
    /// Only meaningful when another parameter has one of these values.
    pub needs: Option<(&'static str, &'static [&'static str])>,
    /// One line, with unit.
    pub doc: &'static str,
}

/// What values a parameter takes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    Integer { min: i64, max: i64 },
    Real { min: f64, max: f64 },
    Choice(&'static [&'static str]),
}

/// The resolved parameters of a case: every parameter of the method, checked, in table order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Values(pub Vec<(&'static str, String)>);

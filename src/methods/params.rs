//! A method's parameters: one table gives the flag, the sweep key, `describe` and the check.

use std::fmt;

/// One parameter of a method.
#[derive(Debug)]
pub struct Param {
    pub name: &'static str,
    pub kind: Kind,
    /// One default for all variants, or one a variant in the order of `MethodInfo::variants`.
    pub defaults: &'static [&'static str],
    /// Only meaningful when another parameter (or "variant") has one of these values.
    pub needs: Option<(&'static str, &'static [&'static str])>,
    /// One line, with unit.
    pub doc: &'static str,
}

/// Where a method of image space answers its pixels, see [`crate::stages::PixelPass`].
pub const STAGE: Param = Param {
    name: "stage",
    kind: Kind::Choice(&["compute", "fragment"]),
    defaults: &["compute"],
    needs: None,
    doc: "where pixels are answered: a compute shader over their list, or a fragment shader through \
          the stencil",
};

/// Where a forward method draws a vertex it has found the reflection point of.
pub const IMAGE: Param = Param {
    name: "image",
    kind: Kind::Choice(&["mirror", "push"]),
    defaults: &["mirror", "push"],
    needs: None,
    doc: "where a vertex is drawn: mirrored in the plane found, or pushed along the eye ray",
};

/// How far a fragment of a forward method may be off.
pub const RESIDUAL_PX: Param = Param {
    name: "residual_px",
    kind: Kind::Real { min: 0.0, max: 1000.0 },
    defaults: &["0", "1"],
    needs: None,
    doc: "pixels a fragment may break the law of reflection by before it is flagged; 0: none is",
};

/// What values a parameter takes; bounds are inclusive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Kind {
    Integer {
        min: i64,
        max: i64,
    },
    /// `auto`, sized from the scene and the view, or an integer that forces it.
    IntegerOrAuto {
        min: i64,
        max: i64,
    },
    Real {
        min: f64,
        max: f64,
    },
    Choice(&'static [&'static str]),
}

/// The value of a [`Kind::IntegerOrAuto`] that leaves the choice to the method.
pub const AUTO: &str = "auto";

impl Kind {
    /// The canonical spelling of `text`, or `None` where it is not a value of this kind.
    pub fn canonical(self, text: &str) -> Option<String> {
        match self {
            Kind::Integer { min, max } => {
                let value: i64 = text.parse().ok()?;
                (min..=max).contains(&value).then(|| value.to_string())
            }
            Kind::IntegerOrAuto { .. } if text == AUTO => Some(AUTO.to_owned()),
            Kind::IntegerOrAuto { min, max } => Kind::Integer { min, max }.canonical(text),
            Kind::Real { min, max } => {
                // + 0.0 turns a negative zero into zero: one spelling a value.
                let value = text.parse::<f64>().ok()? + 0.0;
                (min..=max).contains(&value).then(|| value.to_string())
            }
            Kind::Choice(choices) => choices.contains(&text).then(|| text.to_owned()),
        }
    }
}

impl fmt::Display for Kind {
    /// What is valid, in words.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Kind::Integer { min, max } => write!(f, "an integer from {min} to {max}"),
            Kind::IntegerOrAuto { min, max } => {
                write!(f, "{AUTO} or an integer from {min} to {max}")
            }
            Kind::Real { min, max } => write!(f, "a number from {min} to {max}"),
            Kind::Choice(choices) => write!(f, "one of {}", choices.join(", ")),
        }
    }
}

impl Param {
    /// The canonical default for the variant at this place of `MethodInfo::variants`.
    pub fn default_for(&self, variant: usize) -> String {
        let text = match self.defaults {
            [one] => one,
            many => many[variant],
        };
        self.kind.canonical(text).unwrap_or_else(|| {
            panic!("method table: the default {}={text} is not {}", self.name, self.kind)
        })
    }
}

/// The resolved parameters of a case: every parameter of the method, checked, in table order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Values(pub Vec<(&'static str, String)>);

/// Getters. They panic when the method's table has no such parameter of such a kind: a fault of
/// the method's code, which no user input can cause.
impl Values {
    pub fn get(&self, name: &str) -> &str {
        let found = self.0.iter().find(|(key, _)| *key == name);
        found.map(|(_, value)| value.as_str()).unwrap_or_else(|| {
            panic!("parameter {name} is not in the method's table");
        })
    }

    /// Whether the choice `name` is `value`.
    pub fn is(&self, name: &str, value: &str) -> bool {
        self.get(name) == value
    }

    pub fn u32(&self, name: &str) -> u32 {
        self.number(name)
    }

    pub fn i64(&self, name: &str) -> i64 {
        self.number(name)
    }

    pub fn f32(&self, name: &str) -> f32 {
        self.number(name)
    }

    pub fn f64(&self, name: &str) -> f64 {
        self.number(name)
    }

    /// The integer that forces a [`Kind::IntegerOrAuto`], or `None` for `auto`.
    pub fn forced_u32(&self, name: &str) -> Option<u32> {
        (!self.is(name, AUTO)).then(|| self.u32(name))
    }

    fn number<T: std::str::FromStr>(&self, name: &str) -> T {
        let value = self.get(name);
        value.parse().unwrap_or_else(|_| {
            panic!("parameter {name}={value} does not fit {}", std::any::type_name::<T>())
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_have_one_spelling() {
        let integer = Kind::Integer { min: 1, max: 9 };
        assert_eq!(integer.canonical("+07").as_deref(), Some("7"));
        for bad in ["0", "10", "1.0", "", "x", "99999999999999999999"] {
            assert_eq!(integer.canonical(bad), None, "{bad}");
        }
        let real = Kind::Real { min: -1.0, max: 1.0 };
        assert_eq!(real.canonical("5e-1").as_deref(), Some("0.5"));
        assert_eq!(real.canonical("-0").as_deref(), Some("0"));
        for bad in ["nan", "inf", "1.01", "one"] {
            assert_eq!(real.canonical(bad), None, "{bad}");
        }
        let auto = Kind::IntegerOrAuto { min: 16, max: 64 };
        assert_eq!(auto.canonical("auto").as_deref(), Some("auto"));
        assert_eq!(auto.canonical("32").as_deref(), Some("32"));
        assert_eq!(auto.canonical("8"), None);
        assert_eq!(Kind::Choice(&["a", "b"]).canonical("c"), None);
    }

    #[test]
    fn getters_read_what_the_parser_wrote() {
        let values = Values(vec![
            ("size", "auto".into()),
            ("layers", "3".into()),
            ("threshold", "0.25".into()),
            ("search", "vector".into()),
        ]);
        assert_eq!(values.forced_u32("size"), None);
        assert_eq!(values.forced_u32("layers"), Some(3));
        assert_eq!((values.u32("layers"), values.i64("layers")), (3, 3));
        assert_eq!((values.f32("threshold"), values.f64("threshold")), (0.25, 0.25));
        assert!(values.is("search", "vector") && !values.is("search", "image"));
    }
}

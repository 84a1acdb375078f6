//! A case: a configured method, written `METHOD[@VARIANT][:key=value,...]`.
//!
//! A hybrid gives reflectors different methods: `teapot.body=reflection-morphing;*=environment-map`.

use super::nearest::valid_names;
use super::{MethodInfo, Param, Values};
use crate::error::{Error, Result};
use crate::scene::matches_pattern;

/// A parsed case: one selection, or a hybrid's list of them.
#[derive(Clone, Debug, PartialEq)]
pub struct Case {
    /// The canonical text: the variant where the method has several, parameters that differ from
    /// the defaults, in table order.
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

/// The longest folder name a case gives.
const FOLDER_BYTES: usize = 120;

impl Case {
    /// Reads a case. Errors are [`Error::Usage`] and list what is valid instead.
    pub fn parse(text: &str, methods: &[&'static MethodInfo]) -> Result<Case> {
        Self::build(text, methods).map_err(|cause| usage(text, &cause))
    }

    fn build(text: &str, methods: &[&'static MethodInfo]) -> Result<Case, String> {
        let mut parts: Vec<Selected> = Vec::new();
        let mut texts = Vec::new();
        for part in text.split(';') {
            let (pattern, case) = split_pattern(part.trim())?;
            let covered = |p: &Selected| p.reflectors == "*" || p.reflectors == pattern;
            if parts.iter().any(covered) {
                return Err(format!("`{pattern}` is never reached: an earlier part takes it all"));
            }
            let (selected, canonical) = select(pattern, case, methods)?;
            texts.push(match (pattern, text.contains(';')) {
                ("*", false) => canonical,
                _ => format!("{pattern}={canonical}"),
            });
            parts.push(selected);
        }
        Ok(Case { text: texts.join(";"), parts })
    }

    /// The case with one parameter of every part that uses `method` set, checked anew.
    pub fn with(
        &self,
        method: &str,
        key: &str,
        value: &str,
        methods: &[&'static MethodInfo],
    ) -> Result<Case> {
        let parts = self.parts.iter().zip(self.text.split(';')).map(|(part, text)| {
            if part.method != method {
                return text.to_owned();
            }
            let (head, pairs) = text.split_once(':').unwrap_or((text, ""));
            let kept = pairs.split(',').filter(|pair| {
                !pair.is_empty() && pair.split_once('=').is_none_or(|(name, _)| name != key)
            });
            let pairs: Vec<&str> = kept.collect();
            let changed = format!("{key}={value}");
            let pairs: Vec<&str> = pairs.into_iter().chain([changed.as_str()]).collect();
            format!("{head}:{}", pairs.join(","))
        });
        Case::parse(&parts.collect::<Vec<_>>().join(";"), methods)
    }

    /// Which part serves a reflector of this name.
    pub fn part_for(&self, reflector: &str) -> Option<usize> {
        self.parts.iter().position(|part| matches_pattern(&part.reflectors, reflector))
    }

    /// What a part's parameter or counter is called in results: `PATTERN/name` in a hybrid.
    pub fn column(&self, part: &Selected, name: &str) -> String {
        let is_hybrid = self.parts.len() > 1 || part.reflectors != "*";
        if is_hybrid { format!("{}/{name}", part.reflectors) } else { name.to_owned() }
    }

    /// Whether any part uses this method.
    pub fn uses(&self, method: &str) -> bool {
        self.parts.iter().any(|part| part.method == method)
    }

    /// The text as a name for a folder.
    pub fn folder(&self) -> String {
        let plain =
            |c: char| if c.is_ascii_alphanumeric() || "@.=,-".contains(c) { c } else { '_' };
        let name: String = self.text.chars().map(plain).collect();
        if name.len() <= FOLDER_BYTES {
            return name;
        }
        let hash = blake3::hash(self.text.as_bytes()).to_hex();
        format!("{}-{}", &name[..FOLDER_BYTES - 17], &hash[..16])
    }
}

fn usage(text: &str, cause: &str) -> Error {
    Error::Usage(format!("case `{text}`: {cause}"))
}

/// Splits `pattern=case`; a part without a pattern is for all reflectors.
fn split_pattern(part: &str) -> Result<(&str, &str), String> {
    let case_begins = part.find(':').unwrap_or(part.len());
    let Some((pattern, case)) =
        part[..case_begins].find('=').map(|at| (&part[..at], &part[at + 1..]))
    else {
        return Ok(("*", part));
    };
    let allowed = |c: char| c.is_ascii_alphanumeric() || "._-*?".contains(c);
    if pattern.is_empty() || !pattern.chars().all(allowed) {
        return Err(format!(
            "`{pattern}` is no reflector pattern; valid: letters, digits and . _ - * ?"
        ));
    }
    Ok((pattern, case))
}

/// Reads `METHOD[@VARIANT][:key=value,...]` and its canonical text.
fn select(
    pattern: &str,
    text: &str,
    methods: &[&'static MethodInfo],
) -> Result<(Selected, String), String> {
    let (head, pairs) = text.split_once(':').map_or((text, None), |(h, p)| (h, Some(p)));
    let (id, variant) = head.split_once('@').map_or((head, None), |(m, v)| (m, Some(v)));
    let info = methods.iter().find(|info| info.id == id).ok_or_else(|| {
        format!("there is no method `{id}`; {}", valid_names(id, methods.iter().map(|m| m.id)))
    })?;
    let rank = match variant {
        None => 0,
        Some(name) => info.variants.iter().position(|v| *v == name).ok_or_else(|| {
            let valid = valid_names(name, info.variants.iter().copied());
            format!("{id} has no variant `{name}`; {valid}")
        })?,
    };
    let defaults: Vec<String> = info.params.iter().map(|p| p.default_for(rank)).collect();
    let mut given: Vec<Option<String>> = vec![None; info.params.len()];
    for pair in pairs.map(|p| p.split(',')).into_iter().flatten() {
        read_pair(info, pair.trim(), &mut given)?;
    }
    let values = info.params.iter().zip(&given).zip(&defaults);
    let values =
        values.map(|((p, given), default)| (p.name, given.as_ref().unwrap_or(default).clone()));
    let values = Values(values.collect());
    let variant = info.variants[rank];
    for (param, _) in info.params.iter().zip(&given).filter(|(_, given)| given.is_some()) {
        check_meaning(info, param, variant, &values)?;
    }
    let head = if info.variants.len() > 1 { format!("{id}@{variant}") } else { id.to_owned() };
    let differing =
        values.0.iter().zip(&defaults).filter(|((_, value), default)| value != *default);
    let pairs: Vec<String> = differing.map(|((key, value), _)| format!("{key}={value}")).collect();
    let canonical = if pairs.is_empty() { head } else { format!("{head}:{}", pairs.join(",")) };
    let selected = Selected { reflectors: pattern.to_owned(), method: info.id, variant, values };
    Ok((selected, canonical))
}

/// Checks one `key=value` against the table and notes it in `given`, which is in table order.
fn read_pair(info: &MethodInfo, pair: &str, given: &mut [Option<String>]) -> Result<(), String> {
    let (key, value) = pair
        .split_once('=')
        .ok_or_else(|| format!("`{pair}` is not key=value; {}", valid_names(pair, keys(info))))?;
    let (key, value) = (key.trim(), value.trim());
    let at = info.params.iter().position(|p| p.name == key).ok_or_else(|| {
        format!("{} has no parameter `{key}`; {}", info.id, valid_names(key, keys(info)))
    })?;
    let kind = info.params[at].kind;
    let value = kind
        .canonical(value)
        .ok_or_else(|| format!("{key}=`{value}` is out of range; valid: {kind}"))?;
    match given[at].replace(value) {
        None => Ok(()),
        Some(_) => Err(format!("{key} is given twice")),
    }
}

fn keys(info: &MethodInfo) -> impl Iterator<Item = &'static str> {
    info.params.iter().map(|p| p.name)
}

/// Refuses a parameter whose `needs` (and theirs in turn) the other values do not meet.
fn check_meaning(
    info: &MethodInfo,
    param: &Param,
    variant: &str,
    values: &Values,
) -> Result<(), String> {
    let mut asking = param;
    while let Some((key, valid)) = asking.needs {
        let value = if key == "variant" { variant } else { values.get(key) };
        if !valid.contains(&value) {
            return Err(format!(
                "{} means nothing with {key}={value}; it needs {key}={}",
                param.name,
                valid.join(" or ")
            ));
        }
        match info.params.iter().find(|p| p.name == key) {
            Some(next) => asking = next,
            None => break,
        }
    }
    Ok(())
}

//! `list` and `describe`: what there is to choose from.

use clap::ValueEnum;
use serde_json::{Map, Value, json};

use super::console::{Console, table};
use crate::error::{Error, Result};
use crate::gpu;
use crate::methods::nearest::valid_names;
use crate::methods::{Family, Kind, MethodInfo, Param};
use crate::scene;

/// What `list` lists.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub enum What {
    Methods,
    Scenes,
    Devices,
}

#[derive(Debug, clap::Args)]
pub struct ListArgs {
    pub what: What,
    /// One JSON object a line on stdout; text for people goes to stderr
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, clap::Args)]
pub struct DescribeArgs {
    /// A method of `list methods`
    pub method: String,
    /// A JSON object on stdout; text for people goes to stderr
    #[arg(long)]
    pub json: bool,
}

pub fn list(what: What, methods: &[&'static MethodInfo], console: &Console) -> Result<()> {
    match what {
        What::Methods => list_methods(methods, console),
        What::Scenes => list_scenes(console),
        What::Devices => list_devices(console),
    }
}

fn list_methods(methods: &[&'static MethodInfo], console: &Console) -> Result<()> {
    let mut rows = vec![row(["METHOD", "VARIANTS", "FAMILY", "TITLE"])];
    for info in methods {
        rows.push(row([info.id, &info.variants.join(", "), family(info.family), info.title]));
        console.object(&card(info))?;
    }
    console.report(&table(&rows))
}

fn list_scenes(console: &Console) -> Result<()> {
    let mut rows = vec![row(["SCENE", "ABOUT"])];
    for (name, about) in scene::list()? {
        rows.push(row([&name, &about]));
        console.object(&json!({"scene": name, "about": about}))?;
    }
    console.report(&table(&rows))
}

fn list_devices(console: &Console) -> Result<()> {
    let mut rows = vec![row(["INDEX", "NAME", "DRIVER", "VULKAN", "KIND", "RAY QUERY"])];
    for device in gpu::list_devices()? {
        let kind = if device.is_software { "software" } else { "hardware" };
        let index = device.index.to_string();
        let rays = if device.ray_query { "yes" } else { "no" };
        rows.push(row([&index, &device.name, &device.driver, &device.api, kind, rays]));
        console.object(&device)?;
    }
    console.report(&table(&rows))
}

pub fn describe(method: &str, methods: &[&'static MethodInfo], console: &Console) -> Result<()> {
    let info = methods.iter().find(|info| info.id == method).ok_or_else(|| {
        let valid = valid_names(method, methods.iter().map(|info| info.id));
        Error::Usage(format!("there is no method `{method}`; {valid}"))
    })?;
    console.object(&card(info))?;
    console.report(&description(info))
}

/// The card as text: title, paper, parameters, limits, passes.
fn description(info: &MethodInfo) -> String {
    let mut text = format!("{}: {}\n\n", info.id, info.title);
    let or_none = |list: &[&str]| if list.is_empty() { "none".into() } else { list.join(", ") };
    let facts = [
        ("paper", info.paper.to_owned()),
        ("family", family(info.family).to_owned()),
        ("variants", info.variants.join(", ")),
        ("limits", info.limits.to_owned()),
        ("passes", or_none(info.passes)),
        ("counters", or_none(info.counters)),
        ("flags doubts", if info.flags { "yes" } else { "no" }.to_owned()),
        ("prepares again", or_none(&changes(info))),
    ];
    let facts = facts.map(|(name, value)| vec![format!("  {name}"), value]);
    text.push_str(&table(&facts));
    text.push_str("\n\n");
    if info.params.is_empty() {
        text.push_str("no parameters");
        return text;
    }
    let mut rows = vec![row(["  PARAMETER", "DEFAULT", "VALID", "MEANING"])];
    rows.extend(info.params.iter().map(|param| {
        let name = format!("  {}", param.name);
        row([&name, &param.defaults.join(", "), &valid(param), param.doc])
    }));
    text.push_str(&table(&rows));
    text
}

fn changes(info: &MethodInfo) -> Vec<&'static str> {
    let depends = info.depends;
    let all = [
        (depends.objects, "when objects move"),
        (depends.reflectors, "when reflectors move"),
        (depends.shading, "when the light changes"),
    ];
    all.into_iter().filter(|(depends, _)| *depends).map(|(_, name)| name).collect()
}

fn valid(param: &Param) -> String {
    match param.needs {
        None => param.kind.to_string(),
        Some((key, values)) => format!("{}, with {key}={}", param.kind, values.join("|")),
    }
}

/// The card as JSON.
fn card(info: &MethodInfo) -> Value {
    json!({
        "method": info.id, "title": info.title, "paper": info.paper,
        "family": family(info.family), "variants": info.variants, "limits": info.limits,
        "passes": info.passes, "counters": info.counters, "flags": info.flags,
        "depends": {
            "objects": info.depends.objects, "reflectors": info.depends.reflectors,
            "shading": info.depends.shading,
        },
        "params": info.params.iter().map(|param| param_card(info, param)).collect::<Vec<_>>(),
    })
}

fn param_card(info: &MethodInfo, param: &Param) -> Value {
    let kind = match param.kind {
        Kind::Integer { min, max } => json!({"integer": [min, max]}),
        Kind::IntegerOrAuto { min, max } => json!({"integer_or_auto": [min, max]}),
        Kind::Real { min, max } => json!({"real": [min, max]}),
        Kind::Choice(choices) => json!({"choice": choices}),
    };
    let defaults = info.variants.iter().enumerate();
    let defaults: Map<String, Value> =
        defaults.map(|(i, v)| ((*v).to_owned(), param.default_for(i).into())).collect();
    let needs = param.needs.map(|(key, values)| json!({key: values}));
    json!({
        "name": param.name, "kind": kind, "defaults": defaults, "needs": needs, "doc": param.doc,
    })
}

fn family(family: Family) -> &'static str {
    match family {
        Family::Baseline => "baseline",
        Family::ImageSpace => "image space",
        Family::FeedForward => "feed-forward",
        Family::RayTracing => "ray tracing",
    }
}

fn row<const N: usize>(cells: [&str; N]) -> Vec<String> {
    cells.map(str::to_owned).to_vec()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::methods::METHODS;

    #[test]
    fn every_method_has_a_card_whose_table_is_sound() {
        for info in METHODS {
            assert!(description(info).contains(info.title));
            assert!(card(info).to_string().contains(info.id));
            assert!(!info.variants.is_empty(), "{} has no variant", info.id);
            for param in info.params {
                let counts = [1, info.variants.len()];
                assert!(counts.contains(&param.defaults.len()), "{}.{}", info.id, param.name);
                let (key, values) = param.needs.unwrap_or(("variant", &[]));
                let asked = info.params.iter().find(|p| p.name == key);
                assert!(key == "variant" || asked.is_some(), "{} needs {key}", param.name);
                let kind = asked.map_or(Kind::Choice(info.variants), |p| p.kind);
                assert!(values.iter().all(|v| kind.canonical(v).is_some()), "{}", param.name);
            }
        }
    }
}

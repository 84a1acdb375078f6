//! The house has floors (see `src/lib.rs`): an import never points up, truth and GPU do not know
//! each other, the measures know no method, and only the GPU floor is unsafe.

use std::fs;
use std::path::{Path, PathBuf};

const FLOORS: [(&str, u32); 10] = [
    ("error", 0),
    ("geometry", 1),
    ("scene", 2),
    ("truth", 3),
    ("gpu", 3),
    ("stages", 4),
    ("methods", 5),
    ("measure", 6),
    ("experiment", 7),
    ("cli", 8),
];

/// Below, and yet not to be known.
const STRANGERS: [(&str, &str); 3] =
    [("measure", "methods"), ("measure", "stages"), ("measure", "gpu")];

fn floor(name: &str) -> Option<u32> {
    FLOORS.iter().find(|(n, _)| *n == name).map(|(_, height)| *height)
}

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else {
            found.push(path);
        }
    }
}

/// The modules of this crate that a text names.
fn named(text: &str) -> impl Iterator<Item = &str> {
    text.split("crate::").skip(1).filter_map(|rest| {
        let end = rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(rest.len());
        Some(&rest[..end]).filter(|name| floor(name).is_some())
    })
}

#[test]
fn no_import_points_up() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut wrong = Vec::new();
    let mut imports = 0;
    for (from, height) in FLOORS.iter().filter(|(name, _)| *name != "error") {
        let mut files = Vec::new();
        sources(&root.join(from), &mut files);
        for file in files {
            let text = fs::read_to_string(&file).unwrap();
            // Documentation may speak of anything.
            let code: Vec<&str> =
                text.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
            for to in named(&code.join("\n")) {
                imports += 1;
                let up = floor(to) >= Some(*height) && to != *from;
                if up || STRANGERS.contains(&(*from, to)) {
                    wrong.push(format!("{} names crate::{to}", file.display()));
                }
            }
        }
    }
    assert!(imports > 100, "only {imports} imports seen");
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn shared_shader_types_declare_no_bindings() {
    let mut files = Vec::new();
    sources(&Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders/common"), &mut files);
    assert!(!files.is_empty());
    for file in files {
        let text = fs::read_to_string(&file).unwrap();
        assert!(!text.contains("@binding"), "{} binds", file.display());
    }
}

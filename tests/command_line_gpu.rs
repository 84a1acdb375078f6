//! The command line on a real device: the README's commands, what a row holds, what ends how.

use std::fs;
use std::path::Path;
use std::process::{Command as Process, Stdio};
use std::time::{Duration, Instant};

use assert_cmd::Command;
use serde_json::Value;
use tempfile::TempDir;

const SMALL: [&str; 2] = ["--size", "160x90"];

fn command() -> Command {
    let mut command = Command::cargo_bin("mirrorbench").unwrap();
    command.env("MIRRORBENCH_CACHE", env!("CARGO_TARGET_TMPDIR"));
    command
}

/// Run with validation in a folder of its own.
fn run(arguments: &[&str], folder: &Path) -> String {
    let out = folder.to_str().unwrap();
    let assert =
        command().args(arguments).args(["--vulkan-validation", "--out", out]).assert().success();
    String::from_utf8(assert.get_output().stdout.clone()).unwrap()
}

fn rows(folder: &Path) -> Vec<Value> {
    let text = fs::read_to_string(folder.join("results.jsonl")).unwrap();
    text.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

fn ends(arguments: &[&str], code: i32, words: &[&str]) {
    let assert = command().args(arguments).assert().code(code);
    let text = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
    for word in words {
        assert!(text.contains(word), "{arguments:?} said no `{word}`: {text}");
    }
}

#[test]
fn doctor_and_devices_know_the_device() {
    let text = command().args(["list", "devices", "--json"]).assert().success();
    let text = String::from_utf8(text.get_output().stdout.clone()).unwrap();
    let device: Value = serde_json::from_str(text.lines().next().unwrap()).unwrap();
    let doctor = command().args(["doctor"]).assert().success();
    let report = String::from_utf8(doctor.get_output().stdout.clone()).unwrap();
    assert!(report.contains(device["name"].as_str().unwrap()), "{report}");
    let rays = if device["ray_query"].as_bool().unwrap() { "yes" } else { "no" };
    let line = report.lines().find(|line| line.starts_with("ray query")).unwrap();
    assert!(line.ends_with(rays), "{line}");
}

#[test]
fn a_benched_row_has_every_field_but_stability() {
    let folder = TempDir::new().unwrap();
    let mut arguments = vec!["bench", "--scene", "columns", "--scene", "patow-room"];
    arguments.extend(["--case", "environment-map", "--frames", "0..3", "--repeat", "3", "--json"]);
    arguments.extend(SMALL);
    let printed = run(&arguments, folder.path());
    let rows = rows(folder.path());
    assert_eq!(rows.len(), 2);
    assert_eq!(printed.lines().count(), 2, "{printed}");
    for row in rows {
        for field in [
            "schema_version",
            "run",
            "commit",
            "scene",
            "case",
            "method",
            "variant",
            "params",
            "fallback",
            "size",
            "frames",
            "device",
            "reflector_pixels",
            "prepare",
            "frame_gpu_ms",
            "passes",
            "counters",
            "accuracy",
            "clock",
        ] {
            assert!(!row[field].is_null(), "{field} is null in {row}");
        }
        assert!(row["stability"].is_null());
        assert_eq!(row["software_timing"], row["device"]["is_software"]);
        assert_eq!(row["counters"]["lookups"], row["reflector_pixels"]);
        assert!(row["prepare"]["bytes"].as_u64().unwrap() > 1 << 20);
        assert!(row["accuracy"]["flip"]["mean"].as_f64().unwrap() > 0.0);
    }
}

#[test]
fn profile_writes_a_trace() {
    let folder = TempDir::new().unwrap();
    let trace = folder.path().join("trace.json");
    let arguments = [
        "profile",
        "--scene",
        "columns",
        "--case",
        "environment-map",
        "--repeat",
        "2",
        "--frames",
        "0..2",
    ];
    let table = run(
        &[&arguments[..], &SMALL, &["--trace", trace.to_str().unwrap()]].concat(),
        folder.path(),
    );
    assert!(table.contains("environment-map/reflect"), "{table}");
    let trace: Value = serde_json::from_str(&fs::read_to_string(trace).unwrap()).unwrap();
    let events = trace["traceEvents"].as_array().unwrap();
    assert!(events.iter().any(|e| e["name"] == "composite" && e["ph"] == "X"));
}

#[test]
fn render_leaves_pictures_evidence_and_dumps() {
    let folder = TempDir::new().unwrap();
    let arguments =
        ["render", "--scene", "lecture", "--case", "environment-map", "--record", "full"];
    run(&[&arguments[..], &SMALL, &["--dump", "environment-map/*"]].concat(), folder.path());
    let files: Vec<_> = walk(folder.path());
    for wanted in ["frame-0000.exr", "frame-0000.png", "capture/radiance.exr"] {
        assert!(files.iter().any(|f| f.ends_with(wanted)), "no {wanted} in {files:?}");
    }
}

#[test]
fn one_buffer_of_a_pass_is_dumped_as_an_array() {
    let folder = TempDir::new().unwrap();
    let case = "reflection-morphing:files=none";
    let arguments = ["render", "--scene", "columns", "--case", case, "--record", "full"];
    let dump = ["--dump", "reflection-morphing/morph:corners"];
    run(&[&arguments[..], &SMALL, &dump].concat(), folder.path());
    let files: Vec<_> = walk(folder.path()).into_iter().filter(|f| f.contains("/dump/")).collect();
    assert_eq!(files.len(), 1, "{files:?}");
    assert!(files[0].ends_with("reflection-morphing/morph/corners.npy"), "{files:?}");
    let bytes = fs::read(&files[0]).unwrap();
    assert_eq!(&bytes[..8], b"\x93NUMPY\x01\x00");
    // Position and image of a vertex, a word each to fill up.
    let words = bytes[10 + usize::from(u16::from_le_bytes([bytes[8], bytes[9]]))..].chunks_exact(4);
    let words: Vec<u32> = words.map(|word| u32::from_le_bytes(word.try_into().unwrap())).collect();
    assert!(words.len() > 8000 && words.len().is_multiple_of(8), "{}", words.len());
    let found = words.chunks_exact(8).filter(|corner| corner[..3] != corner[4..7]).count();
    assert!(found > words.len() / 80, "{found}");
}

fn walk(folder: &Path) -> Vec<String> {
    let mut files = Vec::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            files.extend(walk(&path));
        } else {
            files.push(path.to_string_lossy().into_owned());
        }
    }
    files
}

#[test]
fn the_environment_fills_what_a_method_leaves() {
    let folder = TempDir::new().unwrap();
    let arguments = ["bench", "--scene", "sky", "--case", "none", "--fallback", "environment"];
    let few = ["--frames", "0..1", "--repeat", "1"];
    run(&[&arguments[..], &few, &SMALL].concat(), folder.path());
    let accuracy = &rows(folder.path())[0]["accuracy"];
    // A sky alone is all environment, so the fallback is the truth.
    assert_eq!(accuracy["missing"], 0.0, "{accuracy}");
    assert!(accuracy["bad_share"]["0.5"].as_f64().unwrap() < 0.001, "{accuracy}");
}

#[test]
fn a_probed_pixel_tells_truth_and_case() {
    let folder = TempDir::new().unwrap();
    let arguments = ["probe", "--scene", "columns", "--pixel", "80,30", "--case"];
    let text = run(&[&arguments[..], &["environment-map"], &SMALL].concat(), folder.path());
    assert!(text.contains("environment-map") && text.contains("DISPLACED PX"), "{text}");
}

#[test]
fn what_does_not_fit_is_refused() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().to_str().unwrap();
    let render = |more: &[&'static str]| -> Vec<String> {
        let all = [&["render", "--out", out][..], more].concat();
        all.into_iter().map(str::to_owned).collect()
    };
    let cases: [(&[&str], i32, &[&str]); 5] = [
        (&["--scene", "columns", "--case", "planar-mirror"], 2, &["flat reflectors", "sphere"]),
        (
            &["--scene", "columns", "--case", "cube=none;sphere=none"],
            2,
            &["cube", "it has: sphere"],
        ),
        (&["--scene", "sky", "--case", "none", "--fallback", "rays"], 2, &["environment, ray"]),
        (&["--scene", "sky", "--case", "none", "--device", "99"], 3, &["99", "there are"]),
        (
            &["--scene", "sky", "--case", "none", "--shader-dir", "/nonexistent"],
            7,
            &["/nonexistent"],
        ),
    ];
    for (arguments, code, words) in cases {
        let arguments = render(arguments);
        let arguments: Vec<&str> = arguments.iter().map(String::as_str).collect();
        ends(&arguments, code, words);
    }
}

#[test]
fn an_edited_shader_is_read_from_its_folder_and_its_errors_name_file_and_line() {
    let folder = TempDir::new().unwrap();
    let shaders = Path::new(env!("CARGO_MANIFEST_DIR")).join("shaders");
    for file in walk(&shaders) {
        let target = folder.path().join(Path::new(&file).strip_prefix(&shaders).unwrap());
        fs::create_dir_all(target.parent().unwrap()).unwrap();
        fs::copy(&file, target).unwrap();
    }
    let edited = folder.path().join("stages/composite.wgsl");
    let text = fs::read_to_string(&edited).unwrap();
    fs::write(&edited, text.replace("vec4(colour, 1.0)", "vec4(colour, 1.0) + nobody")).unwrap();
    let out = folder.path().join("out");
    let arguments = ["render", "--scene", "sky", "--case", "none", "--out", out.to_str().unwrap()];
    let more = ["--shader-dir", folder.path().to_str().unwrap()];
    ends(&[&arguments[..], &more].concat(), 7, &["composite.wgsl:", "nobody"]);
}

#[test]
fn an_interrupted_run_leaves_earlier_results() {
    let folder = TempDir::new().unwrap();
    let out = folder.path().to_str().unwrap();
    let bench = ["bench", "--scene", "sky", "--case", "none", "--out", out, "--size", "64x48"];
    command().args(bench).args(["--frames", "0..1", "--repeat", "1"]).assert().success();
    let before = rows(folder.path());
    let mut running = Process::new(assert_cmd::cargo::cargo_bin("mirrorbench"))
        .args(bench)
        .args(["--case", "environment-map", "--repeat", "100000"])
        .env("MIRRORBENCH_CACHE", env!("CARGO_TARGET_TMPDIR"))
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let start = Instant::now();
    while start.elapsed() < Duration::from_secs(2) && running.try_wait().unwrap().is_none() {
        std::thread::sleep(Duration::from_millis(50));
    }
    running.kill().unwrap();
    running.wait().unwrap();
    assert_eq!(rows(folder.path())[..before.len()], before);
    // And the folder takes further rows.
    command().args(bench).args(["--frames", "0..1", "--repeat", "1"]).assert().success();
    assert!(rows(folder.path()).len() > before.len());
}

#[test]
fn every_command_of_the_readme_runs() {
    let readme = fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/README.md")).unwrap();
    let commands: Vec<&str> = readme
        .lines()
        .filter_map(|line| line.strip_prefix("| `mirrorbench ")?.split('`').next())
        .collect();
    assert!(commands.len() >= 9, "{commands:?}");
    // The commands write below the folder they run in; later ones read what earlier ones left.
    let folder = TempDir::new().unwrap();
    let sweep = "scenes = [\"sky\"]\ncases = [\"none\"]\nsizes = [\"64x36\"]\nframes = \"0..1\"\n";
    fs::write(folder.path().join("sweep.toml"), sweep).unwrap();
    let frame = "out/columns/environment-map/frame-0000.exr";
    for text in commands {
        let text = text.replace(" A B ", &format!(" {frame} {frame} "));
        let words = text.split_whitespace();
        let done = command().current_dir(folder.path()).args(words).output().unwrap();
        let said = String::from_utf8_lossy(&done.stderr);
        assert!(done.status.success(), "mirrorbench {text}: {said}");
    }
}

//! The command line without a device: what it prints, what it refuses, how it ends.

use std::fs::{self, File};
use std::path::Path;
use std::process::{Command as Process, Stdio};

use assert_cmd::Command;
use assert_cmd::assert::Assert;
use mirrorbench::experiment::frame_file::{Provenance, read_exr, write_exr};
use mirrorbench::scene;
use mirrorbench::truth::{Tracer, TruthOptions};
use tempfile::TempDir;

fn mirrorbench(arguments: &[&str]) -> Assert {
    let mut command = Command::cargo_bin("mirrorbench").unwrap();
    // The tests' own folder of truths, so that no other run's is read.
    command.env("MIRRORBENCH_CACHE", env!("CARGO_TARGET_TMPDIR"));
    command.args(arguments).assert()
}

/// Runs a command that must fail with `code` and one line that holds `words`.
fn refused(arguments: &[&str], code: i32, words: &[&str]) {
    let assert = mirrorbench(arguments).code(code);
    let output = assert.get_output();
    let text = String::from_utf8_lossy(&output.stderr);
    assert!(text.starts_with("mirrorbench: error: "), "{arguments:?} said: {text}");
    assert_eq!(text.matches('\n').count(), 1, "{arguments:?} said: {text}");
    for word in words {
        assert!(text.contains(word), "{arguments:?} said no `{word}`: {text}");
    }
    assert!(output.stdout.is_empty(), "{arguments:?} wrote to stdout");
}

fn stdout(arguments: &[&str]) -> String {
    String::from_utf8(mirrorbench(arguments).success().get_output().stdout.clone()).unwrap()
}

#[test]
fn help_and_version_are_no_errors() {
    for command in
        ["doctor", "list", "describe", "render", "profile", "bench", "probe", "sweep", "diff"]
    {
        assert!(stdout(&[command, "--help"]).contains("Usage"), "{command}");
        assert!(stdout(&["--help"]).contains(command));
    }
    assert!(stdout(&["--version"]).starts_with("mirrorbench "));
    mirrorbench(&[]).code(2);
}

#[test]
fn wrong_flags_end_in_2() {
    refused(&["dance"], 2, &["dance"]);
    refused(&["list", "shoes"], 2, &["methods, scenes, devices"]);
    refused(&["render", "--case", "none"], 2, &["--scene"]);
    refused(
        &["render", "--scene", "sky", "--case", "none", "--spee", "1"],
        2,
        &["--spee", "--help"],
    );
    let flags = [
        ("--size", "12x", "1280x720"),
        ("--size", "8x8", "16 to 16384"),
        ("--fallback", "hope", "none, environment"),
        ("--record", "all", "radiance, full"),
        ("--frames", "5..5", "A below B"),
        ("--repeat", "0", "1.."),
        ("--vary", "layers=2", "METHOD.key=a,b,c"),
    ];
    for (flag, value, words) in flags {
        refused(&["bench", "--scene", "sky", "--case", "none", flag, value], 2, &[flag, words]);
    }
    refused(&["probe", "--scene", "sky", "--pixel", "3"], 2, &["640,360"]);
    refused(&["sweep", "a.toml", "--shard", "3/2"], 2, &["I from 1 to N"]);
    refused(&["diff", "a", "b", "--max-bad-share", "2"], 2, &["0% to 100%"]);
}

#[test]
fn unknown_names_end_in_2_and_say_what_is_valid() {
    refused(&["describe", "magic"], 2, &["no method `magic`", "environment-map"]);
    for (case, words) in [
        ("enviroment-map", "did you mean environment-map?"),
        ("environment-map:indx=surface", "did you mean index?"),
        ("environment-map:index=sideways", "direction"),
        ("environment-map@revised", "valid: published"),
        ("truth:spp=0", "an integer from 1"),
    ] {
        refused(&["render", "--scene", "sky", "--case", case], 2, &[case, words]);
    }
    refused(&["render", "--scene", "skye", "--case", "truth"], 2, &["skye", "columns"]);
    let vary = ["--vary", "planar-mirror.index=surface"];
    let bench = ["bench", "--scene", "sky", "--case", "environment-map"];
    refused(&[&bench[..], &vary[..]].concat(), 2, &["no case uses the method `planar-mirror`"]);
    for command in ["render", "profile", "bench"] {
        let arguments = [command, "--scene", "sky", "--case", "magic:x=1"];
        refused(&arguments, 2, &["case `magic:x=1`", "no method `magic`"]);
    }
    // A message stays one line, whatever the user wrote.
    refused(&["describe", "a\nb"], 2, &["no method `a b`"]);
}

#[test]
fn methods_are_listed_and_described() {
    let list = stdout(&["list", "methods"]);
    for method in ["truth", "none", "environment-map", "planar-mirror"] {
        assert!(list.lines().any(|line| line.starts_with(method)), "{list}");
        assert!(stdout(&["describe", method]).contains("paper"), "{method}");
    }
    let card = stdout(&["describe", "environment-map", "--json"]);
    let card: serde_json::Value = serde_json::from_str(&card).unwrap();
    let params = card["params"].as_array().unwrap();
    assert!(params.iter().any(|param| param["name"] == "index"), "{card}");
}

/// The truth needs no device: a whole run, from flags to files.
#[test]
fn the_truth_is_rendered_compared_and_recorded() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("new/run");
    let out = out.to_str().unwrap();
    let render = ["render", "--scene", "columns", "--case", "truth", "--size", "64x48"];
    let render = [&render[..], &["--frames", "1..3", "--truth-frames", "1", "--out", out]].concat();
    let row = stdout(&[&render[..], &["--json"]].concat());
    let row: serde_json::Value = serde_json::from_str(&row).unwrap();
    assert_eq!(row["frames"], serde_json::json!([1, 2]));
    assert_eq!(row["accuracy"]["bad_share"]["0.5"], 0.0, "the truth is true");
    assert_eq!(row["scene"]["name"], "columns");
    for file in ["frame-0001.exr", "frame-0002.png", "results.jsonl"] {
        assert!(Path::new(out).join(file).is_file(), "{file}");
    }
    let arrays = format!("{}.frames.json", row["run"].as_str().unwrap());
    assert!(Path::new(out).join(arrays).is_file());

    // An interrupted run leaves half a row; the next one cuts it off and keeps what was whole.
    let results = Path::new(out).join("results.jsonl");
    let whole = fs::read_to_string(&results).unwrap();
    fs::write(&results, format!("{whole}{}", &whole[..40])).unwrap();
    stdout(&render);
    let again = fs::read_to_string(&results).unwrap();
    assert_eq!(again, whole.repeat(2), "the same run gives the same row");

    stdout(&["diff", out, out, "--max-bad-share", "0", "--at-px", "0.5"]);
    refused(&["diff", out, out, "--max-bad-share", "0", "--at-px", "3"], 2, &["0.5, 1, 2, 4"]);
}

#[test]
fn a_path_is_followed_and_its_frames_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().to_str().unwrap();
    let bench = ["bench", "--scene", "columns", "--case", "truth", "--size", "64x48"];
    let bench = [&bench[..], &["--truth-frames", "1", "--frames", "3..7", "--out", out]].concat();
    let row = stdout(&[&bench[..], &["--path", "--json"]].concat());
    let row: serde_json::Value = serde_json::from_str(&row).unwrap();
    let stability = &row["stability"];
    assert_eq!(stability["jitter_px"], serde_json::json!({"median": 0.0, "p95": 0.0}));
    assert_eq!((&stability["pops"], &stability["frames"]), (&0.into(), &serde_json::json!([3, 6])));
    assert!(stability["covered"].as_f64().unwrap() > 0.5, "{stability}");
    assert!(stability["speed_px"].as_f64().unwrap() > 0.0, "{stability}");
    let arrays = format!("{}.frames.json", row["run"].as_str().unwrap());
    let arrays = fs::read_to_string(Path::new(out).join(arrays)).unwrap();
    let arrays: serde_json::Value = serde_json::from_str(&arrays).unwrap();
    let frames = arrays["path"].as_array().unwrap();
    assert!(
        frames
            .iter()
            .map(|frame| &frame["frame"])
            .eq([3, 4, 5, 6].map(serde_json::Value::from).iter())
    );
    assert!(frames[0]["jitter_px"].is_null() && frames[3]["jitter_px"].is_null());
    assert_eq!(frames[1]["jitter_px"]["p95"], 0.0);
    assert_eq!(frames[2]["popping"], 0.0);

    let text = stdout(&[&bench[..], &["--path"]].concat());
    assert!(text.contains("JITTER PX") && text.contains("POPS"), "{text}");
    let still = stdout(&[&bench[..], &["--json"]].concat());
    let still: serde_json::Value = serde_json::from_str(&still).unwrap();
    assert!(still["stability"].is_null());
    assert_ne!(still["run"], row["run"], "a path is an input");
}

#[test]
fn a_path_of_two_frames_ends_in_2() {
    let bench = ["bench", "--scene", "columns", "--case", "truth", "--path", "--frames", "0..2"];
    refused(&bench, 2, &["--path", "columns", "at least 3"]);
    // A scene that stands still has one frame.
    refused(
        &["bench", "--scene", "lecture", "--case", "truth", "--path"],
        2,
        &["valid: at least 3"],
    );
}

#[test]
fn a_pixel_is_probed_in_truth() {
    let probe = ["probe", "--scene", "columns", "--size", "64x48", "--case", "truth", "--json"];
    let scene = scene::load("columns").unwrap();
    let frame = Tracer::new(&scene, &scene.at(0), TruthOptions::default()).frame([64, 48]);
    let pixels = frame.reflector_pixels();
    let middle = pixels[pixels.len() / 2];
    let pixel = format!("{},{}", middle % 64, middle / 64);
    let answer = stdout(&[&probe[..], &["--pixel", &pixel]].concat());
    let answer: serde_json::Value = serde_json::from_str(&answer).unwrap();
    assert!(answer["mirror"]["n"].is_array(), "{pixel} sees the sphere: {answer}");
    let [truth, case] = answer["answers"].as_array().unwrap().as_slice() else {
        panic!("{answer}")
    };
    assert_eq!(truth["s"], case["s"]);
    assert_eq!(case["verdict"], "right");
    let corner = stdout(&[&probe[..], &["--pixel", "0,0"]].concat());
    assert!(corner.contains("\"mirror\":null"), "{corner}");
    refused(&[&probe[..], &["--pixel", "64,0"]].concat(), 2, &["valid: 0,0 to 63,47"]);
}

#[test]
fn an_unwritable_folder_ends_in_6_before_any_work() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("file");
    fs::write(&file, "").unwrap();
    let out = file.join("below");
    let out = out.to_str().unwrap();
    for command in ["render", "profile", "bench"] {
        let case = if command == "profile" { "none" } else { "truth" };
        // At this size the work itself would take minutes.
        let arguments = [command, "--scene", "columns", "--case", case, "--size", "16384x16384"];
        refused(&[&arguments[..], &["--out", out]].concat(), 6, &["cannot write", out]);
    }
}

#[test]
fn frames_beyond_the_animation_end_in_2() {
    for flags in [["--frame", "999999"], ["--frames", "0..999999"]] {
        let render = ["render", "--scene", "columns", "--case", "truth"];
        refused(&[&render[..], &flags[..]].concat(), 2, &["no frame", "valid: 0 to"]);
    }
}

#[test]
fn scenes_are_listed_by_name() {
    let text = stdout(&["list", "scenes"]);
    assert!(text.lines().any(|line| line.starts_with("columns ")), "{text}");
    let output = mirrorbench(&["list", "scenes", "--json"]).success();
    let output = output.get_output();
    let lines = String::from_utf8_lossy(&output.stdout).into_owned();
    for line in lines.lines() {
        let value: serde_json::Value = serde_json::from_str(line).unwrap();
        assert!(value["scene"].is_string() && value["about"].is_string(), "{line}");
    }
    assert!(lines.lines().count() >= 4);
    assert!(!output.stderr.is_empty(), "text for people goes to stderr with --json");
}

#[test]
fn a_reader_that_goes_away_is_no_error() {
    let mut child = Process::new(env!("CARGO_BIN_EXE_mirrorbench"))
        .args(["list", "scenes"])
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    drop(child.stdout.take());
    let output = child.wait_with_output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(output.stderr.is_empty(), "{}", String::from_utf8_lossy(&output.stderr));
}

#[cfg(target_os = "linux")]
#[test]
fn a_full_stdout_ends_in_6() {
    let full = File::options().write(true).open("/dev/full").unwrap();
    let mut child = Process::new(env!("CARGO_BIN_EXE_mirrorbench"))
        .args(["list", "scenes"])
        .stdout(full)
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    assert_eq!(child.wait().unwrap().code(), Some(6));
}

/// Two frames of the columns, traced small: the truth, and one with its reflections a pixel right.
fn two_frames() -> (TempDir, [String; 3]) {
    let folder = tempfile::tempdir().unwrap();
    let scene = scene::load("columns").unwrap();
    let truth = Tracer::new(&scene, &scene.at(0), TruthOptions::default()).frame([64, 48]);
    let mut shifted = truth.clone();
    for pixel in (1..truth.reflector.len()).rev() {
        if truth.reflector[pixel] == truth.reflector[pixel - 1] {
            shifted.record.point[pixel] = truth.record.point[pixel - 1];
            shifted.record.ids[pixel] = truth.record.ids[pixel - 1];
            shifted.record.last[pixel] = truth.record.last[pixel - 1];
        }
    }
    let from = |scene: &str| Provenance { scene: scene.into(), ..Default::default() };
    let write = |name: &str, frame, scene: &str| {
        let path = folder.path().join(name);
        write_exr(&path, frame, &from(scene)).unwrap();
        path.to_str().unwrap().to_owned()
    };
    let paths = [
        write("truth.exr", &truth, "columns"),
        write("shifted.exr", &shifted, "columns"),
        write("sky.exr", &truth, "sky"),
    ];
    (folder, paths)
}

#[test]
fn diff_measures_two_frames_and_holds_a_threshold() {
    let (_folder, [truth, shifted, sky]) = two_frames();
    let same = stdout(&["diff", &truth, &truth, "--json", "--max-bad-share", "0"]);
    let same: serde_json::Value = serde_json::from_str(&same).unwrap();
    assert_eq!(same["bad_share_at_px"], 0.0);
    let differs = ["diff", truth.as_str(), shifted.as_str(), "--at-px", "0.5"];
    let text = stdout(&differs);
    assert!(text.contains("bad at 0.5 px"), "{text}");
    let mut strict = differs.to_vec();
    strict.extend(["--max-bad-share", "1%"]);
    let assert = mirrorbench(&strict).code(1);
    let message = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
    assert!(message.contains("bad at 0.5 px, more than 1 %"), "{message}");
    refused(&["diff", &truth, &sky], 2, &["the views differ"]);
    assert!(read_exr(Path::new(&truth)).is_ok());
}

#[test]
fn diff_refuses_what_it_cannot_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    fs::write(path("bad.exr"), "not an image").unwrap();
    refused(&["diff", &path("bad.exr"), &path("bad.exr")], 2, &["bad.exr"]);
    refused(&["diff", &path("no.exr"), &path("no.exr")], 2, &["no.exr"]);
    refused(&["diff", &path("bad.exr"), folder.path().to_str().unwrap()], 2, &["not alike"]);
    let here = folder.path().to_str().unwrap();
    refused(&["diff", here, here], 2, &["results.jsonl"]);
}

#[test]
fn sweep_files_are_refused_with_their_line() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("sweep.toml");
    let path = path.to_str().unwrap();
    refused(&["sweep", path], 2, &["cannot read", "sweep.toml"]);
    for (text, words) in [
        ("scenes = [\"sky\"]\ncase = [\"none\"]", "sweep.toml:2: unknown field `case`"),
        ("scenes = [\"sky\"]\ncases = [\"none\"]\nsizes = [\"3\"]", "sizes `3`: valid"),
        ("scenes = [\"sky\"]\ncases = [\"magic\"]", "no method `magic`"),
    ] {
        fs::write(path, text).unwrap();
        refused(&["sweep", path], 2, &[words]);
    }
}

#[test]
fn a_machine_without_vulkan_ends_in_3_and_says_what_to_install() {
    let mut command = Command::cargo_bin("mirrorbench").unwrap();
    for variable in ["VK_DRIVER_FILES", "VK_ICD_FILENAMES"] {
        command.env(variable, "/nonexistent/driver.json");
    }
    let assert = command.env("VK_LOADER_LAYERS_DISABLE", "*").arg("doctor").assert().code(3);
    let text = String::from_utf8_lossy(&assert.get_output().stderr).into_owned();
    assert!(text.contains("mirrorbench: error: ") && text.contains("apt-get install"), "{text}");
}

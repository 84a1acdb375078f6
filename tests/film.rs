//! `render --film`: the pictures of a film, who encodes it, and what is refused. The truth needs no
//! device.

use std::fs;
use std::io::BufReader;
use std::path::Path;

use assert_cmd::Command;
use assert_cmd::assert::Assert;
use tempfile::TempDir;

const SIZE: [usize; 2] = [48, 36];

/// Renders three frames of the columns' truth to a film, unless `more` names others.
fn film(folder: &Path, name: &str, more: &[&str], search: Option<&Path>) -> Assert {
    let mut command = Command::cargo_bin("mirrorbench").unwrap();
    command.env("MIRRORBENCH_CACHE", env!("CARGO_TARGET_TMPDIR"));
    if let Some(search) = search {
        command.env("PATH", search);
    }
    command.args(["render", "--scene", "columns", "--size", "48x36", "--out"]).arg(folder);
    for usual in [["--case", "truth"], ["--frames", "4..7"]] {
        if !more.contains(&usual[0]) {
            command.args(usual);
        }
    }
    command.arg("--film").arg(folder.join(name)).args(more).assert()
}

fn message(assert: &Assert) -> String {
    String::from_utf8_lossy(&assert.get_output().stderr).into_owned()
}

/// All pictures of an animated PNG, with their size.
fn pictures(path: &Path) -> (Vec<Vec<u8>>, [usize; 2]) {
    let file = BufReader::new(fs::File::open(path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let info = reader.info();
    let (width, height) = (info.width as usize, info.height as usize);
    let count = info.animation_control().unwrap().num_frames;
    let all = (0..count).map(|_| {
        let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
        reader.next_frame(&mut bytes).unwrap();
        bytes
    });
    (all.collect(), [width, height])
}

fn still(path: &Path) -> Vec<u8> {
    let file = BufReader::new(fs::File::open(path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut bytes).unwrap();
    bytes
}

#[test]
fn an_animated_png_holds_the_frames() {
    let folder = TempDir::new().unwrap();
    film(folder.path(), "a.png", &[], None).success();
    let (pictures, size) = pictures(&folder.path().join("a.png"));
    assert_eq!((pictures.len(), size), (3, SIZE));
    for (number, picture) in (4..).zip(&pictures) {
        let frame = still(&folder.path().join(format!("frame-{number:04}.png")));
        assert!(*picture == frame, "frame {number} differs from its picture in the film");
    }
    assert!(pictures[0] != pictures[2], "the camera moves");
    let delay_s = delay_s(&folder.path().join("a.png"));
    assert!((delay_s - 1.0 / 24.0).abs() < 0.0005, "{delay_s} s a picture at 24 Hz");
    assert!(
        fs::read_dir(folder.path())
            .unwrap()
            .all(|entry| { !entry.unwrap().file_name().to_string_lossy().contains("partial") })
    );
}

/// Seconds each picture of an animated PNG is shown.
fn delay_s(path: &Path) -> f64 {
    let file = BufReader::new(fs::File::open(path).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let mut bytes = vec![0; reader.output_buffer_size().unwrap()];
    reader.next_frame(&mut bytes).unwrap();
    let frame = reader.info().frame_control().unwrap();
    f64::from(frame.delay_num) / f64::from(frame.delay_den)
}

#[test]
fn other_cases_stand_beside_the_frame_in_their_order() {
    let folder = TempDir::new().unwrap();
    let cases = ["--beside", "truth:spp=16", "--beside", "truth:bounces=1,shapes=analytic"];
    film(folder.path(), "a.png", &cases, None).success();
    let (pictures, [width, _]) = pictures(&folder.path().join("a.png"));
    assert_eq!((pictures.len(), width), (3, 3 * SIZE[0]));
    for (place, case) in [(1, cases[1]), (2, cases[3])] {
        let alone = TempDir::new().unwrap();
        let more = ["--case", case, "--frames", "4..5"];
        film(alone.path(), "b.png", &more, None).success();
        let picture = still(&alone.path().join("frame-0004.png"));
        let panel = pictures[0].chunks(3 * SIZE[0]).skip(place).step_by(3).flatten().copied();
        assert!(panel.eq(picture), "panel {place} is not {case}");
    }
}

#[test]
fn truth_and_error_stand_beside_the_frame() {
    let folder = TempDir::new().unwrap();
    film(folder.path(), "a.apng", &["--beside", "truth", "--beside", "error"], None).success();
    let (pictures, [width, height]) = pictures(&folder.path().join("a.apng"));
    assert_eq!([width, height], [3 * SIZE[0], SIZE[1]]);
    let frame = still(&folder.path().join("frame-0005.png"));
    for row in 0..height {
        let line = &pictures[1][3 * row * width..][..3 * width];
        let [drawn, truth, error] =
            [0, 1, 2].map(|panel| &line[3 * panel * SIZE[0]..][..3 * SIZE[0]]);
        assert_eq!(drawn, &frame[3 * row * SIZE[0]..][..3 * SIZE[0]]);
        // The case is the truth: the same again, and no error anywhere, which is one colour.
        assert_eq!(drawn, truth);
        assert!(error.chunks(3).all(|colour| colour == &error[..3] && colour[0] < 10));
    }
}

#[test]
fn without_ffmpeg_a_video_ends_in_6_before_any_work() {
    let folder = TempDir::new().unwrap();
    let empty = TempDir::new().unwrap();
    let assert = film(folder.path(), "a.mp4", &[], Some(empty.path())).code(6);
    let said = message(&assert);
    for word in ["a.mp4", "ffmpeg", "apt-get install ffmpeg", ".png"] {
        assert!(said.contains(word), "no `{word}` in: {said}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn what_names_no_film_is_refused() {
    let folder = TempDir::new().unwrap();
    let said = message(&film(folder.path(), "a.gif", &[], None).code(2));
    assert!(said.contains("a.gif") && said.contains(".webm"), "{said}");
    let said = message(&film(folder.path(), "a.png", &["--beside", "flip"], None).code(2));
    for word in ["--beside", "no method `flip`", "truth", "`error`"] {
        assert!(said.contains(word), "no `{word}` in: {said}");
    }
    let mut alone = Command::cargo_bin("mirrorbench").unwrap();
    let render = ["render", "--scene", "sky", "--case", "truth", "--beside", "truth"];
    let said = message(&alone.args(render).assert().code(2));
    assert!(said.contains("--film"), "{said}");
    let said = message(&film(folder.path(), "a.png", &["--frames", "478..481"], None).code(2));
    assert!(said.contains("no frame 480; valid: 0 to 479"), "{said}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

/// A stand-in for ffmpeg that keeps what it is told and given.
#[cfg(unix)]
fn fake_ffmpeg(folder: &Path, ends: &str) {
    use std::os::unix::fs::PermissionsExt;
    let path = folder.join("ffmpeg");
    let script = format!(
        "#!/bin/sh\n[ \"$1\" = -version ] && exit 0\necho \"$@\" > \"$0.told\"\n\
         for file; do :; done\n/bin/cat > \"$file\"\n{ends}\n"
    );
    fs::write(&path, script).unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o755)).unwrap();
}

#[cfg(unix)]
#[test]
fn ffmpeg_is_fed_every_picture_and_told_their_size_and_rate() {
    let (folder, programs) = (TempDir::new().unwrap(), TempDir::new().unwrap());
    fake_ffmpeg(programs.path(), "exit 0");
    film(folder.path(), "a.webm", &["--beside", "truth"], Some(programs.path())).success();
    let given = fs::read(folder.path().join("a.webm")).unwrap();
    assert_eq!(given.len(), 3 * 2 * SIZE[0] * SIZE[1] * 3, "three pictures, two panels");
    let frame = still(&folder.path().join("frame-0004.png"));
    assert_eq!(given[..3 * SIZE[0]], frame[..3 * SIZE[0]]);
    let told = fs::read_to_string(programs.path().join("ffmpeg.told")).unwrap();
    for option in ["-pix_fmt rgb24", "-s 96x36", "-r 24", "libvpx-vp9", "-f webm"] {
        assert!(told.contains(option), "no `{option}` in: {told}");
    }
}

#[cfg(unix)]
#[test]
fn what_ffmpeg_says_is_the_error() {
    let (folder, programs) = (TempDir::new().unwrap(), TempDir::new().unwrap());
    fake_ffmpeg(programs.path(), "echo 'Unknown encoder libx264' >&2\nexit 1");
    let said = message(&film(folder.path(), "a.mp4", &[], Some(programs.path())).code(6));
    assert!(said.contains("a.mp4") && said.contains("ffmpeg: Unknown encoder libx264"), "{said}");
    assert!(!folder.path().join("a.mp4").exists());
}

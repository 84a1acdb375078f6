//! Every way a scene can be wrong: one line, with file, line and what is valid.

use std::path::Path;

use mirrorbench::error::Error;
use mirrorbench::scene;

/// A scene without fault; the cases below replace one of its lines.
const GOOD: &str = r#"about = "test"
frames = 2
[camera]
fov_deg = 60.0
eye = [0.0, 1.0, 4.0]
target = [0.0, 1.0, 0.0]
[environment]
colour = [1.0, 1.0, 1.0]
[lighting]
ambient = [1.0, 1.0, 1.0]
sun = [1.0, 1.0, 1.0]
towards_sun = [0.0, 1.0, 0.0]
[materials]
mirror = { mirror = { reflectance = 1.0 } }
red = { colour = [1.0, 0.0, 0.0] }
[[objects]]
name = "ball"
shape = { sphere = { radius = 1.0 } }
material = "mirror"
"#;

/// The error of a scene text, as a file of its own in a folder with `assets`.
fn error_of(text: &str, assets: &[(&str, &str)]) -> String {
    let folder = tempfile::tempdir().unwrap();
    for (name, content) in assets {
        std::fs::write(folder.path().join(name), content).unwrap();
    }
    let path = folder.path().join("test.toml");
    std::fs::write(&path, text).unwrap();
    let error = scene::load(path.to_str().unwrap()).expect_err("the scene should be refused");
    assert_eq!(error.exit_code(), 4, "{error}");
    let message = error.to_string().replace(&format!("{}/", folder.path().display()), "");
    assert!(!message.contains('\n'), "more than one line: {message}");
    message
}

#[test]
fn the_good_scene_is_good() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("test.toml");
    std::fs::write(&path, GOOD).unwrap();
    scene::load(path.to_str().unwrap()).unwrap();
}

#[test]
fn wrong_lines_are_named_with_what_is_valid() {
    // The line replaced, what it becomes, and the whole message.
    let cases = [
        (
            "frames = 2",
            "frame = 2",
            "test.toml:2: unknown key `frame`; valid: `about`, `frames`, `rate_hz`, `bounces`, `lighting`, `environment`, `camera`, `materials`, `objects`",
        ),
        ("frames = 2", "frames = 0", "test.toml:2: 0 is out of range; valid: 1 to 1000000"),
        (
            "material = \"mirror\"",
            "material = \"mirror\"\nwobble = { amplitude = 0.1, wavelength = 1.0, period = 1.0 }",
            "test.toml:20: unknown key `period`; valid: `amplitude`, `wavelength`, `period_s`, `towards`",
        ),
        (
            "material = \"mirror\"",
            "material = \"mirror\"\nwobble = { amplitude = 0.0, wavelength = 1.0, period_s = 1.0 }",
            "test.toml:20: 0 is out of range; valid: 1e-6 to 1e6",
        ),
        (
            "material = \"mirror\"",
            "material = \"mirror\"\nwobble = { amplitude = 0.1, wavelength = 1.0, period_s = 1.0, towards = [0, 0, 0] }",
            "test.toml:20: towards has no direction; valid: a vector that is not zero",
        ),
        (
            "material = \"mirror\"",
            "material = \"mirror\"\nwobble = { amplitude = 0.1, wavelength = 0.3, period_s = 1.0 }",
            "test.toml:20: wavelength = 0.3 is too short for edges of 0.098 m along it; valid: 0.392 or more, or a shape cut more finely",
        ),
        ("frames = 2", "bounces = 17", "test.toml:2: 17 is out of range; valid: 1 to 16"),
        (
            "frames = 2",
            "frames = \"two\"",
            "test.toml:2: invalid type: string \"two\"; valid: a whole number",
        ),
        (
            "frames = 2",
            "frames = ",
            "test.toml:2: string values must be quoted; valid: literal string",
        ),
        ("fov_deg = 60.0", "fov_deg = 180", "test.toml:4: 180 is out of range; valid: 1 to 170"),
        ("fov_deg = 60.0", "fov_deg = nan", "test.toml:4: NaN is out of range; valid: 1 to 170"),
        (
            "fov_deg = 60.0",
            "",
            "test.toml:3: a camera needs one projection; valid: fov_deg or height",
        ),
        (
            "eye = [0.0, 1.0, 4.0]",
            "eye = [0.0, inf, 4.0]",
            "test.toml:5: inf is out of range; valid: any finite number",
        ),
        (
            "eye = [0.0, 1.0, 4.0]",
            "eye = [0.0, 1.0]",
            "test.toml:5: invalid length 2; valid: an array of length 3",
        ),
        (
            "eye = [0.0, 1.0, 4.0]",
            "eye = [0.0, 5.0, 0.0]",
            "test.toml:3: the camera looks nowhere or straight up or down; valid: a target beside the eye",
        ),
        (
            "eye = [0.0, 1.0, 4.0]",
            "",
            "test.toml:3: a camera needs one path; valid: eye and target (with orbit or without), or keys",
        ),
        (
            "colour = [1.0, 1.0, 1.0]",
            "sky = [1.0, 1.0, 1.0]",
            "test.toml:8: unknown value `sky`; valid: `colour`, `gradient`, `lat_long`",
        ),
        (
            "colour = [1.0, 1.0, 1.0]",
            "lat_long = { file = \"sky.exr\", cap = 70000.0 }",
            "test.toml:8: 70000 is out of range; valid: 1e-6 to 65504",
        ),
        (
            "colour = [1.0, 1.0, 1.0]",
            "colour = [1.0, -1.0, 1.0]",
            "test.toml:8: -1 is out of range; valid: 0 or more",
        ),
        (
            "towards_sun = [0.0, 1.0, 0.0]",
            "towards_sun = [0.0, 0.0, 0.0]",
            "test.toml:9: towards_sun has no direction; valid: a vector that is not zero",
        ),
        (
            "mirror = { mirror = { reflectance = 1.0 } }",
            "mirror = { mirror = { reflectance = 1.5 } }",
            "test.toml:14: 1.5 is out of range; valid: 0 to 1",
        ),
        (
            "mirror = { mirror = { reflectance = 1.0 } }",
            "mirror = { mirror = { reflectance = 1.0, fade = { distance = 0.0 } } }",
            "test.toml:14: 0 is out of range; valid: 1e-6 to 1e6",
        ),
        (
            "material = \"mirror\"",
            "material = \"mirror\"\nimpostor = { facing = [0, 0, 0] }",
            "test.toml:20: facing has no direction; valid: a vector that is not zero",
        ),
        (
            "red = { colour = [1.0, 0.0, 0.0] }",
            "red = {}",
            "test.toml:15: material `red` needs one look; valid: one of colour, checker, grid, image, with a mirror or without, mirror alone, or glass alone",
        ),
        (
            "red = { colour = [1.0, 0.0, 0.0] }",
            "red = { colour = [1.0, 0.0, 0.0], glass = { index = 1.5 } }",
            "test.toml:15: material `red` needs one look; valid: one of colour, checker, grid, image, with a mirror or without, mirror alone, or glass alone",
        ),
        (
            "red = { colour = [1.0, 0.0, 0.0] }",
            "red = { glass = { index = 0.0 } }",
            "test.toml:15: 0 is out of range; valid: 0.2 to 5",
        ),
        (
            "name = \"ball\"",
            "name = \"my ball\"",
            "test.toml:17: object name `my ball`; valid: letters, digits, `-`, `_` and `.`",
        ),
        ("name = \"ball\"", "", "test.toml:16: missing key `name`"),
        (
            "shape = { sphere = { radius = 1.0 } }",
            "shape = { ball = { radius = 1.0 } }",
            "test.toml:18: unknown value `ball`; valid: `sphere`, `ellipsoid`, `box`, `plane`, `cylinder`, `torus`, `revolution`, `obj`, `patches`",
        ),
        (
            "shape = { sphere = { radius = 1.0 } }",
            "shape = { sphere = { radius = 0.0 } }",
            "test.toml:18: 0 is out of range; valid: 1e-6 to 1e6",
        ),
        (
            "shape = { sphere = { radius = 1.0 } }",
            "shape = { box = { size = [1.0, 0.0, 1.0] } }",
            "test.toml:18: 0 is out of range; valid: 1e-6 to 1e6",
        ),
        (
            "shape = { sphere = { radius = 1.0 } }",
            "shape = { sphere = { radius = 1.0, edge = 1e-6 } }",
            "test.toml:18: edge = 0.000001 is out of range; valid: 0.0015339808 or more",
        ),
        (
            "shape = { sphere = { radius = 1.0 } }",
            "shape = { sphere = { radius = 1.0, edge = 0.1, slices = 9 } }",
            "test.toml:18: `edge` and a number of steps; valid: one of the two",
        ),
        (
            "shape = { sphere = { radius = 1.0 } }",
            "shape = { torus = { ring = 1.0, tube = 1.5 } }",
            "test.toml:18: tube = 1.5 is out of range; valid: below ring = 1",
        ),
        (
            "shape = { sphere = { radius = 1.0 } }",
            "shape = { revolution = { curve = \"spline\", profile = [] } }",
            "test.toml:18: unknown value `spline`; valid: `polyline` or `bezier`",
        ),
        (
            "shape = { sphere = { radius = 1.0 } }",
            "shape = { revolution = { curve = \"bezier\", profile = [[1, 0], [1, 1]] } }",
            "test.toml:18: profile has 2 points; valid: 4, 7, 10, ...",
        ),
        (
            "shape = { sphere = { radius = 1.0 } }",
            "shape = { revolution = { curve = \"polyline\", profile = [[0, 0], [0, 1]] } }",
            "test.toml:18: profile encloses no area; valid: radii above 0",
        ),
        (
            "shape = { sphere = { radius = 1.0 } }",
            "shape = { revolution = { curve = \"polyline\", profile = [[1, 0], [1, 0]] } }",
            "test.toml:18: profile repeats a point; valid: points that differ from the one before",
        ),
        (
            "shape = { sphere = { radius = 1.0 } }",
            "shape = { revolution = { curve = \"polyline\", profile = [[1, 0], [-1, 0]] } }",
            "test.toml:18: profile radius -1 is out of range; valid: 0 or more",
        ),
        (
            "shape = { sphere = { radius = 1.0 } }",
            "shape = { obj = { file = \"none.obj\" } }",
            "test.toml:18: no file `none.obj`",
        ),
        (
            "material = \"mirror\"",
            "material = \"chrome\"",
            "test.toml:19: unknown material `chrome`; valid: mirror, red",
        ),
        (
            "material = \"mirror\"",
            "",
            "test.toml:17: missing key `material`; valid: a name under [materials]",
        ),
        (
            "material = \"mirror\"",
            "material = \"red\"\n[[objects]]\nname = \"ball\"\nshape = { sphere = { radius = 1.0 } }\nmaterial = \"red\"",
            "test.toml:21: a second object `ball`; valid: a name of its own for each",
        ),
        (
            "material = \"mirror\"",
            "material = \"red\"\nkeys = [{ time_s = 1, position = [0, 0, 0] },\n{ time_s = 1, position = [0, 0, 0] }]",
            "test.toml:21: time_s = 1 is out of range; valid: above 1, the key before",
        ),
        (
            "material = \"mirror\"",
            "material = \"red\"\nkeys = []",
            "test.toml:17: keys is empty; valid: one key or more",
        ),
        (
            "material = \"mirror\"",
            "material = \"red\"\nposition = [0, 0, 0]\nkeys = [{ time_s = 1, position = [0, 0, 0] }]",
            "test.toml:17: two kinds of motion; valid: keys alone, or position, rotation_deg and orbit",
        ),
        (
            "material = \"mirror\"",
            "material = \"red\"\nscatter = { count = 0, seed = 1, low = [0, 0, 0], high = [4, 4, 4] }",
            "test.toml:20: 0 is out of range; valid: 1 to 10000",
        ),
        (
            "material = \"mirror\"",
            "material = \"red\"\nscatter = { count = 3, seed = 1, low = [0, 0, 0], top = [4, 4, 4] }",
            "test.toml:20: unknown key `top`; valid: `count`, `seed`, `low`, `high`, `scale`, `turn`, `clear`",
        ),
        (
            "material = \"mirror\"",
            "material = \"red\"\nscatter = { count = 3, seed = 1, low = [0, 0, 0], high = [-4, 4, 4] }",
            "test.toml:20: low is above high; valid: opposite corners of a box",
        ),
        (
            "material = \"mirror\"",
            "material = \"red\"\nscatter = { count = 3, seed = 1, low = [0, 0, 0], high = [4, 4, 4], scale = [2, 1] }",
            "test.toml:20: scale = [2, 1] falls; valid: the smallest, the largest",
        ),
        (
            "material = \"mirror\"",
            "material = \"red\"\nscatter = { count = 3, seed = 1, low = [0, 0, 0], high = [4, 4, 4], clear = [{ centre = [2, 2, 2], radius = 9 }] }",
            "test.toml:20: no clear place in 1000 tries; valid: a box with room for each",
        ),
        (
            "material = \"mirror\"",
            "material = \"red\"\nposition = [0, 0, 0]\nscatter = { count = 3, seed = 1, low = [0, 0, 0], high = [4, 4, 4] }",
            "test.toml:21: scatter and a place of its own; valid: scatter alone, or the others",
        ),
    ];
    let mut wrong = Vec::new();
    for (line, replacement, expected) in cases {
        assert!(GOOD.contains(line));
        let message = error_of(&GOOD.replacen(line, replacement, 1), &[]);
        if !message.starts_with(expected) {
            wrong.push(format!("{replacement}\n  said     {message}\n  expected {expected}"));
        }
    }
    assert!(wrong.is_empty(), "\n{}", wrong.join("\n"));
}

#[test]
fn bad_assets_are_named_with_their_line() {
    const TRIANGLE: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    let triangle = |rest: &str| format!("{TRIANGLE}{rest}\n");
    let cases = [
        ("a.obj", "v 0 0 zero\n".to_owned(), "a.obj:1: `zero` is not a finite number"),
        ("a.obj", "v 0 0 nan\n".to_owned(), "a.obj:1: `nan` is not a finite number"),
        ("a.obj", "v 0 0\n".to_owned(), "a.obj:1: too few numbers; valid: 3"),
        ("a.obj", triangle("f 1 2 4"), "a.obj:4: index 4 is out of range; valid: 1 to 3"),
        ("a.obj", triangle("f 1 2 0"), "a.obj:4: index 0 is out of range; valid: 1 to 3"),
        ("a.obj", triangle("f 1 2 x"), "a.obj:4: `x` is not an index"),
        ("a.obj", triangle("f 1 2"), "a.obj:4: a face of 2 corners; valid: 3 or more"),
        ("a.obj", triangle("f 1 2 2"), "a.obj:4: a face without area; valid: corners that are not on one line"),
        ("a.obj", triangle("vn 0 0 1\nf 1 2 3\nf 1//1 2//1 3//1"), "a.obj:6: normals on some faces only; valid: on all faces or on none"),
        ("a.obj", triangle("vn 0 0 1\nf 1 2//1 3//1"), "a.obj:5: normals on some corners only; valid: on all corners or on none"),
        ("a.obj", triangle("vn 0 0 0"), "a.obj:4: a normal of length 0; valid: any other length"),
        ("a.obj", triangle("mtllib no.mtl"), "a.obj:4: no material library `no.mtl` beside it"),
        ("a.obj", TRIANGLE.to_owned(), "a.obj: no triangles; valid: at least one face"),
        ("p.json", "{\n\"nodes\": []}".to_owned(), "p.json:2: unknown field `nodes`"),
        ("p.json", "{\"note\": \"\", \"parts\": [{\"name\": \"a\", \"patches\": 1}], \"patches\": [[0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,9]], \"points\": [[0,0,0]]}".to_owned(), "p.json: patch 0 names point 9; valid: 0 to 0"),
        ("p.json", "{\"note\": \"\", \"parts\": [{\"name\": \"a\", \"patches\": 1}], \"patches\": [[0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0]], \"points\": [[0,0,0]]}".to_owned(), "p.json: part `a` has patches without area"),
        ("i.png", "not a picture".to_owned(), "i.png: "),
        ("i.exr", "not a picture".to_owned(), "i.exr: "),
        ("i.bmp", "not a picture".to_owned(), "i.bmp: unknown image format; valid: .png, .exr"),
    ];
    for (name, content, expected) in cases {
        let kind = Path::new(name).extension().unwrap().to_str().unwrap();
        let text = match kind {
            "obj" => GOOD.replace("sphere = { radius = 1.0 }", "obj = { file = \"a.obj\" }"),
            "json" => GOOD.replace("sphere = { radius = 1.0 }", "patches = { file = \"p.json\" }"),
            _ => GOOD.replace(
                "red = { colour = [1.0, 0.0, 0.0] }",
                &format!("red = {{ image = {{ file = \"{name}\", size = [1.0, 1.0] }} }}"),
            ),
        };
        let message = error_of(&text, &[(name, &content)]);
        assert!(message.starts_with(expected), "\n  said     {message}\n  expected {expected}");
    }
}

#[test]
fn materials_that_the_mesh_file_lacks_are_named() {
    let shape = "obj = { file = \"a.obj\", materials = { Steel = \"red\" } }";
    let obj = "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl Iron\nf 1 2 3\n";
    let assets = [("a.obj", obj), ("a.mtl", "newmtl Iron\nKd 1 0 0\n")];
    let both = GOOD.replace("sphere = { radius = 1.0 }", shape);
    let message = error_of(&both, &assets);
    assert_eq!(message, "test.toml:19: both `material` and `materials`; valid: one of the two");
    let text = both.replace("\nmaterial = \"mirror\"", "");
    let message = error_of(&text, &assets);
    assert_eq!(message, "test.toml:18: no material `Steel` in a.obj; valid: Iron");
    let known = text.replace("Steel = \"red\"", "Iron = \"gold\"");
    let message = error_of(&known, &assets);
    assert_eq!(message, "test.toml:18: unknown material `gold`; valid: mirror, red");
}

#[test]
fn an_unknown_name_is_a_usage_error_with_the_names() {
    let error = scene::load("kolumns").unwrap_err();
    assert!(matches!(error, Error::Usage(_)));
    let message = error.to_string();
    assert!(message.starts_with("unknown scene `kolumns`; valid: "), "{message}");
    assert!(message.contains("columns, ") && message.contains("kitchen, "), "{message}");
    assert!(matches!(scene::load("no/such/file.toml"), Err(Error::Scene(_))));
}

//! A scene at a moment as a POV-Ray 3.7 file.
//!
//! Lengths and directions are written as they are. POV-Ray is left-handed only by habit: with the
//! camera's three vectors given, its `right` points where ours does, and pictures are not mirrored.
//! What it cannot render as the truth does is refused: images, as albedo or environment.

use std::fmt::{self, Display, Write};

use glam::{Affine3A, Vec2, Vec3};
use mirrorbench::geometry::{Camera, Mesh, Projection};
use mirrorbench::scene::{
    Environment, Material, Mirror, Moment, ObjectId, Pattern, Scene, Surface,
};

/// What the picture's colours mean.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Look {
    /// Radiance, every surface lit by white ambient light only.
    Flat,
    /// Red: the object shown, through mirrors. Green: the object seen directly. Both as
    /// [`id_level`]; black where a chain of mirrors is cut off.
    Ids,
}

/// The level of 0 to 1 that stands for an object, or for the environment.
pub fn id_level(object: Option<ObjectId>) -> f64 {
    f64::from(object.map_or(255, |id| id + 1)) / 255.0
}

/// The text of the file. The camera's planes are left out: nothing may lie before the near one or
/// behind the far one.
pub fn write(scene: &Scene, moment: &Moment, look: Look) -> String {
    assert!(scene.objects.len() < 254, "ids are levels of 255");
    let mut file = String::from("#version 3.7;\n");
    // The ray of the camera is level 1, and one more follows each mirror.
    let levels = scene.bounces + 1;
    writeln!(file, "global_settings {{ assumed_gamma 1 max_trace_level {levels} adc_bailout 0 }}")
        .unwrap();
    file += &camera(&moment.camera);
    file += &sky(&scene.environment, look);
    for (id, pose) in (0..).zip(&moment.poses) {
        file += &object(scene, id, pose, look);
    }
    file
}

/// Vectors and numbers with all their digits.
struct V(Vec3);

impl Display for V {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        let [x, y, z] = self.0.as_dvec3().to_array();
        write!(f, "<{x}, {y}, {z}>")
    }
}

fn camera(camera: &Camera) -> String {
    let Projection::Perspective { fov_y } = camera.projection else {
        panic!("only perspective cameras are written");
    };
    let [right, up, back] = camera.axes();
    let side = 2.0 * (0.5 * fov_y).tan();
    format!(
        "camera {{ perspective location {} direction {} right {} up {} }}\n",
        V(camera.eye),
        V(-back),
        V(side * right),
        V(side * up)
    )
}

fn sky(environment: &Environment, look: Look) -> String {
    let pigment = match (look, environment) {
        (Look::Ids, _) => {
            let level = id_level(None);
            format!("color rgb <{level}, {level}, 0>")
        }
        (Look::Flat, Environment::Colour(colour)) => format!("color rgb {}", V(*colour)),
        (Look::Flat, Environment::Gradient { zenith, horizon, nadir }) => format!(
            // From a quarter to three quarters: a map repeats beyond 0 and 1.
            "function {{ 0.5 + 0.25 * y }} color_map {{ [0.25 rgb {}] [0.5 rgb {}] [0.75 rgb {}] }}",
            V(*nadir),
            V(*horizon),
            V(*zenith)
        ),
        (Look::Flat, Environment::LatLong { .. }) => panic!("environment images are not written"),
    };
    format!("sky_sphere {{ pigment {{ {pigment} }} }}\n")
}

fn object(scene: &Scene, id: ObjectId, pose: &Affine3A, look: Look) -> String {
    let texture = texture(id, scene.material_of(id), look);
    let surface = scene.objects[id as usize].surface;
    let shape = surface.and_then(round).unwrap_or_else(|| mesh(scene.mesh_of(id)));
    let [x, y, z] = [pose.matrix3.x_axis, pose.matrix3.y_axis, pose.matrix3.z_axis];
    let columns = [x, y, z, pose.translation];
    let matrix = columns.map(|column| V(column.into()).to_string().replace(['<', '>'], ""));
    // The texture comes before the matrix, so that it moves with the object.
    format!(
        "// {}\n{shape}\n  {texture}\n  matrix <{}>\n}}\n",
        scene.objects[id as usize].name,
        matrix.join(", ")
    )
}

/// A round shape in closed form, not yet closed; flat ones are exact as meshes. POV-Ray has texture
/// coordinates of its own on these, so their patterns are plain colours in the scenes compared.
fn round(surface: Surface) -> Option<String> {
    Some(match surface {
        Surface::Sphere { radius } => format!("sphere {{ <0, 0, 0>, {}", f64::from(radius)),
        Surface::Ellipsoid { radii } => format!("sphere {{ <0, 0, 0>, 1 scale {}", V(radii)),
        Surface::Cylinder { radius, height, capped } => {
            let (half, radius) = (0.5 * f64::from(height), f64::from(radius));
            let ends = if capped { "" } else { " open" };
            format!("cylinder {{ <0, {}, 0>, <0, {half}, 0>, {radius}{ends}", -half)
        }
        Surface::Torus { ring, tube } => {
            format!("torus {{ {}, {}", f64::from(ring), f64::from(tube))
        }
        Surface::Rectangle { .. } => return None,
    })
}

/// `mesh2`, not yet closed.
fn mesh(mesh: &Mesh) -> String {
    let list = |name: &str, items: Vec<String>| {
        format!("  {name} {{ {}, {} }}\n", items.len(), items.join(", "))
    };
    let vectors = |vectors: &[Vec3]| vectors.iter().map(|v| V(*v).to_string()).collect();
    let uv = |uv: &Vec2| format!("<{}, {}>", f64::from(uv.x), f64::from(uv.y));
    let face = |[a, b, c]: &[u32; 3]| format!("<{a}, {b}, {c}>");
    [
        "mesh2 {\n".to_owned(),
        list("vertex_vectors", vectors(&mesh.positions)),
        list("normal_vectors", vectors(&mesh.normals)),
        list("uv_vectors", mesh.uvs.iter().map(uv).collect()),
        list("face_indices", mesh.triangles.iter().map(face).collect()),
    ]
    .concat()
}

fn texture(id: ObjectId, material: &Material, look: Look) -> String {
    let pigment = match look {
        Look::Flat => pattern(&material.pattern),
        Look::Ids => {
            let level = id_level(Some(id));
            let red = if material.mirror.is_some() { 0.0 } else { level };
            format!("color rgb <{red}, {level}, 0>")
        }
    };
    let reflection =
        material.mirror.map_or(String::new(), |Mirror { reflectance, tint, .. }| {
            let passes = match look {
                Look::Flat => reflectance * tint,
                Look::Ids => {
                    assert!(
                        reflectance >= 0.5,
                        "{}: ids are those of the heavier layer",
                        material.name
                    );
                    Vec3::X
                }
            };
            format!(" reflection {{ rgb {} }}", V(passes))
        });
    let finish = format!("finish {{ ambient 0 diffuse 0 emission 1{reflection} }}");
    format!("texture {{ uv_mapping pigment {{ {pigment} }} {finish} }}")
}

/// The albedo over texture coordinates, which `uv_mapping` makes x and y.
fn pattern(pattern: &Pattern) -> String {
    // A function of 1/4 or 3/4, well inside the two halves of the map.
    let two = |first: Vec3, second: Vec3, function: String| {
        let [first, second] = [V(first), V(second)];
        format!(
            "function {{ {function} }} \
             color_map {{ [0 rgb {first}] [0.5 rgb {first}] [0.5 rgb {second}] [1 rgb {second}] }}"
        )
    };
    match *pattern {
        Pattern::Colour(colour) => format!("color rgb {}", V(colour)),
        Pattern::Checker { even, odd, size } => {
            let [u, v] = size.as_dvec2().to_array();
            let cell = format!("(floor(x / {u}) + floor(y / {v}))");
            two(even, odd, format!("0.25 + 0.5 * ({cell} - 2 * floor(0.5 * {cell}))"))
        }
        Pattern::Grid { ground, lines, size, line } => {
            let [u, v] = size.as_dvec2().to_array();
            let off = |axis: &str, size: f64| {
                format!("abs({axis} - floor({axis} / {size} + 0.5) * {size})")
            };
            let distance = format!("min({}, {})", off("x", u), off("y", v));
            let half = 0.5 * f64::from(line);
            two(lines, ground, format!("select({distance} - {half}, 0.25, 0.75)"))
        }
        Pattern::Image { .. } => panic!("images are not written"),
    }
}

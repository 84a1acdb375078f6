//! From the parsed file to the checked scene.

use std::collections::{BTreeMap, HashMap};

use glam::{Affine3A, EulerRot, Quat, Vec2, Vec3};
use half::f16;
use toml::Spanned;

use super::camera;
use super::format::{
    EnvironmentFile, ImpostorFile, KeyFile, LightingFile, MaterialFile, ObjectFile, ScatterFile,
    SceneFile, ShapeFile, Span, WobbleFile,
};
use super::image::decode;
use super::parts::{PartMaterial, parts};
use super::scatter::{Placement, placements};
use super::source::Source;
use super::values::{Positive, Triple, colour, triple};
use super::wobble::wobble;
use crate::error::Result;
use crate::scene::{
    Environment, Fade, Glass, Image, Impostor, Lighting, Material, Mirror, Motion, Object, Pattern,
    Scene, Surface, Wobble,
};

/// The materials of the file, by name.
type Defined = BTreeMap<String, Spanned<MaterialFile>>;

/// Everything gathered so far.
pub struct Builder {
    source: Source,
    rate_hz: f32,
    images: Vec<Image>,
    materials: Vec<Material>,
    meshes: Vec<crate::geometry::Mesh>,
    wobbles: BTreeMap<usize, Wobble>,
    objects: Vec<Object>,
    /// Shapes already made, by their text, scale and wobble: what two objects share is stored once.
    made: HashMap<String, Vec<MadePart>>,
}

/// A part whose mesh is in place.
#[derive(Clone)]
struct MadePart {
    name: Option<String>,
    mesh: usize,
    surface: Option<Surface>,
    material: PartMaterial,
}

/// Checks `file` and reads its assets.
pub fn build(name: String, source: Source, file: SceneFile) -> Result<Scene> {
    let mut builder = Builder {
        source,
        rate_hz: file.rate_hz.0,
        images: Vec::new(),
        materials: Vec::new(),
        meshes: Vec::new(),
        wobbles: BTreeMap::new(),
        objects: Vec::new(),
        made: HashMap::new(),
    };
    let lighting = match file.lighting {
        Some(lighting) => builder.lighting(&lighting)?,
        None => {
            Lighting { ambient: Vec3::ONE, towards_sun: Vec3::Y, sun: Vec3::ZERO, shadows: false }
        }
    };
    let environment = builder.environment(file.environment.get_ref())?;
    for (name, material) in &file.materials {
        let material = builder.material(name, material)?;
        builder.materials.push(material);
    }
    let camera = camera::path(&builder.source, &file.camera, file.rate_hz.0)?;
    for object in &file.objects {
        builder.object(object.get_ref(), &file.materials)?;
    }
    Ok(Scene {
        name,
        about: file.about,
        hash: builder.source.hash(),
        frames: file.frames.0,
        rate_hz: file.rate_hz.0,
        camera,
        objects: builder.objects,
        meshes: builder.meshes,
        wobbles: builder.wobbles,
        materials: builder.materials,
        images: builder.images,
        environment,
        lighting,
        bounces: file.bounces.0,
    })
}

impl Builder {
    fn lighting(&self, file: &Spanned<LightingFile>) -> Result<Lighting> {
        let lighting = file.get_ref();
        let towards_sun = triple(lighting.towards_sun).try_normalize();
        let Some(towards_sun) = towards_sun else {
            let message = "towards_sun has no direction; valid: a vector that is not zero";
            return Err(self.source.error(&file.span(), message));
        };
        Ok(Lighting {
            ambient: colour(lighting.ambient),
            towards_sun,
            sun: colour(lighting.sun),
            shadows: lighting.shadows,
        })
    }

    fn environment(&mut self, file: &EnvironmentFile) -> Result<Environment> {
        Ok(match file {
            EnvironmentFile::Colour(one) => Environment::Colour(colour(*one)),
            EnvironmentFile::Gradient(file) => Environment::Gradient {
                zenith: colour(file.zenith),
                horizon: colour(file.horizon),
                nadir: colour(file.nadir),
            },
            EnvironmentFile::LatLong(file) => {
                Environment::LatLong { image: self.image(&file.file, file.cap.0)? }
            }
        })
    }

    /// Reads an image and gives its index.
    fn image(&mut self, file: &Spanned<String>, cap: f32) -> Result<usize> {
        let asset = self.source.asset(file.get_ref(), &file.span())?;
        self.images.push(decode(&asset, cap)?);
        Ok(self.images.len() - 1)
    }

    fn material(&mut self, name: &str, file: &Spanned<MaterialFile>) -> Result<Material> {
        let keys = file.get_ref();
        let mirror = keys.mirror.as_ref().map(|mirror| Mirror {
            reflectance: mirror.reflectance.0,
            tint: colour(mirror.tint),
            fresnel: mirror.fresnel,
            fade: mirror
                .fade
                .as_ref()
                .map(|fade| Fade { distance: fade.distance.0, floor: fade.floor.0 }),
        });
        let glass = keys.glass.as_ref();
        let glass = glass.map(|glass| Glass { index: glass.index.0, tint: colour(glass.tint) });
        let mut patterns = self.patterns(keys)?;
        let pattern = match (patterns.pop(), mirror, glass) {
            (Some(pattern), _, None) if patterns.is_empty() => pattern,
            (None, Some(_), None) | (None, None, Some(_)) => Pattern::Colour(Vec3::ZERO),
            _ => {
                let message = format!(
                    "material `{name}` needs one look; \
                     valid: one of colour, checker, grid, image, with a mirror or without, \
                     mirror alone, or glass alone"
                );
                return Err(self.source.error(&file.span(), message));
            }
        };
        Ok(Material { name: name.to_owned(), pattern, mirror, glass })
    }

    /// The diffuse looks a material names.
    fn patterns(&mut self, file: &MaterialFile) -> Result<Vec<Pattern>> {
        let size = |size: [Positive; 2]| Vec2::from(size.map(|s| s.0));
        let mut patterns = Vec::new();
        patterns.extend(file.colour.map(|one| Pattern::Colour(colour(one))));
        patterns.extend(file.checker.as_ref().map(|checker| Pattern::Checker {
            even: colour(checker.even),
            odd: colour(checker.odd),
            size: size(checker.size),
        }));
        patterns.extend(file.grid.as_ref().map(|grid| Pattern::Grid {
            ground: colour(grid.ground),
            lines: colour(grid.lines),
            size: size(grid.size),
            line: grid.line.0,
        }));
        if let Some(file) = &file.image {
            let image = self.image(&file.file, f16::MAX.to_f32())?;
            patterns.push(Pattern::Image { image, size: size(file.size) });
        }
        Ok(patterns)
    }

    fn object(&mut self, file: &ObjectFile, defined: &Defined) -> Result<()> {
        let group = self.object_name(&file.name)?;
        if let (ShapeFile::Obj(obj), Some(own)) = (file.shape.get_ref(), &file.material)
            && !obj.materials.is_empty()
        {
            let message = "both `material` and `materials`; valid: one of the two";
            return Err(self.source.error(&own.span(), message));
        }
        match &file.scatter {
            None => {
                let motion = self.motion(file)?;
                let scale = file.scale.map_or(1.0, |s| s.0);
                self.add(file, defined, &group, scale, motion)
            }
            Some(scatter) => self.scattered(file, defined, &group, scatter),
        }
    }

    /// Copies `group-1`, `group-2`, ... of an object, each an object of its own.
    fn scattered(
        &mut self,
        file: &ObjectFile,
        defined: &Defined,
        group: &str,
        scatter: &Spanned<ScatterFile>,
    ) -> Result<()> {
        let placed = file.position.is_some() || file.rotation_deg.is_some() || file.scale.is_some();
        if placed || file.orbit.is_some() || file.keys.is_some() {
            let message = "scatter and a place of its own; valid: scatter alone, or the others";
            return Err(self.source.error(&scatter.span(), message));
        }
        let whole = parts(&mut self.source, file.shape.get_ref(), &file.shape.span())?;
        let points = whole.iter().flat_map(|part| &part.mesh.positions);
        let reach = points.map(|p| p.length()).fold(0.0, f32::max);
        let placements = placements(&self.source, scatter, reach)?;
        for (number, Placement { scale, pose }) in (1..).zip(placements) {
            let name = format!("{group}-{number}");
            self.add(file, defined, &name, scale, Motion::Still(pose))?;
        }
        Ok(())
    }

    /// The parts of an object, at a scale, into the scene.
    fn add(
        &mut self,
        file: &ObjectFile,
        defined: &Defined,
        group: &str,
        scale: f32,
        motion: Motion,
    ) -> Result<()> {
        let wobble = file.wobble.as_ref();
        let closed = file.closed.as_ref().map(|shape| self.closed(shape, scale, wobble));
        let closed = closed.transpose()?;
        let impostor = self.impostor(file)?;
        for part in self.make(&file.shape, scale, wobble)? {
            let name = match &part.name {
                Some(part) => format!("{group}.{}", part.replace(|c| !is_name_character(c), "-")),
                None => group.to_owned(),
            };
            if self.objects.iter().any(|object| object.name == name) {
                let message =
                    format!("a second object `{name}`; valid: a name of its own for each");
                return Err(self.source.error(&file.name.span(), message));
            }
            let material = self.part_material(file, part.material, defined)?;
            self.objects.push(Object {
                name,
                group: group.to_owned(),
                mesh: part.mesh,
                closed,
                material,
                surface: part.surface,
                motion: motion.clone(),
                impostor,
            });
        }
        Ok(())
    }

    fn impostor(&self, file: &ObjectFile) -> Result<Impostor> {
        let Some(file) = &file.impostor else { return Ok(Impostor::Fitted) };
        let ImpostorFile::Facing(towards) = file.get_ref() else { return Ok(Impostor::Backdrop) };
        triple(*towards).try_normalize().map(Impostor::Facing).ok_or_else(|| {
            let message = "facing has no direction; valid: a vector that is not zero";
            self.source.error(&file.span(), message)
        })
    }

    /// Checks that a name is new and may stand in the pattern of a case.
    fn object_name(&self, name: &Spanned<String>) -> Result<String> {
        let text = name.get_ref();
        let fail = |message: String| Err(self.source.error(&name.span(), message));
        if text.is_empty() || !text.chars().all(is_name_character) {
            return fail(format!("object name `{text}`; valid: letters, digits, `-`, `_` and `.`"));
        }
        if self.objects.iter().any(|object| object.group == *text) {
            return fail(format!("a second object `{text}`; valid: a name of its own for each"));
        }
        Ok(text.clone())
    }

    /// The mesh of a closed partner.
    fn closed(
        &mut self,
        shape: &Spanned<ShapeFile>,
        scale: f32,
        wobble: Option<&Spanned<WobbleFile>>,
    ) -> Result<usize> {
        match self.make(shape, scale, wobble)?.as_slice() {
            [one] => Ok(one.mesh),
            _ => {
                let message = "closed has several parts; valid: a shape of one part";
                Err(self.source.error(&shape.span(), message))
            }
        }
    }

    /// The meshes of a shape, from the store where an equal one was made before.
    fn make(
        &mut self,
        shape: &Spanned<ShapeFile>,
        scale: f32,
        wobbling: Option<&Spanned<WobbleFile>>,
    ) -> Result<Vec<MadePart>> {
        let text = |span: Span| &self.source.text()[span];
        let waves = wobbling.map_or("", |wobble| text(wobble.span()));
        let key = format!("{scale} {} {waves}", text(shape.span()));
        if let Some(made) = self.made.get(&key) {
            return Ok(made.clone());
        }
        let mut made = Vec::new();
        for part in parts(&mut self.source, shape.get_ref(), &shape.span())? {
            let (mesh, shape) = (self.meshes.len(), part.mesh.scaled(scale));
            let mut surface = part.surface.map(|surface| surface.scaled(scale));
            if let Some(file) = wobbling {
                self.wobbles.insert(mesh, wobble(&self.source, file, &shape, self.rate_hz)?);
                surface = None;
            }
            self.meshes.push(shape);
            made.push(MadePart { name: part.name, mesh, surface, material: part.material });
        }
        self.made.insert(key, made.clone());
        Ok(made)
    }

    /// The index of a part's material; colours of mesh files become materials when first met.
    fn part_material(
        &mut self,
        file: &ObjectFile,
        material: PartMaterial,
        defined: &Defined,
    ) -> Result<usize> {
        let (name, span) = match (material, &file.material) {
            (_, Some(own)) => (own.get_ref().clone(), own.span()),
            (PartMaterial::Named(name, span), None) => (name, span),
            (PartMaterial::Objects, None) => {
                let message = "missing key `material`; valid: a name under [materials]";
                return Err(self.source.error(&file.name.span(), message));
            }
            (PartMaterial::Diffuse { name, colour }, None) => {
                return Ok(self.diffuse_material(name, colour));
            }
        };
        match self.materials.iter().position(|m| m.name == name) {
            Some(index) if defined.contains_key(&name) => Ok(index),
            _ => {
                let valid: Vec<&str> = defined.keys().map(String::as_str).collect();
                let message = format!("unknown material `{name}`; valid: {}", valid.join(", "));
                Err(self.source.error(&span, message))
            }
        }
    }

    fn diffuse_material(&mut self, name: String, colour: Vec3) -> usize {
        match self.materials.iter().position(|m| m.name == name) {
            Some(index) => index,
            None => {
                let pattern = Pattern::Colour(colour);
                self.materials.push(Material { name, pattern, mirror: None, glass: None });
                self.materials.len() - 1
            }
        }
    }

    fn motion(&self, file: &ObjectFile) -> Result<Motion> {
        let still = pose(file.position, file.rotation_deg);
        match (&file.keys, &file.orbit) {
            (None, None) => Ok(Motion::Still(still)),
            (None, Some(orbit)) => Ok(Motion::Orbit {
                pose: still,
                centre: triple(orbit.centre),
                period: orbit.period_s.0 * self.rate_hz,
            }),
            (Some(keys), None) if file.position.is_none() && file.rotation_deg.is_none() => {
                let keyed = |key: &KeyFile| {
                    (key.time_s.0 * self.rate_hz, pose(Some(key.position), key.rotation_deg))
                };
                let span = file.name.span();
                Ok(Motion::Keys(rising(&self.source, &span, keys, |key| key.time_s.0, keyed)?))
            }
            (Some(_), _) => {
                let message =
                    "two kinds of motion; valid: keys alone, or position, rotation_deg and orbit";
                Err(self.source.error(&file.name.span(), message))
            }
        }
    }
}

/// Converts key frames after checking that there are some and that their times rise; `span` is what
/// they belong to.
pub fn rising<K, T>(
    source: &Source,
    span: &Span,
    keys: &[Spanned<K>],
    time: impl Fn(&K) -> f32,
    convert: impl Fn(&K) -> T,
) -> Result<Vec<T>> {
    if keys.is_empty() {
        return Err(source.error(span, "keys is empty; valid: one key or more"));
    }
    for pair in keys.windows(2) {
        let (before, after) = (time(pair[0].get_ref()), time(pair[1].get_ref()));
        if after <= before {
            let message =
                format!("time_s = {after} is out of range; valid: above {before}, the key before");
            return Err(source.error(&pair[1].span(), message));
        }
    }
    Ok(keys.iter().map(|key| convert(key.get_ref())).collect())
}

fn is_name_character(c: char) -> bool {
    c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.')
}

/// World from object space: turned about z, then x, then y, then moved.
fn pose(position: Option<Triple>, rotation_deg: Option<Triple>) -> Affine3A {
    let [x, y, z] = rotation_deg.map_or([0.0; 3], |r| r.map(|angle| angle.0.to_radians()));
    let rotation = Quat::from_euler(EulerRot::YXZ, y, x, z);
    Affine3A::from_rotation_translation(rotation, position.map_or(Vec3::ZERO, triple))
}

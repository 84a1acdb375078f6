//! Surfaces, images, environment and light: the inputs of the one shading function.

use glam::{Vec2, Vec3};

/// How a surface looks. Colours are linear Rec.709.
#[derive(Clone, Debug, PartialEq)]
pub struct Material {
    pub name: String,
    /// Diffuse albedo; black on a pure mirror.
    pub pattern: Pattern,
    /// Present on mirrors.
    pub mirror: Option<Mirror>,
    /// Present on glass, which is no mirror.
    pub glass: Option<Glass>,
}

impl Material {
    /// Whether it is a mirror or glass.
    pub fn is_reflector(&self) -> bool {
        self.mirror.is_some() || self.glass.is_some()
    }

    /// What is left of light reflected after so many metres from here.
    pub fn faded(&self, path: f32) -> f32 {
        self.mirror.and_then(|mirror| mirror.fade).map_or(1.0, |fade| fade.share(path))
    }
}

/// Diffuse albedo over texture coordinates.
#[derive(Clone, Debug, PartialEq)]
pub enum Pattern {
    Colour(Vec3),
    /// Rectangles of sides `size`, `even` at the origin's upper right (texture coordinate units).
    Checker {
        even: Vec3,
        odd: Vec3,
        size: Vec2,
    },
    /// Lines of width `line` centred on every multiple of `size` (texture coordinate units).
    Grid {
        ground: Vec3,
        lines: Vec3,
        size: Vec2,
        line: f32,
    },
    /// Index into [`crate::scene::Scene::images`]; one image covers `size` texture coordinate
    /// units, its lower left corner at the origin.
    Image {
        image: usize,
        size: Vec2,
    },
}

/// What a reflector does to the light it reflects.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Mirror {
    /// Share of light reflected, 0 to 1; with `fresnel` that of light along the normal.
    pub reflectance: f32,
    /// Colour multiplied onto the reflection.
    pub tint: Vec3,
    /// The share rises to 1 for grazing light.
    pub fresnel: bool,
    /// How what is reflected fades with its distance.
    pub fade: Option<Fade>,
}

impl Mirror {
    /// One whose share depends on nothing.
    pub fn plain(reflectance: f32, tint: Vec3) -> Mirror {
        Mirror { reflectance, tint, fresnel: false, fade: None }
    }

    /// Share of light reflected at this cosine between ray and normal: Fresnel's law in Schlick's
    /// approximation (1994, equation 15).
    pub fn share(&self, cosine: f32) -> f32 {
        if !self.fresnel {
            return self.reflectance;
        }
        let rest = 1.0 - cosine.clamp(0.0, 1.0);
        self.reflectance + (1.0 - self.reflectance) * (rest * rest) * (rest * rest) * rest
    }
}

/// Attenuation with distance (Popescu et al. 2006, slide 29, which gives no formula): the mirror that the
/// eye sees shows light after `path` metres from it as exp(-path / distance) of itself, down to `floor`,
/// which is also what is left of the environment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Fade {
    /// Metres, above 0.
    pub distance: f32,
    /// 0 to 1.
    pub floor: f32,
}

impl Fade {
    /// What is left after so many metres.
    pub fn share(&self, path: f32) -> f32 {
        self.floor + (1.0 - self.floor) * (-path / self.distance).exp()
    }
}

/// The inside of a closed surface: light is split between reflection and refraction (Fresnel).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Glass {
    /// Refractive index of the inside over that of the outside.
    pub index: f32,
    /// Colour multiplied onto light each time it passes through the surface.
    pub tint: Vec3,
}

/// A linear RGB image with half-float precision, row 0 on top; wraps in both directions.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    pub width: u32,
    pub height: u32,
    /// Row-major, values already rounded to half precision so that CPU and GPU agree.
    pub texels: Vec<Vec3>,
}

/// Radiance arriving from infinitely far away.
#[derive(Clone, Debug, PartialEq)]
pub enum Environment {
    Colour(Vec3),
    /// By the direction's y: `nadir` at -1, `horizon` at 0, `zenith` at 1, linear between.
    Gradient {
        zenith: Vec3,
        horizon: Vec3,
        nadir: Vec3,
    },
    /// Latitude-longitude image, index into [`crate::scene::Scene::images`]. A direction d is at
    /// u = 1/2 + atan2(d.x, -d.z) / 2 pi, v = acos(d.y) / pi: -z in the middle, +y on top.
    LatLong {
        image: usize,
    },
}

/// One ambient and one directional light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lighting {
    /// Ambient radiance, multiplied by the albedo.
    pub ambient: Vec3,
    /// Unit vector towards the light.
    pub towards_sun: Vec3,
    /// Multiplied by albedo and the cosine to the normal.
    pub sun: Vec3,
    /// Whether surfaces keep the sun from others. Glass never does.
    pub shadows: bool,
}

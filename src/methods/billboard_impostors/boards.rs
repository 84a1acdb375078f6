//! The billboards of a scene: which there are, whom they face, and which mirror sees which.

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use super::super::Setup;
use super::INFO;
use super::own::{OwnView, own_views};
use crate::error::Result;
use crate::gpu::{Frame, Pass, Slice};
use crate::scene::{Impostor, ObjectId, Scene};
use crate::stages::{
    GpuScene, PortraitStage, PortraitView, Portraits, Sight, own_from_world, own_points,
};

/// What is thinner than this share of its width is its own billboard.
const FLAT: f32 = 0.05;
/// How many texels all pictures together have at most: 512 MiB at 60 bytes each.
const TEXELS: u32 = (512 << 20) / 60;
/// Sides of pictures where no size is forced.
const SIZES: [u32; 10] = [512, 384, 256, 192, 128, 96, 64, 48, 32, 16];
/// The highest bits of a billboard's word, see `shaders/billboard_impostors/boards.wgsl`.
const FLAT_BIT: u32 = 1 << 31;
const OWN_BIT: u32 = 1 << 30;

/// WGSL `Sight` of `shaders/billboard_impostors/boards.wgsl`.
#[derive(Clone, Copy, Default, Pod, Zeroable)]
#[repr(C)]
struct SightEntry {
    first: u32,
    diffuse: u32,
    all: u32,
    pad: u32,
}

/// The objects that environment maps show.
pub fn backdrop(scene: &Scene) -> Vec<ObjectId> {
    with_impostor(scene, |impostor| impostor == Impostor::Backdrop)
}

/// The objects that billboards show.
fn near(scene: &Scene) -> Vec<ObjectId> {
    with_impostor(scene, |impostor| impostor != Impostor::Backdrop)
}

fn with_impostor(scene: &Scene, wanted: impl Fn(Impostor) -> bool) -> Vec<ObjectId> {
    let of = |object: ObjectId| scene.objects[object as usize].impostor;
    (0..scene.objects.len() as ObjectId).filter(|&object| wanted(of(object))).collect()
}

/// What a billboard shows.
struct Thing {
    /// Of one group: they have one pose.
    objects: Vec<ObjectId>,
    /// Some of it mirrors or is of glass, so it sees billboards itself.
    sees: bool,
    /// Some of it mirrors: its billboard counts as reflective.
    mirrors: bool,
    flat: bool,
    moves: bool,
    impostor: Impostor,
}

/// Which mirrors a layer's picture is for.
#[derive(Clone, Copy, PartialEq)]
enum Faced {
    All,
    /// Rank among the things.
    One(usize),
    /// The thing itself, for what it shows of itself: the picture is of a part, from infinitely far in
    /// this direction of own space.
    Own(Vec3),
}

/// One layer of the portraits.
struct Layer {
    thing: usize,
    /// What is pictured: all of the thing, or a part.
    objects: Vec<ObjectId>,
    faced: Faced,
    /// From where it was last taken, own space.
    eye: Option<Vec3>,
}

/// All billboards of a scene.
pub struct Boards {
    stage: PortraitStage,
    portraits: Portraits,
    things: Vec<Thing>,
    layers: Vec<Layer>,
    sight: Sight,
    /// Radians.
    step: f32,
}

/// What shaders read, uploaded for a frame.
pub struct Tables {
    portraits: Slice,
    sights: Slice,
    boards: Slice,
}

impl Boards {
    /// # Errors
    /// [`crate::error::Error::Device`] where the device has no memory or no images for that many.
    pub fn new(setup: &Setup) -> Result<Boards> {
        let (device, scene, values) = (setup.device, &setup.scene.scene, setup.values);
        let things = things(scene);
        let mut layers = layers(&things, values.is("views", "each"));
        if values.is("relief", "on") {
            layers.extend(own_layers(scene, &things, values.u32("own") as usize));
        }
        let fits = |size: &u32| size * size * layers.len() as u32 <= TEXELS;
        let size = values.forced_u32("size");
        let size = size.or(SIZES.into_iter().find(fits)).unwrap_or(SIZES[SIZES.len() - 1]);
        let levels = if values.is("filter", "mip") { size.ilog2() + 1 } else { 1 };
        let portraits = Portraits::new(device, "billboards", size, layers.len() as u32, levels)?;
        let sight = if values.is("sight", "central") { Sight::Central } else { Sight::Parallel };
        let step = values.f32("view_deg").to_radians();
        Ok(Boards { stage: PortraitStage::new(device)?, portraits, things, layers, sight, step })
    }

    /// Texels along a picture's side.
    pub fn size(&self) -> u32 {
        self.portraits.size
    }

    /// Mip levels of their light.
    pub fn levels(&self) -> u32 {
        self.portraits.radiance.levels
    }

    /// Take the pictures whose view or object's shape is another than when they were last taken, and
    /// light them all.
    pub fn prepare(&mut self, frame: &mut Frame, scene: &GpuScene) -> Result<()> {
        for index in 0..self.layers.len() {
            let layer = &self.layers[index];
            let thing = &self.things[layer.thing];
            let eye = self.eye(scene, layer);
            let deformed = thing.objects.iter().any(|&object| scene.deformed(object).is_some());
            if layer.eye == Some(eye) && !deformed {
                continue;
            }
            let points = own_points(&scene.scene, scene.moment(), &layer.objects);
            let view = match (layer.faced, thing.impostor) {
                (Faced::Own(_), _) | (_, Impostor::Facing(_)) => {
                    PortraitView::facing(&points, eye, Sight::Parallel)
                }
                _ if thing.flat => PortraitView::flat(&points, eye),
                _ => PortraitView::facing(&points, eye, self.sight),
            };
            self.layers[index].eye = Some(eye);
            // What is flat looks the same from everywhere on one side.
            if self.portraits.view(index as u32) == Some(&view) && !deformed {
                continue;
            }
            let layer = &self.layers[index];
            let target = (&mut self.portraits, index as u32);
            self.stage.take(frame, scene, INFO.id, target, &layer.objects, view)?;
        }
        self.stage.light(frame, scene, INFO.id, &self.portraits)
    }

    /// The point a layer's picture faces, in its thing's own space. Between things that move it goes in
    /// steps, which depend on nothing but where they are: a frame looks the same whatever came before.
    fn eye(&self, scene: &GpuScene, layer: &Layer) -> Vec3 {
        let (thing, moment) = (&self.things[layer.thing], scene.moment());
        let centre = own_centre(scene, thing);
        if let Impostor::Facing(towards) = thing.impostor {
            // So far away that the middle's own motion does not count.
            return centre + 1e3 * towards;
        }
        let seeing: Vec<_> = match layer.faced {
            Faced::Own(towards) => return centre + 1e3 * towards,
            Faced::One(viewer) => vec![viewer],
            Faced::All => viewers_of(&self.things, layer.thing).collect(),
        };
        let of = |&viewer: &usize| scene.scene.centre_of(moment, &self.things[viewer].objects);
        let mean = seeing.iter().map(of).sum::<Vec3>() / seeing.len() as f32;
        let eye = own_from_world(moment, thing.objects[0]).transform_point3(mean);
        let still = !thing.moves && seeing.iter().all(|&viewer| !self.things[viewer].moves);
        if still || self.step == 0.0 { eye } else { centre + stepped(eye - centre, self.step) }
    }

    /// What environment maps leave out: all that has a billboard but the flat diffuse things, which would otherwise
    /// leave holes in them right where a ray passes their border.
    pub fn left_out(&self) -> Vec<ObjectId> {
        let stands_up = |thing: &&Thing| !thing.flat || thing.mirrors;
        let things = self.things.iter().filter(stands_up);
        things.flat_map(|thing| thing.objects.iter().copied()).collect()
    }

    /// Upload what shaders read.
    pub fn upload(&self, frame: &mut Frame, scene: &GpuScene) -> Result<Tables> {
        let mut sights = vec![SightEntry::default(); scene.scene.objects.len()];
        let mut boards = Vec::new();
        for viewer in (0..self.things.len()).filter(|&thing| self.things[thing].sees) {
            let seen: Vec<u32> = (0..self.layers.len() as u32)
                .filter(|&index| self.is_seen_by(&self.layers[index as usize], viewer))
                .collect();
            let is_mirror = |index: &u32| self.things[self.layers[*index as usize].thing].mirrors;
            let (mirrors, diffuse): (Vec<u32>, Vec<u32>) = seen.into_iter().partition(is_mirror);
            for &object in &self.things[viewer].objects {
                sights[object as usize] = SightEntry {
                    first: boards.len() as u32,
                    diffuse: diffuse.len() as u32,
                    all: (diffuse.len() + mirrors.len()) as u32,
                    pad: 0,
                };
                boards
                    .extend(diffuse.iter().chain(&mirrors).map(|&index| self.word(index, object)));
            }
        }
        Ok(Tables {
            portraits: frame.upload(&self.portraits.uniforms(scene))?,
            sights: frame.upload(&sights)?,
            boards: frame.upload(&boards)?,
        })
    }

    /// What stands for a layer among the billboards that an object sees.
    fn word(&self, index: u32, object: ObjectId) -> u32 {
        let layer = &self.layers[index as usize];
        match layer.faced {
            Faced::Own(_) if layer.objects.contains(&object) => index | OWN_BIT,
            _ if self.things[layer.thing].flat => index | FLAT_BIT,
            _ => index,
        }
    }

    fn is_seen_by(&self, layer: &Layer, viewer: usize) -> bool {
        match layer.faced {
            Faced::All => layer.thing != viewer,
            Faced::One(one) => one == viewer,
            Faced::Own(_) => layer.thing == viewer,
        }
    }

    /// Bind all of it.
    pub fn bind<'f>(&'f self, pass: Pass<'f>, tables: &Tables) -> Pass<'f> {
        self.portraits
            .bind(pass)
            .slice("portraits", tables.portraits)
            .slice("sights", tables.sights)
            .slice("boards", tables.boards)
    }
}

/// The groups that have billboards.
fn things(scene: &Scene) -> Vec<Thing> {
    let thing = |(_, objects): (String, Vec<ObjectId>)| {
        let any = |holds: &dyn Fn(ObjectId) -> bool| objects.iter().any(|&object| holds(object));
        let points = own_points(scene, &scene.at(0), &objects);
        let impostor = scene.objects[objects[0] as usize].impostor;
        Thing {
            sees: any(&|object| scene.is_reflector(object)),
            mirrors: any(&|object| scene.material_of(object).mirror.is_some()),
            flat: impostor == Impostor::Fitted && PortraitView::flatness(&points) < FLAT,
            moves: any(&|object| scene.is_moving(object)),
            impostor,
            objects,
        }
    };
    scene.groups(&near(scene)).into_iter().map(thing).collect()
}

/// The things that see another's billboard.
fn viewers_of(things: &[Thing], of: usize) -> impl Iterator<Item = usize> {
    (0..things.len()).filter(move |&viewer| viewer != of && things[viewer].sees)
}

/// The pictures needed: what is flat or faces one way looks the same from everywhere, and what no mirror but
/// its own sees needs none.
fn layers(things: &[Thing], each: bool) -> Vec<Layer> {
    let mut layers = Vec::new();
    for (index, thing) in things.iter().enumerate() {
        let mut add = |faced| {
            layers.push(Layer { thing: index, objects: thing.objects.clone(), faced, eye: None });
        };
        if each && !thing.flat && thing.impostor == Impostor::Fitted {
            viewers_of(things, index).for_each(|viewer| add(Faced::One(viewer)));
        } else if viewers_of(things, index).next().is_some() {
            add(Faced::All);
        }
    }
    layers
}

/// The pictures mirrors need of themselves, at most so many a thing.
fn own_layers(scene: &Scene, things: &[Thing], most: usize) -> Vec<Layer> {
    let of = |(index, thing): (usize, &Thing)| {
        let views = own_views(scene, &thing.objects, most).into_iter();
        let layer = move |view: OwnView| Layer {
            thing: index,
            objects: vec![view.part],
            faced: Faced::Own(view.towards),
            eye: None,
        };
        views.map(layer).collect::<Vec<_>>()
    };
    things.iter().enumerate().filter(|(_, thing)| thing.mirrors).flat_map(of).collect()
}

/// The middle of a thing's box in its own space, at rest.
fn own_centre(scene: &GpuScene, thing: &Thing) -> Vec3 {
    let empty = (Vec3::INFINITY, Vec3::NEG_INFINITY);
    let boxes = thing.objects.iter().filter_map(|&object| scene.scene.mesh_of(object).bounds());
    let (low, high) = boxes.fold(empty, |(a, b), (c, d)| (a.min(c), b.max(d)));
    0.5 * (low + high)
}

/// A vector with its direction and the logarithm of its length rounded to steps of so many radians.
fn stepped(v: Vec3, step: f32) -> Vec3 {
    let round = |x: f32| (x / step).round() * step;
    let (turn, rise) = (round(v.z.atan2(v.x)), round(v.y.atan2(v.x.hypot(v.z))));
    let length = round(v.length().max(1e-6).ln()).exp();
    length * Vec3::new(rise.cos() * turn.cos(), rise.sin(), rise.cos() * turn.sin())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::gpu::layout::assert_layout;

    #[test]
    fn a_sight_is_laid_out_as_its_wgsl_twin() {
        assert_layout!(
            "billboard_impostors/reflect.wgsl",
            "Sight",
            SightEntry,
            first,
            diffuse,
            all,
            pad
        );
    }

    #[test]
    fn a_view_changes_in_steps_and_by_at_most_one() {
        let step = 0.1f32;
        let v = Vec3::new(1.0, 0.5, -2.0);
        let rounded = stepped(v, step);
        assert!(rounded.angle_between(v) < step, "turned by {}", rounded.angle_between(v));
        assert!((rounded.length() / v.length()).ln().abs() <= 0.5 * step + 1e-5);
        assert!(stepped(rounded * 1.001, step).abs_diff_eq(rounded, 1e-5), "and stays there");
        assert_ne!(stepped(Vec3::new(1.0, 0.5, -1.5), step), rounded);
    }
}

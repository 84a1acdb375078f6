//! Billboard impostors: every reflected object as one picture on a quad; quads of mirrors carry normals, so
//! that rays go on from them (Popescu, Mei, Dauble & Sacks 2006, slides 13 to 34).
//!
//! `published` is the pixel algorithm of slide 15 at the slides' cost: K = 2 orders, of which the last
//! tests the billboards of diffuse things only (slides 17 to 22: "D + (R - 1) + D intersections a pixel"; slide 15 itself
//! tests all at every order: `last=all`). A mirror skips its own billboard. A ray that meets none shows the
//! environment map; beside a flat thing's border the map's direction is morphed (slides 24 to 28), which
//! `morph=0` turns off (slide 24). Distances along the ray decide what is in front.
//!
//! `revised` takes a picture of each object for each mirror, as that mirror's centre sees it, and follows as many
//! orders as the scene asks for. Rays do not meet the quads but the surfaces whose depth is stored with the pictures
//! (`relief`), and leave from there: "flat reflection" and "lack of motion parallax" (slide 34) end where a picture shows
//! all that rays can see. A mirror shows itself (`own`; "self-reflections", slide 50) in pictures of its parts
//! that are chosen by what its rays meet. The environment map is looked up where a ray meets what is in it
//! (`far`), and ray morphing hides a border with mip maps too (`border`).
//!
//! Choices the slides leave open: pictures are placed by the object's bounds, through their middle,
//! facing the middle of all mirrors that see them; what is flat is its own billboard; the margin of ray
//! morphing; only flat diffuse things have one, since behind any other border begins something else. In the
//! environment map is what the scene calls its backdrop, and what is flat: anything else that has a billboard
//! would be seen twice. After the last order a mirror shows its own colour.

mod boards;
mod own;

use std::sync::Arc;

use bytemuck::{Pod, Zeroable};
use glam::Vec3;

use self::boards::Boards;
use super::params::STAGE;
use super::{Changes, Family, Kind, MethodInfo, Param, ReflectionMethod, Setup, Want};
use crate::error::Result;
use crate::gpu::{ComputePipeline, Device, Frame};
use crate::scene::ObjectId;
use crate::stages::{Capture, CaptureStage, GpuScene, PixelPass, ReflectionRecord, View, shrink};

pub const INFO: MethodInfo = MethodInfo {
    id: "billboard-impostors",
    title: "Billboard impostors: reflected objects as quads, those of mirrors with normals",
    paper: "Popescu, Mei, Dauble & Sacks 2006, slides 13-34",
    family: Family::ImageSpace,
    depends: Changes::ALL,
    flags: false,
    refracts: false,
    variants: &["published", "revised"],
    params: &[
        Param {
            name: "bounces",
            kind: Kind::Integer { min: 0, max: 16 },
            defaults: &["2", "0"],
            needs: None,
            doc: "K, the highest order of reflection; 0 takes the scene's",
        },
        Param {
            name: "last",
            kind: Kind::Choice(&["diffuse", "all"]),
            defaults: &["diffuse", "all"],
            needs: None,
            doc: "billboards the last order is tested against: of diffuse things (slide 17), or all \
                  (slide 15)",
        },
        Param {
            name: "views",
            kind: Kind::Choice(&["shared", "each"]),
            defaults: &["shared", "each"],
            needs: None,
            doc: "one billboard an object, or one an object and mirror that sees it",
        },
        Param {
            name: "sight",
            kind: Kind::Choice(&["parallel", "central"]),
            defaults: &["parallel", "central"],
            needs: None,
            doc: "pictures under parallel rays, or as the point they face sees them",
        },
        Param {
            name: "origin",
            kind: Kind::Choice(&["quad", "stored"]),
            defaults: &["quad", "stored"],
            needs: None,
            doc: "where a ray mirrored in a billboard leaves: from the quad, or from the surface point \
                  stored with the picture",
        },
        Param {
            name: "relief",
            kind: Kind::Choice(&["off", "on"]),
            defaults: &["off", "on"],
            needs: None,
            doc: "rays meet quads, or the surface stored with the picture, by a search along it (parallax \
                  within an object)",
        },
        Param {
            name: "steps",
            kind: Kind::Integer { min: 1, max: 1024 },
            defaults: &["64"],
            needs: Some(("relief", &["on"])),
            doc: "the most steps of that search; one a texel is enough",
        },
        Param {
            name: "own",
            kind: Kind::Integer { min: 0, max: 64 },
            defaults: &["0", "16"],
            needs: Some(("relief", &["on"])),
            doc: "the most pictures a mirror has of its own parts, in which it shows itself; 0: it skips its \
                  own billboard",
        },
        Param {
            name: "morph",
            kind: Kind::Real { min: 0.0, max: 1.0 },
            defaults: &["0.25"],
            needs: None,
            doc: "margin of ray morphing round flat things, as a share of their shorter side; 0: none",
        },
        Param {
            name: "far",
            kind: Kind::Choice(&["direction", "distance"]),
            defaults: &["direction", "distance"],
            needs: None,
            doc: "the environment map is looked up by a ray's direction, or where the ray meets the surfaces \
                  in it",
        },
        Param {
            name: "border",
            kind: Kind::Choice(&["blurred", "sharp"]),
            defaults: &["blurred", "sharp"],
            needs: Some(("filter", &["mip"])),
            doc: "mip level of the environment map beside a flat thing's border: the footprint's, or one that \
                  rises from 0 there, as the billboard's own falls to it",
        },
        Param {
            name: "filter",
            kind: Kind::Choice(&["bilinear", "mip"]),
            defaults: &["mip"],
            needs: None,
            doc: "colour between texels, or also between mip levels by the pixel's footprint",
        },
        Param {
            name: "size",
            kind: Kind::IntegerOrAuto { min: 16, max: 2048 },
            defaults: &["auto"],
            needs: None,
            doc: "texels along a picture's side; auto: 512, or fewer in 512 MiB",
        },
        Param {
            name: "map",
            kind: Kind::Integer { min: 4, max: 4096 },
            defaults: &["512"],
            needs: None,
            doc: "texels along a face's side of the environment map that shows the backdrop",
        },
        Param {
            name: "view_deg",
            kind: Kind::Real { min: 0.0, max: 45.0 },
            defaults: &["2"],
            needs: None,
            doc: "steps in which the view of moving things changes, and with it their picture, degrees",
        },
        STAGE,
    ],
    limits: "what no picture of an object shows is not there; without relief, objects are flat, those near a \
             mirror are cut by it, and none mirrors itself; no glass",
    passes: &[
        "billboard-impostors/portrait",
        "billboard-impostors/portrait-light",
        "billboard-impostors/shrink",
        "billboard-impostors/capture-background",
        "billboard-impostors/capture",
        "footprint/clear-list",
        "footprint/list",
        "billboard-impostors/reflect",
    ],
    counters: &["intersections", "most_intersections", "second_order"],
    new: Some(new),
};

/// WGSL `Params` of `shaders/billboard_impostors/boards.wgsl`.
#[derive(Clone, Copy, Pod, Zeroable)]
#[repr(C)]
struct Params {
    centre: [f32; 3],
    bounces: u32,
    size: f32,
    coarsest: f32,
    margin: f32,
    steps: u32,
}

/// The mirrors of one group, and the environment map taken from their middle.
struct Viewer {
    objects: Vec<ObjectId>,
    centre: Vec3,
    /// Where the scene has a backdrop.
    backdrop: Option<Capture>,
}

struct BillboardImpostors {
    device: Arc<Device>,
    boards: Boards,
    reflect: PixelPass,
    bounces: u32,
    margin: f32,
    steps: u32,
    map: u32,
    /// Takes environment maps; where the scene has a backdrop.
    stage: Option<CaptureStage>,
    /// Makes their mip maps, where asked for.
    shrink: Option<ComputePipeline>,
    viewers: Vec<Viewer>,
}

fn new(setup: &Setup) -> Result<Box<dyn ReflectionMethod>> {
    let (device, scene, values) = (setup.device, &setup.scene.scene, setup.values);
    let backdrop = !boards::backdrop(scene).is_empty();
    let margin = values.f32("morph");
    let defines: Vec<_> = [
        ("BACKDROP", backdrop),
        // Behind no backdrop is only what is infinitely far, which no point of view changes.
        ("MORPH", backdrop && margin > 0.0),
        ("LAST_DIFFUSE", values.is("last", "diffuse")),
        ("ORIGIN_STORED", values.is("origin", "stored")),
        ("RELIEF", values.is("relief", "on")),
        ("FAR_DISTANCE", backdrop && values.is("far", "distance")),
        ("BORDER_SHARP", values.is("border", "sharp")),
        ("FILTER_MIP", values.is("filter", "mip")),
    ]
    .into_iter()
    .filter_map(|(name, on)| on.then_some((name, 1)))
    .collect();
    let bounces = values.u32("bounces");
    Ok(Box::new(BillboardImpostors {
        device: device.clone(),
        boards: Boards::new(setup)?,
        reflect: setup.pixel_pass("billboard_impostors/reflect.wgsl", &defines)?,
        bounces: if bounces == 0 { scene.bounces } else { bounces },
        margin,
        steps: values.u32("steps"),
        map: values.u32("map"),
        stage: backdrop.then(|| CaptureStage::new(device)).transpose()?,
        shrink: (backdrop && values.is("filter", "mip"))
            .then(|| ComputePipeline::new(device, "stages/shrink.wgsl", &[]))
            .transpose()?,
        viewers: Vec::new(),
    }))
}

impl BillboardImpostors {
    /// The environment maps, of which each mirror has its own.
    fn take_backdrops(&mut self, frame: &mut Frame, scene: &GpuScene, want: &Want) -> Result<()> {
        if self.viewers.is_empty() {
            for (group, objects) in scene.scene.groups(want.reflectors) {
                let name = format!("backdrop of {group}");
                let levels = if self.shrink.is_some() { self.map.ilog2() + 1 } else { 1 };
                let capture = || Capture::with_levels(&self.device, &name, self.map, levels);
                let backdrop = self.stage.is_some().then(capture).transpose()?;
                self.viewers.push(Viewer { objects, centre: Vec3::NAN, backdrop });
            }
        }
        let left_out = self.boards.left_out();
        let objects = 0..scene.scene.objects.len() as ObjectId;
        let moves = objects
            .filter(|object| !left_out.contains(object))
            .any(|object| scene.scene.is_moving(object));
        for Viewer { objects, centre, backdrop } in &mut self.viewers {
            let now = scene.scene.centre_of(scene.moment(), objects);
            let stale = *centre != now || moves || want.changed.shading;
            *centre = now;
            if let (true, Some(stage), Some(backdrop)) = (stale, &self.stage, backdrop) {
                stage.capture(frame, scene, INFO.id, backdrop, now, &left_out)?;
                if let Some(pipeline) = &self.shrink {
                    shrink(frame, pipeline, INFO.id, &backdrop.radiance)?;
                }
            }
        }
        Ok(())
    }
}

impl ReflectionMethod for BillboardImpostors {
    fn prepare(&mut self, frame: &mut Frame, scene: &GpuScene, want: &Want) -> Result<()> {
        self.boards.prepare(frame, scene)?;
        self.take_backdrops(frame, scene, want)
    }

    fn reflect(
        &mut self,
        frame: &mut Frame,
        scene: &GpuScene,
        view: &View,
        record: &mut ReflectionRecord,
    ) -> Result<()> {
        let tables = self.boards.upload(frame, scene)?;
        for Viewer { objects, centre, backdrop } in &self.viewers {
            let params = Params {
                centre: centre.to_array(),
                bounces: self.bounces,
                size: self.boards.size() as f32,
                coarsest: (self.boards.levels() - 1) as f32,
                margin: self.margin,
                steps: self.steps,
            };
            let name = "billboard-impostors/reflect";
            self.reflect.run(frame, name, (scene, view), record, objects, |pass| {
                let pass = self.boards.bind(pass, &tables).storage_struct("params", &params);
                match backdrop {
                    None => pass,
                    Some(map) => pass
                        .sample("backdrop_radiance", &map.radiance)
                        .sample("backdrop_point", &map.point)
                        .optional()
                        .sample("backdrop_ids", &map.ids)
                        .optional(),
                }
            })?;
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::Params;
    use crate::gpu::layout::assert_layout;

    #[test]
    #[rustfmt::skip]
    fn parameters_are_laid_out_as_their_wgsl_twin() {
        assert_layout!("billboard_impostors/reflect.wgsl", "Params", Params,
            centre, bounces, size, coarsest, margin, steps);
    }
}

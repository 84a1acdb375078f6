//! `render`: frames of one case as EXR and PNG.

use std::path::{Path, PathBuf};

use super::args::{Common, Frames, frames_of};
use super::console::Console;
use super::work;
use crate::error::Result;
use crate::experiment::bench::{self, BenchPlan};
use crate::experiment::film::{self, Film};
use crate::experiment::frame_file::{write_exr, write_png};
use crate::experiment::lab::Lab;
use crate::experiment::output::OutputFolder;
use crate::experiment::panels::{Beside, Panels};
use crate::methods::{Case, MethodInfo};
use crate::scene::{self, FrameRecord, Moment, Scene};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// A scene of `list scenes`, or a path to a .toml file
    #[arg(long)]
    scene: String,
    /// METHOD[@VARIANT][:key=value,...]; `describe METHOD` has the keys
    #[arg(long)]
    case: String,
    /// One frame of the scene's animation [default: 0]
    #[arg(long, conflicts_with = "frames")]
    frame: Option<u32>,
    /// Frames A to B of the scene's animation, B not included
    #[arg(long, value_name = "A..B")]
    frames: Option<Frames>,
    /// Write the frames as a film too: an animated PNG (.png or .apng), or .mp4 or .webm through the
    /// program ffmpeg where that is installed
    #[arg(long, value_name = "FILE")]
    film: Option<PathBuf>,
    /// What stands beside each of the film's frames: another case, the truth for instance, or `error`
    /// (FLIP, against the truth); once for each panel, from left to right
    #[arg(long, requires = "film", value_name = "CASE|error")]
    beside: Vec<String>,
    /// How many of the frames are compared with the truth
    #[arg(long, default_value_t = 0, value_name = "N")]
    truth_frames: usize,
    #[command(flatten)]
    common: Common,
}

pub fn render(args: &Args, methods: &[&'static MethodInfo]) -> Result<()> {
    let console = Console::new(args.common.json);
    let case = Case::parse(&args.case, methods)?;
    let beside = args.beside.iter().map(|text| Beside::parse(text, methods));
    let beside = beside.collect::<Result<Vec<_>>>()?;
    let scene = scene::load(&args.scene)?;
    let one = args.frame.unwrap_or(0);
    let range = args.frames.clone().unwrap_or(Frames(one..one.saturating_add(1)));
    let frames: Vec<u32> = frames_of(&scene, Some(&range))?.collect();
    let folder = work::folder(args.common.out.as_ref(), &scene, &case)?;
    args.film.as_deref().map_or(Ok(()), film::check)?;
    let lab = work::lab(&args.common, methods, &console, folder.path().to_owned());
    console.progress().set_length(frames.len() as u64);
    let shoot = args.film.as_deref().map(|path| Shoot::new(path, &lab, &scene, &frames, &beside));
    let mut shoot = shoot.transpose()?;
    draw(&lab, &scene, &case, &frames, &folder, shoot.as_mut())?;
    shoot.map_or(Ok(()), |shoot| shoot.film.finish())?;
    let plan = BenchPlan {
        frames,
        truth_frames: args.truth_frames,
        timed: false,
        repeat: None,
        path: Vec::new(),
    };
    for outcome in bench::bench(&lab, &scene, std::slice::from_ref(&case), &plan)? {
        outcome.save(&folder)?;
        console.object(&outcome.row)?;
    }
    console.report(&format!("{}: {} frames", folder.path().display(), plan.frames.len()))?;
    lab.close()
}

/// A film on its way.
struct Shoot<'s> {
    film: Film,
    panels: Panels<'s>,
}

impl<'s> Shoot<'s> {
    fn new(
        path: &Path,
        lab: &Lab,
        scene: &'s Scene,
        frames: &[u32],
        beside: &[Beside],
    ) -> Result<Self> {
        let panels = Panels::new(lab, scene, beside)?;
        let film = Film::create(path, panels.picture_size(), frames.len() as u32, scene.rate_hz)?;
        Ok(Shoot { film, panels })
    }

    fn add(&mut self, frame: &FrameRecord, moment: &Moment, cut: bool) -> Result<()> {
        self.film.add(&self.panels.picture(frame, moment, cut)?)
    }
}

/// Draws and writes `frame-NNNN.exr` and `.png`.
fn draw(
    lab: &Lab,
    scene: &Scene,
    case: &Case,
    frames: &[u32],
    folder: &OutputFolder,
    mut shoot: Option<&mut Shoot>,
) -> Result<()> {
    let size = lab.settings.size;
    let mut artist = lab.artist(scene, case, size)?;
    for (i, number) in frames.iter().enumerate() {
        lab.progress.set_message(format!("{} frame {number}: {}", scene.name, case.text));
        let moment = scene.at(*number);
        let (frame, _) = artist.frame(&moment, size, i == 0)?;
        let from = lab.provenance(scene, case, *number)?;
        write_exr(&folder.file(&format!("frame-{number:04}.exr")), &frame, &from)?;
        write_png(&folder.file(&format!("frame-{number:04}.png")), size, &frame.colour)?;
        if let Some(shoot) = &mut shoot {
            shoot.add(&frame, &moment, i == 0)?;
        }
        lab.progress.inc(1);
    }
    Ok(())
}

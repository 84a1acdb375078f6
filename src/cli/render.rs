//! `render`: frames of one case as EXR and PNG.

use std::path::{Path, PathBuf};

use super::args::{Common, Frames, beside, frames_of};
use super::console::Console;
use super::work;
use crate::error::Result;
use crate::experiment::bench::{self, BenchPlan};
use crate::experiment::film::{self, Beside, Film};
use crate::experiment::frame_file::{write_exr, write_png};
use crate::experiment::lab::Lab;
use crate::experiment::output::OutputFolder;
use crate::methods::{Case, MethodInfo};
use crate::scene::{self, FrameRecord, Moment, Scene};
use crate::truth::{Tracer, TruthOptions};

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
    /// What stands beside each of the film's frames: truth, error (FLIP), or both
    #[arg(
        long,
        requires = "film",
        value_name = "truth,error",
        value_delimiter = ',',
        value_parser = beside
    )]
    beside: Vec<Beside>,
    /// How many of the frames are compared with the truth
    #[arg(long, default_value_t = 0, value_name = "N")]
    truth_frames: usize,
    #[command(flatten)]
    common: Common,
}

pub fn render(args: &Args, methods: &[&'static MethodInfo]) -> Result<()> {
    let console = Console::new(args.common.json);
    let case = Case::parse(&args.case, methods)?;
    let scene = scene::load(&args.scene)?;
    let one = args.frame.unwrap_or(0);
    let range = args.frames.clone().unwrap_or(Frames(one..one.saturating_add(1)));
    let frames: Vec<u32> = frames_of(&scene, Some(&range))?.collect();
    let folder = work::folder(args.common.out.as_ref(), &scene, &case)?;
    args.film.as_deref().map_or(Ok(()), film::check)?;
    let lab = work::lab(&args.common, methods, &console, folder.path().to_owned());
    console.progress().set_length(frames.len() as u64);
    let shoot = args.film.as_deref().map(|path| Shoot::new(path, &scene, &frames, args));
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
struct Shoot {
    film: Film,
    beside: Vec<Beside>,
}

impl Shoot {
    fn new(path: &Path, scene: &Scene, frames: &[u32], args: &Args) -> Result<Self> {
        let [width, height] = args.common.size.0;
        let size = [width * (1 + args.beside.len() as u32), height];
        let film = Film::create(path, size, frames.len() as u32, scene.rate_hz)?;
        Ok(Shoot { film, beside: args.beside.clone() })
    }

    fn add(&mut self, scene: &Scene, moment: &Moment, frame: &FrameRecord) -> Result<()> {
        let truth = (!self.beside.is_empty())
            .then(|| Tracer::new(scene, moment, TruthOptions::default()).frame(frame.size));
        let truth = truth.as_ref().unwrap_or(frame);
        self.film.add(&film::side_by_side(frame, &self.beside, truth, &moment.camera))
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
            shoot.add(scene, &moment, &frame)?;
        }
        lab.progress.inc(1);
    }
    Ok(())
}

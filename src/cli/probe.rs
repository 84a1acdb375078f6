//! `probe`: one mirror pixel, in the truth's words and in each case's.

use super::args::{Common, Pixel};
use super::console::{Console, table};
use super::work;
use crate::error::Result;
use crate::experiment::probe::{Answer, Probe, probe};
use crate::methods::MethodInfo;
use crate::scene::{self, NO_OBJECT, Scene};

#[derive(Debug, clap::Args)]
pub struct Args {
    /// A scene of `list scenes`, or a path to a .toml file
    #[arg(long)]
    scene: String,
    /// The pixel, counted from the top left
    #[arg(long, value_name = "X,Y")]
    pixel: Pixel,
    /// METHOD[@VARIANT][:key=value,...]; repeat for several
    #[arg(long)]
    case: Vec<String>,
    /// Frame of the scene's animation
    #[arg(long, default_value_t = 0)]
    frame: u32,
    #[command(flatten)]
    common: Common,
}

pub fn run(args: &Args, methods: &[&'static MethodInfo]) -> Result<()> {
    let console = Console::new(args.common.json);
    let cases = work::parse_cases(&args.case, &[], methods)?;
    let scene = scene::load(&args.scene)?;
    let base = args.common.out.clone().unwrap_or_else(|| "out".into());
    let lab = work::lab(&args.common, methods, &console, base);
    console.progress().set_length(cases.len() as u64);
    let probe = probe(&lab, &scene, &cases, args.frame, args.pixel.0)?;
    console.object(&probe)?;
    console.report(&report(&probe, &scene))?;
    lab.close()
}

fn report(probe: &Probe, scene: &Scene) -> String {
    let [x, y] = probe.pixel;
    let Some(mirror) = &probe.mirror else {
        return format!("pixel {x},{y} of {} frame {}: no mirror here", probe.scene, probe.frame);
    };
    let vector = |v: [f32; 3]| format!("{:.4} {:.4} {:.4}", v[0], v[1], v[2]);
    let mut text =
        format!("pixel {x},{y} of {} frame {}: {}\n", probe.scene, probe.frame, mirror.reflector);
    let facts = [("R", mirror.r), ("N", mirror.n), ("B", mirror.b)];
    text += &table(&facts.map(|(name, v)| vec![format!("  {name}"), vector(v)]));
    text += "\n\n";
    let heading = ["CASE", "SHOWS", "S", "DISTANCE M", "MIRRORS", "VERDICT", "DISPLACED PX"];
    let mut lines = vec![heading.map(str::to_owned).to_vec()];
    for answer in &probe.answers {
        let [sx, sy, sz, _] = answer.s;
        lines.push(vec![
            answer.case.clone(),
            shown(answer, scene),
            vector([sx, sy, sz]),
            answer.distance_m.map_or("-".into(), |d| format!("{d:.4}")),
            answer.order.to_string(),
            answer.verdict.to_owned(),
            answer.displacement_px.map_or("-".into(), |d| format!("{d:.3}")),
        ]);
    }
    text + &table(&lines)
}

fn shown(answer: &Answer, scene: &Scene) -> String {
    match (answer.status.as_str(), answer.object) {
        ("found", object) if object != NO_OBJECT => {
            let found = scene.objects.get(object as usize);
            found.map_or_else(|| object.to_string(), |object| object.name.clone())
        }
        (status, _) => status.to_owned(),
    }
}

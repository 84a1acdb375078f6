//! The command line. Exit codes are [`Error::exit_code`]'s; 2 also covers the flags themselves.

mod args;
mod bench;
mod console;
mod diff;
mod doctor;
mod list;
mod probe;
mod profile;
mod render;
mod work;

use std::process::ExitCode;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};

use crate::error::{Error, Result};
use crate::methods::{METHODS, MethodInfo};
use console::Console;

/// Which scene point does each pixel of a curved mirror show, and what does finding it cost?
#[derive(Debug, Parser)]
#[command(name = "mirrorbench", version, arg_required_else_help = true)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Is this machine fit, which driver was picked, what to install
    Doctor(doctor::Args),
    /// Names to choose from
    List(list::ListArgs),
    /// A method's paper, parameters, limits and passes
    Describe(list::DescribeArgs),
    /// Frames of one case as EXR and PNG
    Render(render::Args),
    /// Where the time of a frame goes, pass by pass
    Profile(profile::Args),
    /// Cases timed against each other and compared with the truth
    Bench(bench::BenchArgs),
    /// One mirror pixel: where it is, what it shows in truth and by each case
    Probe(probe::Args),
    /// The benchmark a file describes, whole or in shards
    Sweep(bench::SweepArgs),
    /// Two frames or two runs, side by side
    Diff(diff::Args),
}

/// Runs the command line with the built-in methods and `extra` ones.
///
/// A method of another crate is given here from its own three-line `main`.
pub fn run(extra: &'static [MethodInfo]) -> ExitCode {
    let methods: Vec<&'static MethodInfo> = METHODS.iter().chain(extra).collect();
    let matches = match Cli::command().try_get_matches() {
        Ok(matches) => matches,
        Err(error) => return refuse(&error),
    };
    let ended = match Cli::from_arg_matches(&matches) {
        Ok(cli) => cli.command.execute(&methods),
        Err(error) => return refuse(&error),
    };
    match ended {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            complain(&error.to_string());
            ExitCode::from(error.exit_code())
        }
    }
}

impl Command {
    fn execute(&self, methods: &[&'static MethodInfo]) -> Result<()> {
        match self {
            Command::Doctor(args) => doctor::doctor(args),
            Command::List(args) => list::list(args.what, methods, &Console::new(args.json)),
            Command::Describe(args) => {
                list::describe(&args.method, methods, &Console::new(args.json))
            }
            Command::Render(args) => render::render(args, methods),
            Command::Profile(args) => profile::profile(args, methods),
            Command::Bench(args) => bench::bench(args, methods),
            Command::Probe(args) => probe::run(args, methods),
            Command::Sweep(args) => bench::sweep(args, methods),
            Command::Diff(args) => diff::run(args),
        }
    }
}

/// Help and version go out as clap writes them; errors become one line.
fn refuse(error: &clap::Error) -> ExitCode {
    if !error.use_stderr()
        || error.kind() == clap::error::ErrorKind::DisplayHelpOnMissingArgumentOrSubcommand
    {
        // A closed stdout or stderr is not worth an error of its own.
        let _ = error.print();
        return ExitCode::from(error.exit_code().clamp(0, 2) as u8);
    }
    let text = error.render().to_string();
    let text = text.split("\n\nUsage:").next().unwrap_or_default();
    let words: Vec<&str> = text.trim_start_matches("error: ").split_whitespace().collect();
    complain(&format!(
        "{} (see --help)",
        words.join(" ").trim_end_matches(" For more information, try '--help'.")
    ));
    ExitCode::from(Error::Usage(String::new()).exit_code())
}

/// One line on stderr, whatever the message holds.
fn complain(message: &str) {
    let line: String = message.chars().map(|c| if c.is_control() { ' ' } else { c }).collect();
    use std::io::Write;
    // With stderr closed there is nobody left to tell.
    let _ = writeln!(std::io::stderr(), "mirrorbench: error: {line}");
}

fn main() -> std::process::ExitCode {
    mirrorbench::cli::run(&[])
}

//! `bn`: the workbench for irregular sampling.

use std::process::ExitCode;

fn main() -> ExitCode {
    let interrupted = ctrlc::set_handler(|| {
        bn_cli::output::discard_unfinished();
        // 128 + SIGINT, as shells report it.
        std::process::exit(130);
    });
    if let Err(error) = interrupted {
        eprintln!("bn: interrupts will leave temporary files behind: {error}");
    }
    match bn_cli::commands::run(std::env::args_os()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) if failure.is_broken_pipe() => ExitCode::SUCCESS,
        Err(failure) => {
            eprintln!("bn: {failure}");
            ExitCode::from(failure.code())
        }
    }
}

//! `bn`: the workbench for irregular sampling.

use std::process::ExitCode;

use bn_cli::output::remark;

fn main() -> ExitCode {
    // Ctrl-C, and the signals of batch systems and closed terminals.
    let interrupted = ctrlc::set_handler(|| {
        bn_cli::output::discard_unfinished();
        // 128 + SIGINT, as shells report an interrupt.
        std::process::exit(130);
    });
    if let Err(error) = interrupted {
        remark(format!("bn: interrupts will leave temporary files behind: {error}"));
    }
    match bn_cli::commands::run(std::env::args_os()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) if failure.is_broken_pipe() => ExitCode::SUCCESS,
        Err(failure) => {
            remark(format!("bn: {failure}"));
            ExitCode::from(failure.code())
        }
    }
}

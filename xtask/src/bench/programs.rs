//! `bn` as a whole process: seconds from start to finished file, and the memory it took.

use std::path::Path;
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use anyhow::{Context as _, anyhow};
use bn_cli::{Failure, Outcome};

use super::chapter::{Chapter, Value};
use super::{Effort, SEED};

/// Runs of each command, of which the median counts; of the long ones one.
const RUNS: usize = 5;

/// Between looks at a process's memory; the system keeps its peak, so that only the last moments of a
/// process may be missed.
const LOOK: Duration = Duration::from_millis(2);

/// What is run, in an empty folder of its own; later ones find what earlier ones wrote.
struct Case {
    name: &'static str,
    arguments: String,
    pixels: usize,
    runs: usize,
}

pub(super) fn measure(effort: Effort) -> Outcome<Chapter> {
    let folder = tempfile::tempdir()?;
    let mut rows = Vec::new();
    for case in cases(effort.quick) {
        let mut taken: Vec<Taken> =
            (0..case.runs).map(|_| run(&case.arguments, folder.path())).collect::<Outcome<_>>()?;
        taken.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
        let seconds = taken[taken.len() / 2].seconds;
        let peak = taken.iter().filter_map(|taken| taken.peak_megabytes).reduce(f64::max);
        rows.push(vec![
            case.name.into(),
            format!("bn {}", case.arguments).as_str().into(),
            case.pixels.into(),
            seconds.into(),
            Value::from(peak),
            taken.len().into(),
        ]);
    }
    Ok(Chapter {
        id: "programs",
        title: "Whole processes",
        method: format!(
            "`bn` from its start to the finished file, seed {SEED}: the median time of the runs, and the \
             most memory that one of them held at a time (resident, where the system tells)."
        ),
        columns: &["task", "command", "pixels", "time / s", "memory / MB", "runs"],
        rows,
        diagrams: Vec::new(),
    })
}

fn cases(quick: bool) -> Vec<Case> {
    // A quick run makes images of an eighth of the width and the height.
    let part = if quick { 8 } else { 1 };
    let runs = if quick { 1 } else { RUNS };
    let case = |name, (width, height): (usize, usize), more: &str, runs| Case {
        name,
        arguments: format!(
            "render zone-plate --size {}x{} --quiet {more}",
            width / part,
            height / part
        ),
        pixels: width / part * (height / part),
        runs,
    };
    let points = Case {
        name: "the points",
        arguments: format!("generate jittered -n 4096 --seed {SEED} --quiet -o points.rps"),
        pixels: 0,
        runs,
    };
    let hd = (1920, 1080);
    let window = 64 / part;
    let at = format!("--crop {},{},{window},{window}", 1280 / part, 720 / part);
    vec![
        points,
        case(
            "pattern made",
            hd,
            &format!("--pattern jittered --seed {SEED} --spp 16 --kernel lanczos2 -o a.png"),
            runs,
        ),
        case(
            "pattern from a file",
            hd,
            "--pattern points.rps --spp 16 --kernel lanczos2 -o b.png",
            runs,
        ),
        Case {
            pixels: window * window,
            ..case(
                "a window",
                (3840, 2160),
                &format!("--pattern points.rps --spp 8 {at} -o c.png"),
                runs,
            )
        },
        case("fitted", (1024, 1024), "--pattern points.rps --spp 4 --reconstruct act -o d.png", 1),
        case(
            "a large image, streamed",
            (16_384, 16_384),
            "--pattern points.rps --spp 1 -o e.png",
            1,
        ),
    ]
}

/// A process that ran.
struct Taken {
    seconds: f64,
    peak_megabytes: Option<f64>,
}

/// Runs `bn` with these words in `folder`: the same code as the program's, in a process of its own.
fn run(arguments: &str, folder: &Path) -> Outcome<Taken> {
    let program = std::env::current_exe().context("cannot find this program");
    let mut command = Command::new(program.map_err(Failure::failed)?);
    command.arg("bn").args(arguments.split(' ')).current_dir(folder).stdout(Stdio::null());
    let taken = timed(&mut command).with_context(|| format!("cannot run bn {arguments}"));
    taken.map_err(Failure::failed)?.ok_or_else(|| Failure::failed(anyhow!("bn {arguments} failed")))
}

/// How long the command takes and what it holds; none if it fails.
fn timed(command: &mut Command) -> std::io::Result<Option<Taken>> {
    let start = Instant::now();
    let mut child = command.spawn()?;
    let (status, peak_megabytes) = waited(&mut child)?;
    let seconds = start.elapsed().as_secs_f64();
    Ok(status.success().then_some(Taken { seconds, peak_megabytes }))
}

/// The child's end and the largest of the peaks seen on the way there.
fn waited(child: &mut Child) -> std::io::Result<(std::process::ExitStatus, Option<f64>)> {
    let (id, done) = (child.id(), AtomicBool::new(false));
    std::thread::scope(|scope| {
        let watcher = scope.spawn(|| {
            let mut peak = None;
            while !done.load(Ordering::Relaxed) {
                peak = peak_megabytes(id).or(peak);
                std::thread::sleep(LOOK);
            }
            peak
        });
        let status = child.wait();
        done.store(true, Ordering::Relaxed);
        let peak = watcher.join().unwrap_or(None);
        Ok((status?, peak))
    })
}

/// The most memory that a running process has held so far, where the system tells it in a file.
fn peak_megabytes(id: u32) -> Option<f64> {
    let text = std::fs::read_to_string(format!("/proc/{id}/status")).ok()?;
    let line = text.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kilobytes: f64 = line.trim().strip_suffix("kB")?.trim().parse().ok()?;
    Some(kilobytes * 1024.0 / 1e6)
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;

    #[test]
    fn processes_are_timed_and_their_memory_is_seen() {
        let shell = |script: &str| timed(Command::new("sh").args(["-c", script])).expect("it runs");
        let slow = shell("sleep 0.2").expect("it succeeds");
        assert!((0.2..20.0).contains(&slow.seconds), "{}", slow.seconds);
        // A word of 30 million letters, held for a while.
        let large =
            shell("x=$(head -c 30000000 /dev/zero | tr '\\0' x); sleep 0.2; test -n \"$x\"");
        let (small, large) = (slow.peak_megabytes, large.expect("it succeeds").peak_megabytes);
        assert!(small.is_some_and(|mb| mb < 20.0), "{small:?}");
        assert!(large.is_some_and(|mb| mb > 30.0), "{large:?}");
        assert!(shell("exit 3").is_none());
    }

    #[test]
    fn the_commands_are_those_of_bn() {
        for case in cases(true).iter().chain(&cases(false)) {
            let words = std::iter::once("bn").chain(case.arguments.split(' '));
            let parsed = bn_cli::commands::command().try_get_matches_from(words);
            assert!(parsed.is_ok(), "{}: {parsed:?}", case.arguments);
        }
    }
}

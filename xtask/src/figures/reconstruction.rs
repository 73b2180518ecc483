//! Convolution against iterative reconstruction: what chapter 6 leaves open.

use bn_cli::Outcome;
use bn_cli::plot::{Axis, Page, Panel, Row, Series, Style, Text};

use super::FigureSpec;
use super::gallery::{Exhibit, enlarged, hang};
use super::studio::Studio;
use crate::measure::reconstruction::{Cells, Made, PATTERNS, Subject, Way};

pub(super) const FIGURES: &[FigureSpec] = &[FigureSpec {
    id: "reconstruction",
    title: "convolution and iterative reconstruction: error, rate, coverage radius and time",
    draw,
}];

/// Sides of panels in points.
const SIDE: f64 = 150.0;

/// Samples per pixel.
const RATES: &[f64] = &[0.5, 1.0, 2.0, 4.0, 8.0, 16.0];
const QUICK_RATES: &[f64] = &[1.0, 4.0];

/// The rate at which patterns are compared.
const RATE: f64 = 4.0;

/// Which patterns' curves over the rate are shown.
const SHOWN: [&str; 3] = ["stochastic", "jittered", "fpo"];

/// What one pattern gives of one scene: way by way, rate by rate.
struct Course {
    pattern: &'static str,
    coverage: f64,
    made: Vec<Vec<Made>>,
}

fn draw(studio: &Studio) -> Outcome {
    let (n, side) = if studio.quick() { (256, 40) } else { (4096, 128) };
    let rates = if studio.quick() { QUICK_RATES } else { RATES };
    let patterns = PATTERNS
        .into_iter()
        .map(|pattern| Ok((pattern, Cells::of(&studio.sets(pattern, &[], n, 1)?[0]))))
        .collect::<Outcome<Vec<_>>>()?;
    let mut page = Page::new();
    let mut pictures = Vec::new();
    for subject in Subject::both(side)? {
        let courses = patterns
            .iter()
            .map(|(pattern, cells)| {
                let at = |way| rates.iter().map(|&rate| subject.image(cells, rate, way)).collect();
                let made = Way::ALL.into_iter().map(at).collect::<Outcome<Vec<_>>>()?;
                Ok(Course { pattern, coverage: cells.coverage, made })
            })
            .collect::<Outcome<Vec<Course>>>()?;
        let title = |text: &str| Text::math(&format!("{}: {text}", subject.name));
        let shown = courses.iter().filter(|course| SHOWN.contains(&course.pattern));
        let over_rates = shown.map(|course| over_rate(course, rates).titled(title(course.pattern)));
        page = page.row(Row::new(SIDE, over_rates.collect()));
        let rate = rates.iter().position(|&rate| rate == RATE).unwrap_or(0);
        let panels = vec![
            over_coverage(&courses, rate).titled(title("all patterns, 4 spp")),
            over_time(&courses).titled(title("jittered")),
        ];
        page = page.row(Row::new(SIDE, panels));
        pictures.extend(exhibits(&courses, rates)?);
    }
    studio.page("", &page)?;
    let title = "Jittered samples, above 1 spp, below 4 spp, of each scene";
    studio.page("images", &hang(title, pictures))
}

fn decibels() -> Axis {
    Axis::linear(Text::plain("PSNR / dB"))
}

fn line(way: usize, points: impl IntoIterator<Item = [f64; 2]>) -> Series {
    let name = Text::plain(Way::ALL[way].name());
    Series::new(points).named(name).styled(Style::Cycle(way)).with_markers()
}

fn over_rate(course: &Course, rates: &[f64]) -> Panel {
    let panel = Panel::new(Axis::log(Text::plain("samples per pixel")), decibels());
    course.made.iter().enumerate().fold(panel, |panel, (way, made)| {
        panel.line(line(way, rates.iter().zip(made).map(|(&rate, made)| [rate, made.psnr])))
    })
}

fn over_coverage(courses: &[Course], rate: usize) -> Panel {
    let panel = Panel::new(Axis::linear(Text::math("*R*_{c}/*d*_{hex}")), decibels());
    let mut sorted: Vec<&Course> = courses.iter().collect();
    sorted.sort_by(|a, b| a.coverage.total_cmp(&b.coverage));
    (0..Way::ALL.len()).fold(panel, |panel, way| {
        let points = sorted.iter().map(|course| [course.coverage, course.made[way][rate].psnr]);
        panel.line(line(way, points))
    })
}

fn over_time(courses: &[Course]) -> Panel {
    let panel = Panel::new(Axis::log(Text::plain("time / s")), decibels());
    let jittered = courses.iter().filter(|course| course.pattern == "jittered");
    jittered.flat_map(|course| course.made.iter().enumerate()).fold(panel, |panel, (way, made)| {
        panel.line(line(way, made.iter().map(|made| [made.seconds, made.psnr])))
    })
}

/// Images of one scene by jittered samples, a row for each of two rates.
fn exhibits(courses: &[Course], rates: &[f64]) -> Outcome<Vec<Vec<Exhibit>>> {
    let Some(course) = courses.iter().find(|course| course.pattern == "jittered") else {
        return Ok(Vec::new());
    };
    let chosen = rates.iter().enumerate().filter(|(_, rate)| [1.0, RATE].contains(*rate));
    let row = |(i, rate): (usize, &f64)| {
        let one = |(way, made): (&Way, &Vec<Made>)| {
            let title = format!("{}, {rate} spp: {:.1} dB", way.name(), made[i].psnr);
            Ok(Exhibit::new(title, enlarged(&made[i].image, 2)?))
        };
        Way::ALL.iter().zip(&course.made).map(one).collect()
    };
    chosen.map(row).collect()
}

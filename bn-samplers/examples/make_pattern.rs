//! Makes a pattern with a method chosen by name and prints its points and how it went.
//!
//! ```text
//! cargo run --release -p bn-samplers --example make_pattern -- dart-throwing 16 radius=0.7
//! ```

use std::error::Error;
use std::io::Write;

use bn_core::{Seed, Unobserved};
use bn_samplers::METHODS;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let name = arguments.next().unwrap_or_else(|| "dart-throwing".to_owned());
    let n = arguments.next().map_or(Ok(16), |text| text.parse())?;
    let options: Vec<String> = arguments.collect();
    let options = options.iter().map(|option| option.split_once('=').unwrap_or((option, "true")));

    let method = bn_samplers::find(&name)?;
    let sample = method.with_options(options)?.sample(n, Seed::new(1), &Unobserved)?;

    eprintln!("{}: {} ({})", method.name, method.summary, method.citation);
    for figure in &sample.report.figures {
        eprintln!("{} = {}", figure.name, figure.value);
    }
    let mut out = std::io::stdout().lock();
    for p in sample.points.points() {
        writeln!(out, "{} {}", p.x, p.y)?;
    }
    let others = METHODS.iter().filter(|other| other.name != method.name);
    let others: Vec<_> = others.map(|other| other.name).collect();
    eprintln!("other methods: {}", others.join(", "));
    Ok(())
}

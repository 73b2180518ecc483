//! `--supersampling`: a standard set, or the user's file.

use std::fs::File;
use std::io::Read as _;

use anyhow::anyhow;
use bn_render::{SUPERSAMPLING, Supersampling};

use crate::{Failure, Outcome};

/// More bytes than the longest supersampling pattern takes.
const LONGEST: u64 = 16 << 20;

/// The supersampling pattern of this name, or of a file.
pub(super) fn pattern(name: &str) -> Outcome<Supersampling> {
    if let Some(pattern) = bn_render::supersampling(name) {
        return Ok(pattern);
    }
    // Pipes and devices don't know their length.
    let mut text = String::new();
    let read = File::open(name).and_then(|file| file.take(LONGEST + 1).read_to_string(&mut text));
    let read = match read {
        Ok(length) if length as u64 > LONGEST => {
            Err("more than 16 MB are too long for a pattern".to_owned())
        }
        read => read.map_err(|error| error.to_string()),
    };
    read.map_err(|error| {
        let known = SUPERSAMPLING.join(", ");
        Failure::misuse(format!("--supersampling {name}: {error}; there are {known}, and files"))
    })?;
    let parsed = Supersampling::parse(name, &text);
    parsed.map_err(|error| Failure::usage(anyhow!(error).context(name.to_owned())))
}

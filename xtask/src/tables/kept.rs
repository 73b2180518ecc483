//! Tables that need not be made again.

use std::fs;
use std::path::{Path, PathBuf};

use bn_cli::{Outcome, output};
use serde::{Deserialize, Serialize};

use super::Tally;
use crate::measure::{Plan, program_digest};

/// What decides a table: how many points in how many sets, and the program, its data included.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(super) struct Maker {
    pub(super) plan: Plan,
    /// A digest of the program's file.
    program: u64,
}

impl Maker {
    /// This program, by a plan.
    pub(super) fn this(plan: Plan) -> Outcome<Self> {
        Ok(Self { plan, program: program_digest()? })
    }
}

/// A table as it was made.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Kept {
    maker: Maker,
    /// How its values fared.
    pub(crate) tally: Tally,
    /// Its text in Markdown.
    pub(crate) text: String,
}

impl Kept {
    pub(super) fn new(maker: Maker, tally: Tally, text: String) -> Self {
        Self { maker, tally, text }
    }

    /// The table called `name` of this folder, if `maker` would make the same.
    pub(super) fn read(folder: &Path, name: &str, maker: &Maker) -> Option<Self> {
        // A file that is damaged is no reason to stop: the table is made again.
        let kept: Self = serde_json::from_slice(&fs::read(place(folder, name)).ok()?).ok()?;
        (kept.maker == *maker).then_some(kept)
    }

    /// Keeps it in this folder under `name`, instead of whatever was kept there.
    pub(super) fn write(&self, folder: &Path, name: &str) -> Outcome {
        let path = place(folder, name);
        if let Some(folder) = path.parent() {
            fs::create_dir_all(folder)?;
        }
        output::write_file(&path, |w| {
            Ok(serde_json::to_writer(w, self).map_err(std::io::Error::from)?)
        })
    }
}

fn place(folder: &Path, name: &str) -> PathBuf {
    folder.join("kept").join(format!("{name}.json"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn tables_of_other_plans_and_programs_are_not_taken() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let full = Maker::this(Plan { n: 4096, sets: 10, seed: 1 }).expect("a file");
        assert_eq!(Maker::this(full.plan).expect("a file"), full);
        let read = |maker: Maker| Kept::read(folder.path(), "table_3_1", &maker);
        assert_eq!(read(full), None);
        let write = |maker| {
            let kept = Kept::new(maker, Tally::default(), "## Table 3.1\n".to_owned());
            kept.write(folder.path(), "table_3_1").expect("writable");
            kept
        };
        let kept = write(full);
        assert_eq!(read(full), Some(kept));
        for other in [
            Maker { plan: Plan { n: 1024, sets: 3, ..full.plan }, ..full },
            Maker { plan: Plan { seed: 2, ..full.plan }, ..full },
            Maker { program: full.program ^ 1, ..full },
        ] {
            let kept = write(other);
            assert_eq!([read(full), read(other)], [None, Some(kept)]);
        }
        fs::write(place(folder.path(), "table_3_1"), b"{").expect("writable");
        assert_eq!(read(full), None, "damaged");
    }
}

//! Point sets on disk, by all that decides their bytes.

use std::fs;
use std::hash::{DefaultHasher, Hasher};
use std::path::PathBuf;

use bn_cli::{Failure, Outcome, input, output, output_points};
use bn_core::PointSet;
use bn_samplers::{CountRule, DefaultValue, Method};

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::Plan;
use crate::thesis::RowSpec;

/// A folder of point sets in double precision.
///
/// A set's file is named by the method, its version, all its options (defaults included), n, seed
/// and the set's number; a new version of a generator leaves the old files unused.
#[derive(Debug)]
pub(crate) struct Store {
    root: PathBuf,
    /// Whether files that exist are used; if not, they are made again.
    reading: bool,
}

/// The place of one set in a [`Store`].
#[derive(Debug)]
pub(super) struct Place {
    path: PathBuf,
    reading: bool,
    /// How many points the set must have, if that is known.
    points: Option<usize>,
}

/// Options in one folder's name: file systems take 255 bytes.
const OPTIONS_PER_FOLDER: usize = 6;

impl Store {
    /// The store at `root`; `reading` false makes every set again.
    pub(crate) fn new(root: PathBuf, reading: bool) -> Self {
        Self { root, reading }
    }

    /// The place of set `set` of a row.
    pub(super) fn place(&self, method: &Method, row: &RowSpec, plan: Plan, set: u32) -> Place {
        let mut path = self.root.join(method.name).join(format!("v{}", method.version));
        for options in all_options(method, row).chunks(OPTIONS_PER_FOLDER) {
            path.push(options.join(","));
        }
        path.push(format!("n{}_seed{}_set{set}.npy", plan.n, plan.seed));
        let points = (method.counts != CountRule::Approximate).then_some(plan.n);
        Place { path, reading: self.reading, points }
    }

    /// The place of what was measured of sets; `key` is a digest of all that decides it.
    pub(crate) fn measured(&self, what: &str, key: u64) -> Notes {
        Notes { path: self.root.join(what).join(format!("{key:016x}.json")), reading: self.reading }
    }
}

/// The place of something that was measured.
#[derive(Debug)]
pub(crate) struct Notes {
    path: PathBuf,
    reading: bool,
}

impl Notes {
    pub(crate) fn read<T: DeserializeOwned>(&self) -> Option<T> {
        // A file that is damaged is no reason to stop: it is measured again.
        serde_json::from_slice(&fs::read(&self.path).ok().filter(|_| self.reading)?).ok()
    }

    pub(crate) fn write(&self, measured: &impl Serialize) -> Outcome {
        if let Some(folder) = self.path.parent() {
            fs::create_dir_all(folder).map_err(Failure::failed)?;
        }
        output::write_to(&self.path, |w| {
            Ok(serde_json::to_writer(w, measured).map_err(std::io::Error::from)?)
        })
    }
}

/// A digest of this program's file: another build may measure otherwise.
pub(crate) fn program_digest() -> Outcome<u64> {
    let mut hasher = DefaultHasher::new();
    hasher.write(&fs::read(std::env::current_exe()?)?);
    Ok(hasher.finish())
}

/// Feeds a set's points to a digest.
pub(crate) fn hash_points(set: &PointSet, hasher: &mut impl Hasher) {
    hasher.write_usize(set.len());
    let coordinates = set.points().iter().flat_map(|p| [p.x, p.y]);
    coordinates.for_each(|x| hasher.write_u64(x.to_bits()));
}

/// Every option of the method as `name=value`, given or default, fit for a file name.
fn all_options(method: &Method, row: &RowSpec) -> Vec<String> {
    let value = |name: &str, default| match (row.options.get(name), default) {
        (Some(text), _) => Some(text.trim().to_owned()),
        (None, DefaultValue::Value(text)) => Some(text.to_owned()),
        (None, DefaultValue::Absent(_)) => None,
    };
    method
        .options
        .iter()
        .filter_map(|spec| {
            Some(format!("{}={}", spec.name, escaped(&value(spec.name, spec.default)?)))
        })
        .collect()
}

/// The text with everything but letters, digits and `. + - _` as %XX.
fn escaped(text: &str) -> String {
    text.bytes()
        .map(|byte| match byte {
            b'.' | b'+' | b'-' | b'_' => char::from(byte).to_string(),
            _ if byte.is_ascii_alphanumeric() => char::from(byte).to_string(),
            _ => format!("%{byte:02X}"),
        })
        .collect()
}

impl Place {
    /// The place of what the run told on its way to the set.
    pub(super) fn trace(&self) -> Notes {
        Notes { path: self.path.with_extension("trace.json"), reading: self.reading }
    }

    /// The set, if a good one is there.
    pub(super) fn read(&self) -> Option<PointSet> {
        if !self.reading || !self.path.exists() {
            return None;
        }
        // A file that is damaged is no reason to stop: its set is made again.
        let ensemble = input::read(&self.path, None, false).ok()?;
        let [set] = <[PointSet; 1]>::try_from(ensemble.into_sets()).ok()?;
        self.points.is_none_or(|n| n == set.len()).then_some(set)
    }

    /// Puts the set in its place.
    pub(super) fn write(&self, set: &PointSet) -> Outcome {
        if let Some(folder) = self.path.parent() {
            fs::create_dir_all(folder).map_err(|error| {
                Failure::failed(anyhow::anyhow!("cannot make {}: {error}", folder.display()))
            })?;
        }
        output_points::write(&self.path, None, std::slice::from_ref(set))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bn_core::{DVec2, Seed, Unobserved};

    fn row(options: &[(&str, &str)]) -> RowSpec {
        RowSpec {
            thesis: "jitter".to_owned(),
            method: "jittered".to_owned(),
            options: options.iter().map(|&(k, v)| (k.to_owned(), v.to_owned())).collect(),
            why: String::new(),
        }
    }

    fn place(store: &Store, options: &[(&str, &str)], n: usize) -> Place {
        let row = row(options);
        let method = row.method().expect("in the registry");
        store.place(method, &row, Plan { n, sets: 1, seed: 1 }, 0)
    }

    #[test]
    fn what_decides_the_bytes_decides_the_name() {
        let store = Store::new(PathBuf::new(), true);
        let plain = place(&store, &[], 64).path;
        let text = plain.to_string_lossy().replace('\\', "/");
        assert!(text.starts_with("jittered/v"), "{text}");
        assert!(text.ends_with("/distribution=uniform,width=1/n64_seed1_set0.npy"), "{text}");
        assert_eq!(plain, place(&store, &[("width", "1")], 64).path);
        assert_ne!(plain, place(&store, &[("width", "1.5")], 64).path);
        assert_ne!(plain, place(&store, &[], 65).path);
        assert_eq!(escaped("a/b c%"), "a%2Fb%20c%25");
    }

    #[test]
    fn measurements_come_back_bit_for_bit() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let notes = |reading| Store::new(folder.path().to_owned(), reading).measured("psnr", 7);
        assert_eq!(notes(true).read::<Vec<f64>>(), None);
        let measured = vec![0.1 + 0.2, 1e-300];
        notes(true).write(&measured).expect("writable");
        assert_eq!(notes(true).read(), Some(measured));
        assert_eq!(notes(false).read::<Vec<f64>>(), None, "measured afresh");
    }

    #[test]
    fn sets_come_back_bit_for_bit_and_damage_is_noticed() {
        let folder = tempfile::tempdir().expect("a temporary folder");
        let store = Store::new(folder.path().to_owned(), true);
        let place = place(&store, &[], 7);
        assert_eq!(place.read(), None);
        let sampler = row(&[]).method().expect("there").with_options([]).expect("defaults");
        let set = sampler.sample(7, Seed::new(1), &Unobserved).expect("valid").points;
        place.write(&set).expect("writable");
        assert_eq!(place.read().as_ref(), Some(&set));

        let again = Place { reading: false, path: place.path.clone(), points: Some(7) };
        assert_eq!(again.read(), None, "made afresh");
        let short = PointSet::new(vec![DVec2::ZERO]).expect("valid");
        place.write(&short).expect("writable");
        assert_eq!(place.read(), None, "another count");
        fs::write(&place.path, b"not a point file").expect("writable");
        assert_eq!(place.read(), None, "damaged");
    }
}

//! `.json`: `{"points": [[x, y], …]}` or `{"sets": [[[x, y], …], …]}`.

use std::fmt;
use std::io::{BufRead, Write};

use serde_core::de::{
    DeserializeSeed, Deserializer, Error, IgnoredAny, MapAccess, SeqAccess, Visitor,
};

use super::error::{Fault, Place};
use super::gather::Gather;
use super::{ReadProblem, Source, WriteError};
use crate::{Ensemble, PointSet};

pub(super) fn read(source: &mut Source<'_>, gather: Gather) -> Result<Ensemble, Fault> {
    let buffered = source.fill_buf()?;
    let mark = b"\xEF\xBB\xBF";
    let skipped = if buffered.starts_with(mark) { mark.len() } else { 0 };
    source.consume(skipped);

    let mut reading = Reading { gather, in_sets: false, problem: None };
    let mut deserializer = serde_json::Deserializer::from_reader(source);
    let outcome = deserializer.deserialize_map(Document(&mut reading));
    match outcome.and_then(|()| deserializer.end()) {
        Ok(()) => Ok(reading.gather.finish()?),
        Err(error) => Err(reading.fault(error)),
    }
}

/// The state that the visitors below share.
struct Reading {
    gather: Gather,
    in_sets: bool,
    /// What was wrong with a point or set, which a visitor can only report as a message.
    problem: Option<ReadProblem>,
}

impl Reading {
    fn note<E: Error>(&mut self, outcome: Result<(), ReadProblem>) -> Result<(), E> {
        outcome.map_err(|problem| {
            let message = E::custom(&problem);
            self.problem = Some(problem);
            message
        })
    }

    fn fault(self, error: serde_json::Error) -> Fault {
        let place = Place::line(error.line() as u64);
        let place = if self.in_sets { place.in_set(self.gather.sets()) } else { place };
        let problem = match self.problem {
            Some(problem) => problem,
            None if error.is_io() => return ReadProblem::Io(error.into()).into(),
            None => ReadProblem::Json { message: bare_message(&error) },
        };
        Fault::at(place, problem)
    }
}

/// The message without its "at line l column c", but with the column.
fn bare_message(error: &serde_json::Error) -> String {
    let message = error.to_string();
    let position = format!(" at line {} column {}", error.line(), error.column());
    let bare = message.strip_suffix(&position).unwrap_or(&message);
    format!("{bare} (column {})", error.column())
}

/// The object; keys other than points and sets are passed over.
struct Document<'a>(&'a mut Reading);

impl<'de> Visitor<'de> for Document<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an object with the key points or sets")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<(), A::Error> {
        let mut found = false;
        while let Some(key) = map.next_key::<String>()? {
            if key != "points" && key != "sets" {
                map.next_value::<IgnoredAny>()?;
                continue;
            }
            if found {
                return Err(Error::custom("more than one of the keys points and sets"));
            }
            found = true;
            if key == "points" {
                map.next_value_seed(Set(self.0))?;
            } else {
                self.0.in_sets = true;
                map.next_value_seed(Sets(self.0))?;
            }
        }
        if found { Ok(()) } else { Err(Error::custom("neither of the keys points and sets")) }
    }
}

struct Sets<'a>(&'a mut Reading);

impl<'de> Visitor<'de> for Sets<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an array of sets")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut sets: A) -> Result<(), A::Error> {
        while sets.next_element_seed(Set(self.0))?.is_some() {}
        Ok(())
    }
}

struct Set<'a>(&'a mut Reading);

impl<'de> Visitor<'de> for Set<'_> {
    type Value = ();

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("an array of points")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut points: A) -> Result<(), A::Error> {
        while let Some(Point(x, y)) = points.next_element()? {
            let outcome = self.0.gather.push(x, y);
            self.0.note(outcome)?;
        }
        let outcome = self.0.gather.end_set();
        self.0.note(outcome)
    }
}

/// Two numbers.
struct Point(f64, f64);

impl<'de> Visitor<'de> for Point {
    type Value = Self;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a point [x, y]")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut numbers: A) -> Result<Self, A::Error> {
        let mut next = |index| {
            numbers.next_element::<f64>()?.ok_or_else(|| Error::invalid_length(index, &self))
        };
        let point = Self(next(0)?, next(1)?);
        match numbers.next_element::<IgnoredAny>()? {
            None => Ok(point),
            Some(_) => Err(Error::invalid_length(3, &self)),
        }
    }
}

macro_rules! deserialize_seq {
    ($($seed:ident),*) => {$(
        impl<'de> DeserializeSeed<'de> for $seed<'_> {
            type Value = ();

            fn deserialize<D: Deserializer<'de>>(self, deserializer: D) -> Result<(), D::Error> {
                deserializer.deserialize_seq(self)
            }
        }
    )*};
}

deserialize_seq!(Sets, Set);

impl<'de> serde_core::Deserialize<'de> for Point {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_seq(Self(0.0, 0.0))
    }
}

pub(super) fn write(sets: &[PointSet], writer: &mut dyn Write) -> Result<(), WriteError> {
    if let [set] = sets {
        write!(writer, "{{\"points\": ")?;
        write_set(set, writer)?;
    } else {
        write!(writer, "{{\"sets\": [")?;
        for (i, set) in sets.iter().enumerate() {
            write!(writer, "{}", if i == 0 { "\n" } else { ",\n" })?;
            write_set(set, writer)?;
        }
        write!(writer, "]")?;
    }
    writeln!(writer, "}}")?;
    Ok(())
}

fn write_set(set: &PointSet, writer: &mut dyn Write) -> Result<(), WriteError> {
    for (i, p) in set.points().iter().enumerate() {
        let before = if i == 0 { "[" } else { ",\n" };
        write!(writer, "{before}[{:?}, {:?}]", p.x, p.y)?;
    }
    write!(writer, "]")?;
    Ok(())
}

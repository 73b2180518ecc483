//! What is known about a method besides how to run it.

use std::fmt;

use crate::{Given, OptionError, OptionSpec, OptionValues, Sampler};

/// A method of the registry: its names, its sources, its options and how to build its [`Sampler`].
#[derive(Clone, Copy)]
#[non_exhaustive]
pub struct Method {
    /// The name, in kebab-case; what scripts and file names use.
    pub name: &'static str,
    /// Other names that are understood.
    pub aliases: &'static [&'static str],
    /// One line on what it makes.
    pub summary: &'static str,
    /// The page of Heck's thesis (2013) that shows or defines it, if it does.
    pub page: Option<u32>,
    /// The paper that the method comes from.
    pub citation: &'static str,
    /// Expected run time as a function of the number of points.
    pub complexity: &'static str,
    /// In which order the points come.
    pub order: PointOrder,
    /// Which counts it serves.
    pub counts: CountRule,
    /// Whether the seed makes a difference, with the default options.
    pub seeded: bool,
    /// Its options.
    pub options: &'static [OptionSpec],
    /// Makes the sampler from checked options.
    pub build: fn(&OptionValues) -> Result<Box<dyn Sampler>, OptionError>,
    /// Raised whenever the same options, count and seed give other bytes than before.
    pub version: u32,
}

impl Method {
    /// The sampler with these options, given as (name, text); the defaults for those left out.
    ///
    /// # Errors
    /// [`OptionError`] for unknown, repeated, invalid or contradictory options.
    pub fn with_options<'a>(
        &self,
        given: impl IntoIterator<Item = (&'a str, &'a str)>,
    ) -> Result<Box<dyn Sampler>, OptionError> {
        self.with_values(given.into_iter().map(|(name, text)| (name, Given::Text(text))))
    }

    /// The sampler with these options, among them point sets and density functions that the
    /// caller has read; the defaults for those left out.
    ///
    /// # Errors
    /// As [`Method::with_options`].
    pub fn with_values<'a>(
        &self,
        given: impl IntoIterator<Item = (&'a str, Given<'a>)>,
    ) -> Result<Box<dyn Sampler>, OptionError> {
        (self.build)(&OptionValues::parse(self.name, self.options, given)?)
    }
}

impl fmt::Debug for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Method").field("name", &self.name).finish_non_exhaustive()
    }
}

/// The order in which a method's points come: what a prefix of them is good for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum PointOrder {
    /// Every order is as likely: a prefix is a random subset.
    Random,
    /// Along rows or a lattice's generator: a prefix covers a part of the torus only.
    Scan,
    /// Every prefix covers the torus about as evenly as its size allows.
    Progressive,
    /// In the order of acceptance, each uniform in what the earlier ones leave free: a prefix is a
    /// pattern of the same minimum distance, with holes.
    Arrival,
}

impl fmt::Display for PointOrder {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Random => "random: a prefix is a random subset",
            Self::Scan => "scan: a prefix covers a part of the torus",
            Self::Progressive => "progressive: every prefix covers the torus evenly",
            Self::Arrival => "arrival: a prefix keeps the minimum distance but has holes",
        })
    }
}

/// Which counts a method serves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize), serde(rename_all = "kebab-case"))]
#[non_exhaustive]
pub enum CountRule {
    /// Exactly any number.
    Any,
    /// Exactly any square number; others are an error that names the nearest.
    Square,
    /// Exactly any power of 2; others are an error that names the nearest.
    PowerOfTwo,
    /// About any number: the count follows from a radius.
    Approximate,
}

impl fmt::Display for CountRule {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Any => "any number",
            Self::Square => "square numbers",
            Self::PowerOfTwo => "powers of 2",
            Self::Approximate => "about any number",
        })
    }
}

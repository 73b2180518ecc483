//! The public samplers: what each method promises, and what all of them do.

mod density;
mod fpo;
mod imitations;
mod matching;
mod registry;
mod statistics;

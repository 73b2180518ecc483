//! The public data types, their degenerate cases, and the files.

mod cell_grid;
mod degenerate;
mod io_formats;
mod io_round_trip;
mod serde;

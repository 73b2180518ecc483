//! placeholder
/// Grid.
#[derive(Debug)]
pub struct CellGrid;

//! Point files.

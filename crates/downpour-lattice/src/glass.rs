//! Drops on a pane of glass.

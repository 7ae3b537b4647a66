//! Child processes and paths of the workspace, for `cargo xtask` and the programs that it calls.

pub mod run;

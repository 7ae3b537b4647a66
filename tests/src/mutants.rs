//! Mutants: every WGSL function with one small change in it at a time, which some case has to see.
//!
//! [`changes`] makes them from the tokens of the text, [`population`] lists them, [`worker`] runs the cases that reach a
//! mutant's function until one sees it, [`pool`] keeps workers as processes with deadlines, [`known`] lists those that no
//! case can see, each with its reason.

pub mod bundle;
pub mod changes;
pub mod known;
pub mod pool;
pub mod population;
pub mod tokens;
pub mod worker;

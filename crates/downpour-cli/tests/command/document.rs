//! A small valid model and broken files made from it: the tests of `downpour-scene` have them.

#![allow(dead_code, reason = "the tests of `downpour-scene` use all of it")]

#[path = "../../../downpour-scene/tests/document/broken.rs"]
pub(crate) mod broken;
#[path = "../../../downpour-scene/tests/document/triangle.rs"]
mod triangle;

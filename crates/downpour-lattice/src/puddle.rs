//! Ripples on shallow water.

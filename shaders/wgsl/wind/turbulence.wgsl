// Turbulence: a sum of frozen plane waves, each perpendicular to its wave vector, so that the sum has no divergence.
//
// Kraichnan 1970: u(x) = sum of a cos(2 pi (k . x + phase)), a perpendicular to k. The host chooses the waves and their
// amplitudes (von Karman's spectrum), and moves them with the mean wind by their phases.
// Twin: downpour_wind::turbulence.

struct WindTurbulenceMode {
    // Wave vector, waves per meter along each axis.
    wave: vec3f,
    // Phase in turns, 0 to 1, at the lower corner of the box.
    phase: f32,
    // Velocity at the crest, m/s.
    amplitude: vec3f,
}

// Cosine of an angle in turns: WGSL's own guarantees too few digits, and only in [-pi, pi].
fn wind_turbulence_wave(turns: f32) -> f32 {
    // Half of the angle, -pi / 2 to pi / 2.
    let half = (turns - floor(turns + 0.5)) * 3.1415927;
    let x = half * half;
    // Series of the sine: the next term is 6e-8 at most.
    let sine = half * (1.0 - x * (0.16666667 - x * (8.3333333e-3 - x * (1.9841270e-4 - x * (2.7557319e-6 - x * 2.5052108e-8)))));
    return 1.0 - 2.0 * sine * sine;
}

// Velocity of a wave, m/s; `offset` is from the lower corner of the box, m.
fn wind_turbulence_velocity(mode: WindTurbulenceMode, offset: vec3f) -> vec3f {
    return mode.amplitude * wind_turbulence_wave(dot(mode.wave, offset) + mode.phase);
}

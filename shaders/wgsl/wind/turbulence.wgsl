// Turbulence: a sum of frozen plane waves, each across its own wave vector, so that none has divergence.
//
// Kraichnan 1970: u(x) = sum of a cos(2 pi (k . x + phase)), a at right angles to k. Which waves there are, with which
// amplitudes, the host decides (von Karman's spectrum); it also carries them along with the mean wind, in their phases.
// Twin: downpour_wind::turbulence.

struct WindTurbulenceMode {
    // Waves per metre along each axis.
    wave: vec3f,
    // Turns, 0 to 1, at the lower corner of the box.
    phase: f32,
    // Velocity of the crest, m/s.
    amplitude: vec3f,
}

// The cosine of an angle in turns: WGSL promises too few digits of its own, and only in [-pi, pi].
fn wind_turbulence_wave(turns: f32) -> f32 {
    // Half of the angle, -pi / 2 to pi / 2.
    let half = (turns - floor(turns + 0.5)) * 3.1415927;
    let x = half * half;
    // The sine by its series: the next term is 6e-8 at most.
    let sine = half * (1.0 - x * (0.16666667 - x * (8.3333333e-3 - x * (1.9841270e-4 - x * (2.7557319e-6 - x * 2.5052108e-8)))));
    return 1.0 - 2.0 * sine * sine;
}

// The velocity of a wave, m/s; `offset` is from the lower corner of the box, m.
fn wind_turbulence_velocity(mode: WindTurbulenceMode, offset: vec3f) -> vec3f {
    return mode.amplitude * wind_turbulence_wave(dot(mode.wave, offset) + mode.phase);
}

// Oscillation of a drop: r(t, theta, phi) = r0 (1 + s2 P20(x) + s3 P31(x) cos(phi)) / V^(1/3),
// s_n = A_n sin(omega_n t + phase_n), x = cos(theta).
//
// Source: equation 2 of P. Rousseau et al., "GPU rainfall", 2008, after K. Garg, S. K. Nayar,
// "Photorealistic rendering of rain streaks", 2006, and A. Frohn, N. Roth, "Dynamics of droplets", 2000;
// frequencies of Lord Rayleigh 1879, damping of H. Lamb, "Hydrodynamics".
//
// - r0: radius of the sphere of equal volume, in meters. theta: angle from the vertical axis; both modes are
//   the same up and down. phi: angle about the axis.
// - P20, P31: associated Legendre functions, not normalized, with the Condon-Shortley sign, by which a
//   positive s3 pushes the outline (theta = pi / 2) outwards at phi = 0.
// - V: volume of equation 2 over that of the sphere. The equation alone does not keep the volume; dividing by
//   V^(1/3) does.
//
// Limits: amplitudes of 0 to 0.3; the modes (2,0) and (3,1) only, which dominate. Both laws are of first
// order in the amplitude, so frequencies are those of a sphere.
//
// Time: sin(omega t) in f32 is noise after some seconds, and WGSL guarantees the sine in [-pi, pi] only. Time
// is therefore counted in ticks of 2^-16 s and frequency in units of 2^-16 Hz: their product, in wrapping 32-bit
// integers, is the phase in 2^-32 turns, exact at any time. The ticks wrap after 18 hours without a jump:
// each frequency makes a whole number of turns by then. The remainder of a tick, or an offset within an
// exposure, is added as f32, and the sine is taken of the fraction of a turn.
//
// Twin: downpour_drop::oscillation.

// Oscillation of one drop. Each pair holds the modes (2,0) and (3,1).
struct DropOscillation {
    // A20, A31: displacement over r0.
    amplitude: vec2f,
    // 1 / tau in 1/s; 0 for no damping.
    damping: vec2f,
    // Phase at time 0, in turns.
    phase: vec2f,
    // Frequency in units of 2^-16 Hz.
    frequency: vec2u,
}

struct DropOscillationTime {
    // Ticks of 2^-16 s.
    ticks: u32,
    // Offset in seconds, added to the ticks; small (below some seconds).
    offset: f32,
}

// P20(x).
fn drop_oscillation_legendre_20(x: f32) -> f32 {
    return 1.5 * x * x - 0.5;
}

// P31(x).
fn drop_oscillation_legendre_31(x: f32) -> f32 {
    return 1.5 * (1.0 - 5.0 * x * x) * sqrt(max(1.0 - x * x, 0.0));
}

// Rayleigh 1879: omega_n in rad/s for a radius in m, a surface tension in N/m and a density in kg/m3. 0 for n
// < 2.
fn drop_oscillation_angular_frequency(n: u32, radius: f32, surface_tension: f32, density: f32) -> f32 {
    let m = max(f32(n), 1.0);
    return sqrt(m * (m - 1.0) * (m + 2.0) * surface_tension / (density * (radius * radius * radius)));
}

// Lamb: tau_n in s, in which the amplitude falls to 1/e, for a kinematic viscosity in m2/s. n from 2.
fn drop_oscillation_damping_time(n: u32, radius: f32, viscosity: f32) -> f32 {
    let m = f32(n);
    return radius * radius / ((m - 1.0) * (2.0 * m + 1.0) * viscosity);
}

// Converts rad/s to units of 2^-16 Hz, rounded down.
fn drop_oscillation_frequency(angular_frequency: f32) -> u32 {
    let units = angular_frequency * DROP_OSCILLATION_UNITS_PER_RADIAN;
    return u32(min(max(units, 0.0), DROP_OSCILLATION_MAX_FREQUENCY));
}

// Phases of both modes at time 0, in turns of [0, 1), derived from the drop's id.
fn drop_oscillation_phase(seed: vec2u, id: u32) -> vec2f {
    let draw = rng_draw(seed, id, 0u, DROP_OSCILLATION_DIMENSION);
    return vec2f(rng_unit(draw.x), rng_unit(draw.y));
}

// Azimuth of phi = 0 about the vertical axis in turns of [0, 1), derived from the drop's id.
fn drop_oscillation_azimuth(seed: vec2u, id: u32) -> f32 {
    let draw = rng_draw(seed, id, 0u, DROP_OSCILLATION_DIMENSION);
    return rng_unit(draw.z);
}

// Phase of one mode at a time, in turns; it may include whole turns.
fn drop_oscillation_turns(frequency: u32, phase: f32, time: DropOscillationTime) -> f32 {
    let counted = f32((frequency * time.ticks) >> 8u) * DROP_OSCILLATION_TURN_STEP;
    return counted + phase + f32(frequency) * DROP_OSCILLATION_TICK * time.offset;
}

// Sine of an angle in turns.
fn drop_oscillation_sine(turns: f32) -> f32 {
    return sin(DROP_OSCILLATION_TURN * (turns - floor(turns + 0.5)));
}

// (s2, s3) at a time; age: seconds since the disturbance from which damping counts.
fn drop_oscillation_displacement(oscillation: DropOscillation, time: DropOscillationTime, age: f32) -> vec2f {
    let since = max(age, 0.0);
    let turns_2 = drop_oscillation_turns(oscillation.frequency.x, oscillation.phase.x, time);
    let turns_3 = drop_oscillation_turns(oscillation.frequency.y, oscillation.phase.y, time);
    return vec2f(
        oscillation.amplitude.x * exp(-(since * oscillation.damping.x)) * drop_oscillation_sine(turns_2),
        oscillation.amplitude.y * exp(-(since * oscillation.damping.y)) * drop_oscillation_sine(turns_3),
    );
}

// Volume of eq. 2 over that of the sphere, exactly: 1 + 3/5 s2^2 + 2/35 s2^3 + 18/7 s3^2 + 18/35 s2 s3^2.
fn drop_oscillation_volume(displacement: vec2f) -> f32 {
    let s2 = displacement.x;
    let s3 = displacement.y;
    return 1.0 + (s2 * s2 * (3.0 / 5.0 + 2.0 / 35.0 * s2) + s3 * s3 * (18.0 / 7.0 + 18.0 / 35.0 * s2));
}

// V^(-1/3) for V in 1 to 1.4, by five steps of Newton's method for y^-3 = V from y = 1.
fn drop_oscillation_inverse_cube_root(volume: f32) -> f32 {
    let y1 = (4.0 - volume) * (1.0 / 3.0);
    let y2 = y1 * (4.0 - volume * y1 * y1 * y1) * (1.0 / 3.0);
    let y3 = y2 * (4.0 - volume * y2 * y2 * y2) * (1.0 / 3.0);
    let y4 = y3 * (4.0 - volume * y3 * y3 * y3) * (1.0 / 3.0);
    return y4 * (4.0 - volume * y4 * y4 * y4) * (1.0 / 3.0);
}

// Coefficients of the radius, computed once per drop and time: (s2, s3, V^(-1/3)).
fn drop_oscillation_state(displacement: vec2f) -> vec3f {
    let scale = drop_oscillation_inverse_cube_root(drop_oscillation_volume(displacement));
    return vec3f(displacement.x, displacement.y, scale);
}

// The same for eq. 2 as printed: the volume varies with the oscillation.
fn drop_oscillation_state_rousseau_2008(displacement: vec2f) -> vec3f {
    return vec3f(displacement.x, displacement.y, 1.0);
}

// r / r0 in the direction with x = cos(theta).
fn drop_oscillation_radius(state: vec3f, x: f32, cos_phi: f32) -> f32 {
    let even = 1.0 + state.x * drop_oscillation_legendre_20(x);
    return (even + state.y * drop_oscillation_legendre_31(x) * cos_phi) * state.z;
}

// r / r0 on the left (phi) and right (phi + pi) outline of a drop seen from the side, at theta = pi / 2.
fn drop_oscillation_outline(state: vec3f, cos_phi: f32) -> vec2f {
    let even = 1.0 - 0.5 * state.x;
    let odd = 1.5 * state.y * cos_phi;
    return vec2f((even + odd) * state.z, (even - odd) * state.z);
}

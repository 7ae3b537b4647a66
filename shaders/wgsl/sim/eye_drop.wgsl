// A drop relative to the eye.
// Host type: downpour_sim::field::EyeDrop.

struct EyeDrop {
    // At the time of the picture, or where it would be then, m.
    offset: vec3f,
    // Diameter, m; 0 for an empty place in a list.
    diameter: f32,
    // m/s.
    velocity: vec3f,
    // Its id in 32 bits.
    id: u32,
    // When it is there, s from the time of the picture.
    present: vec2f,
    // Terminal speed, m/s.
    speed: f32,
    unused: u32,
}

// Spray of a picture.
// Twin: downpour_render::rain::spray.

struct SprayFrame {
    // Squares of the map of heights: x and z of the lowest corner, edge of a texel, m, and its inverse.
    levels: array<vec4f, SPRAY_LEVELS>,
    // Meters aside, along x and z, per meter upward on a line against the mean fall.
    lean: vec2f,
    // Extinction at a surface, 1/m.
    extinction: f32,
    // Height over which it decreases by a factor of e, m.
    height: f32,
    // The eye, relative to the scene's origin.
    eye: vec3f,
    // Height from which the map looks down.
    top: f32,
    // Unit direction against the mean fall.
    rise: vec3f,
    // Distance in pixels between those whose rays look for what hides lamps, and the column and row of the one in each cell.
    ray_spacing: u32,
    ray_column: u32,
    ray_row: u32,
    unused_a: u32,
    unused_b: u32,
}

@group(0) @binding(10) var<uniform> spray_frame: SprayFrame;

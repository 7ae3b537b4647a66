// A perspective camera with its picture.
// Twin: downpour_render::camera.

struct RenderCamera {
    // Position of the eye.
    eye: vec3f,
    // Columns of the picture.
    width: u32,
    // Half the picture's width at distance 1, along the camera's right.
    right: vec3f,
    // Rows of the picture.
    height: u32,
    // Half the picture's height at distance 1, along the camera's up.
    up: vec3f,
    // Seed of the random numbers of this picture.
    seed: u32,
    // View direction, of length 1.
    forward: vec3f,
    // Width of a pixel at distance 1.
    pixel_angle: f32,
}

// Ray through a position of the picture, in pixels from the top left, not normalized: its part along the view direction is 1.
fn camera_ray(camera: RenderCamera, x: f32, y: f32) -> vec3f {
    let u = 2.0 * x / f32(camera.width) - 1.0;
    let v = 1.0 - 2.0 * y / f32(camera.height);
    return camera.forward + camera.right * u + camera.up * v;
}

// Unit direction of that ray.
fn camera_direction(camera: RenderCamera, x: f32, y: f32) -> vec3f {
    let ray = camera_ray(camera, x, y);
    return ray / sqrt(dot(ray, ray));
}

// Position on the picture of a point relative to the eye, right and up from the middle in halves of the picture; `depth` is
// the point's part along the view direction, or what a caller divides by in its place.
fn camera_place(camera: RenderCamera, point: vec3f, depth: f32) -> vec2f {
    return vec2f(
        dot(point, camera.right) / (dot(camera.right, camera.right) * depth),
        dot(point, camera.up) / (dot(camera.up, camera.up) * depth),
    );
}

// Position on the picture, in pixels from the top left, of a point relative to the eye.
fn camera_project(camera: RenderCamera, point: vec3f) -> vec2f {
    let place = camera_place(camera, point, dot(point, camera.forward));
    return vec2f((0.5 + 0.5 * place.x) * f32(camera.width), (0.5 - 0.5 * place.y) * f32(camera.height));
}

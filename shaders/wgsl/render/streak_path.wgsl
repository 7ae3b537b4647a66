// A streak in time: where its drop is at an instant of the exposure, what shape it has then, and the rays that pass it.
// Geometry: offsets are on the plane of streak.wgsl, in equivalent radii from the drop's middle, along the right and up of its
// view. Rays have the directions in which the eye's go, by streak_span.wgsl.
// Time: what a pixel sees of a drop that moves along v is not the drop of one instant: a point that is v radii ahead of the
// middle was passed earlier. Shapes are those of the time at which the point is passed.
// Twin: downpour_render::rain::streak_path.

// A streak that has a profile.
struct StreakPath {
    shape: DropShapeCoefficients,
    // Volume over that of the shape at rest: 1 + s2 (x + s2 (y + s2 z)) + s3^2 (w + s2 volume_last).
    volume: vec4f,
    volume_last: f32,
    // Half the width and half the height of the shape at rest, in equivalent radii.
    wide: f32,
    tall: f32,
    // Refractive index of water relative to air.
    index: f32,
    // Cosine and sine of the azimuth of the lobe of the mode (3,1), from +X toward +Z.
    lobe: vec2f,
    // Amplitudes of the modes (2,0) and (3,1), over the radius.
    amplitudes: vec2f,
    // Instants whose rays are traced, and columns across the motion; along a chord there are as many rays as columns.
    rows: u32,
    columns: u32,
    // Instants of the profile, and its columns for each of the rays'.
    profile_rows: u32,
    fine: u32,
    // First of its rays, and of its entries in the table.
    first_ray: u32,
    first_entry: u32,
    // Index of the drop among the picture's.
    drop: u32,
    unused: u32,
}

// A drop at the time of a row of its profile.
struct StreakInstant {
    // Middle of the drop on the plane.
    middle: vec2f,
    // Equivalent radius on the plane.
    scale: f32,
    time: f32,
    // Time in which it moves by an equivalent radius.
    pace: f32,
    // Fraction of the way along a chord by which its rays go through other points of the plane.
    follow: f32,
    // See StreakSpan.
    funnel: f32,
}

// A ray in the frame of the drop, whose lobe is toward +X: the point on the plane, and the direction.
struct StreakLine {
    origin: vec3f,
    direction: vec3f,
}

// A drop at the time of a row of its profile, by the fraction of the rows before it.
fn streak_path_instant(drop: ScreenDrop, row: f32) -> StreakInstant {
    let span = streak_span(drop);
    let time = streak_span_time(span, row);
    let way = time * drop.depth_ratio / max(1.0 - time + time * drop.depth_ratio, 1.0e-20);
    let scale = drop.slope / streak_depth(drop.depth_ratio, time);
    let faster = way + (1.0 - way) * drop.depth_ratio;
    let rate = drop.depth_ratio / max(faster * faster, 1.0e-12);
    let moves = max(sqrt(dot(drop.along, drop.along)), 1.0e-20);
    let pace = rate * scale / moves;
    let middle = drop.start + drop.along * way;
    return StreakInstant(middle, scale, time, pace, 1.0 - span.parallel, span.funnel);
}

// The unit vector along the motion on the plane, and the one across it.
fn streak_path_axes(drop: ScreenDrop) -> vec4f {
    let along = drop.along / max(sqrt(dot(drop.along, drop.along)), 1.0e-20);
    return vec4f(along, along.y, -along.x);
}

// s2 and s3 at a time.
fn streak_path_displacement(path: StreakPath, drop: ScreenDrop, time: f32) -> vec2f {
    return vec2f(
        path.amplitudes.x * drop_oscillation_sine(drop.mode_phase.z + drop.cycles.x * time),
        path.amplitudes.y * drop_oscillation_sine(drop.mode_phase.w + drop.cycles.y * time),
    );
}

// The drop with these displacements.
fn streak_path_body(path: StreakPath, displacement: vec2f) -> MaskWobbleDrop {
    let s2 = displacement.x;
    let s3 = displacement.y;
    let even = s2 * (path.volume.x + s2 * (path.volume.y + s2 * path.volume.z));
    let odd = s3 * s3 * (path.volume.w + s2 * path.volume_last);
    let size = drop_oscillation_inverse_cube_root(1.0 + (even + odd));
    let wide = path.wide * (1.0 - 0.5 * s2) * size;
    let tall = path.tall * (1.0 + s2) * size;
    return MaskWobbleDrop(
        path.shape,
        vec3f(s2, s3, size),
        path.index,
        1.0 / (wide * wide),
        1.0 / (tall * tall),
    );
}

// A vector of the world in the frame of the drop.
fn streak_path_turned(path: StreakPath, v: vec3f) -> vec3f {
    return vec3f(v.x * path.lobe.x + v.z * path.lobe.y, v.y, v.z * path.lobe.x - v.x * path.lobe.y);
}

// The inverse.
fn streak_path_back(path: StreakPath, v: vec3f) -> vec3f {
    return vec3f(v.x * path.lobe.x - v.z * path.lobe.y, v.y, v.z * path.lobe.x + v.x * path.lobe.y);
}

// A ray of the pixel whose ray is point.x beside the path, when it is point.y ahead of the drop's middle.
fn streak_path_line(path: StreakPath, drop: ScreenDrop, instant: StreakInstant, point: vec2f) -> StreakLine {
    let axes = streak_path_axes(drop);
    let offset = axes.zw * (point.x * (1.0 + instant.funnel * point.y)) + axes.xy * point.y;
    let through = axes.zw * point.x + axes.xy * (instant.follow * point.y);
    let right = drop_glint_right(drop.towards);
    let up = cross(right, drop.towards);
    let position = instant.middle + through * instant.scale;
    let direction = normalize(drop.towards + right * position.x + up * position.y);
    let origin = right * offset.x + up * offset.y;
    return StreakLine(streak_path_turned(path, origin), streak_path_turned(path, direction));
}

// Streaks of unresolved drops: how many more or fewer of them a pixel sees than are to be expected.
// Law: of the drops of a shell of distances, Poisson's number of streaks crosses a pixel, with the mean and the variance of what their
// outlines take out. The streaks stand in columns about the axis of motion, half a pixel to a pixel wide, each as long as the drops move
// while the shutter is open, and go on as the drops do. The mean is 1, so that the light of a rain does not depend on it.
// Twin: downpour_render::rain::medium::streaks.

// A number of Poisson's law over its mean, for a number in [0, 1).
fn medium_streaks_poisson(mean: f32, number: f32) -> f32 {
    if mean >= MEDIUM_STREAKS_MANY {
        // Evenly spread about 1, with the same variance.
        return 1.0 + (number - 0.5) * sqrt(12.0 / mean);
    }
    var chance = exp(-mean);
    var sum = chance;
    var count = 0u;
    // Beyond the least chance the sum is as near to 1 as its digits.
    while count < MEDIUM_STREAKS_MAX && number >= sum && chance > MEDIUM_STREAKS_CHANCE {
        count += 1u;
        chance *= mean / f32(count);
        sum += chance;
    }
    return f32(count) / mean;
}

// The column of a direction, by its part across the axis of motion, and the number of columns: half a pixel to a pixel wide.
fn medium_streaks_column(across: vec2f, pixel: f32) -> vec2u {
    // A coordinate along the edges of a square, 0 to 4, in place of the angle: the same on each device.
    let edge = max(abs(across.x) + abs(across.y), 1.0e-9);
    let part = across.y / edge;
    let turn = select(3.0 - part, 1.0 + part, across.x >= 0.0);
    let sine = sqrt(dot(across, across));
    let wide = edge / max(sine, 1.0e-9);
    let count = 1u << u32(ceil(log2(clamp(4.0 * sine * wide * wide / pixel, 1.0, 1.0e7))));
    return vec2u(u32(turn * 0.25 * f32(count)), count);
}

// The drops of a shell over a pixel, over those that are to be expected, where the ray has this sine and cosine to the axis of motion.
// `part`: of the shell that is before the scene.
fn medium_streaks_shell(index: u32, column: vec2u, sine: f32, cosine: f32, part: f32, pixel: f32) -> f32 {
    let shell = medium_frame.shells[index];
    if shell.count <= 0.0 || part <= 0.0 || sine < MEDIUM_STREAKS_SINE {
        return 1.0;
    }
    let words = rng_pcg4d(vec4u(column.x, column.y, MEDIUM_STREAKS_DIMENSION + index, medium_frame.seed));
    // Drops of neighboring columns begin at other heights; a row is as high as a streak is long, or a pixel.
    let height = cosine / (sine * pixel * max(shell.pixels, 1.0)) + shell.part + rng_unit(words.x);
    let row = shell.row + u32(i32(floor(height)));
    let number = rng_unit(rng_pcg4d(vec4u(words.y, row, words.z, words.w)).x);
    return medium_streaks_poisson(shell.count * part * (1.0 + shell.pixels * sine), number);
}

// The same of a ray of unit direction: of its optical depth from the eye to a distance, and about a distance `light` on it. `pixel`: angle of
// a pixel.
fn medium_streaks_at(direction: vec3f, span: vec3f, end: f32, light: f32, pixel: f32) -> vec2f {
    if medium_frame.is_grainy == 0u {
        return vec2f(1.0);
    }
    let cosine = dot(direction, medium_frame.axis);
    let across = vec2f(dot(direction, medium_frame.across), dot(direction, medium_frame.beside));
    let sine = sqrt(dot(across, across));
    let column = medium_streaks_column(across, pixel);
    // The place of the distance among the middles of the shells.
    let place = clamp(0.5 * (3.0 * log2(max(light / MEDIUM_NEAR, 1.0e-6)) + 1.0) - 0.5, 0.0, f32(MEDIUM_SLICES - 1u));
    var about = 0.0;
    var sum = 0.0;
    var whole = 0.0;
    var before = 0.0;
    var begin = 0.0;
    for (var k = 0u; k < MEDIUM_SLICES; k += 1u) {
        let last = medium_node(2u * k + 1u);
        let until = medium_depth(min(last, end), span, 1.0);
        let weight = max(1.0 - abs(place - f32(k)), 0.0);
        let part = clamp((end - begin) / (last - begin), 0.0, 1.0);
        if part > 0.0 || weight > 0.0 {
            let drops = medium_streaks_shell(k, column, sine, cosine, max(part, MEDIUM_STREAKS_PART), pixel);
            sum += drops * (until - before);
            whole += until - before;
            about += drops * weight;
        }
        before = until;
        begin = last;
    }
    return vec2f(select(sum / max(whole, 1.0e-20), 1.0, whole <= 0.0), about);
}

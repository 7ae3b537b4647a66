// Drops that enter a frustum: candidates in thin regions at its planes and its ball, with the density of the rain, each
// moved by a step as any drop and kept if it arrives.
//
// A region's candidates are uniform between two distances from its plane and in a trapezoid along it, or between two
// radii of the ball and in a cone of directions. The first limit that a candidate violates before the step has to be
// that of its region: no part of space is filled twice.
// Twin: downpour_sim::enter.

// Region of space of the candidates of a bin of sizes.
struct EnterRegion {
    // Plane, or VOLUME_BALL.
    face: u32,
    bin: u32,
    // Number of its first candidate, among all and among those of its bin.
    first: u32,
    first_of_bin: u32,
    // Distances from the plane, or radii, m.
    low: f32,
    high: f32,
    // Ends along the tangent, m.
    begin: f32,
    end: f32,
    // Half the width: at the eye, m, and per m along the tangent. For the ball the slope is 1 - cos of the cone's half
    // angle.
    slope: f32,
    width: f32,
    // Center across, m.
    middle: f32,
    unused: u32,
}

// Step in which each slot was last taken.
@group(0) @binding(10) var<storage, read_write> enter_claims: array<atomic<u32>>;

// Region in the tables.
fn enter_region(index: u32) -> EnterRegion {
    let first = step_frame.regions_first + index * ENTER_REGION_WORDS;
    return EnterRegion(
        step_tables[first], step_tables[first + 1u], step_tables[first + 2u], step_tables[first + 3u],
        bitcast<f32>(step_tables[first + 4u]), bitcast<f32>(step_tables[first + 5u]),
        bitcast<f32>(step_tables[first + 6u]), bitcast<f32>(step_tables[first + 7u]),
        bitcast<f32>(step_tables[first + 8u]), bitcast<f32>(step_tables[first + 9u]),
        bitcast<f32>(step_tables[first + 10u]), 0u,
    );
}

// Region of a candidate: the last whose first candidate is not behind it.
fn enter_find(candidate: u32) -> u32 {
    var low = 0u;
    var high = step_frame.regions;
    for (var k = 0u; k < ENTER_SEARCH && high - low > 1u; k += 1u) {
        let middle = (low + high) / 2u;
        if step_tables[step_frame.regions_first + middle * ENTER_REGION_WORDS + 2u] <= candidate {
            low = middle;
        } else {
            high = middle;
        }
    }
    return low;
}

// Interpolates a diameter in 16 bits between two quantiles.
fn enter_code(lower: f32, upper: f32, fraction: f32) -> u32 {
    return u32(lower + (upper - lower) * fraction + 0.5);
}

// Number in [0, 1) from the low bits of three words, which `rng_unit` does not use.
fn enter_chance(words: vec4u) -> f32 {
    return f32((words.x & 255u) | (words.y & 255u) << 8u | (words.z & 255u) << 16u) * ENTER_UNIT;
}

// Offset from the eye of a candidate, and 1; 0 for a rejected candidate. `normal` and `tangent` are those of the
// plane, for the ball those of the back.
fn enter_offset(region: EnterRegion, normal: vec3f, tangent: vec3f, random: vec3f, chance: f32) -> vec4f {
    let across = cross(normal, tangent);
    let distance = region.low + (region.high - region.low) * random.x;
    if region.face == VOLUME_BALL {
        let disk = 2.0 * random.yz - 1.0;
        let square = dot(disk, disk);
        let lean = square * region.slope;
        let aside = disk * sqrt(region.slope * max(2.0 - lean, 0.0));
        let direction = tangent * aside.x + across * aside.y - normal * (1.0 - lean);
        let there = square <= 1.0 && chance * region.high * region.high <= distance * distance;
        return vec4f(direction * distance, select(0.0, 1.0, there));
    }
    // The density along the tangent grows with the width.
    let near = region.width + region.slope * region.begin;
    let far = region.width + region.slope * region.end;
    let root = sqrt(max(near * near + random.y * (far * far - near * near), 0.0));
    let fraction = random.y * (near + far) / max(near + root, 1.0e-12);
    let along = region.begin + (region.end - region.begin) * fraction;
    let aside = region.middle + (region.width + region.slope * along) * (2.0 * random.z - 1.0);
    return vec4f(normal * distance + tangent * along + across * aside, 1.0);
}

// Candidate after the step; its kind is STEP_GONE if it has not entered.
fn enter_drop(candidate: u32) -> StepDrop {
    let region = enter_region(enter_find(candidate));
    let number = candidate - region.first;
    let dimension = ENTER_DRAW + region.bin * (VOLUME_BALL + 1u) + region.face;
    let words = rng_draw(step_frame.seed, number, step_frame.step, dimension);
    let quantile = rng_unit(words.w) * f32(ENTER_SIZES - 1u);
    let entry = step_frame.sizes_first + region.bin * ENTER_SIZES + u32(quantile);
    let lower = bitcast<f32>(step_tables[entry]);
    let bits = enter_code(lower, bitcast<f32>(step_tables[entry + 1u]), quantile - floor(quantile));
    let word = step_word(bits, STEP_FALLING, (region.first_of_bin + number) & STEP_COUNT);
    let gone = StepDrop(vec3f(0.0), step_word(bits, STEP_GONE, 0u), vec3f(0.0), step_frame.step);
    let plane = min(region.face, VOLUME_PLANES - 1u);
    let normal = step_frame.frustum_before.planes[plane].xyz;
    let random = vec3f(rng_unit(words.x), rng_unit(words.y), rng_unit(words.z));
    let offset = enter_offset(region, normal, step_frame.tangents[plane].xyz, random, enter_chance(words));
    if offset.w == 0.0 {
        return gone;
    }
    let diameter = motion_diameter(bits);
    let speed = step_speed(diameter);
    if volume_limit(step_frame.frustum_before, offset.xyz, diameter, speed) != region.face {
        return gone;
    }
    // Position at the middle of the horizon, and now.
    let ahead = step_frame.frustum_before.eye + offset.xyz;
    let velocity = step_coming(ahead, speed);
    let position = ahead - velocity * step_frame.frustum_before.half_horizon;
    if STEP_COLLIDES {
        if !collision_open(position) {
            return gone;
        }
    }
    return step_view(StepDrop(position, word, velocity, step_frame.step));
}

@compute @workgroup_size(256)
fn main_enter(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let candidate = (id.x + id.y * groups.x * 256u) * step_frame.pieces + step_frame.piece;
    if candidate >= step_frame.candidates {
        return;
    }
    let drop = enter_drop(candidate);
    if step_kind(drop.word) == STEP_GONE {
        return;
    }
    // Any slot that holds no drop: random ones, then one after another.
    var slot = 0u;
    for (var k = 0u; k < ENTER_TRIES + ENTER_SCAN; k += 1u) {
        if k < ENTER_TRIES {
            slot = rng_draw(step_frame.seed, candidate, step_frame.step, ENTER_SLOT + k).x % step_frame.count;
        } else {
            slot = (slot + 1u) % step_frame.count;
        }
        let taken = atomicLoad(&enter_claims[slot]);
        if taken == step_frame.step || step_kind(step_positions[slot].w) != STEP_GONE {
            continue;
        }
        if atomicCompareExchangeWeak(&enter_claims[slot], taken, step_frame.step).exchanged {
            step_positions[slot] = vec4u(bitcast<vec3u>(drop.position), drop.word);
            step_motions[slot] = vec4u(bitcast<vec3u>(drop.velocity), drop.last);
            return;
        }
    }
    // No free slot: it is counted.
    atomicAdd(&step_counts[4], 1u);
}

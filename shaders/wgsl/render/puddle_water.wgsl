// Puddles as rays meet them: depth maps over the ground, ripples of one lattice, what water does to the ground beneath it.
// Twin: downpour_trace::scene::water, where the method is described.

// Water over a position.
struct PuddleWater {
    // Number of the puddle, or PUDDLE_WATER_NONE.
    puddle: u32,
    // Depth, m.
    depth: f32,
    // Height of the surface over the position, m.
    rise: f32,
    // Fraction of the rain that arrives.
    open: f32,
}

// A texel of a map: ground over the map's height (m), rise of the surface over the ground (m), depth (m, below 0 on
// land), fraction of the rain that arrives.
fn puddle_water_texel(map: vec3u, x: i32, y: i32) -> vec4f {
    let column = clamp(x, 0, i32(map.x) - 1);
    let line = clamp(y, 0, i32(map.y) - 1);
    return puddle_texel(map.z + u32(line) * map.x + u32(column));
}

// The map over a position, bilinear. Beyond the map all is land.
fn puddle_water_map(puddle: RenderPuddle, position: vec3f) -> vec4f {
    let axes = puddle.axes;
    let map = puddle.map;
    let dx = position.x - puddle.middle.x;
    let dz = position.z - puddle.middle.z;
    let along = dx * axes.x + dz * axes.y;
    let across = dz * axes.x - dx * axes.y;
    if abs(along) >= axes.z || abs(across) >= axes.w {
        return vec4f(0.0, 0.0, -1.0, 0.0);
    }
    let u = (along / axes.z * 0.5 + 0.5) * f32(map.x) - 0.5;
    let v = (across / axes.w * 0.5 + 0.5) * f32(map.y) - 0.5;
    let x = i32(floor(u));
    let y = i32(floor(v));
    let fx = u - floor(u);
    let fy = v - floor(v);
    let upper = puddle_water_texel(map, x, y) * (1.0 - fx) + puddle_water_texel(map, x + 1, y) * fx;
    let lower = puddle_water_texel(map, x, y + 1) * (1.0 - fx) + puddle_water_texel(map, x + 1, y + 1) * fx;
    return upper * (1.0 - fy) + lower * fy;
}

// The water over a position that a ray has met, on ground whose facet rises by `upward`, or in the water.
fn puddle_water_find(position: vec3f, upward: f32) -> PuddleWater {
    for (var k = 0u; k < render_frame.puddle_count; k += 1u) {
        let puddle = puddle_load(k);
        let found = puddle_water_map(puddle, position);
        if found.z < PUDDLE_WATER_MIN_DEPTH {
            continue;
        }
        let height = position.y - puddle.middle.y - found.x;
        let rise = clamp(found.y - height, 0.0, max(found.y, 0.0));
        let stands = height > 0.0 && rise > 0.0;
        let lies = abs(height) <= PUDDLE_WATER_SLACK && upward > 0.7;
        if stands || lies {
            return PuddleWater(k, max(found.z - max(height, 0.0), 0.0), rise, clamp(found.w, 0.0, 1.0));
        }
    }
    return PuddleWater(PUDDLE_WATER_NONE, 0.0, 0.0, 0.0);
}

// A texel of a level of the ripples: slopes along the lattice's axes, and the mean of the square of the slope.
fn puddle_water_slope(first: u32, size: u32, x: i32, y: i32) -> vec4f {
    let column = u32(clamp(x, 0, i32(size) - 1));
    let line = u32(clamp(y, 0, i32(size) - 1));
    return puddle_texel(first + line * size + column);
}

// A piece of the ripples around a vertex of the mesh: slopes, and the variance that the level does not show. `offset` is
// from the vertex, in the mesh's steps; `level` has size, first row and texels per step.
fn puddle_water_piece(vertex: vec2i, offset: vec2f, first: u32, size: u32, steps: f32) -> vec3f {
    let words = rng_draw(vec2u(0u, 0u), bitcast<u32>(vertex.x), bitcast<u32>(vertex.y), PUDDLE_WATER_DIMENSION);
    // Anywhere as long as the piece lies within the lattice: a step to each side of its middle.
    let room = max(f32(size) - 2.0 * steps, 0.0);
    let u = steps + rng_unit(words.x) * room + offset.x * steps - 0.5;
    let v = steps + rng_unit(words.y) * room + offset.y * steps - 0.5;
    let x = i32(floor(u));
    let y = i32(floor(v));
    let fx = u - floor(u);
    let fy = v - floor(v);
    let upper = puddle_water_slope(first, size, x, y) * (1.0 - fx) + puddle_water_slope(first, size, x + 1, y) * fx;
    let lower = puddle_water_slope(first, size, x, y + 1) * (1.0 - fx)
        + puddle_water_slope(first, size, x + 1, y + 1) * fx;
    let mixed = upper * (1.0 - fy) + lower * fy;
    return vec3f(mixed.xy, max(mixed.z - dot(mixed.xy, mixed.xy), 0.0));
}

// The ripples at a place in steps of the mesh: slopes, and the variance that the level does not show. One lattice serves
// all water: pieces of it, from a different position for each vertex of a triangle mesh, are mixed so that the variance
// stays. The level has a first row, a size and texels per step.
fn puddle_water_mixed(place: vec2f, first: u32, size: u32, steps: f32) -> vec3f {
    // Skewed, so that triangles become halves of squares.
    let sx = place.x - place.y * 0.57735027;
    let sz = place.y * 1.1547005;
    let corner = vec2i(i32(floor(sx)), i32(floor(sz)));
    let fx = sx - floor(sx);
    let fz = sz - floor(sz);
    let under = fx + fz < 1.0;
    let third = 1.0 - fx - fz;
    let weights = select(vec3f(-third, 1.0 - fz, 1.0 - fx), vec3f(third, fz, fx), under);
    var sum = vec2f(0.0);
    var spread = 0.0;
    var square = 0.0;
    for (var k = 0u; k < 3u; k += 1u) {
        var step = vec2i(select(1, 0, under), select(1, 0, under));
        if k == 1u {
            step = vec2i(select(1, 0, under), select(0, 1, under));
        }
        if k == 2u {
            step = vec2i(select(0, 1, under), select(1, 0, under));
        }
        let vertex = corner + step;
        let middle = vec2f(f32(vertex.x) + 0.5 * f32(vertex.y), 0.8660254 * f32(vertex.y));
        let piece = puddle_water_piece(vertex, place - middle, first, size, steps);
        let weight = weights[k];
        sum += piece.xy * weight;
        spread += piece.z * weight * weight;
        square += weight * weight;
    }
    return vec3f(sum / sqrt(square), spread / square);
}

// Slopes along x and z of the water's surface, and the variance of the slope within a footprint (m). Ripples move with water that runs.
// Near the eye the rings of single drops take their part of it.
fn puddle_water_ripple(puddle: u32, position: vec3f, footprint: f32, depth: f32, open: f32) -> vec3f {
    let water = puddle_load(puddle);
    let look = water.ripples;
    let more = water.own;
    let head = puddle_ripples();
    let cell = head.cell;
    let flow = puddle_flow_load(puddle);
    // Velocity, and slopes of the surface.
    var runs = vec4f(0.0);
    if flow.first > 0u {
        runs = puddle_flow_at(flow.first, water, position);
    }
    // look: scale, cosine and sine of the angle, influence.
    let strength = look.w * open * smoothstep(0.0, max(more.x, 1.0e-6), depth);
    if head.size == 0u || strength <= 0.0 {
        return vec3f(runs.zw, 0.0);
    }
    let finest = footprint / (look.x * cell);
    let level = min(u32(max(floor(log2(max(finest, 1.0)) + 0.5), 0.0)), head.levels - 1u);
    // Levels of n x n, n / 2 x n / 2, ...: 4/3 n^2 (1 - 4^-level) texels before this one.
    let size = max(head.size >> level, 1u);
    let first = head.first + (head.size * head.size - size * size) / 3u * 4u;
    let steps = PUDDLE_WATER_MESH / cell * f32(size) / f32(head.size);

    let px = (position.x * look.y + position.z * look.z) / (look.x * PUDDLE_WATER_MESH) + more.y;
    let pz = (position.z * look.y - position.x * look.z) / (look.x * PUDDLE_WATER_MESH) + more.z;
    let moves = puddle_flow_moves(sqrt(dot(runs.xy, runs.xy)));
    var mixed = vec3f(0.0);
    var square = 0.0;
    if moves < 1.0 {
        let weight = 1.0 - moves;
        mixed = puddle_water_mixed(vec2f(px, pz), first, size, steps) * vec3f(weight, weight, weight * weight);
        square = weight * weight;
    }
    if moves > 0.0 {
        let along = vec2f(runs.x * look.y + runs.y * look.z, runs.y * look.y - runs.x * look.z)
            / (look.x * PUDDLE_WATER_MESH);
        for (var second = 0u; second < 2u; second += 1u) {
            let part = puddle_flow_phase(flow.phase, second);
            let weight = moves * part.y;
            let place = vec2f(px, pz) - along * part.x + puddle_flow_place(flow.phase, flow.cycle, second);
            mixed += puddle_water_mixed(place, first, size, steps) * vec3f(weight, weight, weight * weight);
            square += weight * weight;
        }
    }
    var lattice = 1.0;
    var rings = vec2f(0.0);
    if water.rings > 0.0 {
        let drops = puddle_rings_load();
        let shown = select(0.0, puddle_rings_shown(position.xz - drops.middle, drops.reach, footprint), drops.cells.x > 0u);
        if shown > 0.0 {
            rings = puddle_rings_sum(drops, position.xz) * (shown * strength);
            // The lattice keeps what rings do not have.
            lattice = sqrt(1.0 - shown * shown * drops.part);
        }
    }
    let slope = mixed.xy * (strength * lattice / sqrt(square));
    // Back to the world's axes.
    return vec3f(
        slope.x * look.y - slope.y * look.z + rings.x + runs.z,
        slope.y * look.y + slope.x * look.z + rings.y + runs.w,
        mixed.z / square * (strength * strength * lattice * lattice),
    );
}

// The normal of a surface with these slopes, and with a deviation drawn by two numbers in [0, 1).
fn puddle_water_normal(ripple: vec3f, a: f32, b: f32) -> vec3f {
    // Normal deviates along both axes, each with half of the variance.
    let radius = sqrt(-ripple.z * log(max(1.0 - a, 1.0e-6)));
    let angle = 6.2831853 * b;
    let x = -(ripple.x + radius * cos(angle));
    let z = -(ripple.y + radius * sin(angle));
    return vec3f(x, 1.0, z) / sqrt(1.0 + x * x + z * z);
}

// A mirrored direction above the water.
fn puddle_water_mirrored(direction: vec3f, normal: vec3f) -> vec3f {
    let along = direction - normal * (2.0 * dot(direction, normal));
    let raised = vec3f(along.x, max(abs(along.y), PUDDLE_WATER_GRAZING), along.z);
    return raised / sqrt(dot(raised, raised));
}

// The direction beneath the surface.
fn puddle_water_refracted(direction: vec3f, normal: vec3f) -> vec3f {
    let eta = 1.0 / PUDDLE_WATER_INDEX;
    let cosine = max(-dot(direction, normal), 0.0);
    let inner = sqrt(max(1.0 - eta * eta * (1.0 - cosine * cosine), 0.0));
    let along = direction * eta + normal * (eta * cosine - inner);
    return along / sqrt(dot(along, along));
}

// The direction beneath level water of light from above, both toward where it comes from.
fn puddle_water_beneath(direction: vec3f) -> vec3f {
    let x = direction.x / PUDDLE_WATER_INDEX;
    let z = direction.z / PUDDLE_WATER_INDEX;
    return vec3f(x, sqrt(max(1.0 - x * x - z * z, 0.0)), z);
}

// Point at which light that falls on a position under a depth of level water has come through the surface,
// relative to the point of the surface above the position.
fn puddle_water_entry(direction: vec3f, depth: f32) -> vec3f {
    let below = puddle_water_beneath(direction);
    let aside = depth / max(below.y, 0.1);
    return vec3f(below.x * aside, 0.0, below.z * aside);
}

// The direction above level water of light from beneath it; its height is 0 where it does not come out.
fn puddle_water_above(direction: vec3f) -> vec3f {
    let x = direction.x * PUDDLE_WATER_INDEX;
    let z = direction.z * PUDDLE_WATER_INDEX;
    return vec3f(x, sqrt(max(1.0 - x * x - z * z, 0.0)), z);
}

// Albedo of what lies under water, as seen through its surface over the fraction that comes out along the ray: light goes
// in diffusely, and is thrown back between ground and surface. White stays white.
fn puddle_water_albedo(albedo: vec3f) -> vec3f {
    let out = (1.0 - PUDDLE_WATER_OUTSIDE) / (PUDDLE_WATER_INDEX * PUDDLE_WATER_INDEX);
    return albedo * out / (vec3f(1.0) - albedo * PUDDLE_WATER_INSIDE);
}

// Reflectance at normal incidence of what lies under water, from that in air.
fn puddle_water_reflectance(in_air: vec3f) -> vec3f {
    let root = sqrt(clamp(in_air, vec3f(0.0), vec3f(0.98)));
    let index = (vec3f(1.0) + root) / (vec3f(1.0) - root);
    let ratio = (index - vec3f(PUDDLE_WATER_INDEX)) / (index + vec3f(PUDDLE_WATER_INDEX));
    return ratio * ratio;
}

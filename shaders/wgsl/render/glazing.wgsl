// Rain on panes of the scene: drops that stay where they are, and runs of water down tracks that sweep them away. Rows in the table: rain
// (mm) before a pause, what is kept after it, rain after it (mm), and its rate (mm/s); number of panes; then for each pane its
// material, height of the glass, largest radius and seed; center and half width; direction to the right and half height; direction
// outward and half thickness.
// Twin: downpour_trace::glazing, where the method is described.

// True if rain shows on panes of the scene: the code slows down the rest.
override GLAZING_PANES: bool = true;

// Rain on the panes of a scene.
struct RenderGlazing {
    // Rain before a pause, mm; what is kept after it; rain after it, mm; its rate, mm/s.
    before: f32,
    kept: f32,
    since: f32,
    rate: f32,
    count: u32,
}

// A pane that carries water.
struct GlazingPane {
    // SCENE_NONE: any.
    material: u32,
    // Way of the water down the pane, m.
    height: f32,
    // Largest radius of a drop that stays, m.
    largest: f32,
    seed: u32,
    center: vec3f,
    // 0: wherever its material is.
    half_width: f32,
    across: vec3f,
    half_height: f32,
    outward: vec3f,
    half_thickness: f32,
}

// A place on a pane.
struct GlazingPlace {
    // To the right, and down, m.
    at: vec2f,
    // Unit vectors of both.
    across: vec3f,
    down: vec3f,
    // Rain that has met the surface, mm; that since a pause, mm; its rate, mm/s.
    met: f32,
    since: f32,
    rate: f32,
    // Fraction of the water that is kept of what was there before the pause.
    kept: f32,
}

// Runs of water down a lane, at a height.
struct GlazingLane {
    lane: i32,
    // Runs that have come by.
    runs: f32,
    // Rain between two of them, mm.
    period: f32,
    // Height, m.
    height: f32,
}

// A drop that a place is under.
struct GlazingDrop {
    // Of the place from the drop's middle, m, as if the drop were round.
    offset: vec2f,
    // Radius of its edge, m; 0: there is none.
    radius: f32,
    // Factor of its length down the pane.
    stretch: f32,
}

// Water at a place of a pane.
struct GlazingWater {
    // Normal of its surface, toward the rain.
    normal: vec3f,
    // Curvature, 1/m; 0: there is no drop.
    bend: f32,
}

// Reads the rain.
fn glazing_load() -> RenderGlazing {
    let row = render_frame.glazing;
    let rain = bitcast<vec4f>(render_table[row]);
    return RenderGlazing(rain.x, rain.y, rain.z, rain.w, render_table[row + 1u].x);
}

// Reads a pane.
fn glazing_pane(index: u32) -> GlazingPane {
    let row = render_frame.glazing + 2u + index * GLAZING_ROWS;
    let head = render_table[row];
    let center = bitcast<vec4f>(render_table[row + 1u]);
    let across = bitcast<vec4f>(render_table[row + 2u]);
    let outward = bitcast<vec4f>(render_table[row + 3u]);
    return GlazingPane(
        head.x, bitcast<f32>(head.y), bitcast<f32>(head.z), head.w,
        center.xyz, center.w, across.xyz, across.w, outward.xyz, outward.w,
    );
}

// True if a place of a material, which lets light through or does not, is on a pane.
fn glazing_holds(pane: GlazingPane, material: u32, position: vec3f, clear: bool) -> bool {
    if select(pane.material != material, !clear, pane.material == SCENE_NONE) {
        return false;
    }
    if pane.half_width <= 0.0 {
        return true;
    }
    let away = position - pane.center;
    let down = cross(pane.across, pane.outward);
    return abs(dot(away, pane.across)) <= pane.half_width
        && abs(dot(away, down)) <= pane.half_height
        && abs(dot(away, pane.outward)) <= pane.half_thickness;
}

// The direction of a surface in steps of about an eighth of a turn: curved glass has the same axes from triangle to triangle.
fn glazing_facing(facet: vec3f) -> vec3f {
    let all = abs(facet);
    let steps = floor(facet / max(all.x, max(all.y, all.z)) + vec3f(0.5));
    return steps / sqrt(dot(steps, steps));
}

// Direction down a surface of such a direction.
fn glazing_down(facing: vec3f) -> vec3f {
    let along = facing * facing.y - vec3f(0.0, 1.0, 0.0);
    let length = sqrt(dot(along, along));
    // On level glass, as if it fell to the north.
    return select(along / max(length, 1.0e-6), vec3f(0.0, 0.0, -1.0), length < 0.1);
}

// A number from -1 to 1 that changes smoothly along a line of cells.
fn glazing_wander(at: f32, lane: i32, track: i32, seed: u32) -> f32 {
    let low = floor(at);
    let f = at - low;
    let cell = i32(low);
    let words = vec3u(bitcast<u32>(lane), bitcast<u32>(track), seed);
    let a = rng_unit(rng_pcg4d(vec4u(bitcast<u32>(cell), words)).x);
    let b = rng_unit(rng_pcg4d(vec4u(bitcast<u32>(cell + 1), words)).x);
    return 2.0 * (a + (b - a) * (f * f * (3.0 - 2.0 * f))) - 1.0;
}

// Where a track of a lane is at a height: distance to the right of the middle of its lane, m.
fn glazing_track(height: f32, lane: i32, track: i32, seed: u32) -> f32 {
    return GLAZING_LANE * GLAZING_SWAY * glazing_wander(height / GLAZING_TURN, lane, track, seed);
}

// Part of the time between two runs by which a run is late; height at which it begins, over that of the pane; size of its head, over the
// largest.
fn glazing_run(lane: i32, run: i32, seed: u32) -> vec3f {
    let words = rng_pcg4d(vec4u(bitcast<u32>(lane), bitcast<u32>(run), seed, GLAZING_DIMENSION));
    return vec3f(GLAZING_LATE * rng_unit(words.x), GLAZING_START * rng_unit(words.y), 1.0 - GLAZING_SMALLER * rng_unit(words.z));
}

// The runs of the lane of a place.
fn glazing_lane(place: GlazingPlace, at: vec2f, pane: GlazingPane) -> GlazingLane {
    let lane = i32(floor(at.x / GLAZING_LANE));
    // What meets the lane over half the pane's height, in runs.
    let period = GLAZING_RUN_M3 * 1.0e3 / (GLAZING_LANE * 0.5 * pane.height);
    let phase = rng_unit(rng_pcg4d(vec4u(bitcast<u32>(lane), pane.seed, 0u, GLAZING_DIMENSION)).x);
    // They are on their way for so long.
    let late = place.rate * at.y / GLAZING_SPEED;
    return GlazingLane(lane, (place.met - late) / period + phase, period, at.y);
}

// Rain since a place was swept, mm.
fn glazing_age(place: GlazingPlace, at: vec2f, pane: GlazingPane) -> f32 {
    let lane = glazing_lane(place, at, pane);
    let aside = at.x - (f32(lane.lane) + 0.5) * GLAZING_LANE;
    var age = min(place.met, f32(GLAZING_TRACKS * GLAZING_RUNS) * lane.period);
    var run = i32(floor(lane.runs));
    if lane.runs - f32(run) < glazing_run(lane.lane, run, pane.seed).x {
        run -= 1;
    }
    let newest = i32(floor(f32(run) / f32(GLAZING_RUNS)));
    for (var k = 0; k < i32(GLAZING_TRACKS); k += 1) {
        let track = newest - k;
        // Of an old track, its last run.
        let last = min(run, (track + 1) * i32(GLAZING_RUNS) - 1);
        if last < 0 {
            break;
        }
        let drawn = glazing_run(lane.lane, last, pane.seed);
        let distance = aside - glazing_track(lane.height, lane.lane, track, pane.seed);
        if lane.height > glazing_run(lane.lane, track, pane.seed).y * pane.height && abs(distance) < GLAZING_SWEEP * pane.largest {
            age = min(age, (lane.runs - f32(last) - drawn.x) * lane.period);
            break;
        }
    }
    return max(age, 0.0);
}

// Height of a drop over the plane of its edge at an offset, m; below 0 beside it.
fn glazing_cap(offset: vec2f, radius: f32) -> f32 {
    let sphere = radius / GLAZING_SINE;
    let rest = sphere * sphere - dot(offset, offset);
    return sqrt(max(rest, 0.0)) - sphere * GLAZING_COSINE;
}

// The higher of two drops at a place.
fn glazing_higher(a: GlazingDrop, b: GlazingDrop) -> GlazingDrop {
    if b.radius > 0.0 && (a.radius <= 0.0 || glazing_cap(b.offset, b.radius) > glazing_cap(a.offset, a.radius)) {
        return b;
    }
    return a;
}

// The drop of a cell of a size, if a place is under it. `turn`: cosine and sine of the angle by which the cells are turned.
fn glazing_still(place: GlazingPlace, pane: GlazingPane, level: u32, cell: f32, turn: vec2f) -> GlazingDrop {
    let none = GlazingDrop(vec2f(0.0), 0.0, 1.0);
    var at = vec2f(place.at.x * turn.x + place.at.y * turn.y, place.at.y * turn.x - place.at.x * turn.y) / cell;
    // Each line of cells begins elsewhere: no columns are seen.
    let stagger = rng_unit(rng_pcg4d(vec4u(bitcast<u32>(i32(floor(at.y))), pane.seed, level, GLAZING_DIMENSION)).x);
    at.x += stagger;
    let low = floor(at);
    let column = bitcast<u32>(i32(low.x));
    let line = bitcast<u32>(i32(low.y));
    let words = rng_pcg4d(vec4u(column, line, pane.seed, GLAZING_DIMENSION + 1u + level));
    let numbers = vec4f(rng_unit(words.x), rng_unit(words.y), rng_unit(words.z), rng_unit(words.w));
    if numbers.w > GLAZING_PRESENT {
        return none;
    }
    // Small ones are many.
    let widest = min(GLAZING_MAX_RADIUS * cell * (0.3 + 0.7 * numbers.z * numbers.z), pane.largest);
    let stray = (numbers.xy - vec2f(0.5)) * (1.0 - 2.0 * GLAZING_MAX_STRETCH * widest / cell);
    let along = (low + vec2f(0.5) + stray - vec2f(stagger, 0.0)) * cell;
    let middle = vec2f(along.x * turn.x - along.y * turn.y, along.x * turn.y + along.y * turn.x);
    let age = glazing_age(place, middle, pane);
    // What has dried is missing in drops that are older than the pause.
    let left = select(1.0, place.kept, age > place.since);
    // The cell's share of the rain, as a cap.
    let volume = 1.0e-3 * age * left * cell * cell * GLAZING_SHARE;
    let radius = min(pow(volume / GLAZING_VOLUME, 1.0 / 3.0), widest * pow(left, 1.0 / 3.0));
    if radius < GLAZING_MIN_RADIUS {
        return none;
    }
    let stretch = 1.0 + (GLAZING_MAX_STRETCH - 1.0) * radius / pane.largest;
    let away = place.at - middle;
    let offset = vec2f(away.x, away.y / stretch);
    if dot(offset, offset) >= radius * radius {
        return none;
    }
    return GlazingDrop(offset, radius, stretch);
}

// The head of a run, if a place is under it.
fn glazing_runner(place: GlazingPlace, pane: GlazingPane) -> GlazingDrop {
    var found = GlazingDrop(vec2f(0.0), 0.0, 1.0);
    let lane = glazing_lane(place, place.at, pane);
    let aside = place.at.x - (f32(lane.lane) + 0.5) * GLAZING_LANE;
    let near = i32(floor(lane.runs));
    for (var k = 0; k < 3; k += 1) {
        let run = near - 1 + k;
        let drawn = glazing_run(lane.lane, run, pane.seed);
        // Below the place, m.
        let ahead = (lane.runs - f32(run) - drawn.x) * lane.period * GLAZING_SPEED / max(place.rate, 1.0e-9);
        let radius = pane.largest * GLAZING_HEAD * drawn.z;
        if run < 0 || abs(ahead) > 3.0 * radius {
            continue;
        }
        let track = i32(floor(f32(run) / f32(GLAZING_RUNS)));
        let height = lane.height + ahead;
        if height < glazing_run(lane.lane, track, pane.seed).y * pane.height {
            continue;
        }
        let stretch = select(1.0, GLAZING_TAIL, ahead > 0.0);
        let offset = vec2f(aside - glazing_track(height, lane.lane, track, pane.seed), -ahead / stretch);
        if dot(offset, offset) < radius * radius {
            found = glazing_higher(found, GlazingDrop(offset, radius, stretch));
        }
    }
    return found;
}

// The place of a position on a pane whose facet, toward the rain, meets a flux of it, relative to level ground.
fn glazing_place(rain: RenderGlazing, pane: GlazingPane, position: vec3f, shift: vec3f, facet: vec3f, flux: f32) -> GlazingPlace {
    var across = pane.across;
    var down = vec3f(0.0);
    var at = vec2f(0.0);
    if pane.half_width > 0.0 {
        down = cross(pane.across, pane.outward);
        let away = position - pane.center;
        at = vec2f(dot(away, across) + pane.half_width, dot(away, down) + pane.half_height);
    } else {
        let facing = glazing_facing(facet);
        down = glazing_down(facing);
        across = cross(facing, down);
        let away = position + shift;
        let line = dot(away, down) / pane.height;
        at = vec2f(dot(away, across), (line - floor(line)) * pane.height);
    }
    return GlazingPlace(at, across, down, (rain.before + rain.since) * flux, rain.since * flux, rain.rate * flux, rain.kept);
}

// The drop that a place is under.
fn glazing_drop(place: GlazingPlace, pane: GlazingPane) -> GlazingDrop {
    var found = glazing_runner(place, pane);
    var cell = GLAZING_FINE;
    var turn = vec2f(0.8, 0.6);
    for (var level = 0u; level < GLAZING_LEVELS; level += 1u) {
        found = glazing_higher(found, glazing_still(place, pane, level, cell, turn));
        cell *= GLAZING_COARSER;
        turn = vec2f(turn.x * 0.8 - turn.y * 0.6, turn.x * 0.6 + turn.y * 0.8);
    }
    return found;
}

// Water of a drop, as a footprint (m) shows it.
fn glazing_water(place: GlazingPlace, found: GlazingDrop, facet: vec3f, footprint: f32) -> GlazingWater {
    if found.radius <= 0.0 {
        return GlazingWater(facet, 0.0);
    }
    let seen = clamp(1.5 - GLAZING_FADE * footprint / found.radius, 0.0, 1.0);
    let sphere = found.radius / GLAZING_SINE;
    let root = sqrt(max(sphere * sphere - dot(found.offset, found.offset), 1.0e-12));
    let slope = vec2f(found.offset.x, found.offset.y / found.stretch) * (seen / root);
    // Both axes lie in the pane but for the steps of its direction.
    var normal = facet + (place.across - facet * dot(place.across, facet)) * slope.x
        + (place.down - facet * dot(place.down, facet)) * slope.y;
    normal = normal / sqrt(dot(normal, normal));
    return GlazingWater(normal, seen / sphere);
}

// Water on a surface of a material, seen along a direction: its normal is toward the rain.
fn glazing_find(surface: Surface, material: u32, footprint: f32, wet: RenderWet) -> GlazingWater {
    let rain = glazing_load();
    // Toward the side that the rain comes from.
    let facet = select(-surface.facet, surface.facet, dot(surface.facet, wet.towards) > 0.0);
    let none = GlazingWater(facet, 0.0);
    let flux = dot(facet, wet.towards) / max(wet.towards.y, 0.05);
    if flux < GLAZING_MIN_FLUX {
        return none;
    }
    for (var k = 0u; k < rain.count; k += 1u) {
        let pane = glazing_pane(k);
        if !glazing_holds(pane, material, surface.position, surface.transmission > 0.0) {
            continue;
        }
        let place = glazing_place(rain, pane, surface.position, wet.shift, facet, flux);
        let found = glazing_drop(place, pane);
        if found.radius <= 0.0 {
            return none;
        }
        let start = surface.position + facet * render_frame.nearest;
        let hit = surface_blocker(start, wet_arrival(wet.towards, surface.position + wet.shift), render_frame.nearest, BVH_FAR);
        if hit.distance >= 0.0 {
            return none;
        }
        return glazing_water(place, found, facet, footprint);
    }
    return none;
}

// A pane as its gloss is seen with water on it: from the side of the rain the drop's.
fn glazing_surface(dry: Surface, water: GlazingWater) -> Surface {
    var surface = dry;
    if water.bend > 0.0 && dot(dry.facet, water.normal) > 0.0 {
        surface.normal = water.normal;
        surface.bend = water.bend;
    }
    return surface;
}

// Factor of the light that a drop lets through, which mirrors more or less of it (`gloss`) than the pane does: no light is lost or made.
fn glazing_open(surface: Surface, gloss: vec3f, along: vec3f, open: vec3f) -> vec3f {
    let sharp = surface.roughness < PATH_SHARP;
    let dry = scatter_gloss(surface.normal_reflectance, surface.roughness, abs(dot(surface.facet, along)), sharp);
    return max(vec3f(1.0) - (gloss - dry * surface.occlusion) / max(open, vec3f(0.05)), vec3f(0.0));
}

// Direction beyond a pane of a ray that has met water of a normal on a facet that both are toward the rain. What is reflected within goes
// back to where it came from.
fn glazing_through(along: vec3f, normal: vec3f, facet: vec3f) -> vec3f {
    let inward = dot(along, facet) < 0.0;
    var first = select(-facet, normal, inward);
    let second = select(-normal, facet, inward);
    // A slope that a ray from aside does not meet.
    if dot(along, first) > -0.02 {
        first -= along * (dot(along, first) + 0.02);
        first = first / sqrt(dot(first, first));
    }
    let within = optics_refract(along, first, 1.0 / PUDDLE_WATER_INDEX);
    let out = optics_refract(within.xyz, second, PUDDLE_WATER_INDEX);
    if out.w <= 0.0 {
        return optics_reflect(along, first);
    }
    return out.xyz;
}

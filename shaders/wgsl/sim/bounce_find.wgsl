// Parts of the paths of drops whose droplets a picture may show; see bounce.wgsl. BOUNCE_LANES invocations share the chains of a
// column of air that may hold such drops: there are few columns, each with many parts to look at, and software drivers end the loops
// of an invocation after 65535 turns in all. Drops are those of field.wgsl.
// Twin: downpour_sim::impacts, whose search divides space at surfaces.

// Lists the parts of the path of a drop, by its position at the end of the exposure, in which a droplet may start that the picture shows.
fn bounce_find_parts(drop: EyeDrop) {
    let diameter = drop.diameter * bounce_frame.size;
    let speed = fall_speed_terminal(bounce_frame.model, diameter, bounce_frame.air);
    var begin = drop.offset;
    for (var row = 0u; row <= bounce_frame.slices; row += 1u) {
        let before = f32(bounce_frame.slices - row) * BOUNCE_SLICE;
        let end = drop.offset + bounce_row(row, drop.speed).moved + vec3f(0.0, drop.speed * before, 0.0);
        // Where obstacles are, and before the end of the exposure.
        let starts = bounce_frame.first_time + (f32(row) - 1.0) * BOUNCE_SLICE;
        if row > 0u && starts <= bounce_frame.half_shutter && max(begin.y, end.y) >= bounce_frame.lowest && min(begin.y, end.y) <= bounce_frame.highest
            && bounce_may_show(bounce_ball(row - 1u, begin, end, speed, drop), diameter) {
            let slot = atomicAdd(&bounce_parts.count, 1u);
            if slot < bounce_frame.parts {
                // The number of the part and the speed of the droplet are where the time is that a drop is present.
                bounce_parts.drops[slot] = EyeDrop(
                    begin,
                    drop.diameter,
                    (end - begin) / BOUNCE_SLICE,
                    drop.id,
                    vec2f(f32(row - 1u), speed),
                    drop.speed,
                    drop.id_low,
                );
            }
        }
        begin = end;
    }
}

// Lists the parts of the paths of the drops of a chain.
fn bounce_find_chain(kind: FieldClass, column: vec2i, key: vec2u, index: u32) {
    let words = rng_draw(key, index, 0u, FIELD_CHAIN);
    let size = field_size(kind.first_node, words.x);
    let speed = f32(size.y) * FIELD_RATE_STEP * kind.period;
    let drift = field_carried(speed).drift;
    let fallen = field_fallen(size.y, field_frame.seconds, field_frame.fraction, field_frame.is_before);
    // Height of the drop 0 above the eye, in periods.
    let above = field_less(field_less(vec2u(0u, words.y), fallen), kind.eye_periods);
    let part = f32(above.y >> 8u) * (FIELD_FRACTION_STEP * 256.0);
    let heights = (kind.heights - drift.y) / kind.period - part;
    for (var k = i32(ceil(heights.x)); k <= i32(floor(heights.y)); k += 1) {
        let number = u32(k) - above.x;
        if !field_falls(kind, key, index, number, words.y, size) {
            continue;
        }
        let place = rng_draw(key, index, number, FIELD_PLACE);
        let chance = rng_unit(rng_draw(place.wz, 0u, 0u, BOUNCE_CHANCE).x);
        if chance >= bounce_frame.chance {
            continue;
        }
        let in_column = (vec2f(place.xy >> vec2u(8u)) + 0.5) * (FIELD_FRACTION_STEP * 256.0);
        let aside = (vec2f(column - kind.eye_column) + (in_column - kind.eye_in_column)) * kind.edge;
        bounce_find_parts(EyeDrop(
            vec3f(aside.x, (f32(k) + part) * kind.period, aside.y) + drift,
            f32(size.x) * FIELD_DIAMETER_STEP,
            vec3f(0.0),
            place.z ^ place.w,
            vec2f(0.0),
            speed,
            place.w,
        ));
    }
}

@compute @workgroup_size(64, 1, 1)
fn main_bounce_find(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let invocation = invocation_index(id, groups);
    let index = invocation / BOUNCE_LANES;
    if index >= field_frame.columns {
        return;
    }
    var number = 0u;
    while number + 1u < field_frame.classes && index >= field_classes[number + 1u].first_column {
        number += 1u;
    }
    let kind = field_classes[number];
    let place = index - kind.first_column;
    let column = kind.columns + vec2i(vec2u(place / kind.counts.y, place % kind.counts.y));
    let words = rng_pcg4d(vec4u(vec2u(column), kind.seed));
    let key = vec2u(words.x ^ words.z, words.y ^ words.w);
    let count = field_count(key, kind.first_threshold, kind.portions);
    for (var chain = invocation % BOUNCE_LANES; chain < count; chain += BOUNCE_LANES) {
        bounce_find_chain(kind, column, key, chain);
    }
}

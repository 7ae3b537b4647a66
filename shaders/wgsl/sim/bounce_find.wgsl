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
fn bounce_find_chain(column: FieldColumn, chain: FieldChain) {
    for (var place = chain.places.x; place <= chain.places.y; place += 1) {
        if !field_falls(column, chain, u32(place) - chain.above) {
            continue;
        }
        let drop = field_drop(column, chain, place);
        // By both halves of the drop's id.
        let chance = rng_unit(rng_draw(vec2u(drop.id_low, drop.id ^ drop.id_low), 0u, 0u, BOUNCE_CHANCE).x);
        if chance < bounce_frame.chance {
            bounce_find_parts(drop);
        }
    }
}

@compute @workgroup_size(64, 1, 1)
fn main_bounce_find(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let invocation = invocation_index(id, groups);
    let index = invocation / BOUNCE_LANES;
    if index >= field_frame.columns {
        return;
    }
    let column = field_column(index);
    let count = field_count(column.key, column.kind.first_threshold, column.kind.portions);
    for (var chain = invocation % BOUNCE_LANES; chain < count; chain += BOUNCE_LANES) {
        bounce_find_chain(column, field_chain(column, chain));
    }
}

// Crowns of the splashes of stepped rain: those of impacts that the last steps have kept.
// Twin: downpour_sim::step_splash.

struct StepSplashFrame {
    // Of each span of time: its origin relative to the eye, m, and the time from its beginning to the picture, s.
    spans: array<vec4f, STEP_SPANS>,
    // Index of the first impact of the first span, and room for those of each.
    first: u32,
    room: u32,
    unused_1: u32,
    unused_2: u32,
}

@group(0) @binding(14) var<uniform> step_splash_frame: StepSplashFrame;

// The drop of an impact that was kept in a span, up to its end.
fn step_splash_drop(event: StepEvent, span: vec4f) -> EyeDrop {
    let met = event.time - span.w;
    let id = step_list_id(event.last, event.drop & STEP_EVENT_DROP);
    return EyeDrop(
        event.position + span.xyz - event.velocity * met,
        event.diameter,
        event.velocity,
        id.x ^ id.y,
        vec2f(-FIELD_ALWAYS, met),
        FIELD_BOUNCED,
        id.y,
    );
}

@compute @workgroup_size(64, 1, 1)
fn main_step_splash(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let index = invocation_index(id, groups);
    let span = index / step_splash_frame.room;
    if span >= STEP_SPANS {
        return;
    }
    let place = index % step_splash_frame.room;
    let count = atomicLoad(&step_counts[STEP_COUNTS + span]);
    if place == 0u && count > step_splash_frame.room {
        atomicAdd(&step_list_found[2], count - step_splash_frame.room);
    }
    if place >= count {
        return;
    }
    let event = step_events[step_splash_frame.first + index];
    let drop = step_splash_drop(event, step_splash_frame.spans[span]);
    step_list_add(splash_crown(drop, packing_octahedral_decode(event.normal)));
}

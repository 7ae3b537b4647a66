// Pixels by rays: of the picture, and of the capture of the surroundings. Both are one kernel, since a software driver
// compiles the walk through the scene anew for each.
// Samples of a pixel that meet one surface are shaded once; where the two samples at opposite corners do, the others are
// taken to do so too. The sky's light on surfaces leaves the picture's kernel as what one pixel has found of it;
// skylight.wgsl takes means over neighbours.
// Twin: downpour_render::trace.

@group(0) @binding(7) var<storage, read_write> trace_picture: array<vec4f>;
@group(0) @binding(8) var<storage, read_write> trace_gather: array<TraceGather>;

// What a pixel has found of the sky's light, for the filter.
struct TraceGather {
    // Light of the sky over pi, and the share of the sky that is seen: means of the samples that have met a surface.
    sky: vec4f,
    // What it is multiplied with.
    body: vec3f,
    // Share of the samples that have met a surface.
    met: f32,
    // What the square of the open share is multiplied with.
    gloss: vec3f,
    // The normal, octahedral, 16 bits each.
    normal: u32,
}

// The direction of a place of the picture or of the capture, in pixels from the top left.
fn trace_direction(x: f32, y: f32) -> vec3f {
    if render_frame.projection == SCENE_OCTAHEDRAL {
        return capture_direction(x, y);
    }
    return scene_direction(x, y);
}

// A pixel: mean radiance, and the distance of what stands nearest in it. In the picture the sky's light on surfaces is
// left out and goes to the filter.
fn trace_pixel(x: u32, y: u32) -> vec4f {
    let is_picture = render_frame.projection == SCENE_PICTURE;
    var sum = vec3f(0.0);
    var body = vec3f(0.0);
    var gloss = vec3f(0.0);
    var sky = vec4f(0.0);
    var normal = vec3f(0.0);
    var met = 0.0;
    var nearest = SCENE_FAR;
    let n = render_frame.grid;
    var last = scene_nothing();
    var count = 0u;
    for (var k = 0u; k < n * n; k += 1u) {
        // First the opposite corners.
        let place = select(select(k - 1u, n * n - 1u, k == 1u), 0u, k == 0u);
        let dx = (f32(place % n) + 0.5) / f32(n);
        let dy = (f32(place / n) + 0.5) / f32(n);
        let direction = trace_direction(f32(x) + dx, f32(y) + dy);
        let path = scene_path(render_frame.eye, direction, render_frame.pixel_angle, scene_lattice(x, y, place), last);
        if is_picture {
            sum += path.radiance;
        } else {
            sum += scene_radiance(path);
        }
        body += path.body;
        gloss += path.gloss;
        sky += path.sky * path.met;
        normal += path.normal * path.met;
        met += path.met;
        nearest = min(nearest, path.distance);
        count += 1u;
        let both_sky = path.distance >= SCENE_FAR && last.distance >= SCENE_FAR;
        if k == 1u && (path.again > 0.0 || both_sky) {
            break;
        }
        last = path;
    }
    let share = 1.0 / f32(count);
    if is_picture {
        let packed = pack2x16snorm(packing_octahedral_encode(normal));
        trace_gather[y * render_frame.width + x] =
            TraceGather(sky / max(met, 1.0), body * share, met * share, gloss * share, packed);
        return vec4f(sum * share, nearest);
    }
    var seen = sum * share;
    if nearest >= SCENE_FAR && render_frame.projection == SCENE_OCTAHEDRAL {
        seen = capture_sky(x, y);
    }
    return vec4f(seen + capture_suns(x, y), nearest);
}

@compute @workgroup_size(8, 8, 1)
fn main_trace(@builtin(global_invocation_id) id: vec3u) {
    let y = id.y + render_frame.first_row;
    if id.x >= render_frame.width || y >= render_frame.height {
        return;
    }
    trace_picture[y * render_frame.width + id.x] = trace_pixel(id.x, y);
}

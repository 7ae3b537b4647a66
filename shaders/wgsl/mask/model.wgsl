// The mask of a drop given as a mesh: one invocation per texel, rows from the top.
// Twin: downpour_mask::model.

struct MaskModelParameters {
    // Where rays start: in front of everything.
    front: f32,
    index: f32,
    pixel: f32,
    size: u32,
    // First row of this dispatch: large masks are cut into several.
    first_row: u32,
}

@group(0) @binding(0) var<uniform> mask_model: MaskModelParameters;
// Three normals per triangle, as vec4 for their alignment.
@group(0) @binding(3) var<storage, read> mask_model_normals: array<vec4f>;
@group(0) @binding(4) var<storage, read_write> mask_model_texels: array<MaskTexel>;

// Hit of the viewer's ray through (x, y) on the mesh, if any.
fn mask_model_hit(x: f32, y: f32) -> BvhHit {
    return bvh_hit(vec3f(x, y, mask_model.front), vec3f(0.0, 0.0, -1.0), MASK_MODEL_MIN_DISTANCE, BVH_FAR);
}

// The interpolated normal at a hit.
fn mask_model_normal(hit: BvhHit) -> vec3f {
    let first = hit.triangle * 3u;
    let a = mask_model_normals[first].xyz * (1.0 - hit.u - hit.v);
    return normalize(a + mask_model_normals[first + 1u].xyz * hit.u + mask_model_normals[first + 2u].xyz * hit.v);
}

// Exit of light that starts at `start`, along `inside_start`, after total reflections. A ray that finds no way
// out has slipped along an edge of the surface: it counts as lost.
fn mask_model_exit(start: vec3f, inside_start: vec3f) -> MaskTraceExit {
    var point = start;
    var inside = inside_start;
    for (var reflections = 0u; reflections <= MASK_TRACE_REFLECTIONS; reflections += 1u) {
        let hit = bvh_hit(point, inside, MASK_MODEL_MIN_DISTANCE, BVH_FAR);
        if hit.distance < 0.0 {
            break;
        }
        let normal = mask_model_normal(hit);
        point = point + inside * hit.distance;
        let outside = optics_refract(inside, -normal, mask_model.index);
        if outside.w >= 0.0 {
            return MaskTraceExit(point, f32(reflections), normal, 0.0, inside, outside.xyz);
        }
        inside = normalize(optics_reflect(inside, normal));
    }
    return MaskTraceExit(point, f32(MASK_TRACE_REFLECTIONS + 1u), inside, 1.0, inside, inside);
}

// The texel at (x, y) for a ray that hits at `hit`.
fn mask_model_through(x: f32, y: f32, hit: BvhHit, coverage: f32) -> MaskTexel {
    let incident = vec3f(0.0, 0.0, -1.0);
    let index = mask_model.index;
    let entry_normal = mask_model_normal(hit);
    let entry = optics_fresnel_polarized(max(entry_normal.z, 0.0), index);
    let entered = 1.0 - (entry.x + entry.y) * 0.5;
    let reflected = normalize(optics_reflect(incident, entry_normal));
    let inside = normalize(optics_refract(incident, entry_normal, 1.0 / index).xyz);
    var texel = MaskTexel(inside, coverage, reflected, 0.0, inside, 0.0, MASK_TRACE_REFLECTIONS + 1u);
    let exit = mask_model_exit(vec3f(x, y, mask_model.front - hit.distance), inside);
    if exit.lost > 0.0 {
        return texel;
    }
    var polarized = 0.0;
    if exit.reflections == 0.0 {
        polarized = (entry.y - entry.x) * 0.5 * mask_trace_plane_turn(inside, entry_normal, exit.normal);
    }
    let leaving = mask_trace_reflectance(exit, index);
    let through = entered * (1.0 - (leaving.x + leaving.y) * 0.5) + polarized * (leaving.y - leaving.x) * 0.5;
    texel.direction = normalize(exit.outside);
    texel.transmittance = through;
    texel.internal = texel.direction;
    texel.reflections = u32(exit.reflections);
    let back = normalize(optics_reflect(exit.inside, exit.normal));
    let second = mask_model_exit(exit.point, back);
    if second.lost > 0.0 {
        return texel;
    }
    let kept = entered - through;
    var kept_polarized = (entered * (leaving.x - leaving.y) + polarized * (leaving.x + leaving.y)) * 0.5;
    if second.reflections == 0.0 {
        kept_polarized *= mask_trace_plane_turn(back, exit.normal, second.normal);
    } else {
        kept_polarized = 0.0;
    }
    let last = mask_trace_reflectance(second, index);
    texel.internal = normalize(second.outside);
    texel.internal_transmittance =
        kept * (1.0 - (last.x + last.y) * 0.5) + kept_polarized * (last.y - last.x) * 0.5;
    return texel;
}

// The position of sample i of the texel around (x, y).
fn mask_model_sample(x: f32, y: f32, i: u32) -> vec2f {
    let n = MASK_MODEL_SUBSAMPLES;
    let half_width = 0.5 * mask_model.pixel;
    let step = mask_model.pixel / f32(n);
    return vec2f(
        x - half_width + (f32(i % n) + 0.5) * step,
        y - half_width + (f32(i / n) + 0.5) * step,
    );
}

// The texel around (x, y).
fn mask_model_texel(x: f32, y: f32) -> MaskTexel {
    let nothing = MaskTexel(vec3f(0.0), 0.0, vec3f(0.0), 0.0, vec3f(0.0), 0.0, 0u);
    let half_width = 0.5 * mask_model.pixel;
    let center = mask_model_hit(x, y);
    var corners = 0u;
    for (var k = 0u; k < 4u; k += 1u) {
        let dx = select(half_width, -half_width, (k & 1u) == 0u);
        let dy = select(half_width, -half_width, (k & 2u) == 0u);
        corners += select(0u, 1u, mask_model_hit(x + dx, y + dy).distance >= 0.0);
    }
    if center.distance < 0.0 && corners == 0u {
        return nothing;
    }
    if center.distance >= 0.0 && corners == 4u {
        return mask_model_through(x, y, center, 1.0);
    }
    // The outline cuts the texel.
    let n = MASK_MODEL_SUBSAMPLES * MASK_MODEL_SUBSAMPLES;
    var count = 0u;
    var sum = vec2f(0.0);
    for (var i = 0u; i < n; i += 1u) {
        let position = mask_model_sample(x, y, i);
        if mask_model_hit(position.x, position.y).distance >= 0.0 {
            count += 1u;
            sum += position;
        }
    }
    if count == 0u {
        return nothing;
    }
    let middle = sum / f32(count);
    let coverage = f32(count) / f32(n);
    let hit = mask_model_hit(middle.x, middle.y);
    if hit.distance >= 0.0 {
        return mask_model_through(middle.x, middle.y, hit, coverage);
    }
    // The covered part is not convex: take the sample nearest to its middle.
    var best = BVH_FAR;
    var best_position = middle;
    var best_hit = hit;
    for (var i = 0u; i < n; i += 1u) {
        let position = mask_model_sample(x, y, i);
        let offset = position - middle;
        let square = offset.x * offset.x + offset.y * offset.y;
        if square < best {
            let candidate = mask_model_hit(position.x, position.y);
            if candidate.distance >= 0.0 {
                best = square;
                best_position = position;
                best_hit = candidate;
            }
        }
    }
    return mask_model_through(best_position.x, best_position.y, best_hit, coverage);
}

@compute @workgroup_size(8, 8, 1)
fn main_mask_model(@builtin(global_invocation_id) id: vec3u) {
    let row = id.y + mask_model.first_row;
    if id.x >= mask_model.size || row >= mask_model.size {
        return;
    }
    let middle = f32(mask_model.size) * 0.5;
    let x = (f32(id.x) + 0.5 - middle) * mask_model.pixel;
    let y = (middle - f32(row) - 0.5) * mask_model.pixel;
    mask_model_texels[row * mask_model.size + id.x] = mask_model_texel(x, y);
}

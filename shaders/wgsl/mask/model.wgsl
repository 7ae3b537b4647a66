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

// Whether the viewer's ray through (x, y) hits the mesh, and where.
fn mask_model_hit(x: f32, y: f32) -> BvhHit {
    return bvh_hit(vec3f(x, y, mask_model.front), vec3f(0.0, 0.0, -1.0), MASK_MODEL_NEAREST, BVH_FAR);
}

// The interpolated normal at a hit.
fn mask_model_normal(hit: BvhHit) -> vec3f {
    let first = hit.triangle * 3u;
    let a = mask_model_normals[first].xyz * (1.0 - hit.u - hit.v);
    return normalize(a + mask_model_normals[first + 1u].xyz * hit.u + mask_model_normals[first + 2u].xyz * hit.v);
}

// The texel at (x, y) for a ray that hits at `hit`.
fn mask_model_through(x: f32, y: f32, hit: BvhHit, coverage: f32) -> MaskTexel {
    let incident = vec3f(0.0, 0.0, -1.0);
    let index = mask_model.index;
    var normal = mask_model_normal(hit);
    let entry = optics_fresnel_polarised(max(normal.z, 0.0), index);
    let reflectance = (entry.x + entry.y) * 0.5;
    let reflected = normalize(optics_reflect(incident, normal));
    var inside = normalize(optics_refract(incident, normal, 1.0 / index).xyz);
    var point = vec3f(x, y, mask_model.front - hit.distance);
    var polarised = (entry.y - entry.x) * 0.5;
    for (var reflections = 0u; reflections <= MASK_TRACE_REFLECTIONS; reflections += 1u) {
        let next = bvh_hit(point, inside, MASK_MODEL_NEAREST, BVH_FAR);
        // A ray that finds no way out has slipped along an edge of the surface: it counts as lost.
        if next.distance < 0.0 {
            break;
        }
        let exit_normal = mask_model_normal(next);
        point = point + inside * next.distance;
        if reflections == 0u {
            polarised *= mask_trace_plane_turn(inside, normal, exit_normal);
        } else {
            polarised = 0.0;
        }
        normal = exit_normal;
        let outside = optics_refract(inside, -normal, index);
        if outside.w >= 0.0 {
            let exit = optics_fresnel_polarised(max(dot(inside, normal), 0.0), 1.0 / index);
            let exit_mean = 1.0 - (exit.x + exit.y) * 0.5;
            let through = (1.0 - reflectance) * exit_mean + polarised * (exit.y - exit.x) * 0.5;
            return MaskTexel(normalize(outside.xyz), coverage, reflected, through, reflections);
        }
        inside = normalize(optics_reflect(inside, normal));
    }
    return MaskTexel(inside, coverage, reflected, 0.0, MASK_TRACE_REFLECTIONS + 1u);
}

// The place of sample i of the texel round (x, y).
fn mask_model_sample(x: f32, y: f32, i: u32) -> vec2f {
    let n = MASK_MODEL_SUBSAMPLES;
    let half_width = 0.5 * mask_model.pixel;
    let step = mask_model.pixel / f32(n);
    return vec2f(
        x - half_width + (f32(i % n) + 0.5) * step,
        y - half_width + (f32(i / n) + 0.5) * step,
    );
}

// The texel round (x, y).
fn mask_model_texel(x: f32, y: f32) -> MaskTexel {
    let nothing = MaskTexel(vec3f(0.0), 0.0, vec3f(0.0), 0.0, 0u);
    let half_width = 0.5 * mask_model.pixel;
    let centre = mask_model_hit(x, y);
    var corners = 0u;
    for (var k = 0u; k < 4u; k += 1u) {
        let dx = select(half_width, -half_width, (k & 1u) == 0u);
        let dy = select(half_width, -half_width, (k & 2u) == 0u);
        corners += select(0u, 1u, mask_model_hit(x + dx, y + dy).distance >= 0.0);
    }
    if centre.distance < 0.0 && corners == 0u {
        return nothing;
    }
    if centre.distance >= 0.0 && corners == 4u {
        return mask_model_through(x, y, centre, 1.0);
    }
    // The outline cuts the texel.
    let n = MASK_MODEL_SUBSAMPLES * MASK_MODEL_SUBSAMPLES;
    var count = 0u;
    var sum = vec2f(0.0);
    for (var i = 0u; i < n; i += 1u) {
        let place = mask_model_sample(x, y, i);
        if mask_model_hit(place.x, place.y).distance >= 0.0 {
            count += 1u;
            sum += place;
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
    var best_place = middle;
    var best_hit = hit;
    for (var i = 0u; i < n; i += 1u) {
        let place = mask_model_sample(x, y, i);
        let offset = place - middle;
        let square = offset.x * offset.x + offset.y * offset.y;
        if square < best {
            let candidate = mask_model_hit(place.x, place.y);
            if candidate.distance >= 0.0 {
                best = square;
                best_place = place;
                best_hit = candidate;
            }
        }
    }
    return mask_model_through(best_place.x, best_place.y, best_hit, coverage);
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

// Air that is open to the rain: a grid over the picture, a column of slices of distance in each cell.
// Method: one ray per cell and slice, from a position in it, before what the pixel in the cell's middle shows, against the mean fall; the
// optical depth of a cell's ray is summed up slice by slice, and a pixel interpolates between the four cells around it.
// Twin: downpour_render::rain::medium::open.

@group(0) @binding(6) var<storage, read> medium_clean: array<vec4f>;
// First the grid, MEDIUM_SLICES rows for each cell: optical depth up to the slice's end, 1 if the slice is open. Then for each
// pixel two: light of lamps if nothing hid them (below 0: that of the pixels around it), and optical depth; light of lamps that one ray has seen, and the mean distance
// of what they light.
@group(0) @binding(8) var<storage, read_write> medium_out: array<vec4f>;

// Distance of the end of a slice, m.
fn medium_open_end(slice: u32) -> f32 {
    return medium_node(2u * slice + 1u);
}

// The slice of a distance.
fn medium_open_slice(distance: f32) -> u32 {
    let position = 0.5 * (3.0 * log2(max(distance / MEDIUM_NEAR, 1.0)) + 1.0);
    return min(u32(position), MEDIUM_SLICES - 1u);
}

// The middle of a cell of the grid on the picture, pixels from the top left.
fn medium_open_middle(column: u32, row: u32) -> vec2f {
    let part = (vec2f(f32(column), f32(row)) + 0.5) / vec2f(f32(medium_frame.columns), f32(medium_frame.rows));
    return part * vec2f(f32(render_frame.camera.width), f32(render_frame.camera.height));
}

// Distance at which a slice begins, m.
fn medium_open_begin(slice: u32) -> f32 {
    return select(medium_open_end(max(slice, 1u) - 1u), 0.0, slice == 0u);
}

// Distance along the ray of a cell at which the slice asks for what is above it, where a surface is at the distance `solid`.
fn medium_open_asks(word: u32, slice: u32, solid: f32) -> f32 {
    let part = fract(rng_unit(word) + 0.618034 * f32(slice));
    let begin = medium_open_begin(slice);
    let end = medium_open_end(slice);
    let before_solid = select(end, min(end, solid), begin < solid);
    return begin + (before_solid - begin) * part;
}

// Optical depth along the ray of a cell up to a part of a slice, and 1 if the slice is open.
fn medium_open_cell(column: u32, row: u32, slice: u32, part: f32) -> vec2f {
    let at = (row * medium_frame.columns + column) * MEDIUM_SLICES + slice;
    let here = medium_out[at];
    var before = 0.0;
    if slice > 0u {
        before = medium_out[at - 1u].x;
    }
    return vec2f(before + (here.x - before) * part, here.y);
}

// Optical depth of unresolved drops up to a distance along the ray through a position of the picture (pixels from the top left),
// and whether the air is open to the rain there.
fn medium_open_at(x: f32, y: f32, distance: f32) -> vec2f {
    let direction = camera_direction(render_frame.camera, x, y);
    let span = medium_span(direction);
    let outline = medium_outline(direction);
    let whole = medium_depth(distance, span, outline);
    if medium_frame.open == 1u {
        return vec2f(whole, 1.0);
    }
    let slice = medium_open_slice(distance);
    var begin = 0.0;
    if slice > 0u {
        begin = medium_depth(medium_open_begin(slice), span, outline);
    }
    let end = medium_depth(medium_open_end(slice), span, outline);
    // Beyond the last slice, its density continues.
    let fraction = max((whole - begin) / max(end - begin, 1.0e-12), 0.0);
    let last = vec2f(f32(medium_frame.columns - 1u), f32(medium_frame.rows - 1u));
    let size = vec2f(f32(render_frame.camera.width), f32(render_frame.camera.height));
    let position = clamp(vec2f(x, y) / size * (last + 1.0) - 0.5, vec2f(0.0), last);
    let low = vec2u(position);
    let high = min(low + 1u, vec2u(last));
    let part = position - vec2f(low);
    var sum = vec2f(0.0);
    for (var k = 0u; k < 4u; k += 1u) {
        let right = (k & 1u) == 1u;
        let below = k >= 2u;
        let weight = select(1.0 - part.x, part.x, right) * select(1.0 - part.y, part.y, below);
        sum += weight * medium_open_cell(select(low.x, high.x, right), select(low.y, high.y, below), slice, fraction);
    }
    return sum;
}

// Of the cells of a workgroup: optical depth of each slice.
var<workgroup> medium_open_parts: array<array<f32, MEDIUM_SLICES>, MEDIUM_CELLS>;

@compute @workgroup_size(16, 4, 1)
fn main_medium_open(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_id) local: vec3u,
) {
    let slice = local.x;
    let cell = (group.y * groups.x + group.x) * MEDIUM_CELLS + local.y;
    let is_cell = cell < medium_frame.columns * medium_frame.rows;
    let middle = medium_open_middle(cell % medium_frame.columns, cell / medium_frame.columns);
    let direction = camera_direction(render_frame.camera, middle.x, middle.y);
    var open = 1.0;
    if is_cell && medium_frame.open == 0u {
        let word = rng_draw(vec2u(render_frame.camera.seed, 0u), cell, 0u, MEDIUM_RANDOM_DIMENSION).x;
        let solid = medium_clean[u32(middle.y) * render_frame.camera.width + u32(middle.x)].w;
        let start = medium_frame.eye + direction * medium_open_asks(word, slice, solid);
        let above = surface_blocker(start, medium_frame.rise, render_frame.nearest, BVH_FAR);
        open = select(0.0, 1.0, above.distance < 0.0);
    }
    let span = medium_span(direction);
    let outline = medium_outline(direction);
    var before = 0.0;
    if slice > 0u {
        before = medium_depth(medium_open_begin(slice), span, outline);
    }
    medium_open_parts[local.y][slice] = (medium_depth(medium_open_end(slice), span, outline) - before) * open;
    workgroupBarrier();
    if !is_cell {
        return;
    }
    var depth = 0.0;
    for (var k = 0u; k <= slice; k += 1u) {
        depth += medium_open_parts[local.y][k];
    }
    medium_out[cell * MEDIUM_SLICES + slice] = vec4f(depth, open, 0.0, 0.0);
}

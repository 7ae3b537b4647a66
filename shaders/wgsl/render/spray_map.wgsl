// Heights of what rain hits: the first surface on each line of the mean fall, on squares around the eye, each twice as wide as
// the one before.
// Lines are numbered by where they pass the height 0 of the scene: a straight ray is straight there too.
// Layout: SPRAY_LEVELS squares of SPRAY_SIZE times SPRAY_SIZE heights, row by row along z; then for each square the largest of SPRAY_CELL
// times SPRAY_CELL heights.
// Twin: downpour_render::rain::spray::map.

@group(0) @binding(8) var<storage, read_write> spray_map_out: array<f32>;

// Height of the first surface on the line of a texel, relative to the scene's origin.
fn spray_map_height(level: u32, column: u32, row: u32) -> f32 {
    let square = spray_frame.levels[level];
    let plane = square.xy + vec2f(f32(column), f32(row)) * square.z;
    let aside = plane + spray_frame.lean * spray_frame.top;
    let start = vec3f(aside.x, spray_frame.top, aside.y);
    let hit = surface_hit(start, -spray_frame.rise, render_frame.nearest, BVH_FAR);
    return select(spray_frame.top - hit.distance * spray_frame.rise.y, SPRAY_NOTHING, hit.distance < 0.0);
}

// Heights of the texels of a workgroup.
var<workgroup> spray_map_heights: array<f32, 64>;

// A workgroup for each cell, one level after the other in rows of cells.
@compute @workgroup_size(8, 8, 1)
fn main_spray_map(
    @builtin(workgroup_id) cell: vec3u,
    @builtin(local_invocation_id) local: vec3u,
    @builtin(local_invocation_index) invocation: u32,
) {
    let texel = cell.xy * SPRAY_CELL + local.xy;
    let found = spray_map_height(cell.z, texel.x, texel.y);
    spray_map_out[(cell.z * SPRAY_SIZE + texel.y) * SPRAY_SIZE + texel.x] = found;
    spray_map_heights[invocation] = found;
    workgroupBarrier();
    if invocation == 0u {
        var highest = SPRAY_NOTHING;
        for (var k = 0u; k < SPRAY_CELL * SPRAY_CELL; k += 1u) {
            highest = max(highest, spray_map_heights[k]);
        }
        let first = SPRAY_LEVELS * SPRAY_SIZE * SPRAY_SIZE;
        spray_map_out[first + (cell.z * SPRAY_CELLS + cell.y) * SPRAY_CELLS + cell.x] = highest;
    }
}

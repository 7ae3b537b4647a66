// Heights of the water: each drop is a cap of a sphere over its disk, stretched behind its center if it moves; the
// highest of overlapping caps counts.
// Twin: downpour_lattice::glass::height.

@group(0) @binding(0) var<uniform> glass_height_frame: GlassFrame;
@group(0) @binding(1) var<uniform> glass_height_sizes: GlassTable;
@group(0) @binding(2) var<storage, read> glass_height_mass: array<u32>;
@group(0) @binding(3) var<storage, read> glass_height_motion: array<vec2u>;
@group(0) @binding(4) var<storage, read> glass_height_surface: array<u32>;
// In cells / 256.
@group(0) @binding(5) var<storage, read_write> glass_height_cells: array<atomic<u32>>;

// Stretch of a drop behind its center relative to the front, in units of 1/256.
fn glass_height_stretch(speed: u32) -> u32 {
    return 256u + min(speed, u32(GLASS_CELL)) / GLASS_HEIGHT_STRETCH;
}

// Squared distance of a cell from the center of a drop, with the stretch undone, in (cells / 256)^2.
fn glass_height_squared(away: vec2i, v: vec2i) -> u32 {
    let speed = i32(glass_motion_length(v));
    // A drop this slow is round; its direction is not resolved.
    if speed < 4 {
        return u32(away.x * away.x + away.y * away.y) << 16u;
    }
    let along = (away.x * v.x + away.y * v.y) * 16 / speed * 16;
    let across = (away.y * v.x - away.x * v.y) * 16 / speed * 16;
    let behind = along * 256 / i32(glass_height_stretch(u32(speed)));
    let far = select(behind, along, along > 0);
    return u32(far * far) + u32(across * across);
}

// Height of a cap at a squared distance, all in cells / 256.
fn glass_height_cap(radius: u32, sphere: u32, squared: u32) -> u32 {
    if squared >= radius * radius {
        return 0u;
    }
    return glass_motion_root(sphere * sphere - squared) - glass_motion_root(sphere * sphere - radius * radius);
}

// Adds the cap of the drop of a cell. Of a ridge it is a cap as wide, which those of its neighbors make a ridge.
fn glass_height_drop(cell: vec2i) {
    let index = glass_frame_index(glass_height_frame, cell);
    let mass = glass_height_mass[index];
    if mass == 0u {
        return;
    }
    let class_of = glass_size_class(mass);
    let row = glass_size_row(
        glass_height_sizes.rows[class_of], glass_height_sizes.rows[class_of + 1u], glass_size_fraction(mass));
    var v = glass_motion_unpack(glass_height_motion[index].x);
    var center = cell;
    var radius = row.radius;
    var sphere = row.sphere;
    if glass_ridge_is(glass_height_motion[index].y) {
        center = glass_ridge_center(cell, v, row.ahead);
        radius = row.ridge;
        sphere = row.sphere * row.ridge / max(row.radius, 1u);
        v = vec2i(0);
    }
    // The rim may be 15 % beyond the disk.
    let reach = i32(radius * glass_height_stretch(glass_motion_length(v)) / 56000u) + 1;
    for (var y = -reach; y <= reach; y += 1) {
        for (var x = -reach; x <= reach; x += 1) {
            let to = center + vec2i(x, y);
            if !glass_frame_holds(glass_height_frame, to) {
                continue;
            }
            let at = glass_frame_index(glass_height_frame, to);
            // The rim follows the affinity of the glass: inwards where it repels, outwards where it attracts.
            let rim = 320u - (glass_height_surface[at] & 255u) / 2u;
            let squared = (glass_height_squared(vec2i(x, y), v) >> 8u) * rim;
            let height = glass_height_cap(radius, sphere, squared);
            if height != 0u {
                atomicMax(&glass_height_cells[at], height);
            }
        }
    }
}

@compute @workgroup_size(16, 16)
fn main_glass_height(@builtin(global_invocation_id) id: vec3u) {
    if all(id.xy < glass_height_frame.size) {
        glass_height_drop(vec2i(id.xy));
    }
}

// Claim: each drop claims the cells that it wets; the largest wins, before it a ridge that a blade pushes.
// Twin: downpour_lattice::glass::claim.

@group(0) @binding(0) var<uniform> glass_claim_frame: GlassFrame;
@group(0) @binding(1) var<uniform> glass_claim_sizes: GlassTable;
@group(0) @binding(2) var<storage, read> glass_claim_mass: array<u32>;
@group(0) @binding(3) var<storage, read> glass_claim_motion: array<vec2u>;
@group(0) @binding(4) var<storage, read_write> glass_claim_keys: array<atomic<u32>>;
// Time when water last moved over a cell.
@group(0) @binding(5) var<storage, read_write> glass_claim_wet: array<atomic<u32>>;
@group(0) @binding(6) var<storage, read> glass_claim_totals: array<u32>;

// Claims the disk of a drop, or the width of a ridge; a moving drop also wets it. A ridge leaves an eighth of that film, which
// dries in an eighth of the time.
fn glass_claim_drop(cell: vec2i) {
    let index = glass_frame_index(glass_claim_frame, cell);
    let mass = glass_claim_mass[index];
    if mass == 0u {
        return;
    }
    let class_of = glass_size_class(mass);
    let row = glass_size_row(
        glass_claim_sizes.rows[class_of], glass_claim_sizes.rows[class_of + 1u], glass_size_fraction(mass));
    var key = glass_size_key(mass, index);
    let motion = glass_claim_motion[index];
    let moves = motion.x != 0u;
    let clock = glass_claim_frame.first_clock + glass_claim_totals[GLASS_TOTAL_TICK] * glass_claim_frame.clock_step;
    var center = cell;
    var radius = row.radius;
    var stamp = clock;
    if glass_ridge_is(motion.y) {
        center = glass_ridge_center(cell, glass_motion_unpack(motion.x), row.ahead);
        radius = row.ridge;
        stamp = clock - min(56u * glass_claim_frame.wet_life, clock - 1u);
        if motion.y != GLASS_RIDGE {
            key = (GLASS_RIDGE_CLASS << 24u) | index;
        }
    }
    let reach = i32(radius >> 8u);
    for (var y = -reach; y <= reach; y += 1) {
        for (var x = -reach; x <= reach; x += 1) {
            let to = center + vec2i(x, y);
            if u32(x * x + y * y) << 16u > radius * radius || !glass_frame_holds(glass_claim_frame, to) {
                continue;
            }
            let at = glass_frame_index(glass_claim_frame, to);
            atomicMax(&glass_claim_keys[at], key);
            if moves {
                atomicMax(&glass_claim_wet[at], stamp);
            }
        }
    }
}

@compute @workgroup_size(16, 16)
fn main_glass_claim(@builtin(global_invocation_id) id: vec3u) {
    if all(id.xy < glass_claim_frame.size) {
        glass_claim_drop(vec2i(id.xy));
    }
}

// Settling: the water that moved to a cell becomes its drop, and the scratch of the tick is cleared.
// Twin: downpour_lattice::glass::settle.

@group(0) @binding(0) var<uniform> glass_settle_frame: GlassFrame;
@group(0) @binding(1) var<storage, read_write> glass_settle_mass: array<u32>;
@group(0) @binding(2) var<storage, read_write> glass_settle_motion: array<vec2u>;
@group(0) @binding(3) var<storage, read_write> glass_settle_keys: array<u32>;
@group(0) @binding(4) var<storage, read_write> glass_settle_arrival: array<u32>;
@group(0) @binding(5) var<storage, read_write> glass_settle_next: array<u32>;
@group(0) @binding(6) var<storage, read> glass_settle_decided: array<vec2u>;
@group(0) @binding(7) var<storage, read_write> glass_settle_totals: array<atomic<u32>>;

// Removes the mass above the maximum from the pane.
fn glass_settle_spill(mass: u32) -> u32 {
    if mass <= GLASS_MAX_MASS {
        return mass;
    }
    let spilled = mass - GLASS_MAX_MASS;
    let before = atomicAdd(&glass_settle_totals[GLASS_TOTAL_SPILLED], spilled);
    if before + spilled < before {
        atomicAdd(&glass_settle_totals[GLASS_TOTAL_SPILLED + 1u], 1u);
    }
    if atomicAdd(&glass_settle_totals[GLASS_TOTAL_SATURATED], 1u) == 0xffffffffu {
        atomicAdd(&glass_settle_totals[GLASS_TOTAL_SATURATED + 1u], 1u);
    }
    return GLASS_MAX_MASS;
}

// Motion of the drop of a cell: that of the largest drop that moved to it by itself. Water that a blade has pushed is a ridge.
fn glass_settle_motion_of(mass: u32, winner: u32) -> vec2u {
    if mass == 0u || winner == 0u {
        return vec2u(0u);
    }
    if winner >> 24u == GLASS_RIDGE_PUSHED {
        return vec2u(glass_motion_pack(glass_ridge_ahead(winner)), GLASS_RIDGE | glass_settle_frame.ridge_fresh);
    }
    let motion = glass_settle_decided[winner & GLASS_INDEX];
    if winner >> 24u == GLASS_RIDGE_CLASS {
        return motion;
    }
    let v = glass_motion_merged(glass_motion_unpack(motion.x), winner >> 24u, mass);
    return vec2u(glass_motion_pack(v), motion.y);
}

@compute @workgroup_size(16, 16)
fn main_glass_settle(@builtin(global_invocation_id) id: vec3u) {
    if any(id.xy >= glass_settle_frame.size) {
        return;
    }
    let index = glass_frame_index(glass_settle_frame, vec2i(id.xy));
    let mass = glass_settle_spill(glass_settle_next[index]);
    glass_settle_mass[index] = mass;
    glass_settle_motion[index] = glass_settle_motion_of(mass, glass_settle_arrival[index]);
    glass_settle_keys[index] = 0u;
    glass_settle_arrival[index] = 0u;
    glass_settle_next[index] = 0u;
}

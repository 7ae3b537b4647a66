// Number of the tick within the call, counted on the device so that bindings stay as they are.
// Twin: none needed; the host's loop counts.

@group(0) @binding(0) var<storage, read_write> glass_next_totals: array<u32>;

@compute @workgroup_size(1)
fn main_glass_next() {
    glass_next_totals[GLASS_TOTAL_TICK] += 1u;
}

// Blade of a wiper, or a part of its length, during one tick.
// Twin: downpour_lattice::glass::blade.

struct GlassBlade {
    // Direction of the blade before and after the tick: unit vectors of length 16384.
    before: vec2i,
    after: vec2i,
    // Pivot, in half cells from the corner of the pane.
    pivot: vec2i,
    // Start and end along the blade, in half cells.
    reach: vec2i,
    // Sense of rotation: 1 from +x toward +y, -1 the other way, 0 at rest.
    turn: i32,
    // Fraction of the water that stays behind, in units of 1/256.
    leaves: u32,
    unused_1: u32,
    unused_2: u32,
}

// Cross product of two vectors: positive if `b` is on the +y side of `a` along +x. |a| is 16384, |b| below 2^15.
fn glass_blade_side(a: vec2i, b: vec2i) -> i32 {
    return a.x * b.y - a.y * b.x;
}

// True if the blade passes over a cell in this tick.
fn glass_blade_sweeps(blade: GlassBlade, cell: vec2i) -> bool {
    let at = cell * 2 + 1 - blade.pivot;
    let along = (blade.after.x * at.x + blade.after.y * at.y) >> 14u;
    // Once per pass: `after` of one tick is `before` of the next.
    let before = blade.turn * glass_blade_side(blade.before, at);
    let after = blade.turn * glass_blade_side(blade.after, at);
    return blade.turn != 0 && before >= 0 && after < 0 && along >= blade.reach.x && along < blade.reach.y;
}

// Cell ahead of the blade to which it pushes the water of a cell.
fn glass_blade_push(blade: GlassBlade, cell: vec2i) -> vec2i {
    let at = cell * 2 + 1 - blade.pivot;
    let along = (blade.after.x * at.x + blade.after.y * at.y) >> 14u;
    let ahead = blade.turn * vec2i(-blade.after.y, blade.after.x);
    let to = (blade.after * along + ahead * GLASS_BLADE_AHEAD + GLASS_CELL / 2) >> vec2u(14u);
    return (blade.pivot + to) >> vec2u(1u);
}

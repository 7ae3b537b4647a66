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
    // Mass that stays behind as a film, in units of mass / 65536 for each cell.
    film: u32,
    unused: u32,
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

// Direction in which the blade moves: a vector of length 16384, at right angles to it.
fn glass_blade_ahead(blade: GlassBlade) -> vec2i {
    return blade.turn * vec2i(-blade.after.y, blade.after.x);
}

// Whole cells that the blade moves in the tick at a cell's distance from the pivot, at least 1.
fn glass_blade_moved(blade: GlassBlade, cell: vec2i) -> i32 {
    let at = cell * 2 + 1 - blade.pivot;
    let along = (blade.after.x * at.x + blade.after.y * at.y) >> 14u;
    let turned = (blade.turn * glass_blade_side(blade.before, blade.after)) >> 14u;
    return clamp((along * turned + GLASS_CELL) >> 15u, 1, 8);
}

// Cell ahead of the blade to which it pushes the water of a cell, and that many half cells outward along the blade; not
// beyond its ends.
fn glass_blade_push(blade: GlassBlade, cell: vec2i, outward: i32) -> vec2i {
    let at = cell * 2 + 1 - blade.pivot;
    let here = (blade.after.x * at.x + blade.after.y * at.y) >> 14u;
    let along = min(max(here + outward, blade.reach.x), blade.reach.y - 1);
    let ahead = glass_blade_ahead(blade);
    let to = (blade.after * along + ahead * GLASS_BLADE_AHEAD + GLASS_CELL / 2) >> vec2u(14u);
    return (blade.pivot + to) >> vec2u(1u);
}

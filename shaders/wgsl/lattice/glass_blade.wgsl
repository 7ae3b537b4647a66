// The blade of a wiper, or a part of its length, during one tick.
// Twin: downpour_lattice::glass::blade.

struct GlassBlade {
    // Where the blade points before and after the tick: unit vectors of 16384.
    before: vec2i,
    after: vec2i,
    // The pivot, in half cells from the corner of the pane.
    pivot: vec2i,
    // From where to where along the blade, in half cells.
    reach: vec2i,
    // 1 if it turns from +x towards +y, -1 if the other way, 0 if it rests.
    turn: i32,
    // Share of the water that stays behind, of 256.
    leaves: u32,
    unused_1: u32,
    unused_2: u32,
}

// Positive if `b` lies from `a` towards +y of +x. |a| is 16384, |b| below 2^15.
fn glass_blade_side(a: vec2i, b: vec2i) -> i32 {
    return a.x * b.y - a.y * b.x;
}

// Whether the blade passes over a cell in this tick.
fn glass_blade_sweeps(blade: GlassBlade, cell: vec2i) -> bool {
    let at = cell * 2 + 1 - blade.pivot;
    let along = (blade.after.x * at.x + blade.after.y * at.y) >> 14u;
    // Once in each pass: what is `after` in one tick is `before` in the next.
    let before = blade.turn * glass_blade_side(blade.before, at);
    let after = blade.turn * glass_blade_side(blade.after, at);
    return blade.turn != 0 && before >= 0 && after < 0 && along >= blade.reach.x && along < blade.reach.y;
}

// The cell before the blade to which it pushes the water of a cell.
fn glass_blade_push(blade: GlassBlade, cell: vec2i) -> vec2i {
    let at = cell * 2 + 1 - blade.pivot;
    let along = (blade.after.x * at.x + blade.after.y * at.y) >> 14u;
    let ahead = blade.turn * vec2i(-blade.after.y, blade.after.x);
    let to = (blade.after * along + ahead * GLASS_BLADE_AHEAD + GLASS_CELL / 2) >> vec2u(14u);
    return (blade.pivot + to) >> vec2u(1u);
}

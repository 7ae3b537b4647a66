// Positions across a drop and along a chord: the rim, where the light changes fastest, has more of them.
// Twin: downpour_render::rain::streak_cell.

// Position between -1 and 1 of a cell coordinate from 0 to `count`: 0 is the first edge, 0.5 the middle of the first cell.
fn streak_cell_position(position: f32, count: u32) -> f32 {
    return sin(STREAK_QUARTER * (position * (2.0 / f32(count)) - 1.0));
}

// Cell coordinate of a position: 0 at -1, `count` at 1.
fn streak_cell_index(position: f32, count: u32) -> f32 {
    return (asin(clamp(position, -1.0, 1.0)) / STREAK_QUARTER * 0.5 + 0.5) * f32(count);
}

// Slope of the position over the angle at a cell coordinate: the cosine whose sine is the position.
fn streak_cell_slope(position: f32, count: u32) -> f32 {
    return cos(STREAK_QUARTER * (position * (2.0 / f32(count)) - 1.0));
}

// Mean over a cell of the squared slope, as a lookup weighs it that is linear between the middles of cells: the integral of the squared
// slope times the cell's hat, over the width of a cell. Beyond the middles of the first and the last cell the lookup is constant.
// With u the angle of a cell, c its middle's cosine and s = sin^2(u) / u^2: (1 - s) / 2 + s c^2, and u^2 (5 / 12 - 91 / 720 u^2) at
// either end; by series, for differences of nearly equal numbers have no digits left.
fn streak_cell_weight(cell: u32, count: u32) -> f32 {
    let angle = 2.0 * STREAK_QUARTER / f32(count);
    let square = angle * angle;
    if cell == 0u || cell + 1u == count {
        return square * (5.0 / 12.0 - square * (91.0 / 720.0));
    }
    let slope = streak_cell_slope(f32(cell) + 0.5, count);
    // 1 - s.
    let flat = square * (1.0 / 3.0 - square * (2.0 / 45.0));
    return 0.5 * flat + (1.0 - flat) * (slope * slope);
}

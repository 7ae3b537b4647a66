// Pixels whose rays look for light that is much the same in neighboring pixels: one in each cell of `ray_spacing` times `ray_spacing` pixels.
// Twin: downpour_render::spacing.

// True if rays of a pixel look for light; else those of its neighbors do for it.
fn spacing_looks(x: u32, y: u32) -> bool {
    let spacing = render_frame.ray_spacing;
    return x % spacing == render_frame.ray_column && y % spacing == render_frame.ray_row;
}

// The pixel of an invocation of a workgroup of SPACING_GROUP times SPACING_GROUP. Invocations whose rays look for light are in workgroups of
// their own, which wait for no others and begin first; all others are beside their neighbors, whose rays go the same way through the scene.
fn spacing_place(group: vec2u, groups: vec2u, invocation: u32) -> vec2u {
    let spacing = render_frame.ray_spacing;
    // An area of 64 cells of pixels, one of which in each cell looks for light, has as many workgroups as a cell has pixels.
    let areas = groups / spacing;
    let others = spacing * spacing - 1u;
    var area = group.y * groups.x + group.x;
    var cell = invocation;
    var pixel = render_frame.ray_row * spacing + render_frame.ray_column;
    if area >= areas.x * areas.y {
        let later = area - areas.x * areas.y;
        area = later / others;
        let index = later % others * (SPACING_GROUP * SPACING_GROUP) + invocation;
        cell = index / others;
        let other = index % others;
        pixel = other + select(0u, 1u, other >= pixel);
    }
    let corner = vec2u(area % areas.x, area / areas.x) * SPACING_GROUP;
    // Cells in Morton order, so that any of them in a row are near each other: bits of the column and of the row in turn.
    let column = (cell & 1u) | ((cell >> 1u) & 2u) | ((cell >> 2u) & 4u);
    let row = ((cell >> 1u) & 1u) | ((cell >> 2u) & 2u) | ((cell >> 3u) & 4u);
    return (corner + vec2u(column, row)) * spacing + vec2u(pixel % spacing, pixel / spacing);
}

// First column (or row) of a window that reaches so far around a pixel, of those that lie `apart` with one of them at `place`.
fn spacing_first(at: u32, apart: u32, reach: u32, place: u32) -> u32 {
    let first = max(at, reach) - reach;
    return first + (place + apart - first % apart) % apart;
}

// Lists of drops for the tiles of a picture: in each list the drops that may touch the tile, nearest first, without streaks that are summed
// up (drops_sum.wgsl).
// Method: the drops of each tile are counted, a running sum of the counts gives each tile its part of the lists, the drops are put
// there in any order, and each list is sorted by distance, then by id. So the lists do not depend on the order in which the device
// works. A drop that may touch many tiles is shared by the invocations of its workgroup: one alone would keep all others waiting.
// Tiles are 8 pixels wide and high. Where the lists could be longer than there is room, the edge is doubled until they fit: one
// tile for all has each drop once. No drop is left out.
// Layout of the lists: the edge of a tile; the indices at which the tiles' lists begin (one more than there are tiles); the lists.
// Twin: downpour_render::rain::tiles.

struct TilesFrame {
    // Columns and rows of the picture.
    size: vec2u,
    // Drops.
    count: u32,
    // Drops that all lists together have room for, at least `count`.
    room: u32,
}

@group(0) @binding(0) var<uniform> tiles_frame: TilesFrame;
@group(0) @binding(1) var<storage, read> tiles_drops: array<ScreenDrop>;
// For each edge how many drops its lists have at most; a bit for each edge whose number is beyond 32 bits; then from TILES_HEAD the
// number of drops of each tile, and after these are placed 0.
@group(0) @binding(2) var<storage, read_write> tiles_counts: array<atomic<u32>>;
@group(0) @binding(3) var<storage, read_write> tiles_lists: array<u32>;

// A picture without rain: radiance and distance.
@group(0) @binding(4) var<storage, read> tiles_plate: array<vec4f>;
// For each drop its distance, m; 0 where the scene hides all of it, below 0 where it is not on the picture.
@group(0) @binding(5) var<storage, read_write> tiles_seen: array<f32>;

var<workgroup> tiles_sums: array<atomic<u32>, TILES_EDGES>;
var<workgroup> tiles_totals: array<u32, TILES_SCAN>;
// Sort keys: the bits of the distance, and the index of the drop.
var<workgroup> tiles_keys: array<vec2u, TILES_SORTED>;
// First entry and length of a list.
var<workgroup> tiles_list: vec2u;
// Drops of the workgroup that may touch many tiles, and their number.
var<workgroup> tiles_large: array<u32, TILES_GROUP>;
var<workgroup> tiles_large_count: atomic<u32>;

// First and last row of tiles that a drop may touch; (1, 0): there is none.
fn tiles_rows(drop: ScreenDrop, edge: u32, size: vec2u) -> vec2u {
    if drop.reach <= 0.0 {
        return vec2u(1u, 0u);
    }
    let end = drop.first + drop.screen_delta;
    let low = min(drop.first, end) - drop.reach;
    let high = max(drop.first, end) + drop.reach;
    let columns = streak_pixels(low.x, high.x, size.x);
    let rows = streak_pixels(low.y, high.y, size.y);
    if columns.x > columns.y || rows.x > rows.y {
        return vec2u(1u, 0u);
    }
    return rows / edge;
}

// First and last tile of a row of tiles that the path of a drop may touch; (1, 0): there is none.
fn tiles_columns(drop: ScreenDrop, row: u32, edge: u32, width: u32) -> vec2u {
    let top = f32(row * edge) - drop.reach;
    let bottom = f32((row + 1u) * edge) + drop.reach;
    // The part of the path that is as high as this row.
    var low = 0.0;
    var high = 1.0;
    if abs(drop.screen_delta.y) > 1.0e-3 {
        let a = (top - drop.first.y) / drop.screen_delta.y;
        let b = (bottom - drop.first.y) / drop.screen_delta.y;
        low = max(low, min(a, b));
        high = min(high, max(a, b));
    }
    if low > high {
        return vec2u(1u, 0u);
    }
    let a = drop.first.x + drop.screen_delta.x * low;
    let b = drop.first.x + drop.screen_delta.x * high;
    let columns = streak_pixels(min(a, b) - drop.reach, max(a, b) + drop.reach, width);
    if columns.x > columns.y {
        return columns;
    }
    return columns / edge;
}

// True for a drop that is put on lists.
fn tiles_is_listed(drop: ScreenDrop) -> bool {
    return drop.reach > 0.0 && !streak_is_summed(drop);
}

// No fewer tiles of an edge than a drop may touch.
fn tiles_bound(drop: ScreenDrop, edge: u32, size: vec2u) -> u32 {
    let rows = tiles_rows(drop, edge, size);
    if rows.x > rows.y {
        return 0u;
    }
    let across = (size.x + edge - 1u) / edge;
    // Of each row of tiles the path covers what it is slanted, and its own width.
    let reached = f32(edge) + 2.0 * drop.reach;
    let slanted = min(abs(drop.screen_delta.x), reached * abs(drop.screen_delta.x) / max(abs(drop.screen_delta.y), 1.0e-3));
    let columns = min(slanted + 2.0 * drop.reach, f32(size.x)) / f32(edge) + 3.0;
    return (rows.y + 1u - rows.x) * min(u32(columns), across);
}

// The smallest edge whose lists have room.
fn tiles_edge() -> u32 {
    let beyond = atomicLoad(&tiles_counts[TILES_EDGES]);
    for (var k = 0u; k < TILES_EDGES; k += 1u) {
        if ((beyond >> k) & 1u) == 0u && atomicLoad(&tiles_counts[k]) <= tiles_frame.room {
            return DROPS_TILE << k;
        }
    }
    return DROPS_TILE << (TILES_EDGES - 1u);
}

// True if a drop comes before another, by their sort keys.
fn tiles_is_before(a: vec2u, b: vec2u) -> bool {
    if a.x != b.x {
        return a.x < b.x;
    }
    let ids = vec2u(tiles_drops[a.y].id, tiles_drops[b.y].id);
    return select(a.y < b.y, ids.x < ids.y, ids.x != ids.y);
}

// The sort key of a drop: distances are above 0, whose bits are in their order.
fn tiles_key(index: u32) -> vec2u {
    return vec2u(bitcast<u32>(tiles_drops[index].nearest), index);
}

@compute @workgroup_size(64, 1, 1)
fn main_tiles_clear(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(num_workgroups) groups: vec3u,
) {
    let index = invocation_index(id, groups);
    if index < arrayLength(&tiles_counts) {
        atomicStore(&tiles_counts[index], 0u);
    }
}

@compute @workgroup_size(64, 1, 1)
fn main_tiles_measure(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let index = invocation_index(id, groups);
    if index < tiles_frame.count {
        let drop = tiles_drops[index];
        for (var k = 0u; k < TILES_EDGES && tiles_is_listed(drop); k += 1u) {
            let bound = tiles_bound(drop, DROPS_TILE << k, tiles_frame.size);
            atomicAdd(&tiles_sums[k], bound);
        }
    }
    workgroupBarrier();
    if local < TILES_EDGES {
        let sum = atomicLoad(&tiles_sums[local]);
        let before = atomicAdd(&tiles_counts[local], sum);
        if before > 0xffffffffu - sum {
            atomicOr(&tiles_counts[TILES_EDGES], 1u << local);
        }
    }
}

@compute @workgroup_size(64, 1, 1)
fn main_tiles_count(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let index = invocation_index(id, groups);
    let size = tiles_frame.size;
    let edge = tiles_edge();
    let across = (size.x + edge - 1u) / edge;
    let is_listed = index < tiles_frame.count && tiles_is_listed(tiles_drops[index]);
    let is_large = is_listed && tiles_bound(tiles_drops[index], edge, size) > TILES_FEW;
    if is_large {
        tiles_large[atomicAdd(&tiles_large_count, 1u)] = index;
    }
    workgroupBarrier();
    let large = atomicLoad(&tiles_large_count);
    // Its own drop, then its part of those of the workgroup.
    for (var turn = select(1u, 0u, is_listed && !is_large); turn <= large; turn += 1u) {
        var at = index;
        var first = vec2u(0u);
        var each = 1u;
        if turn > 0u {
            at = tiles_large[turn - 1u];
            first = vec2u(local % TILES_LANES, local / TILES_LANES);
            each = TILES_LANES;
        }
        let drop = tiles_drops[at];
        let rows = tiles_rows(drop, edge, size);
        for (var row = rows.x + first.y; row <= rows.y; row += each) {
            let columns = tiles_columns(drop, row, edge, size.x);
            for (var column = columns.x + first.x; column <= columns.y; column += each) {
                atomicAdd(&tiles_counts[TILES_HEAD + row * across + column], 1u);
            }
        }
    }
}

@compute @workgroup_size(256, 1, 1)
fn main_tiles_scan(@builtin(local_invocation_index) local: u32) {
    let edge = tiles_edge();
    let size = tiles_frame.size;
    let tiles = (size + edge - 1u) / edge;
    let count = tiles.x * tiles.y;
    let each = (count + TILES_SCAN - 1u) / TILES_SCAN;
    let first = min(local * each, count);
    let last = min(first + each, count);
    var sum = 0u;
    for (var tile = first; tile < last; tile += 1u) {
        sum += atomicLoad(&tiles_counts[TILES_HEAD + tile]);
    }
    tiles_totals[local] = sum;
    workgroupBarrier();
    for (var step = 1u; step < TILES_SCAN; step *= 2u) {
        var before = 0u;
        if local >= step {
            before = tiles_totals[local - step];
        }
        workgroupBarrier();
        tiles_totals[local] += before;
        workgroupBarrier();
    }
    // The lists begin behind the edge and the indices.
    var start = count + 2u + tiles_totals[local] - sum;
    for (var tile = first; tile < last; tile += 1u) {
        tiles_lists[1u + tile] = start;
        start += atomicLoad(&tiles_counts[TILES_HEAD + tile]);
    }
    if local == TILES_SCAN - 1u {
        tiles_lists[0] = edge;
        tiles_lists[1u + count] = count + 2u + tiles_totals[local];
    }
}

@compute @workgroup_size(64, 1, 1)
fn main_tiles_place(
    @builtin(global_invocation_id) id: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    let index = invocation_index(id, groups);
    let size = tiles_frame.size;
    let edge = tiles_lists[0];
    let across = (size.x + edge - 1u) / edge;
    let is_listed = index < tiles_frame.count && tiles_is_listed(tiles_drops[index]);
    let is_large = is_listed && tiles_bound(tiles_drops[index], edge, size) > TILES_FEW;
    if is_large {
        tiles_large[atomicAdd(&tiles_large_count, 1u)] = index;
    }
    workgroupBarrier();
    let large = atomicLoad(&tiles_large_count);
    // Its own drop, then its part of those of the workgroup.
    for (var turn = select(1u, 0u, is_listed && !is_large); turn <= large; turn += 1u) {
        var at = index;
        var first = vec2u(0u);
        var each = 1u;
        if turn > 0u {
            at = tiles_large[turn - 1u];
            first = vec2u(local % TILES_LANES, local / TILES_LANES);
            each = TILES_LANES;
        }
        let drop = tiles_drops[at];
        let rows = tiles_rows(drop, edge, size);
        for (var row = rows.x + first.y; row <= rows.y; row += each) {
            let columns = tiles_columns(drop, row, edge, size.x);
            for (var column = columns.x + first.x; column <= columns.y; column += each) {
                let tile = row * across + column;
                let left = atomicSub(&tiles_counts[TILES_HEAD + tile], 1u);
                tiles_lists[tiles_lists[1u + tile] + left - 1u] = at;
            }
        }
    }
}

// A bitonic sort whose comparisons all put the nearer drop first: drops beyond the end of a list would stay there, so that lists
// of any length can do without them.
@compute @workgroup_size(64, 1, 1)
fn main_tiles_sort(
    @builtin(workgroup_id) group: vec3u,
    @builtin(num_workgroups) groups: vec3u,
    @builtin(local_invocation_index) local: u32,
) {
    if local == 0u {
        let tile = group.y * groups.x + group.x;
        let edge = tiles_lists[0];
        let size = (tiles_frame.size + edge - 1u) / edge;
        tiles_list = vec2u(0u);
        if tile < size.x * size.y {
            tiles_list = vec2u(tiles_lists[1u + tile], tiles_lists[2u + tile] - tiles_lists[1u + tile]);
        }
    }
    let list = workgroupUniformLoad(&tiles_list);
    let length = list.y;
    if length < 2u {
        return;
    }
    let is_short = length <= TILES_SORTED;
    if is_short {
        for (var k = local; k < length; k += 64u) {
            tiles_keys[k] = tiles_key(tiles_lists[list.x + k]);
        }
        workgroupBarrier();
    }
    for (var width = 2u; width < 2u * length; width *= 2u) {
        for (var apart = width / 2u; apart > 0u; apart /= 2u) {
            // The first step of each width compares with the mirror image.
            let mirror = select(0u, apart - 1u, apart * 2u == width);
            for (var k = local; k < length; k += 64u) {
                let other = (k ^ mirror) ^ apart;
                if other > k && other < length {
                    if is_short {
                        let a = tiles_keys[k];
                        let b = tiles_keys[other];
                        if tiles_is_before(b, a) {
                            tiles_keys[k] = b;
                            tiles_keys[other] = a;
                        }
                    } else {
                        let a = tiles_lists[list.x + k];
                        let b = tiles_lists[list.x + other];
                        if tiles_is_before(tiles_key(b), tiles_key(a)) {
                            tiles_lists[list.x + k] = b;
                            tiles_lists[list.x + other] = a;
                        }
                    }
                }
            }
            workgroupBarrier();
            storageBarrier();
        }
    }
    if is_short {
        for (var k = local; k < length; k += 64u) {
            tiles_lists[list.x + k] = tiles_keys[k].y;
        }
    }
}

@compute @workgroup_size(64, 1, 1)
fn main_tiles_seen(@builtin(global_invocation_id) id: vec3u, @builtin(num_workgroups) groups: vec3u) {
    let index = invocation_index(id, groups);
    if index >= tiles_frame.count {
        return;
    }
    let drop = tiles_drops[index];
    let rows = tiles_rows(drop, 1u, tiles_frame.size);
    let end = drop.first.x + drop.screen_delta.x;
    let columns = streak_pixels(min(drop.first.x, end) - drop.reach, max(drop.first.x, end) + drop.reach, tiles_frame.size.x);
    var seen = select(0.0, -1.0, rows.x > rows.y);
    for (var row = rows.x; row <= rows.y && seen == 0.0; row += 1u) {
        for (var column = columns.x; column <= columns.y && seen == 0.0; column += 1u) {
            if drop.nearest < tiles_plate[row * tiles_frame.size.x + column].w {
                seen = drop.nearest;
            }
        }
    }
    tiles_seen[index] = seen;
}

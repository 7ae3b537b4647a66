// Collision of a moving drop with the surfaces of a map that looks along the fall direction.
//
// Rousseau 2008, 4 and 5.1.2: a drop below the top of its column has bounced if it is slightly below, and is absorbed
// by a wall if it is far below. Here a column has several surfaces, so that the ground under a bridge stops drops as
// well, and a surface within a texel is its tangent plane.
// Map coordinates are texels across, texels along, and depth in meters. Normals "of the map" have the components
// across, along and against the fall.
// Twin: downpour_sim::collision.

struct CollisionMap {
    // Corner of the first texel, m. The map's plane, depth 0, is above everything.
    low: vec3f,
    // Number of triangles of the scene.
    triangles: u32,
    // Unit vectors along the rows, along the columns, and of the fall.
    across: vec3f,
    // Maximum deviation of a surface from the depth at its texel's center, m.
    steep: f32,
    along: vec3f,
    // Distance below which surfaces are merged, m.
    merge: f32,
    fall: vec3f,
    // Edges of a texel, m, and their inverses.
    edge: vec2f,
    per_edge: vec2f,
    // Origin of the drops' coordinates in those of the triangles, m.
    anchor: vec3f,
    // Number of texels.
    size: vec2u,
}

struct CollisionTexel {
    // Depths at the center, ascending; COLLISION_NONE for no surface.
    depths: vec4f,
    // Packed normals, and the state of the space below.
    surfaces: vec4u,
}

// Segment of a drop's path within a texel: its ends in texels from the center and meters of depth, and the number of
// surfaces above the drop when it left the previous texel.
struct CollisionPiece {
    start: vec3f,
    end: vec3f,
    before: u32,
}

// Hit of a drop within a texel.
struct CollisionMeeting {
    kind: u32,
    // Fraction of the segment.
    fraction: f32,
    layer: u32,
    // 1 if the surface was hit from below.
    beneath: u32,
    // Number of surfaces above the end of the segment.
    count: u32,
}

// Hit of a drop.
struct CollisionHit {
    // COLLISION_OPEN, COLLISION_SURFACE or COLLISION_WALL.
    kind: u32,
    // Fraction of the path, 0 to 1. For COLLISION_OPEN: the fraction that was followed, 1 except for paths across many
    // texels.
    fraction: f32,
    // Unit vector toward the side that the drop came from.
    normal: vec3f,
}

@group(0) @binding(8) var<uniform> collision_map: CollisionMap;
@group(0) @binding(9) var<storage, read> collision_texels: array<CollisionTexel>;

// Converts a position to map coordinates.
fn collision_position(map: CollisionMap, at: vec3f) -> vec3f {
    let offset = at - map.low;
    return vec3f(
        dot(offset, map.across) * map.per_edge.x,
        dot(offset, map.along) * map.per_edge.y,
        dot(offset, map.fall),
    );
}

// Packs a normal of the map that faces the rain, and a flag of solid below.
fn collision_pack(normal: vec3f, solid: bool) -> u32 {
    let word = pack2x16snorm(packing_octahedral_encode(vec3f(normal.xy, max(normal.z, 0.0))));
    return (word & ~COLLISION_SOLID) | select(0u, COLLISION_SOLID, solid);
}

// True if the space below a surface, up to the next, is solid.
fn collision_solid(surface: u32) -> bool {
    return (surface & COLLISION_SOLID) != 0u;
}

// Normal of a surface, not normalized.
fn collision_square(surface: u32) -> vec3f {
    let square = unpack2x16snorm(surface & ~COLLISION_SOLID);
    return vec3f(square, max(1.0 - abs(square.x) - abs(square.y), 0.0));
}

// Unit normal of a surface, of the map.
fn collision_normal(surface: u32) -> vec3f {
    let square = collision_square(surface);
    return square * (1.0 / sqrt(dot(square, square)));
}

// Slope of a surface: increase of depth per meter across and along.
fn collision_slope(surface: u32) -> vec2f {
    let square = collision_square(surface);
    return square.xy * (1.0 / max(square.z, 1.0e-4));
}

// Depths of a texel's surfaces at an offset from its center, ascending. `offset` is in texels.
fn collision_depths(map: CollisionMap, texel: CollisionTexel, offset: vec2f) -> vec4f {
    let meters = offset * map.edge;
    var depths = vec4f(COLLISION_NONE);
    var above = -COLLISION_NONE;
    for (var k = 0u; k < COLLISION_LAYERS; k += 1u) {
        let deeper = dot(collision_slope(texel.surfaces[k]), meters);
        // Planes that cross within the texel coincide from there on.
        above = max(above, texel.depths[k] + min(max(deeper, -map.steep), map.steep));
        depths[k] = above;
    }
    return depths;
}

// Number of surfaces above a depth.
fn collision_count(depths: vec4f, depth: f32) -> u32 {
    let above = select(vec4u(0u), vec4u(1u), depths < vec4f(depth));
    return above.x + above.y + above.z + above.w;
}

// Maximum depth below a surface at which it may continue in the next texel.
fn collision_shallow(map: CollisionMap, surface: u32) -> f32 {
    let slope = collision_slope(surface);
    return min(max(map.edge.x, map.edge.y) * (COLLISION_SHALLOW + sqrt(dot(slope, slope))), map.steep);
}

// Finds the hit of a drop within a texel.
fn collision_column(map: CollisionMap, texel: CollisionTexel, piece: CollisionPiece) -> CollisionMeeting {
    // Most drops are far above all surfaces.
    if max(piece.start.z, piece.end.z) + map.steep < texel.depths.x {
        return CollisionMeeting(COLLISION_OPEN, 1.0, 0u, 0u, 0u);
    }
    let first = piece.before == COLLISION_START;
    let start = collision_depths(map, texel, piece.start.xy);
    let end = collision_depths(map, texel, piece.end.xy);
    let count = collision_count(start, piece.start.z - select(0.0, COLLISION_CLEARANCE, first));
    let count_end = collision_count(end, piece.end.z);
    if count > 0u {
        let layer = count - 1u;
        let solid = collision_solid(texel.surfaces[layer]);
        let below = piece.start.z - start[layer];
        let shallow = below <= collision_shallow(map, texel.surfaces[layer]);
        // A drop that has bounced may still be a little below the surface that it leaves.
        let leaves = first && shallow && piece.end.z - end[layer] <= below;
        if solid && !leaves {
            return CollisionMeeting(select(COLLISION_WALL, COLLISION_SURFACE, shallow), 0.0, layer, 0u, count);
        }
        // Planes of neighboring texels do not join exactly at the border.
        if !solid && count > piece.before && shallow {
            return CollisionMeeting(COLLISION_SURFACE, 0.0, layer, 0u, count);
        }
    }
    if count_end > count {
        let before = piece.start.z - start[count];
        let after = piece.end.z - end[count];
        let fraction = min(max(-before / max(after - before, 1.0e-12), 0.0), 1.0);
        return CollisionMeeting(COLLISION_SURFACE, fraction, count, 0u, count_end);
    }
    if count_end < count {
        let layer = count - 1u;
        if !collision_solid(texel.surfaces[layer]) {
            let before = piece.start.z - start[layer];
            let after = piece.end.z - end[layer];
            let fraction = min(max(before / max(before - after, 1.0e-12), 0.0), 1.0);
            return CollisionMeeting(COLLISION_SURFACE, fraction, layer, 1u, count_end);
        }
    }
    return CollisionMeeting(COLLISION_OPEN, 1.0, 0u, 0u, count_end);
}

// Converts a normal of the map to world space.
fn collision_turn(map: CollisionMap, normal: vec3f) -> vec3f {
    return map.across * normal.x + map.along * normal.y - map.fall * normal.z;
}

// Normal of a wall that stops a drop: against its path across the map. `way` is in texels and meters of depth.
fn collision_wall(map: CollisionMap, way: vec3f) -> vec3f {
    let sideways = map.across * (way.x * map.edge.x) + map.along * (way.y * map.edge.y);
    let squared = dot(sideways, sideways);
    if squared < 1.0e-24 {
        return -map.fall;
    }
    return sideways * (-1.0 / sqrt(squared));
}

// Texel of a cell; one without surfaces outside the map.
fn collision_texel(cell: vec2i) -> CollisionTexel {
    if any(cell < vec2i(0)) || any(cell >= vec2i(collision_map.size)) {
        return CollisionTexel(vec4f(COLLISION_NONE), vec4u(0u));
    }
    return collision_texels[u32(cell.y) * collision_map.size.x + u32(cell.x)];
}

// Number of surfaces above a position, and the lowest of them (0: none).
fn collision_cover(at: vec3f) -> vec2u {
    let position = collision_position(collision_map, at);
    let corner = floor(min(max(position.xy, vec2f(-COLLISION_EDGE)), vec2f(COLLISION_EDGE)));
    let texel = collision_texel(vec2i(corner));
    let count = collision_count(collision_depths(collision_map, texel, position.xy - corner - 0.5), position.z);
    return vec2u(count, select(0u, texel.surfaces[max(count, 1u) - 1u], count > 0u));
}

// True if nothing is between a position and the sky that the rain comes from.
fn collision_open(at: vec3f) -> bool {
    return collision_cover(at).x == 0u;
}

// True if a position is inside a solid.
fn collision_inside(at: vec3f) -> bool {
    return collision_solid(collision_cover(at).y);
}

// Finds the first hit of a drop on its straight path from `start` to `end`.
fn collision_find(start: vec3f, end: vec3f) -> CollisionHit {
    let origin = collision_position(collision_map, start);
    let way = collision_position(collision_map, end) - origin;
    let forward = way.xy > vec2f(0.0);
    let moves = way.xy != vec2f(0.0);
    let inverse = vec2f(1.0) / select(vec2f(1.0), way.xy, moves);
    var cell = vec2i(floor(min(max(origin.xy, vec2f(-COLLISION_EDGE)), vec2f(COLLISION_EDGE))));
    var fraction = 0.0;
    var before = COLLISION_START;
    for (var turn = 0u; turn < COLLISION_COLUMNS; turn += 1u) {
        let border = vec2f(cell + select(vec2i(0), vec2i(1), forward));
        let leave = select(vec2f(COLLISION_NONE), (border - origin.xy) * inverse, moves);
        let until = min(max(min(leave.x, leave.y), fraction), 1.0);
        let center = vec3f(vec2f(cell) + 0.5, 0.0);
        let piece = CollisionPiece(origin + way * fraction - center, origin + way * until - center, before);
        let texel = collision_texel(cell);
        let met = collision_column(collision_map, texel, piece);
        if met.kind == COLLISION_WALL {
            return CollisionHit(met.kind, fraction, collision_wall(collision_map, way));
        }
        if met.kind == COLLISION_SURFACE {
            let normal = collision_turn(collision_map, collision_normal(texel.surfaces[met.layer]));
            let side = select(1.0, -1.0, met.beneath == 1u);
            return CollisionHit(met.kind, fraction + (until - fraction) * met.fraction, normal * side);
        }
        fraction = until;
        if until >= 1.0 {
            break;
        }
        // A drop that starts on a border has not moved yet.
        if until > 0.0 {
            before = met.count;
        }
        let step = select(vec2i(-1), vec2i(1), forward);
        cell += select(vec2i(0, step.y), vec2i(step.x, 0), leave.x <= leave.y);
    }
    return CollisionHit(COLLISION_OPEN, fraction, vec3f(0.0));
}

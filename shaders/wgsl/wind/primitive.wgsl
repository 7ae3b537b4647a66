// Wind primitives: velocity of one at a position, m/s.
//
// A primitive is a matrix of three rows (Rousseau 2008, 3.1), here the columns of a mat3x3f: (type, strength, core
// radius), center, up. The paper has 0 in the entry of the core radius. Strength: m/s (uniform), m^2/s (line forms),
// m^3/s (point forms and the updraft); negative for sinks.
//
// Laws: with e the core radius, r the distance from the axis (line) or the center (point),
//   line   r / (2 pi (r^2 + e^2))       -> 1 / (2 pi r)     Rousseau 2008; core: Rosenhead 1930
//   point  r / (4 pi (r^2 + e^2)^(3/2)) -> 1 / (4 pi r^2)   the same core in three dimensions
// outward for sources, across up for vortices. A line may have another core, which its type includes: Rankine's
//   r / (2 pi max(r, e)^2), or Lamb and Oseen's (1 - exp(-r^2 / e^2)) / (2 pi r). The updraft is the point source's
// density of divergence, 3 e^2 / (4 pi (r^2 + e^2)^(5/2)), spread along its line: it carries the air from a point sink
// at its base to a point source at its top, and the three together have no divergence.
// Twin: downpour_wind::primitive.

// Component of an offset perpendicular to the axis.
fn wind_primitive_across(offset: vec3f, axis: vec3f) -> vec3f {
    return offset - axis * dot(offset, axis);
}

// Speed per distance of a line form; `squared` is the squared distance from the axis.
fn wind_primitive_line(strength: f32, squared: f32, core: f32) -> f32 {
    return WIND_PRIMITIVE_LINE * strength / (squared + core * core);
}

// Speed per distance of a line form with Rankine's core, which rotates as a solid.
fn wind_primitive_rankine(strength: f32, squared: f32, core: f32) -> f32 {
    return WIND_PRIMITIVE_LINE * strength / max(squared, core * core);
}

// Speed per distance of a line form with the core of Lamb and Oseen, which is a normal distribution.
fn wind_primitive_lamb_oseen(strength: f32, squared: f32, core: f32) -> f32 {
    let core_squared = core * core;
    let x = squared / core_squared;
    // (1 - exp(-x)) / x; near 0 the difference has no digits.
    var fraction = 1.0 - x * (0.5 - x * (0.16666667 - x * (0.041666668 - x * (0.008333334 - x * 0.0013888889))));
    if x > WIND_PRIMITIVE_SERIES {
        fraction = (1.0 - exp(-x)) / x;
    }
    return WIND_PRIMITIVE_LINE * strength / core_squared * fraction;
}

// Speed per distance of a line form with the core of its type.
fn wind_primitive_core(kind: u32, strength: f32, squared: f32, core: f32) -> f32 {
    if kind >= WIND_PRIMITIVE_LAMB_OSEEN {
        return wind_primitive_lamb_oseen(strength, squared, core);
    }
    if kind >= WIND_PRIMITIVE_RANKINE {
        return wind_primitive_rankine(strength, squared, core);
    }
    return wind_primitive_line(strength, squared, core);
}

// Speed per distance of a point form; `squared` is the squared distance from the center.
fn wind_primitive_point(strength: f32, squared: f32, core: f32) -> f32 {
    let regular = squared + core * core;
    return WIND_PRIMITIVE_POINT * strength / (regular * sqrt(regular));
}

// Integral along the line of 3 / (regular + u^2)^(5/2), times `regular`, from 0 to `along`.
fn wind_primitive_rise(regular: f32, along: f32) -> f32 {
    let whole = regular + along * along;
    return along / sqrt(whole) * (1.0 / whole + 2.0 / regular);
}

// Speed along the line of an updraft; `squared` is the squared distance from the line, `along` the height above its
// base.
fn wind_primitive_updraft(strength: f32, squared: f32, along: f32, height: f32, core: f32) -> f32 {
    let core_squared = core * core;
    let regular = squared + core_squared;
    let rise = wind_primitive_rise(regular, along) - wind_primitive_rise(regular, along - height);
    return WIND_PRIMITIVE_POINT * strength * core_squared / regular * rise;
}

// Velocity of a primitive at a position.
fn wind_primitive_velocity(matrix: mat3x3f, at: vec3f) -> vec3f {
    let kind = u32(matrix[0].x);
    let strength = matrix[0].y;
    let core = matrix[0].z;
    let up = matrix[2];
    if kind == WIND_PRIMITIVE_UNIFORM {
        return up * strength;
    }
    let offset = at - matrix[1];
    if kind == WIND_PRIMITIVE_POINT_SOURCE || kind == WIND_PRIMITIVE_POINT_SINK {
        return offset * wind_primitive_point(strength, dot(offset, offset), core);
    }
    if kind == WIND_PRIMITIVE_POINT_VORTEX {
        return cross(up, offset) * wind_primitive_point(strength, dot(offset, offset), core);
    }
    if kind == WIND_PRIMITIVE_UPDRAFT {
        let height = sqrt(dot(up, up));
        let axis = up / height;
        let across = wind_primitive_across(offset, axis);
        let along = dot(offset, axis);
        return axis * wind_primitive_updraft(strength, dot(across, across), along, height, core);
    }
    let across = wind_primitive_across(offset, up);
    let line = wind_primitive_core(kind, strength, dot(across, across), core);
    let form = kind % WIND_PRIMITIVE_RANKINE;
    if form == WIND_PRIMITIVE_LINE_VORTEX {
        return cross(up, across) * line;
    }
    if form == WIND_PRIMITIVE_LINE_SOURCE || form == WIND_PRIMITIVE_LINE_SINK {
        return across * line;
    }
    return vec3f(0.0);
}

// Surfaces that rain has made wet: how wet, the film on them, and the light under it. Rows in the table: rain in storages before a
// pause, what is kept after it, rain after it; direction the rain comes from; shift of positions; then, for each roughness, the
// parts of the coat's reflectance and their mean.
// Twin: downpour_trace::wet, where the method is described.

// True if rain wets surfaces: the code slows down the rest.
override WET_SURFACES: bool = true;

// Wetness of a scene.
struct RenderWet {
    // Rain before a pause, in storages; what is kept after it; rain after it.
    before: f32,
    kept: f32,
    since: f32,
    // Direction that the rain comes from.
    towards: vec3f,
    // Added to positions, so that the relief stays where it is.
    shift: vec3f,
}

// Unevenness of a film.
struct WetRelief {
    // Gradient of the height.
    slope: vec3f,
    // Height, about -1 to 1.
    height: f32,
    // Variance of the slope that a footprint does not resolve.
    variance: f32,
}

// Reads the wetness.
fn wet_load() -> RenderWet {
    let row = render_frame.wetness;
    let state = bitcast<vec4f>(render_table[row]);
    return RenderWet(
        state.x, state.y, state.z, bitcast<vec4f>(render_table[row + 1u]).xyz, bitcast<vec4f>(render_table[row + 2u]).xyz,
    );
}

// Wetness of a surface that meets a flux of rain, relative to that of a level one.
fn wet_fraction(before: f32, kept: f32, since: f32, flux: f32) -> f32 {
    let paused = (1.0 - exp(-before * flux)) * kept;
    return 1.0 - (1.0 - paused) * exp(-since * flux);
}

// A corner of the lattice of the noise.
fn wet_corner(cell: vec3i, seed: u32) -> f32 {
    let at = bitcast<vec3u>(cell);
    return rng_unit(rng_pcg4d(vec4u(at, seed)).x) * 2.0 - 1.0;
}

// Noise from -1 to 1 with its gradient (x, y, z; then the value), at a position in cells.
fn wet_noise(at: vec3f, seed: u32) -> vec4f {
    let low = floor(at);
    let cell = vec3i(low);
    let f = at - low;
    let u = f * f * (vec3f(3.0) - f * 2.0);
    let rise = f * (vec3f(1.0) - f) * 6.0;
    var sum = vec4f(0.0);
    for (var k = 0u; k < 8u; k += 1u) {
        let bits = vec3u(k & 1u, (k >> 1u) & 1u, k >> 2u);
        let upper = bits == vec3u(1u);
        let weight = select(vec3f(1.0) - u, u, upper);
        let change = select(-rise, rise, upper);
        let value = wet_corner(cell + vec3i(bits), seed);
        sum += vec4f(
            change.x * weight.y * weight.z, weight.x * change.y * weight.z, weight.x * weight.y * change.z,
            weight.x * weight.y * weight.z,
        ) * value;
    }
    return sum;
}

// Relief of a film at a position, as a footprint (m) shows it.
fn wet_relief(position: vec3f, footprint: f32) -> WetRelief {
    var relief = WetRelief(vec3f(0.0), 0.0, 0.0);
    var cell = WET_FINE;
    for (var k = 0u; k < WET_OCTAVES; k += 1u) {
        let seen = clamp(2.0 - 2.0 * footprint / cell, 0.0, 1.0);
        if seen > 0.0 {
            let noise = wet_noise(position / cell, WET_DIMENSION + k);
            relief.slope += noise.xyz * (WET_STEEP * seen);
            relief.height += noise.w * (0.6 * seen);
        }
        relief.variance += (1.0 - seen * seen) * (WET_STEEP * WET_STEEP * WET_SQUARE);
        cell *= WET_COARSER;
    }
    return relief;
}

// Direction that the rain comes from at a position: it strays from place to place, so that the edge of what is wet is uneven.
fn wet_arrival(towards: vec3f, position: vec3f) -> vec3f {
    let at = position / WET_EDGE;
    let x = wet_noise(at, WET_DIMENSION + WET_OCTAVES).w;
    let z = wet_noise(at, WET_DIMENSION + WET_OCTAVES + 1u).w;
    let along = towards / max(towards.y, 0.05) + vec3f(x, 0.0, z) * WET_SPREAD;
    return along / sqrt(dot(along, along));
}

// Wetness of a surface: 0 where no rain reaches it.
fn wet_exposure(surface: Surface, wet: RenderWet) -> f32 {
    let flux = dot(surface.facet, wet.towards) / max(wet.towards.y, 0.05);
    if (surface.flags & (SCENE_BLENDED | SCENE_UNLIT)) != 0u || surface.transmission > 0.0 || flux <= 0.0 {
        return 0.0;
    }
    let storage = WET_SMOOTH_STORAGE + (1.0 - WET_SMOOTH_STORAGE) * surface.porosity;
    let wetness = wet_fraction(wet.before, wet.kept, wet.since, flux / storage);
    if wetness < WET_MIN {
        return 0.0;
    }
    let start = surface.position + surface.facet * render_frame.nearest;
    let hit = surface_blocker(start, wet_arrival(wet.towards, surface.position + wet.shift), render_frame.nearest, BVH_FAR);
    return select(wetness, 0.0, hit.distance >= 0.0);
}

// Reflectance at normal incidence of a surface under a film of water: of both interfaces.
fn wet_reflectance(in_air: vec3f) -> vec3f {
    let below = puddle_water_reflectance(in_air);
    let through = 1.0 - PUDDLE_WATER_NORMAL;
    return vec3f(PUDDLE_WATER_NORMAL) + below * (through * through) / (vec3f(1.0) - below * PUDDLE_WATER_NORMAL);
}

// A surface as it looks when it is wet, seen along a direction.
fn wet_surface(dry: Surface, wetness: f32, along: vec3f, relief: WetRelief) -> Surface {
    var surface = dry;
    let pores = WET_PORES * dry.porosity;
    let soaked = dry.porosity * min(wetness / WET_PORES, 1.0);
    let filled = clamp((wetness - pores) / (1.0 - pores), 0.0, 1.0);
    let level = filled * (1.0 - WET_GRAINS * dry.porosity);
    let patchy = dry.porosity * WET_PATCH * min(4.0 * filled, 1.0);
    let film = clamp(level - relief.height * patchy, 0.0, 1.0);
    surface.diffuse = dry.diffuse + (puddle_water_albedo(dry.diffuse) - dry.diffuse) * soaked;
    let reflectance = wet_reflectance(dry.normal_reflectance);
    surface.normal_reflectance = dry.normal_reflectance + (reflectance - dry.normal_reflectance) * film;
    // Of a narrow lobe and a wide one the narrow one is seen. A metal shines as it is through the film.
    let strongest = max(dry.normal_reflectance.x, max(dry.normal_reflectance.y, dry.normal_reflectance.z));
    let bare = (1.0 - film) * (1.0 - film) * (1.0 - film);
    let coated = (1.0 - bare) * (1.0 - clamp((strongest - WET_DIELECTRIC) / (WET_METAL - WET_DIELECTRIC), 0.0, 1.0));
    let smooth_alpha = WET_SMOOTH_ALPHA + (WET_POROUS_ALPHA - WET_SMOOTH_ALPHA) * dry.porosity;
    let coat = sqrt(smooth_alpha * smooth_alpha + relief.variance * dry.porosity + dry.variance);
    let alpha = dry.roughness * dry.roughness;
    surface.roughness = sqrt(alpha + (min(coat, alpha) - alpha) * coated);
    surface.film = 1.0 - bare;
    // The film's own relief, along the surface.
    let across = relief.slope - dry.normal * dot(relief.slope, dry.normal);
    var normal = dry.normal - across * (film * dry.porosity);
    normal = normal / sqrt(dot(normal, normal));
    let away = dot(normal, along);
    if away > -0.01 {
        normal = normal - along * (away + 0.01);
        normal = normal / sqrt(dot(normal, normal));
    }
    surface.normal = normal;
    return surface;
}

// Two parts of the reflectance of microfacets: the factor of that at normal incidence, and the rest.
fn wet_parts(row: u32, index: u32) -> vec2f {
    let pair = bitcast<vec4f>(render_table[row + index / 2u]);
    return select(pair.xy, pair.zw, index % 2u == 1u);
}

// The same between the cosines of the table.
fn wet_coat_at(row: u32, cosine: f32) -> vec2f {
    let u = sqrt(clamp(cosine, 0.0, 1.0)) * f32(WET_COAT_COSINES - 1u);
    let low = min(u32(u), WET_COAT_COSINES - 2u);
    let part = u - f32(low);
    return wet_parts(row, low) * (1.0 - part) + wet_parts(row, low + 1u) * part;
}

// Fraction of an even environment that microfacets reflect toward a cosine, or that of light from all directions (`of_mean`).
fn wet_coat(normal_reflectance: vec3f, roughness: f32, cosine: f32, of_mean: bool) -> vec3f {
    let x = clamp(roughness, 0.0, 1.0) * f32(WET_COAT_STEPS);
    let low = min(u32(x), WET_COAT_STEPS - 1u);
    let part = x - f32(low);
    let first = render_frame.wetness + WET_HEAD_ROWS + low * WET_COAT_ROWS;
    var lower = vec2f(0.0);
    var upper = vec2f(0.0);
    if of_mean {
        lower = wet_parts(first + WET_COAT_ROWS - 1u, 0u);
        upper = wet_parts(first + 2u * WET_COAT_ROWS - 1u, 0u);
    } else {
        lower = wet_coat_at(first, cosine);
        upper = wet_coat_at(first + WET_COAT_ROWS, cosine);
    }
    let parts = lower * (1.0 - part) + upper * part;
    return normal_reflectance * parts.x + vec3f(parts.y);
}

// Factor of the light that comes out of a surface with a film toward a cosine, per what goes in.
fn wet_out(surface: Surface, cosine: f32) -> vec3f {
    let reflected = wet_coat(surface.normal_reflectance, surface.roughness, cosine, false);
    let mean = wet_coat(surface.normal_reflectance, surface.roughness, 0.0, true);
    return (vec3f(1.0) - reflected) / max(vec3f(1.0) - mean, vec3f(1.0e-3));
}

// Fraction of light from a cosine that goes into a surface with a film.
fn wet_in(surface: Surface, cosine: f32) -> vec3f {
    return vec3f(1.0) - wet_coat(surface.normal_reflectance, surface.roughness, cosine, false);
}

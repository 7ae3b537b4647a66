// A scene of triangles under a sky, and the light of its lamps at a position.
// Twin: downpour_trace::scene.

// True if there are puddles: their code slows down the rest.
override SCENE_WET: bool = true;
// True if a pane throws shadows: likewise.
override SCENE_PANE: bool = true;

// Light of a lamp that arrives at a surface, in air or under water.
struct SceneArrival {
    // Origin of the ray to the lamp.
    start: vec3f,
    // Distance from there.
    distance: f32,
    // Direction to the lamp in air.
    along: vec3f,
    // Half the angle that the light takes.
    spread: f32,
    // Direction from which the light falls on the surface.
    direction: vec3f,
    // Factor of the albedo.
    diffuse: f32,
    // Irradiance over pi on a surface that faces it.
    irradiance: vec3f,
}

// Fraction of light that reaches a position from a distance along a direction: surfaces that let light through dim it.
fn scene_visibility(position: vec3f, direction: vec3f, distance: f32) -> vec3f {
    var from_distance = render_frame.nearest;
    var visible = vec3f(1.0);
    for (var k = 0u; k < SCENE_LAYERS; k += 1u) {
        let hit = surface_hit(position, direction, from_distance, distance - render_frame.nearest);
        if hit.distance < 0.0 {
            return visible;
        }
        let material = material_load(render_corners[hit.triangle * 3u].material);
        if (material.flags & SCENE_BLENDED) != 0u {
            visible *= 1.0 - clamp(surface_alpha(material, hit), 0.0, 1.0);
        } else if material.transmission > 0.0 {
            visible *= material.base.rgb * material.transmission;
        } else {
            return vec3f(0.0);
        }
        from_distance = hit.distance + render_frame.nearest;
    }
    return vec3f(0.0);
}

// Light of row `index` as it arrives at a surface.
// `standoff`: a lamp that is nearer to the surface's plane than this gives it the same light from so far: a spot close to a
// lamp is small, and far brighter than all around it. `under`: the depth of level water over the surface, and how far the
// water's surface is over it in the model; light is refracted where it enters, and what Fresnel's equations do not reflect
// goes in.
fn scene_arrival(index: u32, surface: Surface, standoff: f32, under: vec2f) -> SceneArrival {
    var position = surface.position;
    var light = LightSample();
    var arrival = SceneArrival();
    var height = 0.0;
    var passes = 1u;
    for (var k = 0u; k < passes; k += 1u) {
        if k > 0u {
            position = surface.position - surface.facet * (standoff - height);
            if SCENE_WET && under.x > 0.0 {
                position = surface.position + vec3f(0.0, under.y, 0.0) + puddle_water_entry(light.direction, under.x);
            }
        }
        light = light_sample(light_load(index), position, 0.0);
        if k == 0u {
            let start = position + surface.facet * render_frame.nearest;
            arrival = SceneArrival(
                start, light.distance, light.direction, light.spread, light.direction, 1.0, light.irradiance,
            );
            height = dot(light.direction, surface.facet) * light.distance;
            passes = select(1u, 2u, height > 0.0 && height < standoff);
            if SCENE_WET && under.x > 0.0 {
                passes = 3u;
            }
        }
    }
    arrival.direction = light.direction;
    arrival.irradiance = light.irradiance;
    if SCENE_WET && under.x > 0.0 {
        arrival.start = position + vec3f(0.0, render_frame.nearest, 0.0);
        arrival.distance = light.distance;
        arrival.along = light.direction;
        arrival.direction = puddle_water_beneath(light.direction);
        let cosine = max(light.direction.y, 0.0);
        // The light within is of a narrower cone: what comes out of it again is spread over a wider one.
        let square = PUDDLE_WATER_INDEX * PUDDLE_WATER_INDEX;
        let enters = (1.0 - optics_fresnel(cosine, PUDDLE_WATER_INDEX)) * cosine / (max(arrival.direction.y, 0.1) * square);
        arrival.irradiance *= enters;
        // The albedo of what lies under water has the mean over all directions in it.
        arrival.diffuse = square / (1.0 - PUDDLE_WATER_OUTSIDE);
    }
    return arrival;
}

// Light of one lamp on a surface, toward the viewer, if nothing is between them.
// `out`: wet_out toward the viewer, of a surface with a film.
fn scene_lamp(surface: Surface, view: vec3f, light: SceneArrival, out: vec3f) -> vec3f {
    if dot(surface.facet, light.direction) <= 0.0 {
        return vec3f(0.0);
    }
    let alpha = max(surface.roughness * surface.roughness, SCENE_MIN_ROUGHNESS * SCENE_MIN_ROUGHNESS);
    var base = surface.diffuse * light.diffuse;
    var under = vec3f(0.0);
    if WET_SURFACES && surface.film > 0.0 {
        let cosine = max(dot(surface.normal, light.direction), 0.0);
        under = base * out * wet_in(surface, cosine) * (surface.film * cosine);
        base *= 1.0 - surface.film;
    }
    return light.irradiance * (under + brdf_direct(
        base, surface.normal_reflectance, alpha, surface.normal, view, light.direction,
    ));
}

// Light of lamps and sun on a surface, toward the viewer. With `draws` of 0, or of at least as many as there are, all lamps
// are asked whether something hides them; else so many are drawn by what each would give (`chance` in [0, 1)), for all of
// them. `standoff` and `under`: scene_arrival.
fn scene_direct(surface: Surface, view: vec3f, draws: u32, chance: f32, standoff: f32, under: vec2f) -> vec3f {
    let count = render_frame.light_count;
    let few = draws > 0u && draws < count;
    var sum = vec3f(0.0);
    var total = 0.0;
    var run = 0.0;
    var next = 0.0;
    var step = 0.0;
    var out = vec3f(1.0);
    if WET_SURFACES && surface.film > 0.0 {
        out = wet_out(surface, max(dot(surface.normal, view), BRDF_GRAZING));
    }
    // First what all give together, then the rays.
    for (var k = 0u; k < 2u * count; k += 1u) {
        let index = k % count;
        let arrival = scene_arrival(index, surface, standoff, under);
        let lit = scene_lamp(surface, view, arrival, out);
        let fraction = light_weight(lit);
        if k < count {
            total += fraction;
            continue;
        }
        if k == count {
            // Positions at equal steps along what all give together: the lamps that they fall on are drawn.
            step = total / f32(max(draws, 1u));
            next = chance * step;
        }
        run += fraction;
        var weight = 1.0;
        if few {
            if next >= run {
                continue;
            }
            let times = floor((run - next) / step) + 1.0;
            next += times * step;
            weight = times * step / fraction;
        } else if fraction <= total * SCENE_MIN_LAMP {
            continue;
        }
        let visible = scene_visibility(arrival.start, arrival.along, arrival.distance);
        var fraction_of_pane = 1.0;
        if SCENE_PANE {
            fraction_of_pane = pane_shadow_fraction(arrival.start, arrival.along, arrival.distance, arrival.spread);
        }
        sum += lit * visible * (fraction_of_pane * weight);
    }
    return sum;
}

// A scene of triangles under a sky, and the light of its lamps at a position.
// Twin: downpour_trace::scene.

// True if there are puddles: their code slows down the rest.
override SCENE_WET: bool = true;
// True if a pane throws shadows: likewise.
override SCENE_PANE: bool = true;
// True if surfaces shine: likewise.
override SCENE_SHINES: bool = true;

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

// Light of lamps, and of surfaces that shine, at a surface.
struct SceneDirect {
    // Toward the viewer.
    lit: vec3f,
    // On the diffuse base, over pi: of surfaces that shine, and of lamps with soft shadows. Means over neighbors are taken of it.
    glow: vec3f,
    // Toward the viewer, from a rough gloss that lamps with soft shadows light, and from a wide one that surfaces that shine light: means over
    // neighbors are taken of it, too.
    sheen: vec3f,
    // What lamps of the latter give if nothing hides them: to the facet, and to the surface with its relief.
    flat_light: f32,
    relief_light: f32,
    // True if another lamp is hidden in part.
    is_soft: bool,
}

// Fraction of light that reaches a position from a distance along a direction: surfaces that let light through dim it.
fn scene_visibility(position: vec3f, direction: vec3f, distance: f32) -> vec3f {
    var from_distance = render_frame.nearest;
    var visible = vec3f(1.0);
    for (var k = 0u; k < SCENE_LAYERS; k += 1u) {
        let hit = surface_blocker(position, direction, from_distance, distance - render_frame.nearest);
        if hit.distance < 0.0 {
            return visible;
        }
        let material = material_load(render_corners[hit.triangle * 3u].material);
        if (material.flags & (SCENE_LAMP_GLASS | SCENE_SPOT_GLASS)) != 0u {
            // The light of a lamp begins in its glass.
        } else if (material.flags & SCENE_BLENDED) != 0u {
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

// Light of a lamp as it arrives at a surface.
// `standoff`: a lamp that is nearer to the surface's plane than this gives it the same light from so far: a spot close to a
// lamp is small, and far brighter than all around it. `under`: the depth of level water over the surface, and how far the
// water's surface is over it in the model; light is refracted where it enters, and what Fresnel's equations do not reflect
// goes in.
fn scene_arrival(lamp: RenderLight, surface: Surface, standoff: f32, under: vec2f) -> SceneArrival {
    var position = surface.position;
    var facet = surface.facet;
    var light = LightSample();
    var arrival = SceneArrival();
    var height = 0.0;
    var passes = 1u;
    for (var k = 0u; k < passes; k += 1u) {
        if k > 0u {
            position = surface.position - facet * (standoff - height);
            if SCENE_WET && under.x > 0.0 {
                position = surface.position + vec3f(0.0, under.y, 0.0) + puddle_water_entry(light.direction, under.x);
            }
        }
        light = light_sample(lamp, position, 0.0);
        if k == 0u {
            facet = translucent_facet(surface, light.direction);
            let start = position + facet * render_frame.nearest;
            arrival = SceneArrival(
                start, light.distance, light.direction, light.spread, light.direction, 1.0, light.irradiance,
            );
            height = dot(light.direction, facet) * light.distance;
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
// `out`: wet_out toward the viewer, of a surface with a film; `seen`: rays of the gloss see the lamp itself.
fn scene_lamp(surface: Surface, view: vec3f, light: SceneArrival, out: vec3f, seen: bool) -> vec3f {
    if dot(surface.facet, light.direction) <= 0.0 {
        return vec3f(0.0);
    }
    if seen {
        return surface.diffuse * scene_glow(surface, view, light, out);
    }
    let alpha = scene_alpha(surface.roughness, light.spread, dot(surface.normal, view));
    var base = surface.diffuse * light.diffuse;
    var under = vec3f(0.0);
    if WET_SURFACES && surface.film > 0.0 {
        let cosine = max(dot(surface.normal, light.direction), 0.0);
        under = base * out * wet_in(surface, cosine) * (surface.film * cosine);
        base *= 1.0 - surface.film;
    }
    return light.irradiance * (under + brdf_direct(
        base, surface.normal_reflectance, surface.film, alpha, surface.normal, view, light.direction,
    ));
}

// Part of the light of a lamp whose shadows are wide on the picture, 0 to 1: as if what throws them stood a part of the way to it.
fn scene_softness(distance: f32, spread: f32, footprint: f32) -> f32 {
    let away = min(distance * SCENE_SHADOW_PART, SCENE_SHADOW_M);
    let width = 2.0 * spread * away / max(footprint, 1.0e-9);
    return clamp((width - SCENE_SHARP_PIXELS) / SCENE_SHARP_PIXELS, 0.0, 1.0);
}

// Radiance of the disks of suns that the picture shows in a direction.
fn scene_suns(direction: vec3f) -> vec3f {
    var sum = vec3f(0.0);
    if render_frame.projection != SCENE_PICTURE {
        return sum;
    }
    for (var k = 0u; k < render_frame.light_count; k += 1u) {
        let lamp = light_load(k);
        let apart = direction + lamp.axis;
        // A disk whose edge is a chord away takes pi times its square of the sphere.
        let square = lamp.chord * lamp.chord;
        if lamp.kind == SCENE_LIGHT_DIRECTIONAL && dot(apart, apart) < square {
            sum += lamp.color / square;
        }
    }
    return sum;
}

// Alpha of the lobe in which a surface shows a disk of a half angle: that of a mirror is as bright as the disk. Seen at a small
// angle, a lobe is narrower across.
fn scene_alpha(roughness: f32, spread: f32, cosine_view: f32) -> f32 {
    let square = roughness * roughness;
    let least = SCENE_MIN_ROUGHNESS * SCENE_MIN_ROUGHNESS;
    let disk = 0.25 * spread * spread / max(cosine_view, SCENE_MIN_COSINE);
    return min(sqrt(max(square * square + disk, least * least)), 1.0);
}

// Light that a place of a surface that shines gives to the diffuse base of a surface, over pi and the albedo.
fn scene_glow(surface: Surface, view: vec3f, light: SceneArrival, out: vec3f) -> vec3f {
    let cosine = dot(surface.normal, light.direction);
    if cosine <= 0.0 || dot(surface.facet, light.direction) <= 0.0 {
        return vec3f(0.0);
    }
    let sum = view + light.direction;
    let halfway = sum / max(sqrt(dot(sum, sum)), BRDF_MIN_DIVISOR);
    let fresnel = brdf_fresnel(surface.normal_reflectance, surface.film, clamp(dot(view, halfway), 0.0, 1.0));
    var enters = vec3f(1.0) - fresnel;
    if WET_SURFACES && surface.film > 0.0 {
        enters += (out * wet_in(surface, cosine) - enters) * surface.film;
    }
    return light.irradiance * enters * (cosine * light.diffuse);
}

// Fraction of the light of a lamp that reaches a surface: what a ray to a place on its disk finds.
fn scene_shadow(light: SceneArrival, numbers: vec2f) -> vec3f {
    var along = light.along;
    var distance = light.distance;
    if light.spread > 0.0 {
        let tangent = scatter_tangent(along);
        let offset = scene_disk(numbers) * light.spread;
        let bent = along + tangent * offset.x + cross(along, tangent) * offset.y;
        let longer = sqrt(dot(bent, bent));
        along = bent / longer;
        distance = select(distance * longer, distance, distance >= SCENE_FAR);
    }
    return scene_visibility(light.start, along, distance);
}

// Place on a unit disk.
fn scene_disk(numbers: vec2f) -> vec2f {
    let radius = sqrt(numbers.x);
    let angle = 6.2831853 * numbers.y;
    return vec2f(radius * cos(angle), radius * sin(angle));
}

// Light of lamps, sun, and surfaces that shine on a surface. With `draws` of 0, or of at least as many as there are, all lamps
// are asked whether something hides them; else so many are drawn by what each would give (`numbers.w` in [0, 1)), for all of
// them. A place of a surface that shines is drawn with the first three numbers, and is one of the lamps. `is_first`: the surface
// is what the camera sees: light without hard shadows is told apart, and rays of its gloss see what shines. `footprint`: width of
// the pixel there, m. `spared`: of light without hard shadows no ray asks what hides it. `standoff` and `under`: scene_arrival.
fn scene_direct(
    surface: Surface, view: vec3f, draws: u32, numbers: vec4f, standoff: f32, under: vec2f, is_first: bool, footprint: f32,
    spared: bool,
) -> SceneDirect {
    var result = SceneDirect(vec3f(0.0), vec3f(0.0), vec3f(0.0), 0.0, 0.0, false);
    var count = render_frame.light_count;
    var place = RenderLight();
    if SCENE_SHINES && render_frame.emitters > 0u {
        var normal = surface.normal;
        var weight = 1.0;
        if translucent_is(surface) {
            // Those of one side, drawn for both.
            let chance = translucent_chance(surface);
            let is_behind = fract(numbers.w * TRANSLUCENT_SIDE) < chance;
            normal *= select(1.0, -1.0, is_behind);
            weight = 1.0 / select(1.0 - chance, chance, is_behind);
        }
        place = emitter_draw(surface.position, normal, numbers.xyz);
        // What stands on the other side is drawn with that.
        let is_there = !translucent_is(surface) || dot(place.position - surface.position, normal) > 0.0;
        place.color *= select(0.0, weight, is_there);
        count += 1u;
    }
    let few = draws > 0u && draws < count;
    let glossy = is_first && render_frame.sky_rays > 0u && surface.roughness < SCENE_SEEN_BODY;
    let is_sheen = surface.roughness >= SCENE_SHEEN && surface.variance < SCENE_SHEEN_VARIANCE;
    // One of few is drawn while they are added up: what is left of a number that has decided is as good as a new one.
    let one = few && draws == 1u;
    var rest = numbers.w;
    var drawn = 0u;
    var total = 0.0;
    var run = 0.0;
    var next = 0.0;
    var step = 0.0;
    var out = vec3f(1.0);
    if WET_SURFACES && surface.film > 0.0 {
        out = wet_out(surface, max(dot(surface.normal, view), BRDF_GRAZING));
    }
    // First what all give together, then which lamps are asked, one after another. An invocation goes on to the next lamp that it asks before
    // it traces a ray: all those of a workgroup trace at once, whichever lamps they ask.
    var k = 0u;
    loop {
        var arrival = SceneArrival();
        var lit = vec3f(0.0);
        var glow = vec3f(0.0);
        var soft = 0.0;
        var fraction = 0.0;
        var weight = 1.0;
        var index = 0u;
        var is_asked = false;
        while k < 2u * count && !is_asked {
            index = k % count;
            var lamp = place;
            if index < render_frame.light_count {
                lamp = light_load(index);
            }
            // Areas have a distance of their own within which their light does not grow.
            let is_area = lamp.kind == SCENE_LIGHT_AREA;
            arrival = scene_arrival(lamp, surface, select(standoff, 0.0, is_area), under);
            // The ray ends before the surface that shines.
            arrival.distance -= select(0.0, 4.0 * render_frame.nearest, is_area);
            soft = 0.0;
            // The part that is told apart, with the facet's normal in place of the relief's.
            glow = vec3f(0.0);
            var relief = vec3f(0.0);
            lit = vec3f(0.0);
            if light_weight(arrival.irradiance) > 0.0 {
                if is_first {
                    soft = select(scene_softness(arrival.distance, arrival.spread, footprint), 1.0, is_area);
                }
                // A lamp behind a leaf lights that side: by the normal for shading, so that no lamp is on neither.
                var side = surface;
                var viewer = view;
                var part = vec3f(1.0);
                if translucent_is(surface) {
                    part = translucent_part(surface);
                    if dot(surface.normal, arrival.direction) < 0.0 {
                        side = translucent_behind(surface);
                        viewer = -view;
                    } else {
                        part = vec3f(1.0) - part;
                    }
                    side.facet = translucent_facet(surface, arrival.direction);
                }
                var bare = side;
                bare.diffuse *= 1.0 - surface.transmission;
                if soft > 0.0 {
                    relief = scene_glow(side, viewer, arrival, out) * part * soft;
                    glow = relief;
                    if !is_area {
                        var level = side;
                        level.normal = side.facet;
                        glow = scene_glow(level, viewer, arrival, out) * part * soft;
                    }
                    bare.diffuse *= 1.0 - soft;
                }
                // A narrow gloss sees an area by its rays.
                if !(is_first && is_area && surface.roughness < SCENE_SEEN_AREA) {
                    lit = scene_lamp(bare, viewer, arrival, out, glossy && lamp.kind == SCENE_LIGHT_BODY);
                }
            }
            fraction = light_weight(lit) + light_weight(glow);
            k += 1u;
            if k <= count {
                total += fraction;
                if one && fraction > 0.0 {
                    if rest * total < fraction || total <= fraction {
                        rest *= total / fraction;
                        drawn = index;
                    } else {
                        rest = (rest * total - fraction) / (total - fraction);
                    }
                }
                if k == count {
                    // Positions at equal steps along what all give together: the lamps that they fall on are drawn.
                    step = total / f32(max(draws, 1u));
                    next = numbers.w * step;
                    if total <= 0.0 {
                        k = 2u * count;
                    } else if one {
                        k = count + drawn;
                    }
                }
                continue;
            }
            run += fraction;
            is_asked = fraction > total * SCENE_MIN_LAMP;
            if one {
                is_asked = true;
                weight = total / fraction;
            } else if few {
                is_asked = next < run && fraction > 0.0;
                if is_asked {
                    let times = floor((run - next) / step) + 1.0;
                    next += times * step;
                    weight = times * step / fraction;
                }
            }
            if is_asked && !is_area {
                result.flat_light += light_weight(glow);
                result.relief_light += light_weight(relief);
            }
            is_asked = is_asked && !(spared && light_weight(lit) <= total * SCENE_MIN_LAMP);
        }
        if !is_asked {
            break;
        }
        // Each lamp has places of its own; they come from other digits of the number that draws a lamp.
        let digits = fract(numbers.w * vec2f(SCENE_DIGIT, SCENE_OTHER_DIGIT));
        let place_numbers = fract(digits + f32(index) * vec2f(SCENE_LATTICE, SCENE_OTHER_LATTICE));
        // On what the camera sees, shadows of a few pixels are in part those of a point: noise of the rest would be seen, and its mean over
        // neighbors is taken of the other part. A lamp that gives little has one ray for both.
        let is_point = is_first && soft < 1.0;
        let both = is_point && soft > 0.0 && arrival.spread > 0.0 && fraction > total * SCENE_LARGE_LAMP;
        var seen = vec3f(0.0);
        var blurred = vec3f(0.0);
        for (var ray = 0u; ray < select(1u, 2u, both); ray += 1u) {
            var hidden = arrival;
            hidden.spread = select(arrival.spread, 0.0, is_point && ray == 0u);
            blurred = scene_shadow(hidden, place_numbers);
            seen = select(seen, blurred, ray == 0u);
        }
        let apart = abs(seen - blurred);
        result.is_soft = result.is_soft || max(apart.x, max(apart.y, apart.z)) > SCENE_SAME_SHADOW;
        var passes = weight;
        if SCENE_PANE {
            passes *= pane_shadow_fraction(arrival.start, arrival.along, arrival.distance, arrival.spread);
        }
        if is_sheen && soft >= 1.0 {
            result.sheen += lit * seen * passes;
        } else {
            result.lit += lit * seen * passes;
        }
        result.glow += glow * blurred * passes;
        if one || (few && next >= total) {
            // All are drawn.
            break;
        }
    }
    return result;
}

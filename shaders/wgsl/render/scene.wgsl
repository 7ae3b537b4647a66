// What a ray sees of a scene: light of lamps and sun with shadow rays, light of the sky with rays that find what hides
// it.
// Twin: downpour_render::scene, where the method is described.

// Whether there are puddles: what they need slows down the rest.
override SCENE_WET: bool = true;
// Whether a pane throws shadows: likewise.
override SCENE_PANE: bool = true;

struct SceneLight {
    // From the surface to the light, of length 1.
    direction: vec3f,
    distance: f32,
    // Irradiance over pi on a surface that faces it.
    irradiance: vec3f,
    // Half the angle that the light takes.
    spread: f32,
}

// The light of row `index` at a place. A lamp that is nearer than `least` is as bright as from there.
fn scene_light(index: u32, place: vec3f, least: f32) -> SceneLight {
    let row = render_frame.lights + index * SCENE_LIGHT_ROWS;
    let position = bitcast<vec4f>(render_table[row]);
    let axis = bitcast<vec4f>(render_table[row + 1u]);
    let colour = bitcast<vec4f>(render_table[row + 2u]);
    let cone = bitcast<vec4f>(render_table[row + 3u]);
    if render_table[row].w == SCENE_LIGHT_DIRECTIONAL {
        return SceneLight(-axis.xyz, SCENE_FAR, colour.rgb, PANE_SHADOW_SUN);
    }
    let offset = position.xyz - place;
    let square = max(dot(offset, offset), max(least * least, 1.0e-8));
    let distance = sqrt(max(dot(offset, offset), 1.0e-8));
    let direction = offset / distance;
    // glTF's window: no light beyond the range, if there is one.
    let part = distance / max(colour.w, 1.0e-6);
    let fourth = part * part * part * part;
    let ranged = clamp(1.0 - fourth, 0.0, 1.0);
    let window = select(1.0, ranged, colour.w > 0.0);
    let edge = clamp(dot(-direction, axis.xyz) * cone.x + cone.y, 0.0, 1.0);
    return SceneLight(direction, distance, colour.rgb * (window * edge * edge / square), 0.0);
}

// Share of light that reaches a place from a distance along a direction: surfaces that let light through dim it.
fn scene_visibility(place: vec3f, direction: vec3f, distance: f32) -> vec3f {
    var from_distance = render_frame.nearest;
    var visible = vec3f(1.0);
    for (var k = 0u; k < SCENE_LAYERS; k += 1u) {
        let hit = surface_hit(place, direction, from_distance, distance - render_frame.nearest);
        if hit.distance < 0.0 {
            return visible;
        }
        let row = render_corners[hit.triangle * 3u].material * SCENE_MATERIAL_ROWS;
        let flags = render_table[row + 3u].x;
        let through = bitcast<f32>(render_table[row + 3u].y);
        let base = bitcast<vec4f>(render_table[row]);
        if (flags & SCENE_BLENDED) != 0u {
            visible *= 1.0 - base.a;
        } else if through > 0.0 {
            visible *= base.rgb * through;
        } else {
            return vec3f(0.0);
        }
        from_distance = hit.distance + render_frame.nearest;
    }
    return vec3f(0.0);
}

// Light of one lamp on a surface, towards the viewer, if nothing is between them.
fn scene_lamp(surface: Surface, view: vec3f, light: SceneLight) -> vec3f {
    if dot(surface.facet, light.direction) <= 0.0 {
        return vec3f(0.0);
    }
    let alpha = max(surface.roughness * surface.roughness, SCENE_LEAST_ROUGHNESS * SCENE_LEAST_ROUGHNESS);
    return light.irradiance * brdf_direct(
        surface.diffuse, surface.normal_reflectance, alpha, surface.normal, view, light.direction,
    );
}

// Light of lamps and sun on a surface, towards the viewer. Lamps are asked in turn whether something hides them; with
// `all` false only one is, drawn by what each would give (`chance` in [0, 1)), for all of them.
fn scene_direct(surface: Surface, view: vec3f, all: bool, chance: f32) -> vec3f {
    let start = surface.position + surface.facet * render_frame.nearest;
    // At a glance a spot close to a lamp would be noise: it is small, and far brighter than all round it.
    let least = select(render_frame.sky_reach * SCENE_GLANCE_NEAREST, 0.0, all);
    var sum = vec3f(0.0);
    var total = 0.0;
    var rest = chance;
    var chosen = render_frame.light_count;
    // Once for what each would give, and to draw one; then the rays.
    for (var k = 0u; k < render_frame.light_count; k += 1u) {
        let share = scene_share(scene_lamp(surface, view, scene_light(k, surface.position, least)));
        total += share;
        if share > 0.0 && rest * total < share {
            // The part of the interval that is left is as good as a new number.
            rest = rest * total / share;
            chosen = k;
        } else if share > 0.0 {
            rest = (rest * total - share) / (total - share);
        }
    }
    let first = select(chosen, 0u, all);
    let end = select(min(chosen + 1u, render_frame.light_count), render_frame.light_count, all);
    for (var k = first; k < end; k += 1u) {
        let light = scene_light(k, surface.position, least);
        let lit = scene_lamp(surface, view, light);
        let share = scene_share(lit);
        if share <= total * SCENE_LEAST_LAMP {
            continue;
        }
        let visible = scene_visibility(start, light.direction, light.distance);
        var share_of_pane = 1.0;
        if SCENE_PANE {
            share_of_pane = pane_shadow_share(start, light.direction, light.distance, light.spread);
        }
        sum += lit * visible * (share_of_pane * select(total / share, 1.0, all));
    }
    return sum;
}

// What a colour weighs when lamps are compared.
fn scene_share(colour: vec3f) -> f32 {
    return colour.r + colour.g + colour.b;
}

// Direction k of n over the hemisphere round a normal, cosine-weighted, for a pixel's random words.
fn scene_hemisphere(normal: vec3f, k: u32, n: u32, random: vec4u) -> vec3f {
    // A golden-ratio sequence, shifted for each pixel.
    let a = fract((f32(k) + rng_unit(random.x)) / f32(n));
    let b = fract(f32(k) * 0.618034 + rng_unit(random.y));
    let radius = sqrt(a);
    let angle = 6.2831853 * b;
    let height = sqrt(max(1.0 - a, 0.0));
    // An orthonormal frame (T. Duff et al., JCGT 6(1), 2017).
    let side = packing_sign(normal.z);
    let p = -1.0 / (side + normal.z);
    let q = normal.x * normal.y * p;
    let tangent = vec3f(1.0 + side * normal.x * normal.x * p, side * q, -side * normal.x);
    let other = vec3f(q, side + normal.y * normal.y * p, -normal.y);
    return tangent * (radius * cos(angle)) + other * (radius * sin(angle)) + normal * height;
}

// Numbers for the rays of sample k of a pixel, as words. The pixels of any window of the filter's size have all the
// points of one lattice of rank 1 among them, each once: their mean has no pattern.
fn scene_lattice(x: u32, y: u32, k: u32) -> vec4u {
    let seed = rng_draw(vec2u(render_frame.seed, 0u), k, 0u, SCENE_RANDOM_DIMENSION);
    let edge = 2u * SKYLIGHT_RADIUS + 1u;
    let points = edge * edge;
    // Scattered, so that a part of the window has points from everywhere.
    let index = ((x % edge) * edge + y % edge) * SCENE_LATTICE_SCATTER % points;
    let step = 4294967295u / points;
    return vec4u(
        index * step + seed.x,
        (index * SCENE_LATTICE_SECOND % points) * step + seed.y,
        (index * SCENE_LATTICE_THIRD % points) * step + seed.z,
        seed.w,
    );
}

// What a ray of the camera finds.
struct ScenePath {
    // All light but that of the sky on the first surface.
    radiance: vec3f,
    // Distance of the first surface (SCENE_FAR for the sky).
    distance: f32,
    // What the sky's light on the first surface is multiplied with.
    body: vec3f,
    // 1 if there is a surface whose light of the sky is told apart.
    met: f32,
    // What the square of the open share of the sky is multiplied with.
    gloss: vec3f,
    material: u32,
    // Light of the sky over pi, and the share of the sky that is seen.
    sky: vec4f,
    normal: vec3f,
    // 1 if it is what the sample before has seen.
    again: f32,
    facet: vec3f,
    unused_2: f32,
    place: vec3f,
    unused_3: f32,
}

// A path that has found nothing.
fn scene_nothing() -> ScenePath {
    let none = vec3f(0.0);
    return ScenePath(
        none, SCENE_FAR, none, 0.0, none, SCENE_NONE, vec4f(0.0), none, 0.0, none, 0.0, none, 0.0,
    );
}

// Whether a surface goes on where another sample of the pixel has met it.
fn scene_goes_on(last: ScenePath, material: u32, facet: vec3f, place: vec3f, distance: f32) -> bool {
    return last.met > 0.0 && last.material == material && dot(last.facet, facet) > SCENE_SAME_FACET
        && abs(dot(last.facet, place - last.place)) < SCENE_SAME_PLANE * distance;
}

// What a ray sees. Where it meets the surface that `last` met, it sees the same.
fn scene_path(origin: vec3f, direction: vec3f, cone: f32, random: vec4u, last: ScenePath) -> ScenePath {
    var path = scene_nothing();
    var throughput = vec3f(1.0);
    var from_distance = render_frame.nearest;
    var from_place = origin;
    var towards = direction;
    // Water that the ray has come through, and whether it was the first thing that it met.
    var clear = 1.0;
    var wet_row = PUDDLE_WATER_NONE;
    var under = false;
    var first_is_water = false;
    for (var layer = 0u; layer < SCENE_LAYERS; layer += 1u) {
        // Turn 0 meets the surface; the others are its rays to the sky, or those that water mirrors. One text for all of
        // them: a shader holds the hierarchy's walk and the materials once.
        var surface = Surface();
        var direct = vec3f(0.0);
        var sum = vec3f(0.0);
        var seen = 0.0;
        var start = from_place;
        var along = towards;
        var near = from_distance;
        var reach = BVH_FAR;
        var beyond = vec3f(0.0);
        var width = cone;
        var turns = render_frame.sky_rays;
        var water = PuddleWater(PUDDLE_WATER_NONE, 0.0, 0.0, 0.0);
        var ripple = vec3f(0.0);
        var mirrored_share = 0.0;
        var share_of_turn = 1.0;
        for (var k = 0u; k <= turns; k += 1u) {
            let of_water = SCENE_WET && water.puddle != PUDDLE_WATER_NONE;
            if k > 0u {
                if (surface.flags & SCENE_UNLIT) != 0u {
                    break;
                }
                start = surface.position + surface.facet * render_frame.nearest;
                near = render_frame.nearest;
                if of_water {
                    let a = fract(rng_unit(random.x) + f32(k) * 0.618034);
                    let b = fract(rng_unit(random.y) + f32(k) * 0.7548777);
                    let normal = puddle_water_normal(ripple, a, b);
                    along = puddle_water_mirrored(towards, normal);
                    share_of_turn = optics_fresnel(max(-dot(towards, normal), PUDDLE_WATER_GRAZING), PUDDLE_WATER_INDEX);
                    mirrored_share += share_of_turn;
                    reach = BVH_FAR;
                    width = cone + PUDDLE_WATER_CONE;
                    beyond = sky_level(0u, along);
                } else {
                    along = scene_hemisphere(surface.normal, k - 1u, turns, random);
                    reach = render_frame.sky_reach;
                    width = SCENE_GLANCE_CONE;
                    if dot(along, surface.facet) <= 0.0 {
                        continue;
                    }
                    beyond = sky_level(SCENE_SKY_LEVELS - 1u, along);
                }
            }
            let hit = surface_hit(start, along, near, reach);
            if k == 0u && hit.distance < 0.0 {
                path.radiance += throughput * sky_level(0u, towards);
                return path;
            }
            if hit.distance < 0.0 {
                sum += beyond * share_of_turn;
                seen += 1.0;
                continue;
            }
            var found = surface_at(hit, start, along, width);
            let material = render_corners[hit.triangle * 3u].material;
            var distance = hit.distance;
            if SCENE_WET && k == 0u && wet_row == PUDDLE_WATER_NONE {
                water = puddle_water_find(found.position, found.facet.y);
            }
            let is_water = SCENE_WET && k == 0u && water.puddle != PUDDLE_WATER_NONE;
            if is_water {
                // Back along the ray to where it came through the surface.
                distance = max(hit.distance - water.rise / max(-towards.y, 0.01), near);
                found = scene_water(from_place + towards * distance);
                let footprint = cone * distance / sqrt(max(-towards.y, 0.02));
                ripple = puddle_water_ripple(water.puddle, found.position, footprint, water.depth, water.open);
                found.normal = puddle_water_normal(vec3f(ripple.xy, 0.0), 0.0, 0.0);
                // Beckmann's alpha squared is the variance of the slope.
                found.roughness = clamp(sqrt(sqrt(ripple.z)), 0.0, 1.0);
                turns = max(turns, select(1u, PUDDLE_WATER_RAYS, ripple.z > PUDDLE_WATER_RIPPLED));
            } else if k == 0u && layer == 0u
                && scene_goes_on(last, material, found.facet, found.position, hit.distance) {
                var same = last;
                same.again = 1.0;
                return same;
            }
            if SCENE_WET && k == 0u && under {
                let look = bitcast<vec4f>(render_table[wet_row + 4u]);
                found.diffuse = puddle_water_albedo(found.diffuse * clear + look.rgb * (1.0 - clear));
                found.normal_reflectance = puddle_water_reflectance(found.normal_reflectance) * clear;
                found.emission = found.emission * clear;
            }
            if k > 0u {
                // The mirror image of a lamp, met by chance, would be noise.
                found.roughness = 1.0;
            }
            var lit = found.diffuse + found.normal_reflectance;
            if (found.flags & SCENE_UNLIT) == 0u {
                let chance = rng_unit(random.z + k * 2654435769u);
                // Where there are lamps, they stand for what shines; small bright things would be noise.
                let shines = k == 0u || of_water || render_frame.light_count == 0u;
                lit = select(vec3f(0.0), found.emission, shines) + scene_direct(found, -along, k == 0u, chance);
                if k > 0u {
                    // What it has of the sky itself: half of the whole.
                    let own = sky_irradiance(found.normal) * (0.5 * found.occlusion);
                    lit += (found.diffuse + found.normal_reflectance) * own;
                }
            }
            if k == 0u {
                surface = found;
                direct = lit;
                from_distance = hit.distance + render_frame.nearest;
                if layer == 0u {
                    path.distance = distance;
                    path.material = select(material, PUDDLE_WATER_MATERIAL, is_water);
                    path.facet = found.facet;
                    path.place = found.position;
                    path.normal = found.normal;
                }
                if SCENE_WET && under {
                    path.normal = found.normal;
                }
            } else {
                // What a see-through surface lets pass comes from the sky behind it.
                let share = select(1.0, clamp(found.alpha, 0.0, 1.0), (found.flags & SCENE_BLENDED) != 0u);
                sum += (lit * share + beyond * (1.0 - share)) * share_of_turn;
                seen += 1.0 - share;
            }
        }
        if SCENE_WET && water.puddle != PUDDLE_WATER_NONE {
            let mirrored = 1.0 / f32(turns);
            path.radiance += throughput * (direct + sum * mirrored);
            throughput *= 1.0 - mirrored_share * mirrored;
            // On beneath the surface. Ground that the model does not have is where it would be, seen in the model.
            wet_row = render_frame.puddles + water.puddle * PUDDLE_WATER_ROWS;
            let extinction = bitcast<f32>(render_table[wet_row + 4u].w);
            towards = puddle_water_refracted(towards, surface.normal);
            let steep = max(-towards.y, 0.1);
            clear = exp(-extinction * water.depth * (1.0 / steep + PUDDLE_WATER_DOWN));
            let aside = max(water.depth - water.rise, 0.0) / steep;
            from_place = surface.position + vec3f(towards.x * aside, 0.0, towards.z * aside)
                - towards * (4.0 * render_frame.nearest);
            from_distance = render_frame.nearest;
            under = true;
            first_is_water = layer == 0u;
            continue;
        }
        var sky = vec4f(sum, seen) / max(f32(render_frame.sky_rays), 1.0);
        if render_frame.sky_rays == 0u {
            sky = vec4f(sky_irradiance(surface.normal), 1.0);
        }
        var share = 1.0;
        var tint = vec3f(0.0);
        if (surface.flags & SCENE_BLENDED) != 0u {
            share = clamp(surface.alpha, 0.0, 1.0);
            tint = vec3f(1.0);
        }
        if (surface.flags & SCENE_UNLIT) != 0u {
            path.radiance += throughput * direct * share;
        } else {
            let cosine = max(dot(surface.normal, -towards), 0.0);
            let mirrored = towards - surface.normal * (2.0 * dot(towards, surface.normal));
            let gloss = brdf_environment(surface.normal_reflectance, surface.roughness, cosine);
            let reflection = gloss * sky_reflection(mirrored, surface.roughness) * surface.occlusion;
            let body = surface.diffuse * (1.0 - surface.transmission) * (vec3f(1.0) - gloss) * surface.occlusion;
            // Where the sky is hidden, so is most of its reflection.
            path.radiance += throughput * share * (direct + reflection * 0.1);
            if (layer == 0u || (SCENE_WET && under && first_is_water)) && share == 1.0 && surface.transmission == 0.0 {
                path.body = throughput * body;
                path.gloss = throughput * reflection * 0.9;
                path.sky = sky;
                path.met = 1.0;
            } else {
                path.radiance += throughput * share * (body * sky.rgb + reflection * (0.9 * sky.w * sky.w));
            }
        }
        under = false;
        throughput *= tint * (1.0 - share) + surface.diffuse * surface.transmission * share;
        if max(throughput.x, max(throughput.y, throughput.z)) < 1.0e-3 {
            return path;
        }
    }
    return path;
}

// The surface of water at a place.
fn scene_water(place: vec3f) -> Surface {
    let up = vec3f(0.0, 1.0, 0.0);
    let none = vec3f(0.0);
    return Surface(place, 1.0, up, 0.0, up, 1.0, none, 0u, vec3f(PUDDLE_WATER_NORMAL), 0.0, none, 0.0);
}

// All that a path has seen.
fn scene_radiance(path: ScenePath) -> vec3f {
    return path.radiance + path.body * path.sky.rgb + path.gloss * (path.sky.w * path.sky.w);
}

// The direction of the ray through a place of the picture, in pixels from the top left.
fn scene_direction(x: f32, y: f32) -> vec3f {
    let u = 2.0 * x / f32(render_frame.width) - 1.0;
    let v = 1.0 - 2.0 * y / f32(render_frame.height);
    let direction = render_frame.forward + render_frame.right * u + render_frame.up * v;
    return direction / sqrt(dot(direction, direction));
}

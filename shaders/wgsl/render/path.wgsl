// What a ray of the camera sees: surfaces, water, and the light that comes to them from lamps, sky and one another.
// Twin: downpour_render::path, where the method is described.

// What a ray of the camera finds.
struct ViewPath {
    // All light but that which is told apart below.
    radiance: vec3f,
    // Distance of the first surface (SCENE_FAR for the sky).
    distance: f32,
    // Factor of the light on the diffuse base.
    body: vec3f,
    // 1 if there is a surface whose light is told apart.
    met: f32,
    // Factor of the light that the gloss shows.
    gloss: vec3f,
    material: u32,
    // Light of sky and surfaces on the diffuse base, over pi.
    sky: vec3f,
    // Roughness of the gloss.
    roughness: f32,
    // Light that the gloss shows.
    mirror: vec3f,
    // 1 if it is what the sample before has seen.
    again: f32,
    normal: vec3f,
    // 1 if what it shows is the same over a pixel: no mirror.
    plain: f32,
    facet: vec3f,
    // Half the width of what counts as one plane where means are taken.
    slack: f32,
    place: vec3f,
    unused_1: f32,
    // What stands for `place` where means are taken.
    shown: vec3f,
    unused_2: f32,
    // The direction that a mirror in place of the gloss would show.
    mirrored: vec3f,
    unused_3: f32,
}

// Light that rays have found for a surface.
struct PathLight {
    // On its diffuse base, over pi, or on that of what it mirrors.
    base: vec3f,
    // In its gloss.
    mirror: vec3f,
    // Fraction that water mirrors.
    mirrored: f32,
}

// The rays that look for the light of a surface.
struct PathPlan {
    // Factor of the light on the diffuse base.
    body: vec3f,
    // Rays of the gloss alone; they come first.
    mirrors: u32,
    // Factor of the light that the gloss shows.
    gloss: vec3f,
    // Rays of the diffuse base, or of both.
    rays: u32,
    // Part of the latter that is drawn for the gloss.
    chance: f32,
    // Part of all rays that one is.
    share: f32,
    // Whether rays of the gloss are drawn from its lobe; else they are a mirror's.
    drawn: bool,
    // Whether what the mirror shows takes the surface's place where means over neighbouring pixels are taken.
    replaced: bool,
    // Width of the mirror's ray by what the surface turns within a pixel.
    spread: f32,
}

// A path that has found nothing.
fn path_nothing() -> ViewPath {
    let none = vec3f(0.0);
    return ViewPath(
        none, SCENE_FAR, none, 0.0, none, SCENE_NONE, none, 0.0, none, 0.0, none, 1.0, none, 0.0, none, 0.0, none, 0.0,
        none, 0.0,
    );
}

// All that a path has seen.
fn path_radiance(path: ViewPath) -> vec3f {
    return path.radiance + path.body * path.sky + path.gloss * path.mirror;
}

// Whether a surface is the same where another sample of the pixel has met it.
fn path_same_surface(last: ViewPath, material: u32, facet: vec3f, place: vec3f, distance: f32) -> bool {
    return last.met > 0.0 && last.plain > 0.0 && last.material == material
        && dot(last.facet, facet) > PATH_SAME_FACET
        && abs(dot(last.facet, place - last.place)) < PATH_SAME_PLANE * distance;
}

// The greatest part of a color.
fn path_most(color: vec3f) -> f32 {
    return max(color.x, max(color.y, color.z));
}

// Fraction of the light on its diffuse base that a surface gives back.
fn path_albedo(surface: Surface) -> vec3f {
    return surface.diffuse * ((1.0 - surface.transmission) * surface.occlusion);
}

// Opacity of a surface.
fn path_cover(surface: Surface) -> f32 {
    return select(1.0, clamp(surface.alpha, 0.0, 1.0), (surface.flags & SCENE_BLENDED) != 0u);
}

// Fraction of the light behind a surface that it lets through, straight on.
fn path_open(surface: Surface) -> vec3f {
    let cover = path_cover(surface);
    return vec3f(1.0 - cover) + surface.diffuse * (surface.transmission * cover);
}

// Words for the rays of sample k of a pixel. The first three are those of a lattice of rank 1, of which the pixels of any
// window of the filter's size have each point once; the last is the pixel's own.
fn path_lattice(x: u32, y: u32, k: u32) -> vec4u {
    let seed = rng_draw(vec2u(render_frame.seed, 0u), k, 0u, PATH_DIMENSION);
    let edge = 2u * SKYLIGHT_RADIUS + 1u;
    let points = edge * edge;
    // Scattered, so that a part of the window has points from everywhere.
    let index = ((x % edge) * edge + y % edge) * PATH_LATTICE_SCATTER % points;
    let step = 4294967295u / points;
    return vec4u(
        index * step + seed.x,
        (index * PATH_LATTICE_SECOND % points) * step + seed.y,
        (index * PATH_LATTICE_THIRD % points) * step + seed.z,
        rng_pcg4d(vec4u(x, y, k, seed.w)).x,
    );
}

// Numbers in [0, 1) for ray `index` of `count` of a turn: two for its direction, one for whether it goes on, one for a lamp.
fn path_numbers(random: vec4u, turn: u32, bounce: u32, index: u32, count: u32) -> vec4f {
    let words = rng_pcg4d(vec4u(random.w, turn, bounce, PATH_DIMENSION));
    let own = vec4f(rng_unit(words.x), rng_unit(words.y), rng_unit(words.z), rng_unit(words.w));
    if bounce > 0u {
        return own;
    }
    // Not quite on the lattice's points, so that their images are not seen one by one.
    let a = fract(rng_unit(random.x) + own.x * PATH_JITTER);
    let b = fract(rng_unit(random.y) + own.y * PATH_JITTER);
    let k = f32(index);
    return vec4f(fract((k + a) / f32(count)), fract(k * 0.618034 + b), own.z, fract(k * 0.618034 + rng_unit(random.z)));
}

// The rays of a surface that shows itself to a viewer, to whom a pixel is `footprint` wide there. `told`: means over
// neighbouring pixels are taken of what they find.
fn path_plan(surface: Surface, view: vec3f, footprint: f32, told: bool, under: bool) -> PathPlan {
    let cosine = max(dot(surface.normal, view), 0.0);
    // Neighbouring pixels mirror directions as far apart as this.
    let spread = 2.0 * surface.bend * footprint / max(cosine, 0.2);
    let sharp = surface.roughness < PATH_SHARP || surface.roughness * surface.roughness < spread * PATH_APART;
    let gloss = scatter_gloss(surface.normal_reflectance, surface.roughness, cosine, sharp) * surface.occlusion;
    let body = path_albedo(surface);
    let rays = render_frame.sky_rays;
    let share = select(1.0 / f32(max(rays, 1u)), render_frame.ray_share, told);
    let drawn = told && !sharp && !under && rays > 0u;
    var plan = PathPlan(body, 0u, gloss, rays, 0.0, share, drawn, false, spread);
    if rays == 0u {
        plan.body = body * (vec3f(1.0) - gloss);
    } else if path_most(body) <= 0.0 {
        plan.rays = 0u;
        plan.mirrors = select(1u, rays, drawn);
        plan.replaced = told && !drawn && !under;
    } else if surface.roughness < PATH_MIXED {
        plan.mirrors = select(0u, 1u, path_most(gloss) > select(PATH_MIN_GLOSS, PATH_UNDER_GLOSS, under));
    } else if drawn {
        plan.chance = scatter_chance(body, gloss);
    }
    return plan;
}

// The surface of a puddle that a ray has come through, `distance` along the ray.
fn path_water_surface(water: PuddleWater, start: vec3f, along: vec3f, distance: f32, ripple: vec3f) -> Surface {
    let up = vec3f(0.0, 1.0, 0.0);
    let none = vec3f(0.0);
    let normal = puddle_water_normal(vec3f(ripple.xy, 0.0), 0.0, 0.0);
    // Beckmann's alpha squared is the variance of the slope.
    let roughness = clamp(sqrt(sqrt(ripple.z)), 0.0, 1.0);
    let place = start + along * distance;
    return Surface(place, 1.0, normal, roughness, up, 1.0, none, 0u, vec3f(PUDDLE_WATER_NORMAL), 0.0, none, 0.0);
}

// A ray that water mirrors: drawn from its ripples. Its weight is Fresnel's.
fn path_water_ray(ripple: vec3f, roughness: f32, view: vec3f, cone: f32, a: f32, b: f32) -> ScatterRay {
    let normal = puddle_water_normal(ripple, a, b);
    let along = puddle_water_mirrored(-view, normal);
    let share = optics_fresnel(max(dot(view, normal), PUDDLE_WATER_GRAZING), PUDDLE_WATER_INDEX);
    return ScatterRay(along, cone + PUDDLE_WATER_CONE, vec3f(0.0), roughness, vec3f(share));
}

// A surface as it looks under water of which a fraction `clear` of the light is left.
fn path_soaked(surface: Surface, clear: f32, murk: vec3f) -> Surface {
    var soaked = surface;
    soaked.diffuse = puddle_water_albedo(surface.diffuse * clear + murk * (1.0 - clear));
    soaked.normal_reflectance = puddle_water_reflectance(surface.normal_reflectance) * clear;
    soaked.emission = surface.emission * clear;
    return soaked;
}

// A surface as it looks to rays that are not a mirror's: all that it reflects, it reflects diffusely.
fn path_glance(surface: Surface, roughness: f32) -> Surface {
    var seen = surface;
    if roughness >= PATH_GLANCE {
        seen.diffuse = surface.diffuse + surface.normal_reflectance;
        seen.normal_reflectance = vec3f(0.0);
        seen.roughness = 1.0;
    }
    return seen;
}

// A ray that goes on from what a mirror shows, whose diffuse base takes the mirror's place.
fn path_replaced(ray: ScatterRay, next: ScatterRay) -> ScatterRay {
    var onward = next;
    onward.mirror = ray.mirror * next.mirror;
    onward.roughness = max(ray.roughness, next.roughness);
    return onward;
}

// A ray that goes on from a surface that the ray before has met; without weight if it does not.
fn path_onward(ray: ScatterRay, next: ScatterRay, surface: Surface, number: f32) -> ScatterRay {
    let factor = path_albedo(surface) * next.diffuse + next.mirror;
    let probability = min(path_most(factor), 1.0);
    var onward = next;
    let weight = select(0.0, 1.0 / max(probability, 1.0e-6), number < probability);
    onward.diffuse = ray.diffuse * factor * weight;
    onward.mirror = ray.mirror * factor * weight;
    onward.roughness = max(ray.roughness, next.roughness);
    return onward;
}

// A direction for a ray of the diffuse base, as numbers for scatter_hemisphere, drawn among some of the hemisphere by the
// light of the open sky from each: numbers, and the factor of the ray's weight. What is drawn often counts less (J. Talbot et
// al., EGSR 2005).
fn path_candidate(surface: Surface, a: f32, b: f32, number: f32, share: f32) -> vec3f {
    let sky = sky_irradiance(surface.normal);
    let least = (sky.x + sky.y + sky.z) * PATH_FLOOR + 1.0e-6;
    var sum = 0.0;
    var chosen = vec2f(a, b);
    var weight = 0.0;
    var rest = number;
    for (var k = 0u; k < PATH_CANDIDATES; k += 1u) {
        let x = fract(a + f32(k) / f32(PATH_CANDIDATES));
        let y = fract(b + f32(k) * 0.618034);
        let along = scatter_hemisphere(surface.normal, x, y);
        if dot(surface.facet, along) <= 0.0 {
            continue;
        }
        let width = sqrt(SCATTER_DISC * share / (f32(PATH_CANDIDATES) * sqrt(max(1.0 - x, 0.01))));
        let seen = sky_cone(along, width);
        let light = seen.x + seen.y + seen.z + least;
        sum += light;
        // The part of the interval that is left is as good as a new number.
        if rest * sum < light {
            rest = rest * sum / light;
            chosen = vec2f(x, y);
            weight = light;
        } else {
            rest = (rest * sum - light) / (sum - light);
        }
    }
    return vec3f(chosen, select(0.0, sum / (f32(PATH_CANDIDATES) * weight), weight > 0.0));
}

// Light that falls on the last surface of a path, over pi: the mean of what its surfaces gave, thrown back and forth, and a
// part of the open sky's.
fn path_ambient(surface: Surface, given: vec3f) -> vec3f {
    let albedo = min(surface.diffuse + surface.normal_reflectance, vec3f(1.0));
    let sky = sky_irradiance(surface.normal) * (surface.occlusion * (1.0 - PATH_ENCLOSED));
    return (given * PATH_ENCLOSED + sky) / (vec3f(1.0) - albedo * PATH_ENCLOSED);
}

// What a ray sees. Where it meets the surface that `last` met, it sees the same.
fn path_trace(origin: vec3f, direction: vec3f, cone: f32, random: vec4u, last: ViewPath) -> ViewPath {
    var path = path_nothing();
    var throughput = vec3f(1.0);
    var start = origin;
    var towards = direction;
    var near = render_frame.nearest;
    // Water that the ray has come through, and whether it has met nothing since.
    var water = PuddleWater(PUDDLE_WATER_NONE, 0.0, 0.0, 0.0);
    var wet_row = 0u;
    var clear = 1.0;
    var level = 0.0;
    var under = false;
    for (var layer = 0u; layer < SCENE_LAYERS; layer += 1u) {
        // Turn 0 meets the surface; the others are rays that look for its light. One text for all of them: a shader holds
        // the hierarchy's walk and the materials once.
        var surface = Surface();
        var plan = PathPlan();
        var light = PathLight(vec3f(0.0), vec3f(0.0), 0.0);
        var direct = vec3f(0.0);
        var told = false;
        var of_water = false;
        var ripple = vec3f(0.0);
        // What a mirror shows.
        var shown = Surface();
        var shown_distance = -1.0;
        var shown_weight = vec3f(0.0);
        for (var turn = 0u; turn <= plan.mirrors + plan.rays; turn += 1u) {
            var ray = ScatterRay(towards, cone, vec3f(1.0), 0.0, vec3f(1.0));
            var from_place = start;
            var nearest = near;
            var at = surface;
            var view = -towards;
            var passes = turn == 0u;
            var given = vec3f(0.0);
            for (var bounce = 0u; bounce < PATH_BOUNCES; bounce += 1u) {
                let is_mirror = turn <= plan.mirrors;
                var numbers = vec4f(0.0);
                if turn > 0u {
                    let index = turn - 1u - select(plan.mirrors, 0u, is_mirror);
                    numbers = path_numbers(random, turn, bounce, index, select(plan.rays, plan.mirrors, is_mirror));
                }
                if !passes {
                    let is_first = bounce == 0u;
                    var next = scatter_mirror(at, view);
                    if SCENE_WET && of_water && is_first {
                        next = path_water_ray(ripple, at.roughness, view, cone, numbers.x, numbers.y);
                        light.mirrored += next.mirror.x;
                    } else if plan.drawn || !is_mirror || !is_first {
                        let of_both = scatter_chance(at.diffuse, at.normal_reflectance);
                        let of_first = select(plan.chance, 1.0, is_mirror);
                        let of_gloss = select(of_both, of_first, is_first);
                        let share = select(PATH_LATER_SHARE, plan.share, is_first);
                        var drawn = vec3f(numbers.xy, 1.0);
                        if is_first && numbers.x >= of_gloss {
                            let own = (numbers.x - of_gloss) / (1.0 - of_gloss);
                            drawn = path_candidate(at, own, numbers.y, numbers.z, share);
                            drawn.x = of_gloss + drawn.x * (1.0 - of_gloss);
                        }
                        next = scatter_draw(
                            at, view, select(vec3f(1.0), plan.gloss, is_first), of_gloss, drawn.x, drawn.y, share * drawn.z,
                        );
                        next.diffuse *= drawn.z;
                        next.mirror *= drawn.z;
                    }
                    if SCENE_WET && under && is_first && is_mirror {
                        next.along = puddle_water_above(next.along);
                        next.mirror *= select(0.0, 1.0, next.along.y > 0.0);
                    }
                    from_place = at.position + at.facet * render_frame.nearest;
                    nearest = render_frame.nearest;
                    if is_first {
                        ray = next;
                        ray.width += cone + plan.spread;
                    } else if plan.replaced && bounce == 1u {
                        ray = path_replaced(ray, next);
                    } else {
                        ray = path_onward(ray, next, at, numbers.z);
                    }
                    if path_most(ray.diffuse + ray.mirror) <= 0.0 {
                        break;
                    }
                }
                let hit = surface_hit(from_place, ray.along, nearest, BVH_FAR);
                if hit.distance < 0.0 {
                    if turn == 0u {
                        path.radiance += throughput * sky_level(0u, towards);
                        return path;
                    }
                    let beyond = sky_cone(ray.along, ray.width);
                    light.base += ray.diffuse * beyond;
                    light.mirror += ray.mirror * beyond;
                    break;
                }
                var found = surface_at(hit, from_place, ray.along, ray.width);
                // All lamps, of the first surface; else some drawn for all, at a glance.
                var lamps = 0u;
                var standoff = 0.0;
                var depth = vec2f(0.0);
                var shines = true;
                if turn == 0u {
                    let material = render_corners[hit.triangle * 3u].material;
                    var distance = hit.distance;
                    if SCENE_WET && water.puddle == PUDDLE_WATER_NONE {
                        water = puddle_water_find(found.position, found.facet.y);
                        of_water = water.puddle != PUDDLE_WATER_NONE;
                    }
                    if SCENE_WET && of_water {
                        // Back along the ray to where it came through the surface.
                        distance = max(hit.distance - water.rise / max(-towards.y, 0.01), near);
                        let place = start + towards * distance;
                        let footprint = cone * distance / sqrt(max(-towards.y, 0.02));
                        ripple = puddle_water_ripple(water.puddle, place, footprint, water.depth, water.open);
                        found = path_water_surface(water, start, towards, distance, ripple);
                    } else if layer == 0u
                        && path_same_surface(last, material, found.facet, found.position, hit.distance) {
                        var same = last;
                        same.again = 1.0;
                        return same;
                    }
                    if SCENE_WET && under {
                        let rise = max(level - found.position.y, 0.0);
                        depth = vec2f(rise + max(water.depth - water.rise, 0.0), rise);
                        found = path_soaked(found, clear, bitcast<vec3f>(render_table[wet_row + 4u].xyz));
                    }
                    if layer == 0u {
                        path.distance = distance;
                        path.material = select(material, PUDDLE_WATER_MATERIAL, of_water);
                        path.facet = found.facet;
                        path.place = found.position;
                        path.normal = found.normal;
                        path.shown = found.position;
                        path.slack = distance * (cone * 2.0 + SKYLIGHT_SLACK);
                    }
                    near = hit.distance + render_frame.nearest;
                } else {
                    found = path_glance(found, ray.roughness);
                    lamps = select(1u, PATH_MIRROR_LAMPS, ray.roughness < PATH_GLANCE);
                    standoff = hit.distance * ray.width * 0.5;
                    // Where there are lamps, they stand for what shines; small bright things would be noise.
                    shines = ray.roughness < PATH_SHINES || render_frame.light_count == 0u;
                }
                let unlit = (found.flags & SCENE_UNLIT) != 0u;
                var lit = found.diffuse;
                if !unlit {
                    lit = select(vec3f(0.0), found.emission, shines)
                        + scene_direct(found, -ray.along, lamps, numbers.w, standoff, depth);
                }
                if turn == 0u {
                    surface = found;
                    direct = lit;
                    if SCENE_WET && of_water {
                        let rippled = ripple.z > PUDDLE_WATER_RIPPLED;
                        let turns = max(render_frame.sky_rays, select(1u, PUDDLE_WATER_RAYS, rippled));
                        plan = PathPlan(vec3f(0.0), turns, vec3f(1.0), 0u, 0.0, 1.0, rippled, false, 0.0);
                    } else if !unlit {
                        told = path.met == 0.0 && path_cover(found) == 1.0 && found.transmission == 0.0;
                        plan = path_plan(found, -towards, cone * hit.distance, told, under);
                    }
                    break;
                }
                let cover = path_cover(found);
                light.base += ray.diffuse * lit * cover;
                light.mirror += ray.mirror * lit * cover;
                let open = path_open(found);
                if unlit && cover == 1.0 {
                    break;
                }
                if plan.replaced && bounce == 0u {
                    ray.diffuse = vec3f(0.0);
                    shown = found;
                    shown_distance = hit.distance;
                    shown_weight = ray.mirror;
                }
                var ambient = vec3f(0.0);
                passes = path_most(open) > PATH_OPEN;
                if passes && !unlit {
                    // What it reflects of the sky itself: half of the whole.
                    ambient = sky_irradiance(found.normal) * (0.5 * found.occlusion * cover);
                } else if bounce + 1u == PATH_BOUNCES {
                    ambient = path_ambient(found, (given + lit) / f32(bounce + 1u));
                }
                let own = (found.diffuse * (1.0 - found.transmission) + found.normal_reflectance) * ambient;
                light.base += ray.diffuse * own;
                light.mirror += ray.mirror * own;
                given += lit;
                if passes {
                    ray.diffuse *= open;
                    ray.mirror *= open;
                    from_place = found.position;
                    nearest = render_frame.nearest;
                }
                at = found;
                view = -ray.along;
            }
        }
        let mirrored = towards - surface.normal * (2.0 * dot(towards, surface.normal));
        if SCENE_WET && of_water {
            let share = light.mirrored / f32(plan.mirrors);
            let gloss = throughput * share;
            let mirror = light.mirror / max(light.mirrored, 1.0e-6);
            path.radiance += throughput * direct;
            if plan.drawn && layer == 0u {
                path.gloss = gloss;
                path.mirror = mirror;
                path.roughness = surface.roughness;
                path.mirrored = mirrored;
            } else {
                path.radiance += gloss * mirror;
            }
            throughput *= 1.0 - share;
            // On beneath the surface. Ground that the model does not have is where it would be, seen in the model.
            wet_row = render_frame.puddles + water.puddle * PUDDLE_WATER_ROWS;
            let extinction = bitcast<f32>(render_table[wet_row + 4u].w);
            towards = puddle_water_refracted(towards, surface.normal);
            let steep = max(-towards.y, 0.1);
            clear = exp(-extinction * water.depth * (1.0 / steep + PUDDLE_WATER_DOWN));
            let aside = max(water.depth - water.rise, 0.0) / steep;
            start = surface.position + vec3f(towards.x * aside, 0.0, towards.z * aside)
                - towards * (4.0 * render_frame.nearest);
            level = surface.position.y;
            near = render_frame.nearest;
            under = true;
            continue;
        }
        let cover = path_cover(surface);
        path.radiance += throughput * direct * cover;
        if (surface.flags & SCENE_UNLIT) == 0u {
            var base = light.base / f32(max(plan.rays, 1u));
            var mirror = light.mirror / f32(max(select(plan.mirrors, plan.rays, plan.chance > 0.0), 1u));
            if plan.mirrors + plan.rays == 0u {
                base = sky_irradiance(surface.normal);
                mirror = sky_cone(mirrored, scatter_mirror(surface, -towards).width);
            } else if plan.mirrors == 0u && plan.chance == 0.0 {
                // Too little for rays of its own.
                plan.body += plan.gloss;
                plan.gloss = vec3f(0.0);
            }
            let of_base = throughput * plan.body * cover;
            let of_gloss = throughput * plan.gloss * cover;
            if shown_distance >= 0.0 {
                path.body = of_gloss * shown_weight * path_albedo(shown);
                path.sky = base;
                path.met = 1.0;
                path.plain = 0.0;
                path.normal = shown.normal;
                path.shown = shown.position;
                path.slack += shown_distance * (2.0 * plan.spread + SKYLIGHT_SLACK);
            } else if told {
                path.body = of_base;
                path.sky = base;
                path.met = 1.0;
                path.normal = surface.normal;
                let mirrors = plan.mirrors > 0u && surface.roughness < PATH_CURVED
                    && path_most(plan.gloss) > PATH_PLAIN_GLOSS;
                path.plain = select(1.0, 0.0, mirrors || layer > 0u);
                if layer > 0u {
                    path.shown = surface.position;
                }
            } else {
                path.radiance += of_base * base;
            }
            if told && plan.drawn {
                path.gloss = of_gloss;
                path.mirror = mirror;
                path.roughness = surface.roughness;
                path.mirrored = mirrored;
            } else {
                path.radiance += of_gloss * mirror;
            }
        }
        under = false;
        throughput *= path_open(surface);
        if path_most(throughput) < 1.0e-3 {
            return path;
        }
    }
    return path;
}

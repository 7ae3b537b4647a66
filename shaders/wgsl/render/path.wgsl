// Path of a ray of the camera: surfaces, water, and the light that comes to them from lamps, sky and one another.
// Twin: downpour_trace::path, where the method is described.

// Light of which means are taken over neighboring pixels.
struct PathSlot {
    light: vec3f,
    // Largest distance of another position from the plane; 0: there is no light.
    slack: f32,
    // Factor of the light.
    factor: vec3f,
    // Roughness of a gloss; 0 for light on a diffuse base.
    roughness: f32,
    // The surface's normal; of a gloss, the direction that a mirror would show.
    normal: vec3f,
    // 1 if no ray has looked for the light: it is that of the open sky.
    guessed: u32,
    position: vec3f,
}

// Result of a ray of the camera.
struct ViewPath {
    // All light except what the fields below hold.
    radiance: vec3f,
    // Distance of the first surface (SCENE_FAR for the sky).
    distance: f32,
    facet: vec3f,
    material: u32,
    position: vec3f,
    // 1 if it is the surface that the sample before has seen.
    again: u32,
    // 1 if its result is the same over a pixel: no mirror, nothing behind a pane.
    plain: u32,
    // Light of sky and surfaces on the diffuse base of the first opaque surface, over pi.
    base: PathSlot,
    // Light that the first gloss or mirror shows: of a mirror, on the diffuse base of what stands in it.
    mirror: PathSlot,
}

// Light that rays have found for a surface.
struct PathLight {
    // On its diffuse base, over pi.
    base: vec3f,
    // In its gloss.
    mirror: vec3f,
    // On the diffuse base of what a mirror shows.
    shown: vec3f,
    // Factor of that light, its distance (-1: there is none), and where it is.
    factor: vec3f,
    distance: f32,
    normal: vec3f,
    position: vec3f,
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
    fraction: f32,
    // True if rays of the gloss are drawn from its lobe; else they are a mirror's.
    drawn: bool,
    // True if the light that the gloss shows is averaged over neighboring pixels.
    kept: bool,
    // True if the average is of the light on the surface that the gloss shows.
    replaced: bool,
    // Width of the mirror's ray by what the surface turns within a pixel.
    spread: f32,
    // True if what is averaged over neighboring pixels is left to their rays.
    spared: bool,
    // True if the light on what a mirror shows is left to them, too: also that of a pane, of which else no means are taken.
    shown_spared: bool,
}

// A surface that a ray of the camera has met.
struct PathMeeting {
    surface: Surface,
    direct: vec3f,
    // Light of surfaces that shine, and of lamps with soft shadows, on its diffuse base, over pi.
    glow: vec3f,
    // Light of the latter that its gloss shows, and of the former where it is wide.
    sheen: vec3f,
    // Part of that light that the relief of the surface leaves.
    relief: f32,
    // True if a lamp is hidden in part.
    is_soft: bool,
    plan: PathPlan,
    // True if its light is averaged over neighboring pixels.
    told: bool,
    // Largest distance from its plane at which the surface of a neighboring pixel may be.
    slack: f32,
}

// A path that has found nothing.
fn path_nothing() -> ViewPath {
    var path = ViewPath();
    path.distance = SCENE_FAR;
    path.material = SCENE_NONE;
    return path;
}

// All that a path has seen.
fn path_radiance(path: ViewPath) -> vec3f {
    return path.radiance + path.base.factor * path.base.light + path.mirror.factor * path.mirror.light;
}

// True if a surface is the same that another sample of the pixel has met.
fn path_same_surface(last: ViewPath, material: u32, facet: vec3f, position: vec3f, distance: f32) -> bool {
    return last.plain > 0u
        && last.material == material
        && dot(last.facet, facet) > PATH_SAME_FACET
        && abs(dot(last.facet, position - last.position)) < PATH_SAME_PLANE * distance;
}

// With what a ray brings: `of_shown` for the diffuse base of what a mirror shows.
fn path_accumulated(light: PathLight, ray: ScatterRay, radiance: vec3f, of_shown: bool) -> PathLight {
    var sum = light;
    let of_base = ray.diffuse * radiance;
    if of_shown {
        sum.shown += of_base;
    } else {
        sum.base += of_base;
    }
    sum.mirror += ray.mirror * radiance;
    return sum;
}

// The greatest part of a color.
fn path_max(color: vec3f) -> f32 {
    return max(color.x, max(color.y, color.z));
}

// Fraction of the light on its diffuse base that a surface gives back.
fn path_albedo(surface: Surface) -> vec3f {
    return translucent_albedo(surface) * ((1.0 - surface.transmission) * surface.occlusion);
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

// Fraction of the light that the gloss of a surface shows to a viewer at a cosine.
fn path_gloss(surface: Surface, cosine: f32) -> vec3f {
    let sharp = surface.roughness < PATH_SHARP;
    var gloss = scatter_gloss(surface.normal_reflectance, surface.roughness, cosine, sharp) * surface.occlusion;
    if WET_SURFACES && surface.film > 0.0 {
        // What is above a film is open to the sky.
        let coat = wet_coat(surface.normal_reflectance, surface.roughness, cosine, false);
        gloss += (coat - gloss) * surface.film;
    }
    return gloss;
}

// A surface without its gloss, which is shown otherwise.
fn path_matte(surface: Surface, gloss: vec3f) -> Surface {
    var matte = surface;
    matte.diffuse = surface.diffuse * (vec3f(1.0) - gloss);
    matte.diffuse_transmission = surface.diffuse_transmission * (vec3f(1.0) - gloss);
    matte.normal_reflectance = vec3f(0.0);
    matte.roughness = 1.0;
    matte.film = 0.0;
    return matte;
}

// The rays of a surface that shows itself to a viewer, to whom a pixel is `footprint` wide there. `told`: means over
// neighboring pixels are taken of what they find; `free`: of what the gloss shows, too.
fn path_plan(surface: Surface, view: vec3f, footprint: f32, told: bool, free: bool) -> PathPlan {
    let cosine = max(dot(surface.normal, view), 0.0);
    // Neighboring pixels mirror directions as far apart as this.
    let spread = 2.0 * surface.bend * footprint / max(cosine, 0.2);
    let sharp = surface.roughness < PATH_SHARP;
    let gloss = path_gloss(surface, cosine);
    let body = path_albedo(surface);
    let rays = render_frame.sky_rays;
    let drawn = told && free && !sharp && rays > 0u;
    // If neighbors mirror other things, a mean over them would be wider than the lobe.
    let kept = drawn && surface.roughness * surface.roughness >= spread * PATH_APART;
    let fraction = select(1.0 / f32(max(rays, 1u)), render_frame.ray_fraction, told);
    var plan = PathPlan(body, 0u, gloss, rays, 0.0, fraction, drawn, kept, false, spread, false, false);
    if rays > 0u && path_max(body) <= 0.0 {
        plan.rays = 0u;
        plan.mirrors = select(1u, rays, drawn);
    } else if rays > 0u && surface.roughness < PATH_MIXED {
        plan.mirrors = select(0u, 1u, path_max(gloss) > PATH_MIN_GLOSS);
    } else if kept {
        plan.chance = scatter_chance(body, gloss);
    }
    plan.replaced = free && !kept && plan.mirrors > 0u;
    return plan;
}

// A plan without the rays of which means are taken over neighboring pixels: theirs do.
fn path_spared(plan: PathPlan) -> PathPlan {
    var spared = plan;
    spared.spared = true;
    // A gloss without rays of its own stays without.
    spared.kept = plan.kept && (plan.mirrors > 0u || plan.chance > 0.0);
    spared.rays = 0u;
    if plan.kept {
        spared.mirrors = 0u;
    }
    return spared;
}

// The surface of a puddle that a ray has come through, `distance` along the ray.
fn path_water_surface(start: vec3f, along: vec3f, distance: f32, ripple: vec3f) -> Surface {
    let up = vec3f(0.0, 1.0, 0.0);
    let none = vec3f(0.0);
    let normal = puddle_water_normal(vec3f(ripple.xy, 0.0), 0.0, 0.0);
    // Beckmann's alpha squared is the variance of the slope.
    let roughness = clamp(sqrt(sqrt(ripple.z)), 0.0, 1.0);
    let position = start + along * distance;
    return Surface(position, 1.0, normal, roughness, up, 1.0, none, 0u, vec3f(PUDDLE_WATER_NORMAL), 0.0, none, 0.0, 0.0, 0.0, 0.0, none);
}

// Number of rays that water mirrors, where so many of a pixel look for light in one of `spacing` times `spacing` pixels: of ripples several,
// or as many fewer as pixels look for light less often.
fn path_water_rays(rays: u32, spacing: u32, rippled: bool) -> u32 {
    return max(rays, select(1u, max(PUDDLE_WATER_RAYS / spacing, 1u), rippled));
}

// A ray that water mirrors: drawn from its ripples. Its weight is Fresnel's.
fn path_water_ray(ripple: vec3f, roughness: f32, view: vec3f, cone: f32, a: f32, b: f32) -> ScatterRay {
    let normal = puddle_water_normal(ripple, a, b);
    let along = puddle_water_mirrored(-view, normal);
    let fraction = optics_fresnel(max(dot(view, normal), PUDDLE_WATER_GRAZING), PUDDLE_WATER_INDEX);
    return ScatterRay(along, cone + PUDDLE_WATER_CONE, vec3f(0.0), roughness, vec3f(fraction));
}

// Fraction of light that water mirrors toward a viewer: Fresnel's, in the mean over its ripples. Always the same of them: it
// has no noise.
fn path_water_fraction(ripple: vec3f, view: vec3f) -> f32 {
    let count = select(1u, PATH_WATER_FACETS, ripple.z > PUDDLE_WATER_RIPPLED);
    var sum = 0.0;
    for (var k = 0u; k < count; k += 1u) {
        let normal = puddle_water_normal(ripple, (f32(k) + 0.5) / f32(count), fract(f32(k) * 0.618034));
        sum += optics_fresnel(max(dot(view, normal), PUDDLE_WATER_GRAZING), PUDDLE_WATER_INDEX);
    }
    return sum / f32(count);
}

// A surface as it looks under water of which a fraction `clear` of the light is left.
fn path_submerged(surface: Surface, clear: f32, scattering_albedo: vec3f) -> Surface {
    var wet = surface;
    wet.diffuse = puddle_water_albedo(surface.diffuse * clear + scattering_albedo * (1.0 - clear));
    wet.normal_reflectance = puddle_water_reflectance(surface.normal_reflectance) * clear;
    wet.diffuse_transmission = surface.diffuse_transmission * clear;
    wet.emission = surface.emission * clear;
    wet.film = 0.0;
    return wet;
}

// A surface as it looks along a direction to rays that are not a mirror's: what its gloss reflects, it reflects diffusely.
fn path_secondary(surface: Surface, towards: vec3f, roughness: f32) -> Surface {
    var seen = surface;
    if roughness >= PATH_SECONDARY_ROUGHNESS {
        var open = surface;
        // Of that there is less in gaps, as of what is diffuse.
        open.occlusion = 1.0;
        let gloss = path_gloss(open, max(-dot(surface.normal, towards), 0.0));
        seen = path_matte(surface, gloss);
        seen.diffuse += gloss;
    }
    return seen;
}

// Continuation of a ray from the surface that a mirror shows; its diffuse base replaces the mirror.
fn path_replaced(ray: ScatterRay, next: ScatterRay) -> ScatterRay {
    var onward = next;
    onward.mirror = ray.mirror * next.mirror;
    onward.roughness = max(ray.roughness, next.roughness);
    return onward;
}

// Continuation of a ray from the surface that it met; has no weight if the ray ends there.
fn path_onward(ray: ScatterRay, next: ScatterRay, surface: Surface, number: f32) -> ScatterRay {
    let factor = path_albedo(surface) * next.diffuse + next.mirror;
    let probability = min(path_max(factor), 1.0);
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
fn path_candidate(surface: Surface, a: f32, b: f32, number: f32, fraction: f32) -> vec3f {
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
        let width = sqrt(SCATTER_DISK * fraction / (f32(PATH_CANDIDATES) * sqrt(max(1.0 - x, 0.01))));
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

// Light that falls on the last surface of a path, over pi: the mean of what its surfaces gave, thrown back and forth. A path that has met
// so many is enclosed by them, and sees no open sky.
fn path_ambient(surface: Surface, given: vec3f) -> vec3f {
    let albedo = min(surface.diffuse + surface.normal_reflectance, vec3f(1.0));
    return given * PATH_ENCLOSED / (vec3f(1.0) - albedo * PATH_ENCLOSED);
}

// A ray drawn for a surface, which the ray before leaves as `leaves` says.
fn path_draw(surface: Surface, viewer: vec3f, plan: PathPlan, leaves: u32, is_mirror: bool, numbers: vec4f) -> ScatterRay {
    var at = surface;
    var view = viewer;
    var a = numbers.x;
    var b = numbers.y;
    // Factors of the light on the diffuse base, and in the gloss.
    var of_side = vec3f(1.0);
    var of_gloss = 1.0;
    var gloss = vec3f(1.0);
    var chance = scatter_chance(at.diffuse, at.normal_reflectance);
    var fraction = PATH_LATER_FRACTION;
    var weight = 1.0;
    if leaves == PATH_SHOWN {
        chance = 0.0;
    }
    if leaves == PATH_FIRST {
        gloss = plan.gloss;
        chance = select(plan.chance, 1.0, is_mirror);
        fraction = plan.fraction;
        if translucent_is(at) && !is_mirror {
            // One side is drawn, with the gloss for the viewer's.
            let behind = (1.0 - chance) * translucent_chance(at);
            let part = translucent_part(at);
            if fract(numbers.w * PATH_OTHER) < behind {
                of_side = part / behind;
                at = translucent_behind(at);
                view = -view;
                chance = 0.0;
            } else {
                of_side = (vec3f(1.0) - part) / (1.0 - behind);
                of_gloss = 1.0 / (1.0 - behind);
                chance *= of_gloss;
            }
        }
        if is_mirror && !plan.kept {
            // Few rays: far out in the lobe they would be noise.
            fraction = PATH_CURVED_FRACTION;
            a = a * PATH_CURVED_PART;
        }
        if a >= chance {
            let own = (a - chance) / (1.0 - chance);
            let drawn = path_candidate(at, own, b, numbers.z, fraction);
            a = chance + drawn.x * (1.0 - chance);
            b = drawn.y;
            weight = drawn.z;
            fraction /= f32(PATH_CANDIDATES);
        }
    }
    var ray = scatter_draw(at, view, gloss, chance, a, b, fraction);
    ray.diffuse *= of_side * weight;
    ray.mirror *= of_gloss * weight;
    return ray;
}

// A path with the light on what a mirror shows; the same path if it shows no diffuse base.
fn path_show_mirrored(path: ViewPath, light: PathLight, gloss: vec3f, meeting: PathMeeting) -> ViewPath {
    var shown = path;
    if light.distance >= 0.0 {
        let slack = meeting.slack + light.distance * (2.0 * meeting.plan.spread + SKYLIGHT_SLACK);
        shown.mirror = PathSlot(light.shown, slack, gloss * light.factor, 0.0, light.normal, select(0u, 1u, meeting.plan.shown_spared), light.position);
    }
    return shown;
}

// The direction that a mirror in the plane of a surface would show.
fn path_mirrored(surface: Surface, towards: vec3f) -> vec3f {
    return towards - surface.normal * (2.0 * dot(towards, surface.normal));
}

// A path with what water mirrors, which is a fraction of the light.
fn path_show_water(
    path: ViewPath, meeting: PathMeeting, light: PathLight, fraction: f32, towards: vec3f, throughput: vec3f,
) -> ViewPath {
    var shown = path;
    let surface = meeting.surface;
    let all = f32(max(meeting.plan.mirrors, 1u));
    shown.radiance += throughput * (meeting.direct + meeting.sheen);
    if meeting.plan.kept {
        shown.mirror = PathSlot(
            light.mirror / max(all * fraction, 1.0e-6), meeting.slack, throughput * fraction, surface.roughness,
            path_mirrored(surface, towards), 0u, surface.position,
        );
        return shown;
    }
    shown.radiance += throughput * light.mirror / all;
    return path_show_mirrored(shown, light, throughput / all, meeting);
}

// A path with what a surface shows.
fn path_show(
    path: ViewPath, meeting: PathMeeting, light: PathLight, towards: vec3f, layer: u32, throughput: vec3f,
) -> ViewPath {
    var shown = path;
    let surface = meeting.surface;
    var plan = meeting.plan;
    let cover = path_cover(surface);
    shown.radiance += throughput * meeting.direct * cover;
    if (surface.flags & SCENE_UNLIT) != 0u {
        return shown;
    }
    let mirrored = path_mirrored(surface, towards);
    let rays_of_gloss = select(plan.mirrors, plan.rays, plan.chance > 0.0);
    var base = light.base / f32(max(plan.rays, 1u)) + meeting.glow;
    var mirror = light.mirror / f32(max(rays_of_gloss, 1u));
    let guessed = select(0u, 1u, plan.spared);
    if plan.spared {
        base = translucent_sky(surface) + meeting.glow;
        if plan.kept {
            mirror = sky_cone(mirrored, scatter_mirror(surface, -towards).width);
        }
    }
    if plan.mirrors + plan.rays == 0u && !plan.spared {
        base = translucent_sky(surface) * (vec3f(1.0) - plan.gloss) + meeting.glow;
        mirror = sky_cone(mirrored, scatter_mirror(surface, -towards).width);
    } else if plan.mirrors == 0u && plan.chance == 0.0 && !(plan.spared && plan.kept) {
        // Too faint to trace rays for it.
        base -= meeting.glow * plan.gloss / max(plan.body + plan.gloss, vec3f(1.0e-9));
        plan.body += plan.gloss;
        plan.gloss = vec3f(0.0);
    }
    let gloss = min(plan.gloss.x, min(plan.gloss.y, plan.gloss.z));
    let body = min(plan.body.x, min(plan.body.y, plan.body.z)) * meeting.relief;
    if plan.kept && gloss > PATH_MIN_FACTOR {
        mirror += meeting.sheen / plan.gloss;
    } else if meeting.told && path_max(plan.gloss) <= 0.0 && body > PATH_MIN_FACTOR {
        base += meeting.sheen / (plan.body * meeting.relief);
    } else {
        shown.radiance += throughput * meeting.sheen * cover;
    }
    let of_base = throughput * plan.body * (cover * meeting.relief);
    let of_gloss = throughput * plan.gloss * cover;
    if meeting.told {
        shown.base = PathSlot(base, meeting.slack, of_base, 0.0, surface.normal, guessed, surface.position);
        let mirrors = (plan.mirrors > 0u || plan.spared && path_max(plan.body) <= 0.0) && (surface.roughness < PATH_CURVED || !plan.kept)
            && path_max(plan.gloss) > PATH_PLAIN_GLOSS;
        shown.plain = select(1u, 0u, mirrors || layer > 0u || meeting.is_soft);
    } else {
        shown.radiance += of_base * base;
    }
    if plan.kept {
        shown.mirror = PathSlot(mirror, meeting.slack, of_gloss, surface.roughness, mirrored, guessed, surface.position);
        return shown;
    }
    shown.radiance += of_gloss * mirror;
    return path_show_mirrored(shown, light, of_gloss, meeting);
}

// Traces a ray. If it meets the surface that `last` met, it sees the same. `spared`: light of which means are taken over neighboring
// pixels is left to their rays.
fn path_trace(origin: vec3f, direction: vec3f, cone: f32, random: vec4u, last: ViewPath, spared: bool) -> ViewPath {
    var path = path_nothing();
    var throughput = vec3f(1.0);
    var start = origin;
    var towards = direction;
    var near = render_frame.nearest;
    // Water that the ray has come through, and whether it has met nothing since.
    var water = PuddleWater(PUDDLE_WATER_NONE, 0.0, 0.0, 0.0);
    var scattering_albedo = vec3f(0.0);
    var clear = 1.0;
    var level = 0.0;
    var under = false;
    var wet = RenderWet();
    if WET_SURFACES {
        wet = wet_load();
    }
    // Widened by drops on panes.
    var width = cone;
    for (var layer = 0u; layer < SCENE_LAYERS; layer += 1u) {
        // Turn 0 meets the surface; the others are rays that look for its light. One text for all of them: a shader holds
        // the hierarchy's walk and the materials once.
        var meeting = PathMeeting();
        meeting.relief = 1.0;
        var light = PathLight();
        light.distance = -1.0;
        var of_water = false;
        var ripple = vec3f(0.0);
        var drop = GlazingWater();
        for (var turn = 0u; turn <= meeting.plan.mirrors + meeting.plan.rays; turn += 1u) {
            var ray = ScatterRay(towards, width, vec3f(1.0), 0.0, vec3f(1.0));
            var from_position = start;
            var nearest = near;
            var at = meeting.surface;
            var view = -towards;
            var leaves = select(PATH_FIRST, PATH_STRAIGHT, turn == 0u);
            var given = vec3f(0.0);
            // Roughness of the gloss that the ray follows.
            var followed = 1.0;
            let is_mirror = turn <= meeting.plan.mirrors;
            let of_shown = meeting.plan.replaced && is_mirror;
            for (var bounce = 0u; bounce < PATH_BOUNCES; bounce += 1u) {
                var numbers = vec4f(0.0);
                if turn > 0u {
                    let index = turn - 1u - select(meeting.plan.mirrors, 0u, is_mirror);
                    numbers = path_lattice_numbers(random, turn, bounce, index, select(meeting.plan.rays, meeting.plan.mirrors, is_mirror));
                }
                if leaves != PATH_STRAIGHT {
                    let is_first = leaves == PATH_FIRST;
                    var next = ScatterRay();
                    if SCENE_WET && of_water && is_first {
                        next = path_water_ray(ripple, at.roughness, view, cone, numbers.x, numbers.y);
                    } else if leaves == PATH_MIRROR || (is_first && is_mirror && !meeting.plan.drawn) {
                        next = scatter_mirror(at, view);
                    } else {
                        next = path_draw(at, view, meeting.plan, leaves, is_mirror, numbers);
                    }
                    let behind = translucent_is(at) && dot(at.facet, next.along) < 0.0;
                    from_position = at.position + at.facet * select(render_frame.nearest, -render_frame.nearest, behind);
                    nearest = render_frame.nearest;
                    if is_first {
                        if SCENE_WET && under && is_mirror {
                            next.along = puddle_water_above(next.along);
                            next.mirror *= select(0.0, 1.0, next.along.y > 0.0);
                        }
                        ray = next;
                        ray.width += cone + meeting.plan.spread;
                        followed = at.roughness;
                    } else if leaves == PATH_MIRROR {
                        next.mirror = ray.mirror * brdf_fresnel(at.normal_reflectance, at.film, max(dot(at.normal, view), 0.0));
                        next.width += ray.width;
                        ray = next;
                        followed = max(followed, at.roughness);
                    } else {
                        if leaves == PATH_SHOWN {
                            ray = path_replaced(ray, next);
                        } else {
                            ray = path_onward(ray, next, at, numbers.z);
                        }
                        followed = 1.0;
                    }
                    if path_max(ray.diffuse + ray.mirror) <= 0.0 {
                        break;
                    }
                }
                let hit = surface_hit(from_position, ray.along, nearest, BVH_FAR);
                if hit.distance < 0.0 {
                    if turn == 0u {
                        var beyond = vec3f(0.0);
                        if WET_SURFACES && GLAZING_PANES && width > cone {
                            beyond = sky_cone(towards, width);
                        } else {
                            beyond = sky_level(0u, towards) + scene_suns(towards);
                        }
                        path.radiance += throughput * beyond;
                        return path;
                    }
                    light = path_accumulated(light, ray, sky_cone(ray.along, ray.width), of_shown);
                    break;
                }
                if turn == 0u {
                    let facet = surface_facet(hit, towards);
                    let position = start + towards * hit.distance;
                    if SCENE_WET && water.puddle == PUDDLE_WATER_NONE {
                        water = puddle_water_find(position, facet.y);
                        of_water = water.puddle != PUDDLE_WATER_NONE;
                    }
                    let material = render_corners[hit.triangle * 3u].material;
                    if layer == 0u && !of_water && path_same_surface(last, material, facet, position, hit.distance) {
                        var same = last;
                        same.again = 1u;
                        return same;
                    }
                }
                var found = surface_at(hit, from_position, ray.along, ray.width, select(1.0, TEXTURE_TAPS, turn == 0u));
                var wetness = 0.0;
                if WET_SURFACES && bounce == 0u && !under {
                    wetness = wet_exposure(found, wet);
                }
                if WET_SURFACES && wetness > 0.0 {
                    var footprint = WET_FAR;
                    if turn == 0u {
                        footprint = ray.width * hit.distance / sqrt(max(-dot(found.facet, ray.along), 0.02));
                    }
                    found = wet_surface(found, wetness, ray.along, wet_relief(found.position + wet.shift, footprint));
                }
                if WET_SURFACES && GLAZING_PANES && turn == 0u && !under && render_frame.projection == SCENE_PICTURE {
                    let footprint = width * hit.distance / max(-dot(found.facet, towards), 0.1);
                    drop = glazing_find(found, render_corners[hit.triangle * 3u].material, footprint, wet);
                    found = glazing_surface(found, drop);
                }
                // All lamps for the first surface; for others, some sampled lamps.
                var lamps = 0u;
                var seen_from = -ray.along;
                var standoff = 0.0;
                var depth = vec2f(0.0);
                var emission = found.emission;
                if turn == 0u {
                    let material = render_corners[hit.triangle * 3u].material;
                    var distance = hit.distance;
                    if SCENE_WET && of_water {
                        // Back along the ray to where it came through the surface.
                        distance = max(hit.distance - water.rise / max(-towards.y, 0.01), near);
                        let position = start + towards * distance;
                        let footprint = cone * distance / sqrt(max(-towards.y, 0.02));
                        ripple = puddle_water_ripple(water.puddle, position, footprint, water.depth, water.open)
                            + puddle_wake_slope(water.puddle, position, footprint, water.depth);
                        found = path_water_surface(start, towards, distance, ripple);
                    }
                    if SCENE_WET && under {
                        let rise = max(level - found.position.y, 0.0);
                        depth = vec2f(rise + max(water.depth - water.rise, 0.0), rise);
                        found = path_submerged(found, clear, scattering_albedo);
                    }
                    if layer == 0u {
                        path.distance = distance;
                        path.material = select(material, PUDDLE_WATER_MATERIAL, of_water);
                        path.facet = found.facet;
                        path.position = found.position;
                    }
                    if IMPOSTOR_REFLECTIONS && !under && render_frame.projection == SCENE_PICTURE {
                        if SCENE_WET && of_water {
                            let fraction = path_water_fraction(ripple, -towards);
                            path.radiance += throughput * impostor_mirrored(found.facet, found.normal, towards) * fraction;
                            found.flags |= SCENE_UNLIT;
                        } else if found.film > 0.0 && found.porosity > 0.0 {
                            // What is smooth shows its own rays, as it does when it is dry.
                            let gloss = path_gloss(found, max(-dot(found.normal, towards), 0.0));
                            path.radiance += throughput * impostor_mirrored(found.facet, found.normal, towards) * gloss;
                            found = path_matte(found, gloss);
                        }
                    }
                    near = hit.distance + render_frame.nearest;
                    meeting.told = path.base.slack == 0.0 && path_cover(found) == 1.0 && found.transmission == 0.0;
                } else {
                    found = path_secondary(found, ray.along, ray.roughness);
                    if translucent_is(found) {
                        let facet = found.facet;
                        found = translucent_drawn(found, fract(numbers.w * TRANSLUCENT_SIDE));
                        seen_from *= sign(dot(found.facet, facet));
                    }
                    lamps = select(1u, PATH_MIRROR_LAMPS, ray.roughness < PATH_SECONDARY_ROUGHNESS);
                    standoff = hit.distance * ray.width * 0.5;
                    // Surfaces that shine are lights: rays see them in a gloss only.
                    emission = vec3f(0.0);
                    if followed < select(SCENE_SEEN_AREA, SCENE_SEEN_BODY, (found.flags & SCENE_LAMP_GLASS) != 0u) {
                        light.mirror += ray.mirror * found.emission * path_cover(found);
                    }
                }
                let unlit = (found.flags & SCENE_UNLIT) != 0u;
                var lit = found.diffuse;
                if !unlit {
                    let is_lamp = (found.flags & SCENE_LAMP_GLASS) != 0u;
                    let all_out = render_frame.suns_out == SCENE_ALL_OUT;
                    if (is_lamp || all_out) && render_frame.projection != SCENE_PICTURE && render_frame.suns_out > 0u {
                        // Drops are lit by lamps on their own.
                        emission = vec3f(0.0);
                    }
                    var chances = vec4f(fract(numbers.xyz * PATH_OTHER), numbers.w);
                    if turn == 0u {
                        // The lattice has few points along its third axis: each pixel is somewhere between them.
                        let first = path_lattice_numbers(random, 0u, 0u, 0u, 1u);
                        // Of lamps no means over neighbors are taken, where a lattice would be seen.
                        chances = vec4f(first.xy, fract(first.w + first.z * PATH_BETWEEN), first.z);
                    }
                    let lamplight = scene_direct(
                        found, seen_from, lamps, chances, standoff, depth, turn == 0u, cone * hit.distance,
                        turn == 0u && spared && meeting.told,
                    );
                    lit = emission + lamplight.lit;
                    if turn == 0u {
                        // What is told apart goes with the rest of the light on the diffuse base, which has the material's occlusion.
                        meeting.glow = lamplight.glow / max(found.occlusion, PATH_OCCLUSION);
                        meeting.sheen = lamplight.sheen;
                        meeting.is_soft = lamplight.is_soft;
                        let rest = max(light_weight(sky_irradiance(found.normal)), 1.0e-9);
                        meeting.relief = (rest + lamplight.relief_light) / (rest + lamplight.flat_light);
                    }
                }
                if turn == 0u {
                    meeting.surface = found;
                    meeting.direct = lit;
                    let free = path.mirror.slack == 0.0;
                    if SCENE_WET && of_water && !unlit {
                        let rippled = ripple.z > PUDDLE_WATER_RIPPLED;
                        meeting.plan.mirrors = path_water_rays(render_frame.sky_rays, render_frame.ray_spacing, rippled);
                        meeting.plan.gloss = vec3f(1.0);
                        meeting.plan.fraction = 1.0;
                        meeting.plan.drawn = rippled && free;
                        meeting.plan.kept = meeting.plan.drawn;
                        meeting.plan.replaced = !rippled && free;
                    } else if !unlit {
                        meeting.plan = path_plan(found, -towards, cone * hit.distance, meeting.told, free && !under);
                        if spared && meeting.told && render_frame.sky_rays > 0u {
                            meeting.plan = path_spared(meeting.plan);
                        }
                    }
                    meeting.plan.shown_spared = spared && meeting.plan.replaced && render_frame.sky_rays > 0u;
                    // Neighboring pixels are on one plane if they are no farther from it than this.
                    let from_eye = found.position - origin;
                    meeting.slack = sqrt(dot(from_eye, from_eye)) * (cone * 2.0 + SKYLIGHT_SLACK);
                    break;
                }
                let cover = path_cover(found);
                light = path_accumulated(light, ray, lit * cover, of_shown);
                if unlit && cover == 1.0 {
                    break;
                }
                let open = path_open(found);
                var ambient = vec3f(0.0);
                leaves = PATH_ONWARD;
                if path_max(open) > PATH_OPEN {
                    leaves = PATH_STRAIGHT;
                    if !unlit {
                        // Light of the sky that it reflects itself: half of the whole.
                        ambient = sky_irradiance(found.normal) * (0.5 * found.occlusion * cover);
                    }
                } else if of_shown && light.distance < 0.0 {
                    leaves = PATH_MIRROR;
                    if path_max(path_albedo(found)) > 0.0 || found.roughness >= PATH_SECONDARY_ROUGHNESS {
                        leaves = PATH_SHOWN;
                        found = path_secondary(found, ray.along, 1.0);
                        light.factor = ray.mirror * path_albedo(found);
                        light.distance = hit.distance;
                        light.normal = found.normal;
                        light.position = found.position;
                        if meeting.plan.shown_spared {
                            light.shown = sky_irradiance(found.normal);
                            break;
                        }
                    }
                } else if bounce + 1u == PATH_BOUNCES {
                    ambient = path_ambient(found, (given + lit) / f32(bounce + 1u));
                }
                let own = (path_albedo(found) + found.normal_reflectance) * ambient;
                light = path_accumulated(light, ray, own, of_shown);
                given += lit;
                if leaves == PATH_STRAIGHT {
                    ray.diffuse *= open;
                    ray.mirror *= open;
                    from_position = found.position;
                    nearest = render_frame.nearest;
                }
                at = found;
                view = seen_from;
            }
        }
        let surface = meeting.surface;
        if SCENE_WET && of_water {
            let fraction = path_water_fraction(ripple, -towards);
            path = path_show_water(path, meeting, light, fraction, towards, throughput);
            throughput *= 1.0 - fraction;
            // On beneath the surface. Ground that the model does not have is where it would be, seen in the model.
            let puddle = puddle_load(water.puddle);
            scattering_albedo = puddle.scattering_albedo;
            towards = puddle_water_refracted(towards, surface.normal);
            let steep = max(-towards.y, 0.1);
            clear = exp(-puddle.extinction * water.depth * (1.0 / steep + PUDDLE_WATER_DOWN));
            let aside = max(water.depth - water.rise, 0.0) / steep;
            start = surface.position + vec3f(towards.x * aside, 0.0, towards.z * aside)
                - towards * (4.0 * render_frame.nearest);
            level = surface.position.y;
            near = render_frame.nearest;
            under = true;
            continue;
        }
        path = path_show(path, meeting, light, towards, layer, throughput);
        under = false;
        let open = path_open(surface);
        throughput *= open;
        if WET_SURFACES && GLAZING_PANES && drop.bend > 0.0 {
            width *= 1.0 + (PUDDLE_WATER_INDEX - 1.0) * drop.bend * (near - render_frame.nearest);
            throughput *= glazing_open(surface, meeting.plan.gloss, towards, open);
            let facet = select(-surface.facet, surface.facet, dot(surface.facet, drop.normal) > 0.0);
            towards = glazing_through(towards, drop.normal, facet);
            start = surface.position;
            near = 4.0 * render_frame.nearest;
        }
        if path_max(throughput) < 1.0e-3 {
            return path;
        }
    }
    return path;
}

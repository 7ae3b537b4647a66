// The picture of a scene: rays from the eye, light of lamps and sun with shadow rays, light of the sky with rays that
// find what hides it.
// Twin: downpour_render::scene, where the method is described.

@group(0) @binding(7) var<storage, read_write> scene_picture: array<vec4f>;

struct SceneLight {
    // From the surface to the light, of length 1.
    direction: vec3f,
    distance: f32,
    // Irradiance over pi on a surface that faces it.
    irradiance: vec3f,
    unused: f32,
}

// The light of row `index` at a place.
fn scene_light(index: u32, place: vec3f) -> SceneLight {
    let row = render_frame.lights + index * SCENE_LIGHT_ROWS;
    let position = bitcast<vec4f>(render_table[row]);
    let axis = bitcast<vec4f>(render_table[row + 1u]);
    let colour = bitcast<vec4f>(render_table[row + 2u]);
    let cone = bitcast<vec4f>(render_table[row + 3u]);
    if render_table[row].w == SCENE_LIGHT_DIRECTIONAL {
        return SceneLight(-axis.xyz, SCENE_FAR, colour.rgb, 0.0);
    }
    let offset = position.xyz - place;
    let square = max(dot(offset, offset), 1.0e-8);
    let distance = sqrt(square);
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
        let hit = surface_hit(place, direction, from_distance);
        if hit.distance < 0.0 || hit.distance >= distance - render_frame.nearest {
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

// Light of lamps and sun on a surface, towards the viewer.
fn scene_direct(surface: Surface, view: vec3f) -> vec3f {
    let alpha = max(surface.roughness * surface.roughness, SCENE_LEAST_ROUGHNESS * SCENE_LEAST_ROUGHNESS);
    let start = surface.position + surface.facet * render_frame.nearest;
    var sum = vec3f(0.0);
    for (var k = 0u; k < render_frame.light_count; k += 1u) {
        let light = scene_light(k, surface.position);
        if dot(surface.facet, light.direction) <= 0.0 || dot(light.irradiance, vec3f(1.0)) <= 0.0 {
            continue;
        }
        let reflected = brdf_direct(
            surface.diffuse, surface.normal_reflectance, alpha, surface.normal, view, light.direction,
        );
        if dot(reflected, vec3f(1.0)) <= 0.0 {
            continue;
        }
        let visible = scene_visibility(start, light.direction, light.distance);
        sum += reflected * light.irradiance * visible;
    }
    return sum;
}

// What a surface shows at a glance: lamps, and half of the whole sky.
fn scene_glance(surface: Surface, view: vec3f) -> vec3f {
    if (surface.flags & SCENE_UNLIT) != 0u {
        return surface.diffuse + surface.normal_reflectance;
    }
    let sky = sky_irradiance(surface.normal) * surface.occlusion;
    return surface.emission + scene_direct(surface, view) + (surface.diffuse + surface.normal_reflectance) * sky * 0.5;
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

// Light of the sky on a surface over pi, and, in w, the share of the sky that is seen.
fn scene_sky_light(surface: Surface, random: vec4u) -> vec4f {
    if render_frame.sky_rays == 0u {
        return vec4f(sky_irradiance(surface.normal), 1.0);
    }
    let start = surface.position + surface.facet * render_frame.nearest;
    var sum = vec3f(0.0);
    var seen = 0.0;
    for (var k = 0u; k < render_frame.sky_rays; k += 1u) {
        let direction = scene_hemisphere(surface.normal, k, render_frame.sky_rays, random);
        if dot(direction, surface.facet) <= 0.0 {
            continue;
        }
        let hit = surface_hit(start, direction, render_frame.nearest);
        if hit.distance < 0.0 || hit.distance > render_frame.sky_reach {
            sum += sky_level(SCENE_SKY_LEVELS - 1u, direction);
            seen += 1.0;
        } else {
            let other = surface_at(hit, start, direction, 0.05);
            sum += scene_glance(other, -direction);
        }
    }
    return vec4f(sum, seen) / f32(render_frame.sky_rays);
}

// What a ray sees, and the distance of the first surface (SCENE_FAR for the sky).
fn scene_radiance(origin: vec3f, direction: vec3f, cone: f32, random: vec4u) -> vec4f {
    var throughput = vec3f(1.0);
    var radiance = vec3f(0.0);
    var from_distance = render_frame.nearest;
    var first = SCENE_FAR;
    for (var layer = 0u; layer < SCENE_LAYERS; layer += 1u) {
        let hit = surface_hit(origin, direction, from_distance);
        if hit.distance < 0.0 {
            return vec4f(radiance + throughput * sky_level(0u, direction), first);
        }
        first = min(first, hit.distance);
        let surface = surface_at(hit, origin, direction, cone);
        var shown = surface.diffuse + surface.normal_reflectance;
        if (surface.flags & SCENE_UNLIT) == 0u {
            let view = -direction;
            let sky = scene_sky_light(surface, random);
            let cosine = max(dot(surface.normal, view), 0.0);
            let mirrored = direction - surface.normal * (2.0 * dot(direction, surface.normal));
            // Where the sky is hidden, so is most of its reflection.
            let open = sky.w * sky.w * 0.9 + 0.1;
            let reflection = sky_reflection(mirrored, surface.roughness) * open;
            let gloss = brdf_environment(surface.normal_reflectance, surface.roughness, cosine);
            let body = surface.diffuse * (1.0 - surface.transmission) * (vec3f(1.0) - gloss);
            shown = surface.emission + scene_direct(surface, view)
                + (body * sky.rgb + gloss * reflection) * surface.occlusion;
        }
        var share = 1.0;
        var tint = vec3f(0.0);
        if (surface.flags & SCENE_BLENDED) != 0u {
            share = clamp(surface.alpha, 0.0, 1.0);
            tint = vec3f(1.0);
        }
        radiance += throughput * shown * share;
        let through = tint * (1.0 - share) + surface.diffuse * surface.transmission * share;
        throughput *= through;
        if max(throughput.x, max(throughput.y, throughput.z)) < 1.0e-3 {
            return vec4f(radiance, first);
        }
        from_distance = hit.distance + render_frame.nearest;
    }
    return vec4f(radiance, first);
}

// The direction of the ray through a place of the picture, in pixels from the top left.
fn scene_direction(x: f32, y: f32) -> vec3f {
    let u = 2.0 * x / f32(render_frame.width) - 1.0;
    let v = 1.0 - 2.0 * y / f32(render_frame.height);
    let direction = render_frame.forward + render_frame.right * u + render_frame.up * v;
    return direction / sqrt(dot(direction, direction));
}

// A pixel: mean radiance, and the distance of what stands nearest in it.
fn scene_pixel(x: u32, y: u32) -> vec4f {
    var sum = vec3f(0.0);
    var nearest = SCENE_FAR;
    let n = render_frame.grid;
    for (var k = 0u; k < n * n; k += 1u) {
        let random = rng_draw(
            vec2u(render_frame.seed, 0u), y * render_frame.width + x, k, SCENE_RANDOM_DIMENSION,
        );
        let dx = (f32(k % n) + 0.5) / f32(n);
        let dy = (f32(k / n) + 0.5) / f32(n);
        let direction = scene_direction(f32(x) + dx, f32(y) + dy);
        let seen = scene_radiance(render_frame.eye, direction, render_frame.pixel_angle, random);
        sum += seen.rgb;
        nearest = min(nearest, seen.w);
    }
    return vec4f(sum / f32(n * n), nearest);
}

@compute @workgroup_size(8, 8, 1)
fn main_scene(@builtin(global_invocation_id) id: vec3u) {
    let y = id.y + render_frame.first_row;
    if id.x >= render_frame.width || y >= render_frame.height {
        return;
    }
    scene_picture[y * render_frame.width + id.x] = scene_pixel(id.x, y);
}

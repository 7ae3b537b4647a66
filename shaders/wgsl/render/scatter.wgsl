// Sampling of the light that a surface shows: rays drawn for its diffuse base and for its gloss.
// Twin: downpour_trace::scatter, where the method is described.

// A ray that looks for light.
struct ScatterRay {
    // Direction, of length 1.
    along: vec3f,
    // Width at distance 1.
    width: f32,
    // Weight of its light for the diffuse base, per albedo.
    diffuse: vec3f,
    // Roughness of the surface that it has left; 1 for rays of the diffuse base.
    roughness: f32,
    // Weight of its light for the gloss, per what the gloss is multiplied with.
    mirror: vec3f,
}

// A unit vector across a normal.
fn scatter_tangent(normal: vec3f) -> vec3f {
    // T. Duff et al., JCGT 6(1), 2017.
    let side = packing_sign(normal.z);
    let p = -1.0 / (side + normal.z);
    return vec3f(1.0 + side * normal.x * normal.x * p, side * (normal.x * normal.y * p), -side * normal.x);
}

// A direction over the hemisphere around a normal, cosine-weighted, for two numbers in [0, 1).
fn scatter_hemisphere(normal: vec3f, a: f32, b: f32) -> vec3f {
    let radius = sqrt(a);
    let angle = 6.2831853 * b;
    let height = sqrt(max(1.0 - a, 0.0));
    let tangent = scatter_tangent(normal);
    let other = cross(normal, tangent);
    return tangent * (radius * cos(angle)) + other * (radius * sin(angle)) + normal * height;
}

// A direction, thrown back by the facet if it goes into it: at the rim of a round thing, interpolated normals send it there.
fn scatter_above(facet: vec3f, along: vec3f) -> vec3f {
    return along - facet * (2.0 * min(dot(facet, along), 0.0));
}

// Alpha of the lobe of a roughness.
fn scatter_alpha(roughness: f32) -> f32 {
    return max(roughness * roughness, SCATTER_MIN_ALPHA);
}

// Fraction of a uniform environment that the gloss of a surface shows. `sharp`: of a mirror.
fn scatter_gloss(normal_reflectance: vec3f, roughness: f32, cosine: f32, sharp: bool) -> vec3f {
    if sharp {
        return brdf_fresnel(normal_reflectance, 0.0, cosine);
    }
    return brdf_environment(normal_reflectance, roughness, cosine);
}

// A ray of a surface: of its gloss where `a` is below `chance`, else of its diffuse base. `view` points to the viewer,
// `gloss` is what the weight of the gloss is divided by, `fraction` the part of all rays that this is.
fn scatter_draw(
    surface: Surface, view: vec3f, gloss: vec3f, chance: f32, a: f32, b: f32, fraction: f32,
) -> ScatterRay {
    let normal = surface.normal;
    let alpha = scatter_alpha(surface.roughness);
    let cosine_view = max(dot(normal, view), BRDF_GRAZING);
    var along = normal;
    var roughness = 1.0;
    if a < chance {
        let tangent = scatter_tangent(normal);
        let other = cross(normal, tangent);
        let local = vec3f(dot(view, tangent), dot(view, other), cosine_view);
        let drawn = brdf_visible_normal(local, alpha, a / chance, b);
        let half = tangent * drawn.x + other * drawn.y + normal * drawn.z;
        along = half * (2.0 * dot(view, half)) - view;
        roughness = surface.roughness;
    } else {
        along = scatter_hemisphere(along, (a - chance) / (1.0 - chance), b);
    }
    // Rays into the surface are lost; only rays into the facet alone are thrown back.
    let above = dot(normal, along) > 0.0;
    along = scatter_above(surface.facet, along);
    var ray = ScatterRay(along, 0.0, vec3f(0.0), roughness, vec3f(0.0));
    let cosine = dot(normal, along);
    if !above || cosine <= 0.0 {
        return ray;
    }
    let sum = view + along;
    let halfway = sum / max(sqrt(dot(sum, sum)), SCATTER_MIN_DIVISOR);
    let cosine_half = clamp(dot(normal, halfway), 0.0, 1.0);
    let fresnel = brdf_fresnel(surface.normal_reflectance, surface.film, dot(view, halfway));
    // All densities times pi.
    let glossy = brdf_visible_density(alpha, cosine_half, cosine_view);
    let density = max(glossy * chance + cosine * (1.0 - chance), SCATTER_MIN_DIVISOR);
    ray.width = min(sqrt(SCATTER_DISK * fraction / density), SCATTER_MAX_WIDTH);
    if chance < 1.0 {
        ray.diffuse = (vec3f(1.0) - fresnel) * (cosine / density);
        if WET_SURFACES && surface.film > 0.0 {
            let under = wet_out(surface, cosine_view) * wet_in(surface, cosine);
            ray.diffuse += (under - vec3f(1.0) + fresnel) * (surface.film * cosine / density);
        }
    }
    if chance > 0.0 {
        let lobe = brdf_distribution(alpha, cosine_half) * brdf_visibility(alpha, cosine_view, cosine) * cosine;
        ray.mirror = fresnel * (lobe / density) / max(gloss, vec3f(SCATTER_MIN_DIVISOR));
    }
    return ray;
}

// The ray of a mirror, as wide as the lobe of its roughness.
fn scatter_mirror(surface: Surface, view: vec3f) -> ScatterRay {
    let cosine = max(dot(surface.normal, view), 0.0);
    let along = surface.normal * (2.0 * dot(surface.normal, view)) - view;
    let density = brdf_visible_density(scatter_alpha(surface.roughness), 1.0, max(cosine, BRDF_GRAZING));
    let width = min(sqrt(SCATTER_DISK / max(density, SCATTER_MIN_DIVISOR)), SCATTER_MAX_WIDTH);
    return ScatterRay(scatter_above(surface.facet, along), width, vec3f(0.0), surface.roughness, vec3f(1.0));
}

// The part of rays that are drawn for the gloss of a surface, by what both parts of it show.
fn scatter_chance(body: vec3f, gloss: vec3f) -> f32 {
    let of_body = max(body.x, max(body.y, body.z));
    let of_gloss = max(gloss.x, max(gloss.y, gloss.z));
    if of_body <= 0.0 {
        return 1.0;
    }
    return of_gloss / (of_body + of_gloss);
}

// Reflection at a surface: GGX microfacets over a diffuse base, metallic-roughness.
// Sources: B. Walter et al., "Microfacet models for refraction through rough surfaces", EGSR 2007 (GGX); E. Heitz,
// JCGT 3(2), 2014 (height-correlated Smith); C. Schlick 1994; glTF 2.0 appendix B; Fresnel's own law for water (optics). The
// environment term is the fit of B. Karis, "Physically based shading on mobile", 2014.
// Reflected rays are drawn by the normals that the viewer sees (E. Heitz, JCGT 7(4), 2018).
// Symbols: alpha = roughness^2; all cosines in [0, 1].
// Twin: downpour_trace::brdf.

// Normal distribution times pi: D(h) pi, at a cosine to the normal.
fn brdf_distribution(alpha: f32, cosine_half: f32) -> f32 {
    let a2 = alpha * alpha;
    let d = (cosine_half * a2 - cosine_half) * cosine_half + 1.0;
    return a2 / (d * d);
}

// Height-correlated Smith visibility: G over 4 times both cosines.
fn brdf_visibility(alpha: f32, cosine_view: f32, cosine_light: f32) -> f32 {
    let a2 = alpha * alpha;
    let view = cosine_light * sqrt((cosine_view - a2 * cosine_view) * cosine_view + a2);
    let light = cosine_view * sqrt((cosine_light - a2 * cosine_light) * cosine_light + a2);
    return 0.5 / max(view + light, BRDF_MIN_DIVISOR);
}

// Rise of a reflectance from that at normal incidence (0) to that at grazing incidence (1), of a surface of which a film of
// water covers the fraction `film`: Fresnel's for water; where there is no film, Schlick's, whose index is not known.
fn brdf_rise(film: f32, cosine: f32) -> f32 {
    let c = clamp(cosine, 0.0, 1.0);
    let rest = 1.0 - c;
    let square = rest * rest;
    let fifth = square * square * rest;
    if film <= 0.0 {
        return fifth;
    }
    let of_water = (optics_fresnel(c, PUDDLE_WATER_INDEX) - PUDDLE_WATER_NORMAL) / (1.0 - PUDDLE_WATER_NORMAL);
    return fifth + (of_water - fifth) * film;
}

// Reflectance at grazing incidence: all light, but for what reflects nothing at normal incidence, which has no gloss.
fn brdf_grazing(normal_reflectance: vec3f) -> vec3f {
    return min(normal_reflectance / BRDF_MIN_REFLECTANCE, vec3f(1.0));
}

// Reflectance at a cosine, for that at normal incidence. `film`: fraction that a film of water covers.
fn brdf_fresnel(normal_reflectance: vec3f, film: f32, cosine: f32) -> vec3f {
    return normal_reflectance + (brdf_grazing(normal_reflectance) - normal_reflectance) * brdf_rise(film, cosine);
}

// Radiance toward the viewer for light of irradiance pi from one direction, cosine at the surface included.
fn brdf_direct(
    diffuse: vec3f, normal_reflectance: vec3f, film: f32, alpha: f32,
    normal: vec3f, view: vec3f, light: vec3f,
) -> vec3f {
    let cosine_light = dot(normal, light);
    if cosine_light <= 0.0 {
        return vec3f(0.0);
    }
    let cosine_view = max(dot(normal, view), BRDF_GRAZING);
    let sum = view + light;
    let halfway = sum / max(sqrt(dot(sum, sum)), BRDF_MIN_DIVISOR);
    let cosine_half = clamp(dot(normal, halfway), 0.0, 1.0);
    let fresnel = brdf_fresnel(normal_reflectance, film, dot(view, halfway));
    let specular = brdf_distribution(alpha, cosine_half) * brdf_visibility(alpha, cosine_view, cosine_light);
    return ((vec3f(1.0) - fresnel) * diffuse + fresnel * specular) * cosine_light;
}

// Smith's masking: fraction of the microfacets facing a direction that is visible from it.
fn brdf_masking(alpha: f32, cosine: f32) -> f32 {
    let a2 = alpha * alpha;
    return 2.0 * cosine / max(cosine + sqrt((cosine - a2 * cosine) * cosine + a2), BRDF_MIN_DIVISOR);
}

// Normal of a microfacet, drawn from those that a viewer sees. `view` points to the viewer, in axes whose third is the
// surface's normal; `a` and `b` are uniform in [0, 1).
fn brdf_visible_normal(view: vec3f, alpha: f32, a: f32, b: f32) -> vec3f {
    // Stretched, so that the surface is one of roughness 1.
    let stretched = vec3f(alpha * view.x, alpha * view.y, view.z);
    let v = stretched / max(sqrt(dot(stretched, stretched)), BRDF_MIN_DIVISOR);
    let flat_part = v.x * v.x + v.y * v.y;
    var level = vec3f(1.0, 0.0, 0.0);
    if flat_part > 0.0 {
        level = vec3f(-v.y, v.x, 0.0) / sqrt(flat_part);
    }
    let rising = cross(v, level);
    // A point of the disk that the hemisphere of normals shows: half of it is foreshortened.
    let radius = sqrt(a);
    let angle = 6.2831853 * b;
    let x = radius * cos(angle);
    let fraction = 0.5 * (1.0 + v.z);
    let y = (1.0 - fraction) * sqrt(max(1.0 - x * x, 0.0)) + fraction * (radius * sin(angle));
    let z = sqrt(max(1.0 - x * x - y * y, 0.0));
    let normal = level * x + rising * y + v * z;
    let back = vec3f(alpha * normal.x, alpha * normal.y, max(normal.z, 0.0));
    return back / max(sqrt(dot(back, back)), BRDF_MIN_DIVISOR);
}

// Density, per solid angle, of reflections drawn with brdf_visible_normal, times pi.
fn brdf_visible_density(alpha: f32, cosine_half: f32, cosine_view: f32) -> f32 {
    return brdf_distribution(alpha, cosine_half) * brdf_masking(alpha, cosine_view) * 0.25
        / max(cosine_view, BRDF_MIN_DIVISOR);
}

// Fraction of a uniform environment that microfacets reflect.
fn brdf_environment(normal_reflectance: vec3f, roughness: f32, cosine_view: f32) -> vec3f {
    let r = roughness * vec4f(-1.0, -0.0275, -0.572, 0.022) + vec4f(1.0, 0.0425, 1.04, -0.04);
    let lift = min(r.x * r.x, exp2(-9.28 * cosine_view)) * r.x + r.y;
    let scale = -1.04 * lift + r.z;
    let bias = 1.04 * lift + r.w;
    // The fit goes below 0 where almost nothing is reflected.
    return max(normal_reflectance * scale + brdf_grazing(normal_reflectance) * bias, vec3f(0.0));
}

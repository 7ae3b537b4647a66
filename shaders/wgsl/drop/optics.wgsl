// Optics of the interface between air and water.
//
// Laws: reflection and Snell's law in vectors; Fresnel's equations for a dielectric (Born & Wolf, Principles of
// Optics, 1.5.2), exact, for both polarizations; by name, the approximations of Schlick 1994 and of Tatarchuk &
// Isidoro 2006. Unit vectors; the normal faces against the incident ray; eta = n(from) / n(to);
// index = n(to) / n(from); cosines in [0, 1]. Absorption within a drop is negligible.
// Twin: downpour_drop::optics.

// Direction of the refracted ray (xyz), and the square of the cosine of its angle to the normal (w).
// A negative w is total reflection: xyz is then meaningless.
fn optics_refract(incident: vec3f, normal: vec3f, eta: f32) -> vec4f {
    let cosine = -(incident.x * normal.x + incident.y * normal.y + incident.z * normal.z);
    let squared = 1.0 - eta * eta * (1.0 - cosine * cosine);
    let along = eta * cosine - sqrt(max(squared, 0.0));
    return vec4f(
        eta * incident.x + along * normal.x,
        eta * incident.y + along * normal.y,
        eta * incident.z + along * normal.z,
        squared,
    );
}

// Direction of the reflected ray.
fn optics_reflect(incident: vec3f, normal: vec3f) -> vec3f {
    let cosine = -(incident.x * normal.x + incident.y * normal.y + incident.z * normal.z);
    let along = cosine + cosine;
    return vec3f(
        incident.x + along * normal.x,
        incident.y + along * normal.y,
        incident.z + along * normal.z,
    );
}

// Fraction of the power that is reflected: across (s) and within (p) the plane of incidence. 1 in total reflection.
fn optics_fresnel_polarized(cosine: f32, index: f32) -> vec2f {
    let c = max(cosine, 0.0);
    // index^2 - sin^2, without the loss of digits of 1 - cos^2.
    let squared = (index - 1.0) * (index + 1.0) + c * c;
    let g = sqrt(max(squared, 0.0));
    let s = (c - g) / max(c + g, OPTICS_MIN);
    let nc = index * index * c;
    let p = (nc - g) / max(nc + g, OPTICS_MIN);
    let total = squared < 0.0;
    return vec2f(select(s * s, 1.0, total), select(p * p, 1.0, total));
}

// Fraction of unpolarized light that is reflected.
fn optics_fresnel(cosine: f32, index: f32) -> f32 {
    let r = optics_fresnel_polarized(cosine, index);
    return 0.5 * (r.x + r.y);
}

// Schlick 1994, from the side of the smaller index.
fn optics_fresnel_schlick(cosine: f32, index: f32) -> f32 {
    let root = (index - 1.0) / (index + 1.0);
    let base = root * root;
    let x = 1.0 - cosine;
    let x2 = x * x;
    return base + (1.0 - base) * (x2 * x2 * x);
}

// Tatarchuk & Isidoro 2006: 2.5 times the reflectance of water at normal incidence.
fn optics_fresnel_tatarchuk(cosine: f32) -> f32 {
    let x = 1.0 - cosine;
    let x2 = x * x;
    return OPTICS_TATARCHUK_RISE * (x2 * x2) + OPTICS_TATARCHUK_BASE;
}

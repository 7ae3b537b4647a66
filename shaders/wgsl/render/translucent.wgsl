// Surfaces that transmit light diffusely, as leaves do: the light on one side leaves on both.
// Twin: downpour_trace::translucent, where the method is described.

// Fraction of the light on a surface that leaves it toward the viewer: of that on the viewer's side and of that from behind together.
fn translucent_albedo(surface: Surface) -> vec3f {
    return surface.diffuse + surface.diffuse_transmission;
}

// Part of that fraction that light from behind has.
fn translucent_part(surface: Surface) -> vec3f {
    return surface.diffuse_transmission / max(translucent_albedo(surface), vec3f(1.0e-9));
}

// True if light from behind leaves a surface.
fn translucent_is(surface: Surface) -> bool {
    return SURFACE_TRANSLUCENT && any(surface.diffuse_transmission > vec3f(0.0));
}

// Part of the rays that look for the light behind.
fn translucent_chance(surface: Surface) -> f32 {
    let own = surface.diffuse;
    let other = surface.diffuse_transmission;
    let behind = max(other.x, max(other.y, other.z));
    return behind / max(behind + max(own.x, max(own.y, own.z)), 1.0e-9);
}

// The surface as the light behind it meets it: matte, and with its other side to the light. Its viewer is where the ray goes.
fn translucent_behind(surface: Surface) -> Surface {
    var behind = surface;
    behind.normal = -surface.normal;
    behind.facet = -surface.facet;
    behind.diffuse = surface.diffuse_transmission;
    behind.diffuse_transmission = vec3f(0.0);
    behind.normal_reflectance = vec3f(0.0);
    behind.roughness = 1.0;
    behind.film = 0.0;
    return behind;
}

// The normal of the triangle on the side of the surface that light from a direction meets; the viewer's if no light passes.
fn translucent_facet(surface: Surface, direction: vec3f) -> vec3f {
    return select(surface.facet, -surface.facet, translucent_is(surface) && dot(surface.facet, direction) < 0.0);
}

// One side drawn for both by a number in [0, 1), and as much brighter; flat, so that no light is on neither.
fn translucent_drawn(surface: Surface, number: f32) -> Surface {
    let chance = translucent_chance(surface);
    var drawn = surface;
    if number < chance {
        drawn = translucent_behind(surface);
        drawn.diffuse /= chance;
    } else {
        drawn.diffuse /= 1.0 - chance;
        drawn.diffuse_transmission = vec3f(0.0);
    }
    drawn.normal = drawn.facet;
    return drawn;
}

// Light of the open sky on the diffuse base, over pi.
fn translucent_sky(surface: Surface) -> vec3f {
    var light = sky_irradiance(surface.normal);
    if translucent_is(surface) {
        light += (sky_irradiance(-surface.normal) - light) * translucent_part(surface);
    }
    return light;
}

// Intersection of a ray with the scene: the nearest triangle that is not a hole, and its material there.
// Twin: downpour_trace::surface.

// True if materials transmit light diffusely, as leaves do: the code slows down the rest.
override SURFACE_TRANSLUCENT: bool = true;

struct SurfaceHit {
    // Negative: nothing.
    distance: f32,
    triangle: u32,
    u: f32,
    v: f32,
}

struct Surface {
    position: vec3f,
    alpha: f32,
    // Faces the viewer.
    normal: vec3f,
    roughness: f32,
    // The triangle's own normal, facing the viewer.
    facet: vec3f,
    occlusion: f32,
    diffuse: vec3f,
    flags: u32,
    normal_reflectance: vec3f,
    transmission: f32,
    emission: vec3f,
    // Curvature, 1/m: how much the normal turns per meter.
    bend: f32,
    // Fraction that soaks up rain and darkens.
    porosity: f32,
    // Fraction that a film of water covers.
    film: f32,
    // Square of the alpha by which its roughness allows for what the ray's footprint does not resolve of its relief and of its bend.
    variance: f32,
    // Fraction of the light from behind that it scatters toward the viewer.
    diffuse_transmission: vec3f,
}

// A texture of a material's row, or white.
fn surface_texture(row: u32, uv: vec4f, footprint: TextureFootprint) -> vec4f {
    if row == SCENE_NONE {
        return vec4f(1.0);
    }
    return texture_sample(row, uv, footprint);
}

// Alpha at a hit.
fn surface_alpha(material: RenderMaterial, hit: SurfaceHit) -> f32 {
    let point = TextureFootprint(vec4f(0.0), vec4f(0.0), 1.0);
    return material.base.a
        * surface_texture(material.maps.x, surface_uv(hit), point).a * surface_color(hit).a;
}

// True if there is a hole at a hit.
fn surface_is_open(hit: SurfaceHit) -> bool {
    let material = material_load(render_corners[hit.triangle * 3u].material);
    if (material.flags & (SCENE_MASKED | SCENE_BLENDED)) == 0u {
        return false;
    }
    let least = select(SURFACE_OPEN, material.cutoff, (material.flags & SCENE_MASKED) != 0u);
    return surface_alpha(material, hit) < least;
}

// Returns the nearest surface up to a distance. Holes are skipped: where a masked material is below its cutoff, or one that is
// blended has no alpha. Twelve holes in a row end the ray.
fn surface_hit(origin: vec3f, direction: vec3f, nearest: f32, farthest: f32) -> SurfaceHit {
    return surface_walk(origin, direction, nearest, farthest, false);
}

// Returns what is in the way of a ray up to a distance: any surface through which nothing passes, or the nearest of all if it is one
// that lets light through.
fn surface_blocker(origin: vec3f, direction: vec3f, nearest: f32, farthest: f32) -> SurfaceHit {
    return surface_walk(origin, direction, nearest, farthest, true);
}

// The nearest surface up to a distance or, if `any`, any through which nothing passes.
fn surface_walk(origin: vec3f, direction: vec3f, nearest: f32, farthest: f32, any: bool) -> SurfaceHit {
    var from_distance = nearest;
    for (var k = 0u; k < SCENE_LAYERS; k += 1u) {
        let hit = bvh_walk(origin, direction, from_distance, farthest, any);
        if hit.distance < 0.0 {
            break;
        }
        let found = SurfaceHit(hit.distance, hit.triangle, hit.u, hit.v);
        if !surface_is_open(found) {
            return found;
        }
        from_distance = hit.distance + nearest;
    }
    return SurfaceHit(-1.0, 0u, 0.0, 0.0);
}

// Texture coordinates at a hit.
fn surface_uv(hit: SurfaceHit) -> vec4f {
    let first = hit.triangle * 3u;
    let w = 1.0 - hit.u - hit.v;
    return render_corners[first].uv * w + render_corners[first + 1u].uv * hit.u
        + render_corners[first + 2u].uv * hit.v;
}

// Vertex color at a hit.
fn surface_color(hit: SurfaceHit) -> vec4f {
    let first = hit.triangle * 3u;
    let w = 1.0 - hit.u - hit.v;
    return render_corners[first].color * w + render_corners[first + 1u].color * hit.u
        + render_corners[first + 2u].color * hit.v;
}

// Where a ray's cone, of a width at the hit, meets the triangle: as wide across the ray, and in the direction in which the ray goes over
// the triangle longer by the cosine between ray and normal.
fn surface_footprint(hit: SurfaceHit, geometric: vec3f, direction: vec3f, width: f32, taps: f32) -> TextureFootprint {
    let first = hit.triangle * 3u;
    let a = render_corners[first].uv;
    let b = render_corners[first + 1u].uv - a;
    let c = render_corners[first + 2u].uv - a;
    let edge_1 = bvh_triangles[hit.triangle].edge_1;
    let edge_2 = bvh_triangles[hit.triangle].edge_2;
    let normal = geometric / max(sqrt(dot(geometric, geometric)), 1.0e-20);
    let cosine = dot(normal, direction);
    let over = direction - normal * cosine;
    let is_oblique = dot(over, over) > SURFACE_OBLIQUE;
    let chosen = select(edge_1, over, is_oblique);
    let along = chosen / max(sqrt(dot(chosen, chosen)), 1.0e-20);
    let across = cross(normal, along);
    // What the edges are to be multiplied by for one meter in a direction.
    let inverse = width / max(dot(geometric, geometric), 1.0e-30);
    let longer = inverse / max(abs(cosine), SURFACE_GRAZING);
    return TextureFootprint(
        (b * dot(cross(along, edge_2), geometric) + c * dot(cross(edge_1, along), geometric)) * longer,
        (b * dot(cross(across, edge_2), geometric) + c * dot(cross(edge_1, across), geometric)) * inverse,
        taps,
    );
}

// The cross product of the edges of the triangle that was hit: its normal, as long as twice its area.
fn surface_edges(hit: SurfaceHit) -> vec3f {
    return cross(bvh_triangles[hit.triangle].edge_1, bvh_triangles[hit.triangle].edge_2);
}

// The normal of the triangle that was hit, facing the viewer.
fn surface_facet(hit: SurfaceHit, direction: vec3f) -> vec3f {
    let geometric = surface_edges(hit);
    let facing = select(1.0, -1.0, dot(geometric, direction) > 0.0);
    return geometric * (facing / max(sqrt(dot(geometric, geometric)), 1.0e-20));
}

// Rate at which the corners' normals turn over the triangle that was hit, 1/m.
fn surface_bend(hit: SurfaceHit) -> f32 {
    let first = hit.triangle * 3u;
    let a = render_corners[first].normal;
    let b = render_corners[first + 1u].normal;
    let c = render_corners[first + 2u].normal;
    let edge_1 = bvh_triangles[hit.triangle].edge_1;
    let edge_2 = bvh_triangles[hit.triangle].edge_2;
    let turned = dot(b - a, b - a) + dot(c - a, c - a);
    let length = dot(edge_1, edge_1) + dot(edge_2, edge_2);
    return sqrt(turned / max(length, 1.0e-20));
}

// Variance of the slopes along both axes that a bent surface has within the footprint of a ray, of a width across it, that meets it at a
// cosine: those of a box.
fn surface_turn(bend: f32, width: f32, cosine: f32) -> f32 {
    let across = bend * width;
    let along = across / max(abs(cosine), SURFACE_BENT);
    return (across * across + along * along) / 12.0;
}

// Roughness of a surface whose microfacets have a relief under them, with a variance of its slopes along both axes together.
fn surface_roughness(own: f32, variance: f32) -> f32 {
    let alpha = own * own;
    return min(sqrt(sqrt(alpha * alpha + variance)), 1.0);
}

// Fraction of a surface that soaks up rain: its material's own where that is not below 0; else rough stone, plaster and cloth do,
// metal, smooth paint and leaves do not.
fn surface_porosity(own: f32, flags: u32, roughness: f32, metallic: f32) -> f32 {
    if own >= 0.0 {
        return min(own, 1.0);
    }
    if (flags & SCENE_MASKED) != 0u {
        return 0.0;
    }
    let x = clamp((roughness - SURFACE_DENSE) / (SURFACE_POROUS - SURFACE_DENSE), 0.0, 1.0);
    return x * x * (3.0 - 2.0 * x) * (1.0 - metallic);
}

// Everything that shading needs at a hit of a ray whose cone is as wide at distance 1. `taps`: see TextureFootprint.
fn surface_at(hit: SurfaceHit, origin: vec3f, direction: vec3f, cone: f32, taps: f32) -> Surface {
    let first = hit.triangle * 3u;
    let w = 1.0 - hit.u - hit.v;
    let corner = render_corners[first];
    let second = render_corners[first + 1u];
    let third = render_corners[first + 2u];
    let geometric = surface_edges(hit);
    let facing = select(1.0, -1.0, dot(geometric, direction) > 0.0);
    let facet = surface_facet(hit, direction);

    let uv = surface_uv(hit);
    let footprint = surface_footprint(hit, geometric, direction, cone * hit.distance, taps);
    let material = material_load(corner.material);
    let flags = material.flags;
    let maps = material.maps;
    let more = material.more;

    // One text for all textures: each copy of it is compiled again.
    var rows = array<u32, 8>(maps.x, maps.y, maps.z, maps.w, more.x, more.y, more.z, more.w);
    var texels: array<vec4f, 8>;
    for (var k = 0u; k < select(6u, 8u, SURFACE_TRANSLUCENT); k += 1u) {
        texels[k] = surface_texture(rows[k], uv, footprint);
    }
    let base = material.base * texels[0] * surface_color(hit);
    let rough = texels[1];
    // Unlit, the base color is all that is seen.
    let unlit = (flags & SCENE_UNLIT) != 0u;
    let metallic = select(clamp(material.metallic * rough.b, 0.0, 1.0), 0.0, unlit);
    let roughness = clamp(material.roughness * rough.g, 0.0, 1.0);
    let emission = material.emission * texels[3].rgb;
    let occlusion = 1.0 + material.occlusion_strength * (texels[4].r - 1.0);
    let transmission = material.transmission * texels[5].r;
    var behind = vec3f(0.0);
    var reflected = 1.0 - metallic;
    if SURFACE_TRANSLUCENT && !unlit {
        let part = clamp(material.diffuse_transmission * texels[6].a, 0.0, 1.0);
        behind = material.diffuse_transmission_color * texels[7].rgb * (part * reflected);
        reflected *= 1.0 - part;
    }

    var normal = (corner.normal * w + second.normal * hit.u + third.normal * hit.v) * facing;
    let bend = surface_bend(hit);
    var variance = surface_turn(bend, cone * hit.distance, dot(facet, direction));
    if maps.z != SCENE_NONE {
        let tangent = corner.tangent * w + second.tangent * hit.u + third.tangent * hit.v;
        let relief = texels[2];
        let side = cross(normal * facing, tangent.xyz) * tangent.w;
        let scale = material.normal_scale;
        normal = normal + tangent.xyz * (relief.x * scale) + side * (relief.y * scale);
        variance += relief.z * (scale * scale);
    }
    normal = normal / max(sqrt(dot(normal, normal)), 1.0e-20);
    // A shading normal that faces away from the viewer is bent back to the horizon.
    let away = dot(normal, direction);
    if away > 0.0 {
        normal = normal - direction * (away + 0.01);
        normal = normal / max(sqrt(dot(normal, normal)), 1.0e-20);
    }
    let dielectric = (material.ior - 1.0) / (material.ior + 1.0);
    let f0 = select(dielectric * dielectric, 0.0, unlit);
    return Surface(
        origin + direction * hit.distance,
        base.a,
        normal,
        surface_roughness(roughness, variance),
        facet,
        clamp(occlusion, 0.0, 1.0),
        base.rgb * reflected,
        flags,
        vec3f(f0) * (1.0 - metallic) + base.rgb * metallic,
        clamp(transmission, 0.0, 1.0) * (1.0 - metallic),
        emission,
        bend,
        surface_porosity(material.porosity, flags, roughness, metallic),
        0.0,
        variance,
        behind,
    );
}

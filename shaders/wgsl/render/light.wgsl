// Lamps and the sun. Rows of a light in the table: position and kind; axis and chord; color and range; cone.
// Twin: downpour_render::light.

// A lamp or the sun.
struct RenderLight {
    position: vec3f,
    // SCENE_LIGHT_DIRECTIONAL, SCENE_LIGHT_POINT, SCENE_LIGHT_BODY or SCENE_LIGHT_AREA.
    kind: u32,
    // Direction in which the light goes, the axis of the cone, or an area's normal.
    axis: vec3f,
    // Chord from the middle to the edge of the disk that a drop shows of it; 0: that of the sun.
    chord: f32,
    // Irradiance over pi of a surface that faces it, for a lamp at 1 m.
    color: vec3f,
    // No light beyond this, meters; 0 for no end.
    range: f32,
    // Scale and offset of the cosine at the edge of the cone.
    cone: vec2f,
    // Radius of the lamp, meters; 0: a point. Of a place of an area: distance within which its light does not grow.
    radius: f32,
}

// Light of a lamp at a point.
struct LightSample {
    // Unit direction to the lamp.
    direction: vec3f,
    distance: f32,
    // Irradiance over pi of a surface that faces it.
    irradiance: vec3f,
    // Half the angle that the light takes.
    spread: f32,
}

// Reads a light.
fn light_load(index: u32) -> RenderLight {
    let row = render_frame.lights + index * SCENE_LIGHT_ROWS;
    let position = render_table[row];
    let axis = bitcast<vec4f>(render_table[row + 1u]);
    let color = bitcast<vec4f>(render_table[row + 2u]);
    let cone = bitcast<vec3f>(render_table[row + 3u].xyz);
    return RenderLight(bitcast<vec3f>(position.xyz), position.w, axis.xyz, axis.w, color.rgb, color.w, cone.xy, cone.z);
}

// The light at a point. A lamp that is nearer than `least` is as bright as from there.
fn light_sample(light: RenderLight, point: vec3f, least: f32) -> LightSample {
    if light.kind == SCENE_LIGHT_DIRECTIONAL {
        // A small chord is as long as its angle.
        let spread = select(PANE_SHADOW_SUN, light.chord, light.chord > 0.0);
        return LightSample(-light.axis, SCENE_FAR, light.color, spread);
    }
    let offset = light.position - point;
    let inside = max(least, light.radius);
    let square = max(dot(offset, offset), max(inside * inside, 1.0e-8));
    let distance = sqrt(max(dot(offset, offset), 1.0e-8));
    let direction = offset / distance;
    // glTF's window: no light beyond the range, if there is one.
    let part = distance / max(light.range, 1.0e-6);
    let fourth = part * part * part * part;
    let ranged = clamp(1.0 - fourth, 0.0, 1.0);
    let window = select(1.0, ranged, light.range > 0.0);
    let cosine = dot(-direction, light.axis);
    let edge = clamp(cosine * light.cone.x + light.cone.y, 0.0, 1.0);
    // An area shines to both sides.
    let is_area = light.kind == SCENE_LIGHT_AREA;
    let shape = select(edge * edge, abs(cosine), is_area);
    let spread = select(min(light.radius / distance, LIGHT_MAX_SPREAD), 0.0, is_area);
    return LightSample(direction, distance, light.color * (window * shape / square), spread);
}

// Sum of a color's parts, by which lights are compared.
fn light_weight(color: vec3f) -> f32 {
    return color.x + color.y + color.z;
}

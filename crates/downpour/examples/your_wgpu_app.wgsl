// The street of the example: boxes, lit by lamps, and a tone curve to look at it.

struct Camera {
    projection: mat4x4f,
    eye: vec4f,
    size: vec4f,
}

struct Block {
    low: vec3f,
    kind: f32,
    high: vec3f,
    shade: f32,
}

struct Corner {
    @builtin(position) position: vec4f,
    @location(0) world: vec3f,
    @location(1) normal: vec3f,
    @location(2) @interpolate(flat) block: u32,
}

@group(0) @binding(0) var<uniform> camera: Camera;
@group(0) @binding(1) var<storage, read> blocks: array<Block>;
@group(0) @binding(2) var picture: texture_2d<f32>;

@vertex
fn street_vertex(@builtin(vertex_index) index: u32, @builtin(instance_index) instance: u32) -> Corner {
    let face = index / 6u;
    let order = array<vec2f, 6>(
        vec2f(0.0, 0.0), vec2f(1.0, 0.0), vec2f(1.0, 1.0), vec2f(0.0, 0.0), vec2f(1.0, 1.0), vec2f(0.0, 1.0));
    let at = order[index % 6u];
    let axis = face / 2u;
    let side = f32(face % 2u);
    var place = vec3f(side, at.x, at.y);
    var normal = vec3f(2.0 * side - 1.0, 0.0, 0.0);
    if axis == 1u {
        place = place.zxy;
        normal = normal.zxy;
    }
    if axis == 2u {
        place = place.yzx;
        normal = normal.yzx;
    }
    let block = blocks[instance];
    let world = mix(block.low, block.high, place);
    return Corner(camera.projection * vec4f(world, 1.0), world, normal, instance);
}

fn noise(cell: vec3f) -> f32 {
    return fract(sin(dot(floor(cell), vec3f(12.9898, 78.233, 37.719))) * 43758.547);
}

@fragment
fn street_fragment(corner: Corner) -> @location(0) vec4f {
    let block = blocks[corner.block];
    if block.kind == 2.0 {
        return vec4f(vec3f(36.0, 25.0, 14.0) * 1.6, 1.0);
    }
    var albedo = vec3f(block.shade);
    var glow = vec3f(0.0);
    if block.kind == 0.0 {
        albedo *= mix(vec3f(1.0, 0.86, 0.72), vec3f(0.85, 0.9, 1.0), noise(vec3f(block.low.z)));
        if abs(corner.normal.y) < 0.5 {
            // Windows 1.1 m wide, 1.5 m high; some rooms are lit.
            let along = select(corner.world.z, corner.world.x, abs(corner.normal.z) > 0.5);
            let cell = vec2f(along / 2.04, (corner.world.y - 0.8) / 3.0);
            let inside = fract(cell);
            if inside.x > 0.23 && inside.x < 0.77 && inside.y > 0.2 && inside.y < 0.72 && cell.y > 0.0 {
                albedo = vec3f(0.03);
                let room = noise(vec3f(floor(cell), block.low.z + block.low.x));
                if room > 0.72 {
                    glow = mix(vec3f(0.9, 0.55, 0.25), vec3f(0.55, 0.7, 0.9), noise(vec3f(room * 91.0))) * (0.4 + room);
                    let bar = abs(inside.x - 0.5) < 0.02 || abs(inside.y - 0.5) < 0.02;
                    glow *= select(1.0, 0.15, bar);
                }
            }
        }
    }
    if block.kind == 1.0 {
        albedo *= 0.8 + 0.4 * noise(corner.world * vec3f(9.0, 1.0, 9.0));
    }
    var light = vec3f(0.020, 0.026, 0.040) * (0.6 + 0.4 * corner.normal.y);
    for (var k = 0u; k < arrayLength(&blocks); k += 1u) {
        let lamp = blocks[k];
        if lamp.kind == 2.0 {
            let way = 0.5 * (lamp.low + lamp.high) - corner.world;
            let square = max(dot(way, way), 0.05);
            let facing = max(dot(corner.normal, way) / sqrt(square), 0.0);
            light += vec3f(36.0, 25.0, 14.0) * facing / (3.1415927 * square);
        }
    }
    return vec4f(albedo * light + glow, 1.0);
}

@vertex
fn present_vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return vec4f(f32((index & 1u) << 2u) - 1.0, 1.0 - f32((index & 2u) << 1u), 0.0, 1.0);
}

// Exposure and a curve that ends at white.
@fragment
fn present_fragment(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let light = textureLoad(picture, vec2u(at.xy), 0).rgb * 1.3;
    return vec4f(light * (1.0 + light / 16.0) / (1.0 + light), 1.0);
}

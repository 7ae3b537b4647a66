// The buffers of a scene and of a frame. Bindings 1 and 2 are the triangles' hierarchy (mask/bvh.wgsl).
// Host types: downpour_trace::data.

struct RenderFrame {
    // Width, height and first texel of each level of the sky.
    sky_levels: array<vec4u, SCENE_SKY_LEVELS>,
    camera: RenderCamera,
    // Samples along an edge of a pixel.
    grid: u32,
    // Rows of the table where slots and lights begin.
    slots: u32,
    lights: u32,
    light_count: u32,
    // Rays to the sky per sample.
    sky_rays: u32,
    // First row of pixels of this dispatch.
    first_row: u32,
    // Nearest distance of the next surface, meters.
    nearest: f32,
    // Part of the rays that look for the light of a surface that one of them is.
    ray_fraction: f32,
    // Projection that is traced: SCENE_PICTURE, SCENE_OCTAHEDRAL or SCENE_PERSPECTIVE.
    projection: u32,
    // 1: the capture leaves parallel light out, and lamps. SCENE_ALL_OUT: all that shines by itself.
    suns_out: u32,
    // Row of the table where puddles begin, and how many there are.
    puddles: u32,
    puddle_count: u32,
    // Row of the table where the pane begins that throws shadows; 0: none.
    pane: u32,
    // Turn of a dispatch: pass of the means over neighboring pixels, or sample of main_trace_sample.
    turn: u32,
    // Row of the table where the wetness of surfaces begins; 0: all is dry.
    wetness: u32,
    // Word of the texels where the tree of surfaces that shine begins; 0: none shine.
    emitters: u32,
    // In the picture, distance in pixels between those whose rays look for the light of sky and surfaces; 1: all do.
    ray_spacing: u32,
    // Column and row of such a pixel in each cell of pixels.
    ray_column: u32,
    ray_row: u32,
    // Row of the table where rain on panes of the scene begins; 0: they are dry.
    glazing: u32,
    // Number of billboards in the reflection buffer, plus 1; 0: reflections on wet surfaces are found by rays.
    impostors: u32,
    // The paper's f0 of reflections from that buffer.
    impostor_edge: f32,
    // 1 if materials transmit light diffusely.
    translucent: u32,
    unused: u32,
    // Irradiance of the sky over pi as spherical harmonics of degree 2.
    sky_irradiance: array<vec4f, 9>,
}

// A corner of a triangle.
struct RenderCorner {
    normal: vec3f,
    material: u32,
    // Unit tangent and handedness.
    tangent: vec4f,
    // Two sets of texture coordinates.
    uv: vec4f,
    color: vec4f,
}

@group(0) @binding(0) var<uniform> render_frame: RenderFrame;
@group(0) @binding(3) var<storage, read> render_corners: array<RenderCorner>;
@group(0) @binding(4) var<storage, read> render_table: array<vec4u>;
@group(0) @binding(5) var<storage, read> render_texels: array<u32>;
@group(0) @binding(6) var<storage, read> render_sky: array<vec4f>;

// Rain over the color texture of a host application: a triangle over all of it whose color is added to what is there, times
// the transmittance in its alpha.
// Twin: downpour_render::host.

struct HostBlendFrame {
    // Columns of the picture.
    width: u32,
    // Color of the radiance 1.
    scale: f32,
    unused: vec2u,
}

@group(0) @binding(0) var<uniform> host_blend_frame: HostBlendFrame;
// Radiance and transmittance of each pixel.
@group(0) @binding(1) var<storage, read> host_blend_rain: array<vec4f>;

// Corner 0 to 2 of a triangle that covers the picture.
fn host_blend_corner(index: u32) -> vec4f {
    let x = f32((index & 1u) << 2u) - 1.0;
    let y = 1.0 - f32((index & 2u) << 1u);
    return vec4f(x, y, 0.0, 1.0);
}

// Color to add and factor of what is there, of the rain before a pixel.
fn host_blend_color(rain: vec4f, scale: f32) -> vec4f {
    return vec4f(rain.rgb * scale, rain.w);
}

@vertex
fn main_host_blend_vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    return host_blend_corner(index);
}

@fragment
fn main_host_blend_fragment(@builtin(position) at: vec4f) -> @location(0) vec4f {
    let pixel = vec2u(at.xy);
    return host_blend_color(host_blend_rain[pixel.y * host_blend_frame.width + pixel.x], host_blend_frame.scale);
}

// The buffers of a streak atlas. Host: downpour_atlas::gpu.

@group(0) @binding(0) var<uniform> atlas_data_frame: AtlasFrame;
@group(0) @binding(1) var<storage, read> atlas_data_triangles: array<AtlasTriangle>;
// Patterns, two half floats each, the first in the low bits: layers, rows, columns. A texel is how many times as bright it is as a
// disk of even light with the streak's amount.
@group(0) @binding(2) var<storage, read> atlas_data_texels: array<u32>;
// Amounts: diameters, oscillations, elevations of the grids, rows, columns; then that of each layer.
@group(0) @binding(3) var<storage, read> atlas_data_amounts: array<f32>;

// The buffers of a streak atlas. Host: downpour_mask::atlas::gpu.

@group(0) @binding(0) var<uniform> atlas_data_frame: AtlasFrame;
@group(0) @binding(1) var<storage, read> atlas_data_triangles: array<AtlasTriangle>;
// Two half floats each, the first in the low bits: layers, rows, columns.
@group(0) @binding(2) var<storage, read> atlas_data_texels: array<u32>;

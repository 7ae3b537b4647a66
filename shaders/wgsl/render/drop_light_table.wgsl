// Table of the light of lamps that drops scatter. Host: downpour_render::rain::light::DropLightTable.

// Row 0: (dsigma/dOmega) / (pi a^2) in 1/sr, red, green, blue; the other rows: the same for each way of light, and its
// position on the disk. Behind them, if there is one, what has to be known of a streak atlas.
@group(0) @binding(7) var<storage, read> drop_light_table: array<vec4f>;

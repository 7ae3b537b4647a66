// What the host has computed of drops: by class of mass, and by rank among the drops that land.

struct GlassTable {
    rows: array<GlassSizeRow, GLASS_CLASSES>,
    // Masses of landing drops at 4096 equal shares of their number.
    landing: array<vec4u, GLASS_LANDING_QUADS>,
}

// Properties of drops computed by the host: by class of mass, and by rank among the drops that land.

struct GlassTable {
    rows: array<GlassSizeRow, GLASS_CLASSES>,
    // Masses of landing drops at 4096 equal steps of their cumulative number.
    landing: array<vec4u, GLASS_LANDING_QUADS>,
}

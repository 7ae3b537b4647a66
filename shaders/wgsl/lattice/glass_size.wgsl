// Sizes of drops on a pane: classes of mass, and the properties of drops by class.
//
// A class is an eighth of a doubling of the mass. The properties of a class (radius, forces) are computed by the host;
// between two classes they are linear in the mass. All numbers are integers, so that a CPU has the same bits.
// Twin: downpour_lattice::glass::size.

// Properties of a drop of a mass.
struct GlassSizeRow {
    // Radius of the wetted disk, in cells / 256.
    radius: u32,
    // Retention by the contact line (Furmidge) in one tick, in units of velocity.
    hold: u32,
    // Fraction of its velocity that a drop keeps in one tick, in units of 1/16384.
    slow: u32,
    // Push of the air in one tick, in units of velocity.
    air: u32,
    // Radius of the sphere of the cap, in cells / 256.
    sphere: u32,
    // Evaporation in one tick, in units of mass / 65536.
    loss: u32,
    // Half-width of a ridge that has this mass in each cell of its length, in cells / 256.
    ridge: u32,
    // Distance of the middle of that ridge from its cells, ahead of the blade, in cells / 256.
    ahead: u32,
}

// Class of a mass: the mass itself below 16, then eight classes per doubling.
fn glass_size_class(mass: u32) -> u32 {
    if mass < 16u {
        return mass;
    }
    let top = firstLeadingBit(mass);
    return (top - 2u) * 8u + ((mass >> (top - 3u)) & 7u);
}

// Smallest mass of a class.
fn glass_size_floor(class_of: u32) -> u32 {
    if class_of < 16u {
        return class_of;
    }
    return (8u + (class_of & 7u)) << (class_of / 8u - 1u);
}

// Fraction of a mass between its class and the next, in units of 1/256.
fn glass_size_fraction(mass: u32) -> u32 {
    if mass < 16u {
        return 0u;
    }
    let shift = firstLeadingBit(mass) - 3u;
    return ((mass & ((1u << shift) - 1u)) << 8u) >> shift;
}

// Rank of a drop among others: its class, then its cell. Never 0.
fn glass_size_key(mass: u32, index: u32) -> u32 {
    return (glass_size_class(mass) << 24u) | index;
}

// Interpolates between two numbers below 2^22.
fn glass_size_mix(low: u32, high: u32, fraction: u32) -> u32 {
    return u32(i32(low) + (((i32(high) - i32(low)) * i32(fraction)) >> 8u));
}

// Interpolates between two classes.
fn glass_size_row(low: GlassSizeRow, high: GlassSizeRow, fraction: u32) -> GlassSizeRow {
    return GlassSizeRow(
        glass_size_mix(low.radius, high.radius, fraction),
        glass_size_mix(low.hold, high.hold, fraction),
        glass_size_mix(low.slow, high.slow, fraction),
        glass_size_mix(low.air, high.air, fraction),
        glass_size_mix(low.sphere, high.sphere, fraction),
        glass_size_mix(low.loss, high.loss, fraction),
        glass_size_mix(low.ridge, high.ridge, fraction),
        glass_size_mix(low.ahead, high.ahead, fraction),
    );
}

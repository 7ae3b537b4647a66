// Sizes of drops on a pane: classes of mass, and what a drop of a class does.
//
// A class is an eighth of a doubling of the mass. What belongs to a class (radius, forces) is computed by the host; between
// two classes it is linear in the mass. All numbers are integers, so that a CPU has the same bits.
// Twin: downpour_lattice::glass::size.

// What a drop of some mass does.
struct GlassSizeRow {
    // Radius of the wetted disc, in cells / 256.
    radius: u32,
    // What the contact line holds back (Furmidge) in one tick, in units of velocity.
    hold: u32,
    // Share of its velocity that a drop keeps in one tick, of 16384.
    slow: u32,
    // What the air pushes in one tick, in units of velocity.
    air: u32,
    // Radius of the sphere whose cap the drop is, in cells / 256.
    sphere: u32,
    // What dries in one tick, in units of mass / 65536.
    loss: u32,
    unused_1: u32,
    unused_2: u32,
}

// The class of a mass: the mass itself below 16, then eight classes to a doubling.
fn glass_size_class(mass: u32) -> u32 {
    if mass < 16u {
        return mass;
    }
    let top = firstLeadingBit(mass);
    return (top - 2u) * 8u + ((mass >> (top - 3u)) & 7u);
}

// The smallest mass of a class.
fn glass_size_floor(class_of: u32) -> u32 {
    if class_of < 16u {
        return class_of;
    }
    return (8u + (class_of & 7u)) << (class_of / 8u - 1u);
}

// How far a mass is on the way from its class to the next, of 256.
fn glass_size_share(mass: u32) -> u32 {
    if mass < 16u {
        return 0u;
    }
    let shift = firstLeadingBit(mass) - 3u;
    return ((mass & ((1u << shift) - 1u)) << 8u) >> shift;
}

// The rank of a drop among others: its class, then its cell. Never 0.
fn glass_size_key(mass: u32, index: u32) -> u32 {
    return (glass_size_class(mass) << 24u) | index;
}

// What is between two numbers below 2^22.
fn glass_size_mix(low: u32, high: u32, share: u32) -> u32 {
    return u32(i32(low) + (((i32(high) - i32(low)) * i32(share)) >> 8u));
}

// What is between two classes.
fn glass_size_row(low: GlassSizeRow, high: GlassSizeRow, share: u32) -> GlassSizeRow {
    return GlassSizeRow(
        glass_size_mix(low.radius, high.radius, share),
        glass_size_mix(low.hold, high.hold, share),
        glass_size_mix(low.slow, high.slow, share),
        glass_size_mix(low.air, high.air, share),
        glass_size_mix(low.sphere, high.sphere, share),
        glass_size_mix(low.loss, high.loss, share),
        0u,
        0u,
    );
}

//! Classes of mass, and what a drop of a class does. Twin of `shaders/wgsl/lattice/glass_size.wgsl`.

use downpour_shaders::lattice::glass::GLASS_LANDING_QUADS;

/// What a drop of some mass does. The same layout as `GlassSizeRow` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct GlassSizeRow {
    /// Radius of the wetted disc, in cells / 256.
    pub radius: u32,
    /// What the contact line holds back in one tick, in units of velocity.
    pub hold: u32,
    /// Share of its velocity that a drop keeps in one tick, of 16384.
    pub slow: u32,
    /// What the air pushes in one tick, in units of velocity.
    pub air: u32,
    /// Radius of the sphere whose cap the drop is, in cells / 256.
    pub sphere: u32,
    /// What dries in one tick, in units of mass / 65536.
    pub loss: u32,
    /// 0.
    pub unused_1: u32,
    /// 0.
    pub unused_2: u32,
}

/// What the host has computed of drops. The same layout as `GlassTable` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct GlassTable {
    /// By class of mass: 10 times 13 rows, which is one array of 130 in memory.
    pub rows: [[GlassSizeRow; 13]; 10],
    /// Masses of landing drops at 4096 equal shares of their number.
    pub landing: [[u32; 4]; GLASS_LANDING_QUADS as usize],
}

impl GlassTable {
    /// What a drop of a mass up to the largest does.
    #[inline]
    #[must_use]
    pub fn row(&self, mass: u32) -> GlassSizeRow {
        let class = glass_size_class(mass) as usize;
        match self.rows.as_flattened().get(class..class + 2) {
            Some([low, high]) => glass_size_row(*low, *high, glass_size_share(mass)),
            _ => GlassSizeRow::default(),
        }
    }
}

/// The class of a mass: the mass itself below 16, then eight classes to a doubling.
#[inline]
#[must_use]
pub fn glass_size_class(mass: u32) -> u32 {
    if mass < 16 {
        return mass;
    }
    let top = 31 - mass.leading_zeros();
    (top - 2) * 8 + ((mass >> (top - 3)) & 7)
}

/// The smallest mass of a class.
#[inline]
#[must_use]
pub fn glass_size_floor(class: u32) -> u32 {
    if class < 16 {
        return class;
    }
    (8 + (class & 7)) << (class / 8 - 1)
}

/// How far a mass is on the way from its class to the next, of 256.
#[inline]
#[must_use]
pub fn glass_size_share(mass: u32) -> u32 {
    if mass < 16 {
        return 0;
    }
    let shift = 31 - mass.leading_zeros() - 3;
    ((mass & ((1 << shift) - 1)) << 8) >> shift
}

/// The rank of a drop among others: its class, then its cell. Never 0.
#[inline]
#[must_use]
pub fn glass_size_key(mass: u32, index: u32) -> u32 {
    (glass_size_class(mass) << 24) | index
}

/// What is between two numbers below 2^22.
#[inline]
#[must_use]
pub fn glass_size_mix(low: u32, high: u32, share: u32) -> u32 {
    (low as i32 + (((high as i32 - low as i32) * share as i32) >> 8)) as u32
}

/// What is between two classes.
#[inline]
#[must_use]
pub fn glass_size_row(low: GlassSizeRow, high: GlassSizeRow, share: u32) -> GlassSizeRow {
    GlassSizeRow {
        radius: glass_size_mix(low.radius, high.radius, share),
        hold: glass_size_mix(low.hold, high.hold, share),
        slow: glass_size_mix(low.slow, high.slow, share),
        air: glass_size_mix(low.air, high.air, share),
        sphere: glass_size_mix(low.sphere, high.sphere, share),
        loss: glass_size_mix(low.loss, high.loss, share),
        unused_1: 0,
        unused_2: 0,
    }
}

#[cfg(test)]
mod tests {
    use downpour_shaders::lattice::glass::GLASS_CLASSES;

    use super::*;

    #[test]
    fn classes_are_in_order_and_begin_at_their_floor() {
        for mass in 1..=downpour_shaders::lattice::glass::GLASS_LARGEST {
            let class = glass_size_class(mass);
            assert!(glass_size_floor(class) <= mass && mass < glass_size_floor(class + 1), "{mass}");
            assert!(class + 1 < GLASS_CLASSES, "{mass}");
            let (low, high) = (glass_size_floor(class), glass_size_floor(class + 1));
            let off = i64::from(glass_size_mix(low, high, glass_size_share(mass))) - i64::from(mass);
            assert!(off.unsigned_abs() * 256 <= u64::from(high), "{mass}: {off}");
        }
    }
}

//! Classes of mass, and the properties of drops by class. Twin of `shaders/wgsl/lattice/glass_size.wgsl`.

use downpour_shaders::lattice::glass::GLASS_LANDING_QUADS;

/// Properties of a drop of a mass, in the layout of `GlassSizeRow` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct GlassSizeRow {
    /// Radius of the wetted disk, in cells / 256.
    pub radius: u32,
    /// Retention by the contact line in one tick, in units of velocity.
    pub hold: u32,
    /// Fraction of its velocity that a drop keeps in one tick, in units of 1/16384.
    pub slow: u32,
    /// Push of the air in one tick, in units of velocity.
    pub air: u32,
    /// Radius of the sphere of the cap, in cells / 256.
    pub sphere: u32,
    /// Evaporation in one tick, in units of mass / 65536.
    pub loss: u32,
    /// Half-width of a ridge that has this mass in each cell of its length, in cells / 256.
    pub ridge: u32,
    /// Distance of the middle of that ridge from its cells, ahead of the blade, in cells / 256.
    pub ahead: u32,
}

/// Properties of drops computed by the host, in the layout of `GlassTable` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct GlassTable {
    /// Rows by class of mass: 10 times 13 rows, which is one array of 130 in memory.
    pub rows: [[GlassSizeRow; 13]; 10],
    /// Masses of landing drops at 4096 equal steps of their cumulative number.
    pub landing: [[u32; 4]; GLASS_LANDING_QUADS as usize],
}

impl GlassTable {
    /// Properties of a drop of a mass up to the maximum.
    #[inline]
    #[must_use]
    pub fn row(&self, mass: u32) -> GlassSizeRow {
        let class = glass_size_class(mass) as usize;
        match self.rows.as_flattened().get(class..class + 2) {
            Some([low, high]) => glass_size_row(*low, *high, glass_size_fraction(mass)),
            _ => GlassSizeRow::default(),
        }
    }
}

/// Class of a mass: the mass itself below 16, then eight classes per doubling.
#[inline]
#[must_use]
pub fn glass_size_class(mass: u32) -> u32 {
    if mass < 16 {
        return mass;
    }
    let top = 31 - mass.leading_zeros();
    (top - 2) * 8 + ((mass >> (top - 3)) & 7)
}

/// Smallest mass of a class.
#[inline]
#[must_use]
pub fn glass_size_floor(class: u32) -> u32 {
    if class < 16 {
        return class;
    }
    (8 + (class & 7)) << (class / 8 - 1)
}

/// Fraction of a mass between its class and the next, in units of 1/256.
#[inline]
#[must_use]
pub fn glass_size_fraction(mass: u32) -> u32 {
    if mass < 16 {
        return 0;
    }
    let shift = 31 - mass.leading_zeros() - 3;
    ((mass & ((1 << shift) - 1)) << 8) >> shift
}

/// Rank of a drop among others: its class, then its cell. Never 0.
#[inline]
#[must_use]
pub fn glass_size_key(mass: u32, index: u32) -> u32 {
    (glass_size_class(mass) << 24) | index
}

/// Interpolates between two numbers below 2^22.
#[inline]
#[must_use]
pub fn glass_size_mix(low: u32, high: u32, fraction: u32) -> u32 {
    (low as i32 + (((high as i32 - low as i32) * fraction as i32) >> 8)) as u32
}

/// Interpolates between two classes.
#[inline]
#[must_use]
pub fn glass_size_row(low: GlassSizeRow, high: GlassSizeRow, fraction: u32) -> GlassSizeRow {
    GlassSizeRow {
        radius: glass_size_mix(low.radius, high.radius, fraction),
        hold: glass_size_mix(low.hold, high.hold, fraction),
        slow: glass_size_mix(low.slow, high.slow, fraction),
        air: glass_size_mix(low.air, high.air, fraction),
        sphere: glass_size_mix(low.sphere, high.sphere, fraction),
        loss: glass_size_mix(low.loss, high.loss, fraction),
        ridge: glass_size_mix(low.ridge, high.ridge, fraction),
        ahead: glass_size_mix(low.ahead, high.ahead, fraction),
    }
}

#[cfg(test)]
mod tests {
    use downpour_shaders::lattice::glass::GLASS_CLASSES;

    use super::*;

    #[test]
    fn classes_are_in_order_and_begin_at_their_floor() {
        for mass in 1..=downpour_shaders::lattice::glass::GLASS_MAX_MASS {
            let class = glass_size_class(mass);
            assert!(glass_size_floor(class) <= mass && mass < glass_size_floor(class + 1), "{mass}");
            assert!(class + 1 < GLASS_CLASSES, "{mass}");
            let (low, high) = (glass_size_floor(class), glass_size_floor(class + 1));
            let off = i64::from(glass_size_mix(low, high, glass_size_fraction(mass))) - i64::from(mass);
            assert!(off.unsigned_abs() * 256 <= u64::from(high), "{mass}: {off}");
        }
    }
}

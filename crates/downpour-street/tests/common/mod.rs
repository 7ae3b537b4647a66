//! Settings that the tests share.

use downpour_street::{
    LampEra, MAX_CARRIAGEWAY_M, MAX_PAVEMENT_M, MIN_CARRIAGEWAY_M, MIN_LENGTH_M, MIN_PAVEMENT_M, Paving,
    StreetSettings,
};

/// Settings of a short street that differ with its seed.
pub(crate) fn settings(seed: u64) -> StreetSettings {
    let between =
        |low: f32, high: f32, n: u64| low + (high - low) * ((seed % 11 * 7 + n * 3) % 11) as f32 / 10.0;
    StreetSettings {
        seed,
        length_m: MIN_LENGTH_M + (seed % 3) as f32 * 6.0,
        carriageway_m: between(MIN_CARRIAGEWAY_M, MAX_CARRIAGEWAY_M, 1),
        pavement_m: between(MIN_PAVEMENT_M, MAX_PAVEMENT_M, 2),
        paving: if seed.is_multiple_of(2) { Paving::Cobbles } else { Paving::Asphalt },
        age: between(0.0, 1.0, 3),
        lamps: [LampEra::Lantern, LampEra::Sodium, LampEra::Led][seed as usize % 3],
        lamp_spacing_m: between(6.0, 60.0, 4),
        furniture: between(0.0, 1.0, 5),
        cars: between(0.0, 1.0, 6),
        shops: between(0.0, 1.0, 7),
        lit_windows: between(0.0, 1.0, 8),
    }
}

//! Properties of water and air against published values.

use approx::assert_relative_eq;
use downpour_drop::air::{Air, viscosity_linear, viscosity_pruppacher_klett};
use downpour_drop::{DropError, water};
use downpour_math::OutOfRange;

/// (Celsius, density kg/m^3, surface tension N/m, viscosity mPa s).
const WATER: [(f64, f64, f64, f64); 7] = [
    (0.0, 999.84, 0.075_648, 1.7918),
    (5.0, 999.964, 0.074_942, 1.5182),
    (10.0, 999.7, 0.074_221, 1.3059),
    (15.0, 999.1, 0.073_486, 1.1375),
    (20.0, 998.204, 0.072_736, 1.0016),
    (25.0, 997.045, 0.071_972, 0.89),
    (30.0, 995.647, 0.071_194, 0.7972),
];

#[test]
fn water_has_its_tabulated_properties() {
    for (t, density, tension, viscosity) in WATER {
        assert!((water::density(t).unwrap() - density).abs() <= 5.1e-4, "{t} C");
        assert!((water::surface_tension(t).unwrap() - tension).abs() <= 5.1e-7, "{t} C");
        assert!((water::viscosity(t).unwrap() * 1e3 - viscosity).abs() <= 5.1e-5, "{t} C");
    }
    assert_relative_eq!(water::kinematic_viscosity(20.0).unwrap(), 1.0034e-6, max_relative = 5e-5);
}

/// The check value of IAPWS R1-76(2014).
#[test]
fn surface_tension_has_the_release_s_value() {
    assert!((water::surface_tension(300.0 - 273.15).unwrap() - 0.071_685_962_5).abs() < 1e-10);
}

/// Supercooled water: the values of the usual tables.
#[test]
fn supercooled_water_has_its_density() {
    for (t, density) in [(-10.0, 998.117), (-20.0, 993.547)] {
        assert!((water::density(t).unwrap() - density).abs() < 0.001, "{t} C");
    }
}

/// Water is densest at 3.98 C.
#[test]
fn water_is_heaviest_near_four_degrees() {
    let heaviest = (0..4000)
        .map(|i| f64::from(i) * 0.01)
        .max_by(|a, b| water::density(*a).unwrap().total_cmp(&water::density(*b).unwrap()));
    assert!((heaviest.unwrap() - 3.98).abs() < 0.02, "{heaviest:?}");
}

#[test]
fn temperatures_outside_are_errors() {
    for t in [-20.1, 40.1, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        for property in [water::density, water::surface_tension, water::viscosity, water::kinematic_viscosity]
        {
            assert!(matches!(property(t), Err(DropError::OutOfRange(OutOfRange { .. }))), "{t}");
        }
        assert!(Air::new(t, 101_325.0).is_err(), "{t}");
    }
    let message = water::density(55.0).unwrap_err().to_string();
    assert_eq!(message, "water temperature is 55 C; allowed: -20 to 40 C");
}

#[test]
fn pressures_outside_are_errors() {
    for p in [29_999.0, 110_001.0, 0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(Air::new(20.0, p).is_err(), "{p}");
    }
    let message = Air::new(20.0, 1013.0).unwrap_err().to_string();
    assert_eq!(message, "air pressure is 10.13 hPa; allowed: 300 to 1100 hPa");
}

#[test]
fn standard_air() {
    let air = Air::standard();
    assert_eq!(air, Air::new(20.0, 101_325.0).unwrap());
    // 1.204 kg/m^3; 1.816e-5 Pa s; Beard's reference values of viscosity and mean free path.
    assert!((air.density() - 1.2041).abs() < 1e-4);
    assert!((air.viscosity() - 1.816e-5).abs() < 1e-12);
    assert_relative_eq!(air.mean_free_path(), 6.62e-8, max_relative = 2e-3);
    assert_eq!(air.speed_factor(), 1.0);
}

/// The two forms of the viscosity differ by less than 0.2 % where drops are liquid, and by 0.5 % at -20 C.
#[test]
fn both_viscosities_agree() {
    for i in -20..=40 {
        let t = f64::from(i);
        let bound = if i < 0 { 5.5e-3 } else { 2e-3 };
        assert_relative_eq!(viscosity_linear(t), viscosity_pruppacher_klett(t), max_relative = bound);
    }
}

/// Drops fall faster in thinner air: by (2)^0.4 at half of the density.
#[test]
fn thin_air_is_fast() {
    let air = Air::new(20.0, 101_325.0 / 2.0).unwrap();
    assert_relative_eq!(air.speed_factor(), 1.319_507_910_772_894, max_relative = 1e-12);
}

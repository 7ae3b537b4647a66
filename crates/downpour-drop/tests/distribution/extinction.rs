//! Published laws of extinction and visibility.

use approx::assert_relative_eq;
use downpour_drop::distribution::{ExtinctionLaw, KOSCHMIEDER, visibility};
use downpour_math::ops::f64 as ops;

/// R, and per km: Marshall & Palmer, Weber, Carbonneau, Atlas; visibility in km by the first two.
#[rustfmt::skip]
const EXTINCTION: [[f64; 7]; 9] = [
    [0.25, 0.1523, 0.1232, 0.0979, 0.1044, 25.693, 31.741],
    [1.0, 0.3647, 0.312, 0.2478, 0.25, 10.728, 12.538],
    [2.5, 0.6495, 0.5765, 0.4578, 0.4453, 6.023, 6.786],
    [5.0, 1.0052, 0.9172, 0.7283, 0.6891, 3.892, 4.265],
    [10.0, 1.5556, 1.4593, 1.1589, 1.0664, 2.515, 2.681],
    [12.5, 1.7904, 1.6947, 1.3457, 1.2274, 2.185, 2.308],
    [25.0, 2.7707, 2.6963, 2.1412, 1.8995, 1.412, 1.451],
    [50.0, 4.2878, 4.2901, 3.4067, 2.9396, 0.912, 0.912],
    [100.0, 6.6357, 6.8258, 5.4204, 4.5493, 0.59, 0.573],
];

#[test]
fn extinction_laws_have_their_tabulated_values() {
    for row in EXTINCTION {
        let laws = [
            ExtinctionLaw::MarshallPalmerGeometric,
            ExtinctionLaw::Weber2015,
            ExtinctionLaw::Carbonneau1998,
            ExtinctionLaw::Atlas1953,
        ];
        for (law, expected) in laws.into_iter().zip(&row[1..]) {
            let found = law.extinction(row[0]).unwrap() * 1e3;
            assert!((found - expected).abs() < 5.1e-5, "{law:?} at {}: {found} for {expected}", row[0]);
        }
        for (law, expected) in laws.into_iter().zip(&row[5..]) {
            let found = visibility(law.extinction(row[0]).unwrap()) * 1e-3;
            assert!((found - expected).abs() < 6e-4, "{law:?} at {}: {found} for {expected}", row[0]);
        }
    }
    let db = ExtinctionLaw::ItuRP1814.extinction(1.0).unwrap() * 1e3 * 10.0 / std::f64::consts::LN_10;
    assert_relative_eq!(db, 1.2924, max_relative = 1e-12);
    assert_relative_eq!(KOSCHMIEDER, -ops::ln(0.02), max_relative = 1e-5);
    assert_eq!(visibility(0.0), f64::INFINITY);
}

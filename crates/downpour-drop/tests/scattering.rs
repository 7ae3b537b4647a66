//! Scattering by a sphere against closed forms, an independent quadrature, and the rainbow's table.

use std::f64::consts::PI;

use downpour_drop::DropError;
use downpour_drop::optics::*;
use downpour_math::ops::f64 as ops;
use downpour_math::quadrature::GaussLegendre;

const N: f64 = WATER_INDEX;

/// The middle of an interval.
fn middle(k: usize, count: usize) -> f64 {
    PI * (k as f64 + 0.5) / count as f64
}

/// Mean of a cross-section over an interval's solid angle, and mean position weighted by its light.
fn means(k: usize, count: usize, of: impl Fn(f64) -> [f64; 2]) -> [f64; 2] {
    let rule = GaussLegendre::new(8);
    let ends = [k, k + 1].map(|k| PI * k as f64 / count as f64);
    let sum =
        |part: &dyn Fn(f64) -> f64| rule.integrate(ends[0], ends[1], |angle| ops::sin(angle) * part(angle));
    let light = sum(&|angle| of(angle)[0]);
    [light / sum(&|_| 1.0), sum(&|angle| of(angle)[0] * of(angle)[1]) / light]
}

/// Fraction of each order by the impact parameter, with the angles of each interaction computed separately.
fn fraction_by_interactions(order: u32) -> f64 {
    let rule = GaussLegendre::new(32);
    // The reflectance rises steeply toward the rim: b = 1 - t^4.
    let of = |t: f64| {
        let b = 1.0 - t * t * t * t;
        let outside = (1.0 - b * b).sqrt();
        let inside = (1.0 - b * b / (N * N)).sqrt();
        let entry = optics_fresnel_polarized(outside, N);
        let exit = optics_fresnel_polarized(inside, 1.0 / N);
        let fraction = [0, 1].map(|k| match order {
            0 => entry[k],
            p => (1.0 - entry[k]) * ops::pow(exit[k], f64::from(p - 1)) * (1.0 - exit[k]),
        });
        0.5 * (fraction[0] + fraction[1]) * 2.0 * b * 4.0 * t * t * t
    };
    rule.integrate_panels(0.0, 1.0, 8, of)
}

#[test]
fn orders_have_the_fractions_of_fresnel() {
    let table = SphereScattering::new(N, 256, SUN_DIAMETER).unwrap();
    let mut total = 0.0;
    for order in 0..SCATTERING_ORDERS {
        let expected = fraction_by_interactions(order);
        let quadrature = scattered_fraction(N, order).unwrap();
        let found = table.fraction(order);
        assert!((quadrature / expected - 1.0).abs() < 1e-5, "{order}: {quadrature} for {expected}");
        assert!((found / expected - 1.0).abs() < 1e-4, "{order}: {found} for {expected}");
        total += found;
    }
    assert!(total > 0.99 && total < 1.0, "{total}");
    let all: f64 = (0..40).map(|order| scattered_fraction(N, order).unwrap()).sum();
    assert!((all - 1.0).abs() < 1e-4, "{all}");
    // The outside reflects the mean of Fresnel's reflectance over the disk.
    let outside = diffuse_reflectance(N).unwrap();
    assert!((scattered_fraction(N, 0).unwrap() - outside).abs() < 1e-6);
}

/// b = cos(theta / 2), so that dsigma/dOmega = a^2 R / 4: a mirror would be as bright from everywhere.
#[test]
fn the_outside_is_a_mirror_dimmed_by_its_reflectance() {
    let table = SphereScattering::new(N, 256, 0.0).unwrap();
    let outside = &table.paths()[0];
    let law = |angle: f64| [optics_fresnel(ops::sin(0.5 * angle), N) / (4.0 * PI), ops::cos(0.5 * angle)];
    for (k, (&phase, &position)) in outside.phase.iter().zip(&outside.exit_position).enumerate() {
        let [expected, edge] = means(k, 256, law);
        let degrees = middle(k, 256).to_degrees();
        assert!((phase / expected - 1.0).abs() < 1e-3, "{degrees}: {phase} for {expected}");
        assert!((position - edge).abs() < 1e-4, "{degrees}: {position} for {edge}");
    }
}

/// From tan i = n sin(h) / (n cos(h) - 1) with h = theta / 2:
/// dsigma/dOmega = a^2 T^2 n^2 (n cos h - 1) (n - cos h) / (4 cos h (1 + n^2 - 2 n cos h)^2).
#[test]
fn what_goes_through_has_its_closed_form() {
    let table = SphereScattering::new(N, 256, 0.0).unwrap();
    let through = &table.paths()[1];
    let most = maximal_deviation(N).unwrap();
    let law = |angle: f64| {
        let c = ops::cos(0.5 * angle);
        let spread = 1.0 + N * N - 2.0 * N * c;
        let b = N * ops::sin(0.5 * angle) / spread.sqrt();
        let [s, p] = optics_fresnel_polarized((1.0 - b * b).sqrt(), N).map(|r| (1.0 - r) * (1.0 - r));
        let cross = N * N * (N * c - 1.0) * (N - c) / (4.0 * c * spread * spread);
        // A lens of water shows the background upside down.
        [0.5 * (s + p) * cross / PI, -b]
    };
    for (k, (&phase, &position)) in through.phase.iter().zip(&through.exit_position).enumerate() {
        let angle = middle(k, 256);
        if angle > most + 0.01 {
            assert_eq!(phase, 0.0, "{}", angle.to_degrees());
        } else if angle < 1.4 {
            let [expected, b] = means(k, 256, law);
            assert!((phase / expected - 1.0).abs() < 1e-3, "{}: {phase} for {expected}", angle.to_degrees());
            assert!((position - b).abs() < 1e-4, "{}: {position} for {b}", angle.to_degrees());
        }
    }
}

/// Index (20 C, against vacuum), radii of the primary and the secondary bow in degrees.
const RAINBOWS: [[f64; 3]; 7] = [
    [1.34356, 40.567, 53.62],
    [1.33961, 41.127, 52.608],
    [1.33679, 41.53, 51.88],
    [1.33468, 41.834, 51.331],
    [1.33335, 42.028, 50.982],
    [1.33167, 42.272, 50.541],
    [1.33052, 42.44, 50.238],
];

#[test]
fn bows_stand_where_the_table_of_rainbows_says() {
    let peak = |phase: &[f64]| {
        let best = phase.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).unwrap().0;
        middle(best, phase.len()).to_degrees()
    };
    for [index, primary, secondary] in RAINBOWS {
        let table = SphereScattering::new(index, 1800, 0.0).unwrap();
        for (paths, radius, dark) in [(2..4, primary, -0.3), (4..6, secondary, 0.3)] {
            for path in &table.paths()[paths] {
                let found = peak(&path.phase);
                assert!((found - (180.0 - radius)).abs() < 0.11, "{index}, {:?}: {found}", path.impacts);
                // Alexander's band: no light of this order on the bow's dark side.
                let beyond = ((180.0 - radius + dark) * 10.0) as usize;
                assert_eq!(path.phase[beyond], 0.0, "{index}, {:?}", path.impacts);
            }
        }
    }
}

/// The bow of a disk is wider and lower, and has the same light.
#[test]
fn a_disk_of_light_makes_a_wide_bow() {
    let tables = [0.0, 0.05].map(|diameter| SphereScattering::new(N, 1800, diameter).unwrap());
    let highest = |table: &SphereScattering| table.paths()[2].phase.iter().copied().fold(0.0, f64::max);
    let lit = |table: &SphereScattering| table.paths()[2].phase.iter().filter(|&&phase| phase > 0.0).count();
    assert!(highest(&tables[0]) > 2.0 * highest(&tables[1]));
    // Half a diameter of 0.05 radians is 14 intervals of a tenth of a degree.
    let wider = lit(&tables[1]) - lit(&tables[0]);
    assert!((12..=16).contains(&wider), "{wider}");
    for order in 0..SCATTERING_ORDERS {
        let [point, disk] = [0, 1].map(|k| tables[k].fraction(order));
        assert!((point / disk - 1.0).abs() < 1e-9, "{order}: {point}, {disk}");
    }
}

/// Exit position of a ray traced in the plane by positions and directions, without angles.
#[test]
fn glints_stand_where_a_ray_leaves() {
    let cross = |a: [f64; 3], b: [f64; 3]| a[0] * b[1] - a[1] * b[0];
    for order in 0..SCATTERING_ORDERS {
        for b in [0.05, 0.3, 0.6, 0.85, 0.95, 0.999] {
            let mut at = [-(1.0f64 - b * b).sqrt(), b, 0.0];
            let mut along = [1.0, 0.0, 0.0];
            if order == 0 {
                along = optics_reflect(along, at);
            } else {
                along = optics_refract(along, at, 1.0 / N).0;
                for interaction in 1..=order {
                    let chord = -2.0 * (at[0] * along[0] + at[1] * along[1]);
                    at = [at[0] + chord * along[0], at[1] + chord * along[1], 0.0];
                    let inward = at.map(|x| -x);
                    along = if interaction == order {
                        optics_refract(along, inward, N).0
                    } else {
                        optics_reflect(along, inward)
                    };
                }
            }
            // The light is at (-1, 0): its side of the disk, seen against the direction of the ray.
            let side = [-1.0 + along[0] * along[0], along[0] * along[1], 0.0];
            let length = ops::hypot(side[0], side[1]);
            let expected = (at[0] * side[0] + at[1] * side[1]) / length;
            let ray = scattered_ray(b, N, order).unwrap();
            assert!(
                (ray.exit_position - expected).abs() < 1e-6,
                "{order}, {b}: {} for {expected}",
                ray.exit_position
            );
            assert!((ops::cos(ray.turn) - along[0]).abs() < 1e-9, "{order}, {b}");
            assert!((ops::sin(ray.angle) - cross([1.0, 0.0, 0.0], along).abs()).abs() < 1e-7, "{order}, {b}");
        }
    }
}

#[test]
fn what_is_no_sphere_of_water_is_refused() {
    let refused = |error: DropError, words: &str| {
        let said = error.to_string();
        assert!(said.contains(words), "{said}");
    };
    refused(SphereScattering::new(f64::NAN, 256, 0.0).unwrap_err(), "allowed: 1.2 to 1.4");
    refused(SphereScattering::new(1.5, 256, 0.0).unwrap_err(), "refractive index is 1.5");
    refused(SphereScattering::new(N, 8, 0.0).unwrap_err(), "allowed: 16 to 4096");
    refused(SphereScattering::new(N, 256, -1.0).unwrap_err(), "0 to 0.2 radians");
    refused(scattered_ray(1.1, N, 1).unwrap_err(), "impact parameter is 1.1");
    refused(scattered_ray(0.5, f64::INFINITY, 1).unwrap_err(), "refractive index");
    refused(scattered_fraction(N, 5000).unwrap_err(), "order of scattering is 5000");
}

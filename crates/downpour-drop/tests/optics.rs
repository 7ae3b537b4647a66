//! Optics against exact cases and published values.

use approx::assert_relative_eq;
use downpour_drop::air::Air;
use downpour_drop::optics::*;
use downpour_math::ops::f64 as ops;
use downpour_math::quadrature::GaussLegendre;
use downpour_math::real::{Lanes, Real, Simd, WithLanes, with_widest_lanes};
use downpour_math::rng::{rng_draw, rng_unit};

fn cos_deg(angle: f64) -> f64 {
    ops::cos(angle.to_radians())
}

/// n = 1.333: degrees, across, within, unpolarized, Tatarchuk & Isidoro, Schlick.
#[rustfmt::skip]
const FRESNEL: [[f64; 6]; 18] = [
    [0.0, 0.020373, 0.020373, 0.020373, 0.05, 0.02037],
    [10.0, 0.021328, 0.01944, 0.020384, 0.05, 0.02037],
    [20.0, 0.024491, 0.01662, 0.020555, 0.050013, 0.020371],
    [30.0, 0.030934, 0.011939, 0.021436, 0.050306, 0.020412],
    [40.0, 0.043157, 0.005848, 0.024502, 0.052846, 0.021057],
    [45.0, 0.052989, 0.002808, 0.027898, 0.056991, 0.022482],
    [50.0, 0.066809, 0.000527, 0.033668, 0.065468, 0.026068],
    [53.12, 0.078258, 0.0, 0.039129, 0.074286, 0.030384],
    [55.0, 0.086518, 0.000245, 0.043382, 0.081411, 0.034182],
    [60.0, 0.115068, 0.004314, 0.059691, 0.109375, 0.050983],
    [65.0, 0.15706, 0.01718, 0.08712, 0.155579, 0.08323],
    [67.5, 0.185206, 0.029309, 0.107257, 0.187961, 0.108192],
    [70.0, 0.219672, 0.047278, 0.133475, 0.228063, 0.141186],
    [75.0, 0.314017, 0.110738, 0.212378, 0.336695, 0.239491],
    [80.0, 0.457017, 0.238816, 0.347917, 0.492979, 0.397844],
    [85.0, 0.673757, 0.49329, 0.583523, 0.709645, 0.641304],
    [88.0, 0.853561, 0.754524, 0.804043, 0.874164, 0.840579],
    [89.0, 0.923858, 0.868695, 0.896276, 0.935397, 0.917448],
];

#[test]
fn fresnel_has_its_tabulated_values() {
    for [degrees, s, p, r, tatarchuk, schlick] in FRESNEL {
        let c = cos_deg(degrees);
        let [found_s, found_p] = optics_fresnel_polarized(c, 1.333);
        for (found, expected) in [
            (found_s, s),
            (found_p, p),
            (optics_fresnel(c, 1.333), r),
            (optics_fresnel_tatarchuk(c), tatarchuk),
        ] {
            assert!((found - expected).abs() < 5.1e-7, "{degrees}: {found} for {expected}");
        }
        // The table of Schlick's form has F0 rounded to 0.02037.
        assert!((optics_fresnel_schlick(c, 1.333) - schlick).abs() < 4e-6, "{degrees}");
    }
}

/// The documented errors of Schlick's form for water.
#[test]
fn schlick_is_as_far_off_as_said() {
    let error = |degrees: f64| {
        optics_fresnel_schlick(cos_deg(degrees), 1.333) / optics_fresnel(cos_deg(degrees), 1.333) - 1.0
    };
    assert!((error(50.0) + 0.23).abs() < 0.005 && (error(80.0) - 0.14).abs() < 0.005);
}

#[test]
fn brewster_s_angle_reflects_no_p() {
    for n in [1.1, 1.333, 1.5, 2.4] {
        let [s, p] = optics_fresnel_polarized(ops::cos(brewster_angle(n).unwrap()), n);
        let expected = (n * n - 1.0) / (n * n + 1.0);
        assert!(p < 1e-28, "{n}: {p}");
        assert_relative_eq!(s, expected * expected, max_relative = 1e-12);
    }
    assert_relative_eq!(brewster_angle(1.333).unwrap().to_degrees(), 53.12, epsilon = 0.005);
    let r = optics_fresnel(ops::cos(brewster_angle(1.333).unwrap()), 1.333);
    assert!((r - 0.03913).abs() < 1e-5);
}

/// The same fraction is reflected in both directions through the interface.
#[test]
fn fresnel_is_reciprocal() {
    for n in [1.01, 1.333, 1.5, 2.0] {
        for i in 1..=1000 {
            let c = f64::from(i) / 1000.0;
            let c_t = (1.0 - (1.0 - c * c) / (n * n)).sqrt();
            let (there, back) = (optics_fresnel_polarized(c, n), optics_fresnel_polarized(c_t, 1.0 / n));
            for k in 0..2 {
                assert!((there[k] - back[k]).abs() < 1e-10, "{n} {c}: {there:?} {back:?}");
            }
        }
    }
}

/// Reflected and transmitted amplitudes from the boundary conditions of the fields: their powers add up to 1.
#[test]
fn no_power_is_lost() {
    let n = 1.333;
    for i in 1..=1000 {
        let c = f64::from(i) / 1000.0;
        let c_t = (1.0 - (1.0 - c * c) / (n * n)).sqrt();
        let t_s = 2.0 * c / (c + n * c_t);
        let t_p = 2.0 * c / (n * c + c_t);
        let [r_s, r_p] = optics_fresnel_polarized(c, n);
        assert!((r_s + n * c_t / c * t_s * t_s - 1.0).abs() < 1e-13);
        assert!((r_p + n * c_t / c * t_p * t_p - 1.0).abs() < 1e-13);
    }
}

#[test]
fn fresnel_at_its_ends() {
    // Grazing and total reflection: 1. No interface: 0.
    assert_eq!(optics_fresnel_polarized(0.0f32, 1.333), [1.0, 1.0]);
    assert_eq!(optics_fresnel_polarized(-1.0e-3f32, 1.333), [1.0, 1.0]);
    assert_eq!(optics_fresnel_polarized(0.0f32, 0.75), [1.0, 1.0]);
    let critical = critical_angle(1.333).unwrap();
    assert_eq!(optics_fresnel_polarized(ops::cos(critical + 1e-6), 1.0 / 1.333), [1.0, 1.0]);
    assert!(optics_fresnel(ops::cos(critical - 1e-3), 1.0 / 1.333) < 0.85);
    for c in [0.0, 1.0e-3, 0.5, 1.0f32] {
        assert_eq!(optics_fresnel_polarized(c, 1.0), [0.0, 0.0], "{c}");
    }
    // f32 keeps five digits up to 89.99 degrees.
    for degrees in [0.0, 45.0, 80.0, 89.0, 89.9, 89.99] {
        let c = cos_deg(degrees) as f32;
        let (single, double) =
            (optics_fresnel(c, 1.333f32), optics_fresnel(f64::from(c), f64::from(1.333f32)));
        assert_relative_eq!(f64::from(single), double, max_relative = 1e-6, epsilon = 1e-7);
    }
}

/// 6.64 % of diffuse light is reflected, and of parallel light by a sphere: both means are equal.
#[test]
fn a_sphere_reflects_what_diffuse_light_does() {
    let diffuse = diffuse_reflectance(1.333).unwrap();
    assert!((diffuse - 0.0664).abs() < 5e-5, "{diffuse}");
    // Over the disk, in rings of b db, with b = sin^2 so that the edge is resolved.
    let disk = GaussLegendre::new(64).integrate(0.0, 1.0, |u| {
        let c = u * u;
        4.0 * u * c * optics_fresnel(c, 1.333)
    });
    assert_relative_eq!(disk, diffuse, max_relative = 1e-9);
}

fn unit(random: [u32; 2]) -> [f64; 3] {
    let z = 2.0 * f64::from(rng_unit(random[0])) - 1.0;
    let phi = std::f64::consts::TAU * f64::from(rng_unit(random[1]));
    let r = (1.0 - z * z).sqrt();
    [r * ops::cos(phi), r * ops::sin(phi), z]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

/// Snell: n x i is conserved up to the index; the refracted ray is a unit vector on the far side; reversed through
/// the interface it is the incident ray.
#[test]
fn refraction_obeys_snell_and_can_be_reversed() {
    let mut total = 0;
    for i in 0..4000 {
        let random = rng_draw([5, 0], i, 0, 0);
        let incident = unit([random[0], random[1]]);
        let mut normal = unit([random[2], random[3]]);
        if dot(incident, normal) > 0.0 {
            normal = normal.map(|x| -x);
        }
        for eta in [1.0 / 1.333, 1.333, 1.0, 0.6] {
            let (refracted, squared) = optics_refract(incident, normal, eta);
            let reflected = optics_reflect(incident, normal);
            assert!((dot(reflected, reflected) - 1.0).abs() < 1e-12);
            assert!((dot(reflected, normal) + dot(incident, normal)).abs() < 1e-12);
            if squared < 0.0 {
                total += 1;
                let sine = (1.0 - dot(incident, normal) * dot(incident, normal)).sqrt();
                assert!(eta * sine > 1.0);
                continue;
            }
            assert!((dot(refracted, refracted) - 1.0).abs() < 1e-12);
            assert!((dot(refracted, normal) + squared.sqrt()).abs() < 1e-12);
            let (before, after) = (cross(normal, incident), cross(normal, refracted));
            for k in 0..3 {
                assert!((eta * before[k] - after[k]).abs() < 1e-12, "{incident:?} {normal:?} {eta}");
            }
            let back = optics_refract(refracted.map(|x| -x), normal.map(|x| -x), 1.0 / eta).0;
            for k in 0..3 {
                assert!((back[k] + incident[k]).abs() < 1e-6, "{incident:?} {normal:?} {eta}: {back:?}");
            }
            let single = optics_refract(incident.map(|x| x as f32), normal.map(|x| x as f32), eta as f32).0;
            // Near grazing refraction, a square root loses half of the digits.
            let bound = 2e-6 / squared.sqrt().max(1e-3);
            for k in 0..3 {
                assert!((f64::from(single[k]) - refracted[k]).abs() < bound, "{incident:?} {normal:?} {eta}");
            }
        }
    }
    assert!(total > 500, "{total}");
}

/// A ray through a sphere, by vectors, is deflected as by the formula, and is never totally reflected inside.
#[test]
fn a_sphere_turns_rays_as_the_formula_says() {
    let n = 1.333;
    for i in 0..=999 {
        let b = f64::from(i) / 1000.0;
        let enter = [b, 0.0, (1.0 - b * b).sqrt()];
        let (within, _) = optics_refract([0.0, 0.0, -1.0], enter, 1.0 / n);
        let chord = -2.0 * dot(within, enter);
        let leave = [0, 1, 2].map(|k| enter[k] + chord * within[k]);
        let (out, squared) = optics_refract(within, leave.map(|x| -x), n);
        assert!(squared > 0.0, "{b}");
        let turned = ops::acos((-out[2]).clamp(-1.0, 1.0));
        assert_relative_eq!(turned, deviation(b, n).unwrap(), epsilon = 2e-8);
    }
    assert_relative_eq!(deviation(1.0, n).unwrap(), maximal_deviation(n).unwrap(), epsilon = 1e-12);
}

#[test]
fn a_drop_shows_165_57_degrees() {
    for (n, deviation, field) in [(1.33, 82.49, 164.99), (1.333, 82.79, 165.57)] {
        assert!((maximal_deviation(n).unwrap().to_degrees() - deviation).abs() < 0.005, "{n}");
        assert!((field_of_view(n).unwrap().to_degrees() - field).abs() < 0.005, "{n}");
    }
    assert_relative_eq!(critical_angle(1.33).unwrap().to_degrees(), 48.75, epsilon = 0.005);
    assert_relative_eq!(critical_angle(1.333).unwrap().to_degrees(), 48.61, epsilon = 0.005);
    // Blue to red, 20 C, against vacuum.
    for (nm, field) in [(400.0, 167.6), (700.0, 165.1)] {
        let n = water_index(nm * 1e-9, 20.0).unwrap();
        assert!((field_of_view(n).unwrap().to_degrees() - field).abs() < 0.05, "{nm}");
    }
}

/// nm, index at 20 C, radii of the primary and the secondary, their angles of incidence, in degrees.
#[rustfmt::skip]
const RAINBOWS: [[f64; 6]; 7] = [
    [400.0, 1.34356, 40.567, 53.62, 58.798, 71.504],
    [450.0, 1.33961, 41.127, 52.608, 59.027, 71.63],
    [500.0, 1.33679, 41.53, 51.88, 59.19, 71.721],
    [550.0, 1.33468, 41.834, 51.331, 59.313, 71.789],
    [589.3, 1.33335, 42.028, 50.982, 59.39, 71.831],
    [650.0, 1.33167, 42.272, 50.541, 59.488, 71.886],
    [700.0, 1.33052, 42.44, 50.238, 59.555, 71.923],
];

#[test]
fn rainbows_stand_where_they_are_seen() {
    for [nm, index, primary, secondary, incidence_1, incidence_2] in RAINBOWS {
        let n = water_index(nm * 1e-9, 20.0).unwrap();
        assert!((n - index).abs() < 5.1e-6, "{nm}: {n}");
        for (k, radius, incidence) in [(1, primary, incidence_1), (2, secondary, incidence_2)] {
            let bow = rainbow(n, k).unwrap();
            assert!((bow.radius.to_degrees() - radius).abs() < 5.1e-4, "{nm}: {bow:?}");
            assert!((bow.incidence.to_degrees() - incidence).abs() < 5.1e-4, "{nm}: {bow:?}");
        }
    }
    let [primary, secondary] = [1, 2].map(|k| rainbow(4.0 / 3.0, k).unwrap().radius.to_degrees());
    assert!((primary - 42.03).abs() < 0.005 && (secondary - 50.98).abs() < 0.005);
    // A published solution for n = 1.343.
    let bow = rainbow(1.343, 2).unwrap();
    assert!((bow.deviation.to_degrees() - 233.48).abs() < 0.005, "{bow:?}");
    assert!((bow.incidence.to_degrees() - 71.52).abs() < 0.005, "{bow:?}");
}

/// nm; index of water against vacuum at 0, 10, 20, 25, 30 C (IAPWS 1997).
#[rustfmt::skip]
const WATER_INDEX_TABLE: [[f64; 6]; 20] = [
    [400.0, 1.344587, 1.344302, 1.343559, 1.343048, 1.342457],
    [404.7, 1.344148, 1.343863, 1.343121, 1.342611, 1.34202],
    [425.0, 1.342423, 1.34214, 1.341401, 1.340894, 1.340308],
    [435.8, 1.341606, 1.341323, 1.340587, 1.340082, 1.339497],
    [450.0, 1.340622, 1.34034, 1.339607, 1.339103, 1.33852],
    [475.0, 1.3391, 1.338821, 1.338091, 1.33759, 1.337011],
    [486.1, 1.338498, 1.338219, 1.337491, 1.336992, 1.336413],
    [500.0, 1.337797, 1.337519, 1.336794, 1.336295, 1.335718],
    [525.0, 1.336667, 1.336391, 1.335669, 1.335172, 1.334598],
    [546.1, 1.335822, 1.335547, 1.334828, 1.334333, 1.333761],
    [550.0, 1.335675, 1.3354, 1.334682, 1.334188, 1.333616],
    [575.0, 1.334795, 1.334522, 1.333807, 1.333315, 1.332745],
    [589.3, 1.334334, 1.334062, 1.333348, 1.332857, 1.332289],
    [600.0, 1.334006, 1.333735, 1.333023, 1.332533, 1.331965],
    [625.0, 1.333293, 1.333023, 1.332314, 1.331826, 1.33126],
    [632.8, 1.333083, 1.332815, 1.332106, 1.331618, 1.331054],
    [650.0, 1.332641, 1.332374, 1.331667, 1.33118, 1.330617],
    [656.3, 1.332485, 1.332218, 1.331512, 1.331026, 1.330463],
    [675.0, 1.332041, 1.331775, 1.331071, 1.330587, 1.330025],
    [700.0, 1.331483, 1.331219, 1.330518, 1.330035, 1.329476],
];

#[test]
fn water_has_its_tabulated_index() {
    for [nm, rest @ ..] in WATER_INDEX_TABLE {
        for (t, expected) in [0.0, 10.0, 20.0, 25.0, 30.0].into_iter().zip(rest) {
            let n = water_index(nm * 1e-9, t).unwrap();
            assert!((n - expected).abs() < 1e-6, "{nm} nm, {t} C: {n} for {expected}");
        }
    }
    let n = water_index_iapws_1997(226.5e-9, 25.0, 997.047_435).unwrap();
    assert!((n - 1.392_778_24).abs() < 5e-9, "{n}");
    // Crown-glass-like dispersion: Abbe's number.
    let [f, d, c] = [486.1, 589.3, 656.3].map(|nm| water_index(nm * 1e-9, 20.0).unwrap());
    assert!(((d - 1.0) / (f - c) - 55.75).abs() < 0.02);
}

#[test]
fn air_has_its_index() {
    // The usual value for sodium light at 15 C and 1013.25 hPa.
    let n = air_index(589.3e-9, &Air::new(15.0, 101_325.0).unwrap()).unwrap();
    assert!((n - 1.000_277).abs() < 5e-7, "{n}");
    let yellow = air_index(589.3e-9, &Air::standard()).unwrap();
    assert!((yellow - 1.000_273).abs() < 2e-6, "{yellow}");
    let n = water_index_in_air(589.3e-9, &Air::standard()).unwrap();
    assert!((n - 1.332_98).abs() < 1e-5 && (n - WATER_INDEX).abs() < 3e-5, "{n}");
}

struct OnLanes<'a> {
    cosines: &'a [f32],
    reflected: &'a mut [f32],
    refracted: &'a mut [f32],
}

impl WithLanes for OnLanes<'_> {
    type Output = ();
    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let n = Lanes::<S>::COUNT;
        let chunks =
            self.cosines.chunks(n).zip(self.reflected.chunks_mut(n)).zip(self.refracted.chunks_mut(n));
        for ((cosines, reflected), refracted) in chunks {
            let (r, x) = fresnel_and_refracted(Lanes::load(simd, cosines));
            r.store(reflected);
            x.store(refracted);
        }
    }
}

/// Reflectance from within water, and a component of the refracted ray.
#[inline(always)]
fn fresnel_and_refracted<R: Real>(cosine: R) -> (R, R) {
    let (zero, one) = (cosine.constant(0.0), cosine.constant(1.0));
    let incident = [(one - cosine * cosine).sqrt(), zero, -cosine];
    let ([x, ..], _) = optics_refract(incident, [zero, zero, one], cosine.constant(1.333));
    (optics_fresnel(cosine, cosine.constant(1.0 / 1.333)), x)
}

/// Lanes have the bits of a single ray, in total reflection too.
#[test]
fn lanes_have_the_bits_of_the_scalar() {
    let cosines: Vec<f32> = (0..=1000).map(|i| i as f32 / 1000.0).collect();
    let (mut reflected, mut refracted) = (vec![f32::NAN; 1001], vec![f32::NAN; 1001]);
    with_widest_lanes(OnLanes { cosines: &cosines, reflected: &mut reflected, refracted: &mut refracted });
    for i in 0..cosines.len() {
        let (r, x) = fresnel_and_refracted(cosines[i]);
        assert_eq!(
            (reflected[i].to_bits(), refracted[i].to_bits()),
            (r.to_bits(), x.to_bits()),
            "{}",
            cosines[i]
        );
    }
}

#[test]
fn numbers_outside_are_errors() {
    for nm in [199.0, 1101.0, -550.0, 0.0, f64::NAN, f64::INFINITY] {
        assert!(water_index(nm * 1e-9, 20.0).is_err() && air_index(nm * 1e-9, &Air::standard()).is_err());
    }
    assert!(water_index(550e-9, 41.0).is_err() && water_index(550e-9, -12.1).is_err());
    assert!(water_index_iapws_1997(550e-9, 20.0, f64::NAN).is_err());
    assert!(rgb_indices(&Air::new(-15.0, 9e4).unwrap()).is_err());
    for n in [0.99, 4.01, 0.0, -1.333, f64::NAN, f64::INFINITY] {
        assert!(critical_angle(n).is_err() && brewster_angle(n).is_err() && field_of_view(n).is_err());
        assert!(
            maximal_deviation(n).is_err() && deviation(0.5, n).is_err() && diffuse_reflectance(n).is_err()
        );
        assert!(rainbow(n, 1).is_err());
    }
    assert!(rainbow(1.333, 0).is_err() && rainbow(2.1, 1).is_err() && rainbow(2.1, 2).is_ok());
    for b in [-0.1, 1.1, f64::NAN] {
        assert!(deviation(b, 1.333).is_err());
    }
    let message = water_index(2e-6, 20.0).unwrap_err().to_string();
    assert_eq!(message, "wavelength is 2000 nm; allowed: 200 to 1100 nm");
}

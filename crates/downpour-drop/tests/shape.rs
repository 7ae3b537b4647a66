//! Equilibrium shape against the published table, and against itself between the rows.

use std::f64::consts::PI;

use downpour_drop::shape::{
    COEFFICIENTS, DropShape, DropShapeCoefficients, MAX_DIAMETER, ShapeTable, drop_shape_normal,
    drop_shape_radius, drop_shape_radius_slope, drop_shape_slope,
};
use downpour_math::ops::f64::{cbrt, cos, sin};
use downpour_math::quadrature::GaussLegendre;
use downpour_math::real::{Lanes, Simd, WithLanes, with_widest_lanes};

type Coefficients = [f64; COEFFICIENTS];

/// The printed sum, with cosines.
fn printed_radius(c: &Coefficients, theta: f64) -> f64 {
    1.0 + (0..).zip(c).map(|(n, c)| c * cos(f64::from(n) * theta)).sum::<f64>()
}

/// Volume over that of the sphere, by quadrature over theta.
fn volume_ratio(c: &Coefficients) -> f64 {
    GaussLegendre::new(64).integrate(0.0, PI, |theta| {
        let r = printed_radius(c, theta);
        0.5 * r * r * r * sin(theta)
    })
}

/// The row as printed, with the uncorrected values.
fn found_row(i: usize) -> (f64, Coefficients) {
    let row = ShapeTable::ChuangBeard1990.rows()[i];
    let mut c = row.coefficients();
    for correction in ShapeTable::CORRECTIONS {
        // The last of them is another paper's.
        if correction.diameter_m == row.diameter_m && correction.n < 2 {
            c[correction.n] = f64::from(correction.found) * 1.0e-4;
        }
    }
    (row.diameter_m, c)
}

/// Measured on the printed rows by another program: diameter (mm), volume, centroid below the origin, axis
/// ratio, largest half width, extent down, extent up; lengths over a.
const MEASURES: [[f64; 7]; 15] = [
    [1.0, 1.000031, -0.00165, 0.98367, 1.00511, 0.9837, 0.9937],
    [1.5, 1.000006, -0.00335, 0.95923, 1.01279, 0.9595, 0.9835],
    [2.0, 1.000083, -0.00499, 0.92586, 1.02391, 0.9277, 0.9683],
    [2.5, 0.999893, -0.00718, 0.88745, 1.03758, 0.8909, 0.9507],
    [3.0, 0.999946, -0.00956, 0.84687, 1.05329, 0.8528, 0.9312],
    [3.5, 0.999933, -0.01141, 0.807, 1.06976, 0.8163, 0.9103],
    [4.0, 0.99993, -0.01239, 0.76884, 1.08683, 0.7829, 0.8883],
    [4.5, 1.000167, -0.01318, 0.7331, 1.10422, 0.753, 0.866],
    [5.0, 1.000123, -0.01364, 0.7, 1.12114, 0.7259, 0.8437],
    [5.5, 1.000293, -0.01433, 0.66935, 1.13797, 0.7014, 0.822],
    [6.0, 1.00031, -0.01367, 0.64094, 1.1544, 0.6807, 0.7991],
    [6.5, 1.000196, -0.01406, 0.61484, 1.17022, 0.6611, 0.7779],
    [7.0, 1.000377, -0.01419, 0.59069, 1.18557, 0.644, 0.7566],
    [8.0, 0.997482, -0.01398, 0.54681, 1.21431, 0.6138, 0.7142],
    [9.0, 1.000429, -0.01026, 0.51007, 1.24257, 0.5952, 0.6724],
];

#[test]
fn measures_of_the_printed_rows() {
    for (i, expected) in MEASURES.iter().enumerate() {
        let (diameter, c) = found_row(i);
        assert!((diameter * 1.0e3 - expected[0]).abs() < 1.0e-12);
        let volume = volume_ratio(&c);
        assert!((volume - expected[1]).abs() < 6.0e-7, "{diameter}: {volume}");
        let shape = DropShape::from_coefficients(diameter, c).unwrap();
        // The shape is scaled to the volume of the sphere: undone here.
        let unit = shape.equivalent_radius() / cbrt(volume);
        let found = [
            -shape.centroid_height() / unit,
            shape.axis_ratio(),
            shape.max_half_width() / unit,
            shape.extent_down() / unit,
            shape.extent_up() / unit,
        ];
        for ((found, expected), tolerance) in
            found.iter().zip(&expected[2..]).zip([6.0e-6, 6.0e-6, 6.0e-6, 6.0e-5, 6.0e-5])
        {
            assert!((found - expected).abs() < tolerance, "{diameter}: {found} for {expected}");
        }
    }
}

#[test]
fn corrected_rows_close() {
    for row in ShapeTable::ChuangBeard1990.rows() {
        let volume = volume_ratio(&row.coefficients());
        assert!((volume - 1.0).abs() < 5.0e-4, "{}: {volume}", row.diameter_m);
    }
    let at_8 = ShapeTable::ChuangBeard1990.coefficients(8.0e-3).unwrap();
    assert!((volume_ratio(&at_8) - 1.0004).abs() < 1.0e-4);
    assert!((volume_ratio(&found_row(13).1) - 0.9975).abs() < 1.0e-4);
    // Rousseau 2006 prints one different digit for 9 mm, 0.12 % of the volume.
    let printed = ShapeTable::Rousseau2006.rows()[3];
    let full = ShapeTable::ChuangBeard1990.rows()[14];
    let wrong = ShapeTable::CORRECTIONS[2];
    assert_eq!((printed.printed[wrong.n], full.printed[wrong.n]), (wrong.found, wrong.used));
    assert!((volume_ratio(&printed.coefficients()) - 0.998819).abs() < 1.0e-6);
    assert_eq!(&ShapeTable::Rousseau2006.rows()[..2], &[0, 2].map(|i| ShapeTable::ChuangBeard1990.rows()[i]));
    assert_eq!(ShapeTable::Rousseau2006.rows()[2], ShapeTable::ChuangBeard1990.rows()[10]);
}

#[test]
fn the_volume_is_the_sphere_s() {
    for table in [ShapeTable::ChuangBeard1990, ShapeTable::Rousseau2006] {
        for i in 1..=180 {
            let d = f64::from(i) * 0.05e-3;
            let shape = DropShape::with_table(table, d).unwrap();
            let sphere = PI / 6.0 * d * d * d;
            assert!((volume_ratio(&shape.coefficients()) - 1.0).abs() < 1.0e-13, "{table:?} {d}");
            assert!((shape.volume() / sphere - 1.0).abs() < 1.0e-13);
            let radii = (0..=180).map(|k| shape.radius(PI * f64::from(k) / 180.0));
            assert!(radii.fold(f64::INFINITY, f64::min) > 0.5 * shape.equivalent_radius());
        }
    }
}

/// The pole below is nearer to the origin than the pole above, and within 0.5 rad of it the height changes
/// less.
#[test]
fn the_bottom_is_flatter() {
    for i in 10..=90 {
        let shape = DropShape::new(f64::from(i) * 0.1e-3).unwrap();
        assert!(shape.radius(0.0) < shape.radius(PI));
        let height = |theta: f64| shape.profile(theta)[1];
        let (below, above) = (height(0.5) - height(0.0), height(PI) - height(PI - 0.5));
        assert!(below > 0.0 && below < 0.98 * above, "{i}: {below} {above}");
        assert!(
            shape.centroid_height() > 0.0 && shape.centroid_height() < 0.0145 * shape.equivalent_radius()
        );
    }
}

/// The end of the sum at n = 10 is visible on the flat bottom of large drops: outwards, the height rises by
/// more, then by less.
#[test]
fn large_drops_have_a_ripple_below() {
    for (mm, is_rippled) in [(5.0, false), (7.0, true), (9.0, true)] {
        let shape = DropShape::new(mm * 1.0e-3).unwrap();
        let rise = |from: f64, to: f64| shape.profile(to)[1] - shape.profile(from)[1];
        let (inner, outer) = (rise(0.1, 0.2), rise(0.3, 0.4));
        assert_eq!(outer < inner, is_rippled, "{mm}: {inner} {outer}");
        assert!((inner - outer).abs() < 0.01 * shape.equivalent_radius());
    }
}

#[test]
fn exact_at_rows_and_bounded_between() {
    let rows = ShapeTable::ChuangBeard1990.rows();
    let mut worst = 0.0f64;
    for pair in rows.windows(2) {
        let (before, after) = (pair[0].coefficients(), pair[1].coefficients());
        assert_eq!(ShapeTable::ChuangBeard1990.coefficients(pair[0].diameter_m).unwrap(), before);
        assert_eq!(ShapeTable::ChuangBeard1990.coefficients(pair[1].diameter_m).unwrap(), after);
        for k in 1..20 {
            let d = pair[0].diameter_m + (pair[1].diameter_m - pair[0].diameter_m) * f64::from(k) / 20.0;
            let c = ShapeTable::ChuangBeard1990.coefficients(d).unwrap();
            for n in 0..COEFFICIENTS {
                let (low, high) = (before[n].min(after[n]), before[n].max(after[n]));
                worst = worst.max(low - c[n]).max(c[n] - high);
            }
        }
    }
    assert!(worst < 1.5e-4, "{worst}");
}

/// Midway between rows the cubic through the four nearest rows agrees.
#[test]
fn between_rows_as_four_rows_say() {
    let rows = ShapeTable::ChuangBeard1990.rows();
    for four in rows.windows(4) {
        let d = 0.5 * (four[1].diameter_m + four[2].diameter_m);
        let c = ShapeTable::ChuangBeard1990.coefficients(d).unwrap();
        for (n, &c) in c.iter().enumerate() {
            let lagrange: f64 = four
                .iter()
                .map(|p| {
                    let others = four.iter().filter(|q| q.diameter_m != p.diameter_m);
                    let weight: f64 =
                        others.map(|q| (d - q.diameter_m) / (p.diameter_m - q.diameter_m)).product();
                    weight * p.coefficients()[n]
                })
                .sum();
            assert!((c - lagrange).abs() < 1.0e-4, "{d} {n}: {c} for {lagrange}");
        }
    }
}

/// The slopes on the two sides of a row are the same, in the raw coefficients and in those of the shape.
#[test]
fn smooth_across_rows() {
    let raw = |d: f64| ShapeTable::ChuangBeard1990.coefficients(d).unwrap();
    let scaled = |d: f64| DropShape::new(d).unwrap().coefficients();
    for row in &ShapeTable::ChuangBeard1990.rows()[..14] {
        let (d, h) = (row.diameter_m, 1.0e-8);
        for of in [&raw as &dyn Fn(f64) -> Coefficients, &scaled] {
            let (below, at, above) = (of(d - h), of(d), of(d + h));
            for n in 0..COEFFICIENTS {
                let (left, right) = ((at[n] - below[n]) / h, (above[n] - at[n]) / h);
                // Slopes are up to 50 per meter; curvature (below 2e4 per m^2) times h is the allowed difference.
                assert!((left - right).abs() < 1.0e-3, "{d} {n}: {left} {right}");
            }
        }
    }
}

#[test]
fn small_drops_become_spheres() {
    let deformation = |d: f64| {
        let c = DropShape::new(d).unwrap().coefficients();
        c[1..].iter().fold(0.0f64, |worst, c| worst.max(c.abs()))
    };
    let at_1 = deformation(1.0e-3);
    for d in [0.5e-3, 0.1e-3, 1.0e-5, 1.0e-6] {
        let bond = (d / 1.0e-3) * (d / 1.0e-3);
        assert!((deformation(d) / (at_1 * bond) - 1.0).abs() < 1.0e-3, "{d}");
    }
    let shape = DropShape::new(1.0e-6).unwrap();
    assert!((shape.axis_ratio() - 1.0).abs() < 1.0e-7);
    let sphere = DropShape::sphere(2.0e-3).unwrap();
    assert_eq!(sphere.coefficients(), [0.0; COEFFICIENTS]);
    assert!((sphere.surface_area() / (PI * 4.0e-6) - 1.0).abs() < 1.0e-13);
    assert!((sphere.axis_ratio() - 1.0).abs() < 1.0e-13 && sphere.centroid_height().abs() < 1.0e-18);
}

/// The area by quadrature, against cones between points of the profile.
#[test]
fn surface_area() {
    for mm in [1.0, 3.0, 6.0, 9.0] {
        let shape = DropShape::new(mm * 1.0e-3).unwrap();
        let steps = 4000;
        let points: Vec<_> =
            (0..=steps).map(|i| shape.profile(PI * f64::from(i) / f64::from(steps))).collect();
        let cones: f64 = points
            .windows(2)
            .map(|p| {
                let (dx, dy) = (p[1][0] - p[0][0], p[1][1] - p[0][1]);
                PI * (p[0][0] + p[1][0]) * (dx * dx + dy * dy).sqrt()
            })
            .sum();
        assert!((shape.surface_area() / cones - 1.0).abs() < 1.0e-6, "{mm}");
        assert!(shape.surface_area() > PI * mm * mm * 1.0e-6, "a sphere has the least");
    }
}

#[test]
fn refused_numbers() {
    for d in [f64::NAN, f64::INFINITY, -f64::INFINITY, 0.0, -1.0e-3, 1.0e-46, 0.99e-6, 9.00001e-3, 1.0] {
        assert!(DropShape::new(d).is_err() && DropShape::sphere(d).is_err(), "{d}");
        assert!(DropShape::with_table(ShapeTable::Rousseau2006, d).is_err(), "{d}");
        assert!(ShapeTable::ChuangBeard1990.coefficients(d).is_err(), "{d}");
    }
    let error = DropShape::new(9.5e-3).unwrap_err();
    assert_eq!(error.to_string(), "diameter is 9.5 mm; allowed: 0.001 to 9");
    for d in [1.0e-6, MAX_DIAMETER, 9.0 * 1.0e-3, f64::from(9.0e-3f32)] {
        assert!(DropShape::new(d).is_ok(), "{d}");
    }
    let with = |n: usize, c: f64| {
        let mut all = [0.0; COEFFICIENTS];
        all[n] = c;
        DropShape::from_coefficients(2.0e-3, all)
    };
    for (n, c) in [
        (3, f64::NAN),
        (10, f64::INFINITY),
        (0, -1.0),
        (0, -2.0),
        (0, 1.0e300),
        (1, 1.01),
        (2, -1.5),
        (10, 1.0e300),
    ] {
        assert!(with(n, c).is_err(), "c{n} = {c}");
    }
    for (n, c) in [(0, 0.5), (1, 0.3), (2, -0.4), (10, 0.2)] {
        let shape = with(n, c).unwrap();
        assert!((volume_ratio(&shape.coefficients()) - 1.0).abs() < 1.0e-13);
    }
}

#[test]
fn the_recurrence_is_the_sum() {
    for mm in [0.3, 1.0, 2.2, 5.0, 9.0] {
        let c = DropShape::new(mm * 1.0e-3).unwrap().coefficients();
        for i in 0..=200 {
            let theta = PI * f64::from(i) / 200.0;
            let x = cos(theta);
            assert!((drop_shape_radius(&c, x) - printed_radius(&c, theta)).abs() < 1.0e-14);
            if i > 0 && i < 200 {
                // d rho / d x = sum n c_n sin(n theta) / sin(theta).
                let slope: f64 =
                    (0..).zip(&c).map(|(n, c)| f64::from(n) * c * sin(f64::from(n) * theta)).sum();
                assert!((drop_shape_slope(&c, x) - slope / sin(theta)).abs() < 1.0e-12, "{mm} {theta}");
            }
        }
    }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    v.map(|x| x / dot(v, v).sqrt())
}

/// Evenly spread unit vectors, the first along `up` and the last against it.
fn directions(up: [f64; 3]) -> Vec<[f64; 3]> {
    let side = unit(cross(up, [0.3, -0.5, 0.8]));
    let third = cross(up, side);
    (0..=200)
        .map(|i| {
            let (theta, phi) = (PI * f64::from(i) / 200.0, 2.4 * f64::from(i));
            std::array::from_fn(|k| {
                cos(theta) * up[k] + sin(theta) * (cos(phi) * side[k] + sin(phi) * third[k])
            })
        })
        .collect()
}

/// The normal is perpendicular to the surface: two tangents by central differences.
#[test]
fn normals_against_differences() {
    for (mm, up) in [(1.0, [0.0, 1.0, 0.0]), (5.0, unit([0.2, 0.9, -0.4])), (9.0, unit([-1.0, 0.1, 0.3]))] {
        let c = DropShape::new(mm * 1.0e-3).unwrap().coefficients();
        let position = |p: [f64; 3]| {
            let r = drop_shape_radius(&c, -dot(p, up));
            p.map(|x| r * x)
        };
        for p in directions(up) {
            let normal = drop_shape_normal(&c, p, up);
            assert!((dot(normal, normal) - 1.0).abs() < 1.0e-14 && dot(normal, p) > 0.5);
            let side = unit(cross(p, [0.48, 0.6, 0.64]));
            for tangent in [side, cross(p, side)] {
                let h = 1.0e-5;
                let at = |h: f64| position(unit(std::array::from_fn(|k| p[k] + h * tangent[k])));
                let (ahead, behind) = (at(h), at(-h));
                let along: [f64; 3] = std::array::from_fn(|k| (ahead[k] - behind[k]) / (2.0 * h));
                assert!(dot(along, normal).abs() < 2.0e-9, "{mm} {p:?}: {}", dot(along, normal));
            }
        }
        for side in [1.0, -1.0] {
            let pole = drop_shape_normal(&c, up.map(|u| side * u), up);
            assert!((0..3).all(|k| (pole[k] - side * up[k]).abs() < 1.0e-15), "{pole:?}");
        }
    }
    let shape = DropShape::new(4.0e-3).unwrap();
    assert_eq!(shape.normal(0.0), [0.0, -1.0]);
    let [away, up] = shape.normal(0.5 * PI);
    assert!(away > 0.9 && up > 0.0, "the widest part is below the origin: {away} {up}");
}

#[test]
fn single_precision_is_near() {
    let up32 = [0.0f32, 1.0, 0.0];
    let (mut radius, mut slope, mut normal) = (0.0f64, 0.0f64, 0.0f64);
    for mm in [0.5, 1.0, 2.7, 5.0, 9.0] {
        let shape = DropShape::new(mm * 1.0e-3).unwrap();
        let c = shape.coefficients();
        assert_eq!(c.map(|c| c as f32).map(f64::from), Coefficients::from(shape.gpu_coefficients()));
        for p in directions([0.0, 1.0, 0.0]) {
            let p32 = p.map(|x| x as f32);
            let x = -p32[1];
            let [r, s] = drop_shape_radius_slope(&c, x).map(f64::from);
            let [r64, s64] = drop_shape_radius_slope(&c, f64::from(x));
            (radius, slope) = (radius.max((r - r64).abs()), slope.max((s - s64).abs()));
            let (n, n64) = (drop_shape_normal(&c, p32, up32), drop_shape_normal(&c, p, [0.0, 1.0, 0.0]));
            normal = (0..3).fold(normal, |worst, k| worst.max((f64::from(n[k]) - n64[k]).abs()));
        }
    }
    assert!(radius < 2.0e-7 && slope < 2.0e-6 && normal < 5.0e-7, "{radius} {slope} {normal}");
    assert_eq!(size_of::<DropShapeCoefficients>(), 48);
    assert_eq!(bytemuck::bytes_of(&DropShapeCoefficients::default()), [0; 48]);
}

struct Radii<'a>(&'a Coefficients, &'a [f32], &'a mut [f32]);

impl WithLanes for Radii<'_> {
    type Output = ();
    #[inline(always)]
    fn run<S: Simd>(self, simd: S) {
        let n = Lanes::<S>::COUNT;
        for (x, out) in self.1.chunks(n).zip(self.2.chunks_mut(n)) {
            let [radius, slope] = drop_shape_radius_slope(self.0, Lanes::load(simd, x));
            (radius + slope).store(out);
        }
    }
}

#[test]
fn lanes_have_the_bits_of_the_scalar() {
    let c = DropShape::new(6.3e-3).unwrap().coefficients();
    let x: Vec<f32> = (-500..=500).map(|i| i as f32 * 0.002).collect();
    let mut out = vec![f32::NAN; x.len()];
    with_widest_lanes(Radii(&c, &x, &mut out));
    for (&x, &out) in x.iter().zip(&out) {
        assert_eq!(out.to_bits(), (drop_shape_radius(&c, x) + drop_shape_slope(&c, x)).to_bits());
    }
}

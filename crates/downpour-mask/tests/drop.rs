//! Masks of drops of revolution against analytic cases and an independent trace.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use downpour_drop::DropShape;
use downpour_mask::trace::{TracedDrop, mask_trace_through};
use downpour_mask::{LOST, MaskError, MaskOptions, View, trace_drop, trace_drop_f64, trace_drop_scalar};
use downpour_math::ops::f64 as ops;
use downpour_math::vector::{add_scaled, dot, normalize, scale};

const INDEX: f64 = 1.333;

fn sphere() -> DropShape {
    DropShape::sphere(2.0e-3).unwrap()
}

fn view(degrees: f64) -> View {
    View::from_elevation(degrees.to_radians()).unwrap()
}

fn options(size: u32, degrees: f64) -> MaskOptions {
    MaskOptions { size, view: view(degrees), refractive_index: INDEX }
}

fn largest_difference(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y).abs()).fold(0.0, f64::max)
}

fn traced(shape: &DropShape, degrees: f64, steps: u32) -> TracedDrop {
    let a = shape.equivalent_radius();
    let wide = shape.max_half_width() / a;
    let tall = 0.5 * (shape.extent_up() + shape.extent_down()) / a;
    TracedDrop {
        coefficients: shape.coefficients(),
        up: view(degrees).up(),
        index: INDEX,
        inverse_wide: 1.0 / (wide * wide),
        inverse_tall: 1.0 / (tall * tall),
        steps,
    }
}

/// Through a sphere a ray at distance b from the axis turns by 2 (i - r), sin i = b, sin r = b / n.
#[test]
fn a_sphere_turns_a_ray_by_twice_the_difference() {
    let drop = traced(&sphere(), 30.0, 4);
    for k in 0..=1000 {
        let b = f64::from(k) / 1000.0;
        let phi = 0.7 * f64::from(k);
        let (x, y) = (b * ops::cos(phi), b * ops::sin(phi));
        let turn = 2.0 * (ops::asin(b) - ops::asin(b / INDEX));
        // The ray bends toward the axis: the picture in the drop is upside down.
        let exact = [-ops::sin(turn) * ops::cos(phi), -ops::sin(turn) * ops::sin(phi), -ops::cos(turn)];
        let through = mask_trace_through(&drop, x, y);
        // The derivative of asin grows without bound toward the rim.
        let slack = 1.0e-9 / (1.0 - b * b).sqrt().max(1.0e-6);
        let error = largest_difference(through.direction, exact);
        assert!(error < slack.max(1.0e-12), "b = {b}: {:?} for {exact:?}", through.direction);
        assert_eq!(through.reflections, 0.0, "b = {b}");
        if b < 0.999 {
            let single = mask_trace_through(&drop, x as f32, y as f32);
            let error = largest_difference(single.direction.map(f64::from), exact);
            assert!(error < 1.0e-5, "b = {b} in f32: {error:e}");
        }
    }
}

/// The edge of a sphere shows what is 180 - 2 asin(1/n) degrees off: the field of view of the papers.
#[test]
fn the_edge_of_a_sphere_turns_by_the_limit() {
    let through = mask_trace_through(&traced(&sphere(), 0.0, 4), 1.0 - 1.0e-13, 0.0);
    let degrees = ops::acos(-through.direction[2]).to_degrees();
    let limit = 180.0 - 2.0 * ops::asin(1.0 / INDEX).to_degrees();
    assert!((degrees - limit).abs() < 1.0e-4, "{degrees} for {limit}");
    assert!((2.0 * limit - 165.57).abs() < 0.01, "the table's field of view is 165.57 degrees");
}

/// Exact Fresnel through a sphere: both interfaces have the same angle and plane of incidence, so that
/// T = ((1 - Rs)^2 + (1 - Rp)^2) / 2.
#[test]
fn a_sphere_lets_through_what_fresnel_says() {
    let drop = traced(&sphere(), 0.0, 4);
    for k in 0..100 {
        let b = f64::from(k) / 100.0;
        let (i, r) = (ops::asin(b), ops::asin(b / INDEX));
        let (ci, cr) = (ops::cos(i), ops::cos(r));
        let square = |v: f64| v * v;
        let rs = square((ci - INDEX * cr) / (ci + INDEX * cr));
        let rp = square((INDEX * ci - cr) / (INDEX * ci + cr));
        let through = mask_trace_through(&drop, 0.6 * b, 0.8 * b);
        let exact = 0.5 * (square(1.0 - rs) + square(1.0 - rp));
        assert!(
            (through.transmittance - exact).abs() < 1.0e-10,
            "b = {b}: {} for {exact}",
            through.transmittance
        );
        assert!((through.reflectance - 0.5 * (rs + rp)).abs() < 1.0e-10, "b = {b}");
        // Reflection: the angle doubles.
        let reflected = through.reflected;
        let exact = [0.6 * ops::sin(2.0 * i), 0.8 * ops::sin(2.0 * i), ops::cos(2.0 * i)];
        assert!(largest_difference(reflected, exact) < 1.0e-10, "b = {b}: {reflected:?} for {exact:?}");
    }
}

/// Light that is reflected inside a sphere once turns by 2 (i - r) + 180 degrees - 2 r (van de Hulst 1957, 12.21), and its
/// fraction is that of each polarization: (1 - R)^2 R.
#[test]
fn a_sphere_sends_back_what_it_reflects_inside() {
    let drop = traced(&sphere(), -20.0, 4);
    for k in 1..990 {
        let b = f64::from(k) / 1000.0;
        let phi = 0.7 * f64::from(k);
        let (i, r) = (ops::asin(b), ops::asin(b / INDEX));
        let turn = 2.0 * (i - r) + std::f64::consts::PI - 2.0 * r;
        let exact = [-ops::sin(turn) * ops::cos(phi), -ops::sin(turn) * ops::sin(phi), -ops::cos(turn)];
        let through = mask_trace_through(&drop, b * ops::cos(phi), b * ops::sin(phi));
        let error = largest_difference(through.internal, exact);
        assert!(error < 1.0e-9, "b = {b}: {:?} for {exact:?}", through.internal);
        let (ci, cr) = (ops::cos(i), ops::cos(r));
        let fraction = |amplitude: f64| {
            let reflected = amplitude * amplitude;
            0.5 * (1.0 - reflected) * (1.0 - reflected) * reflected
        };
        let exact =
            fraction((ci - INDEX * cr) / (ci + INDEX * cr)) + fraction((INDEX * ci - cr) / (INDEX * ci + cr));
        let found = through.internal_transmittance;
        assert!((found - exact).abs() < 1.0e-9, "b = {b}: {found} for {exact}");
    }
}

/// A mask lacks only the light that is reflected inside twice and more: 0.6 to 1.2 % of all light of a drop up to
/// 6 mm, from any direction, and in no texel below 0.
#[test]
fn a_mask_has_almost_all_light() {
    for (d, degrees) in [(0.5e-3, 0.0), (2.0e-3, 0.0), (2.0e-3, 40.0), (4.0e-3, -25.0), (6.0e-3, 70.0)] {
        let mask = trace_drop(&DropShape::new(d).unwrap(), &options(128, degrees)).unwrap();
        let (mut rest, mut all) = (0.0, 0.0);
        for texel in mask.texels.iter().filter(|texel| texel.coverage > 0.0) {
            let accounted =
                texel.transmittance + texel.internal_transmittance + texel.reflectance(INDEX as f32);
            assert!(accounted < 1.0 + 1.0e-5, "{accounted}");
            rest += f64::from(texel.coverage * (1.0 - accounted));
            all += f64::from(texel.coverage);
        }
        println!("{d}, {degrees} degrees: {:.4}", rest / all);
        assert!((0.002..0.02).contains(&(rest / all)), "{d}, {degrees} degrees: {}", rest / all);
    }
}

#[test]
fn the_area_of_a_sphere_is_that_of_a_disk() {
    for size in [16, 63, 64, 256] {
        let mask = trace_drop(&sphere(), &options(size, 0.0)).unwrap();
        let area: f64 = mask.texels.iter().map(|t| f64::from(t.coverage)).sum::<f64>()
            * mask.texel_width()
            * mask.texel_width();
        let error = (area / std::f64::consts::PI - 1.0).abs();
        // A tangent instead of an arc adds 1 / (12 R^2) to the area of a disk of R pixels.
        let radius = 1.0 / mask.texel_width();
        let allowed = 1.0 / (12.0 * radius * radius);
        assert!(error < 1.1 * allowed + 1.0e-6, "size {size}: {error:e} of {allowed:e}");
    }
}

/// An independent trace: the surface by bisection of |p| - r(theta), the normal by finite differences of it.
struct Brute<'a> {
    shape: &'a DropShape,
    up: [f64; 3],
}

impl Brute<'_> {
    fn outside(&self, p: [f64; 3]) -> f64 {
        let length = dot(p, p).sqrt();
        let theta = ops::acos((-dot(p, self.up) / length).clamp(-1.0, 1.0));
        length - self.shape.radius(theta) / self.shape.equivalent_radius()
    }

    fn normal(&self, p: [f64; 3]) -> [f64; 3] {
        let h = 1.0e-5;
        normalize(std::array::from_fn(|k| {
            let mut step = [0.0; 3];
            step[k] = h;
            (self.outside(add_scaled(p, step, 1.0)) - self.outside(add_scaled(p, step, -1.0))) / (2.0 * h)
        }))
    }

    /// The first change of side from `from` on.
    fn cross(&self, origin: [f64; 3], direction: [f64; 3], from: f64) -> Option<[f64; 3]> {
        let at = |t: f64| self.outside(add_scaled(origin, direction, t));
        let step = 2.0e-3;
        let start = at(from) > 0.0;
        let mut t = from;
        while t < 6.0 {
            if (at(t + step) > 0.0) != start {
                let (mut low, mut high) = (t, t + step);
                for _ in 0..60 {
                    let middle = 0.5 * (low + high);
                    if (at(middle) > 0.0) == start { low = middle } else { high = middle }
                }
                return Some(add_scaled(origin, direction, 0.5 * (low + high)));
            }
            t += step;
        }
        None
    }

    fn refract(d: [f64; 3], n: [f64; 3], eta: f64) -> Option<[f64; 3]> {
        let c = -dot(d, n);
        let k = 1.0 - eta * eta * (1.0 - c * c);
        (k >= 0.0).then(|| add_scaled(scale(d, eta), n, eta * c - k.sqrt()))
    }

    /// Direction and number of total reflections; `None` if the ray misses.
    fn trace(&self, x: f64, y: f64) -> Option<([f64; 3], u32)> {
        let incident = [0.0, 0.0, -1.0];
        let entry = self.cross([x, y, 3.0], incident, 0.0)?;
        let mut direction = Self::refract(incident, self.normal(entry), 1.0 / INDEX)?;
        let mut point = entry;
        for reflections in 0..LOST {
            point = self.cross(point, direction, 1.0e-6)?;
            let normal = self.normal(point);
            if let Some(out) = Self::refract(direction, scale(normal, -1.0), INDEX) {
                return Some((out, reflections));
            }
            direction = add_scaled(direction, normal, -2.0 * dot(direction, normal));
        }
        Some((direction, LOST))
    }
}

/// f32 and f64 masks of drops up to 9 mm, from all sides, against the independent trace.
#[test]
fn drops_are_traced_as_bisection_traces_them() {
    for (d, degrees) in [
        (1.0e-3, 0.0),
        (2.0e-3, 40.0),
        (3.0e-3, 0.0),
        (5.0e-3, -60.0),
        (6.0e-3, 0.0),
        (7.0e-3, 15.0),
        (9.0e-3, 0.0),
        (9.0e-3, 90.0),
    ] {
        let shape = DropShape::new(d).unwrap();
        let brute = Brute { shape: &shape, up: view(degrees).up() };
        let drop = traced(&shape, degrees, 16);
        let (mut compared, mut worst) = (0, 0.0f64);
        for k in 0..400 {
            let r = (f64::from(k) / 400.0).sqrt() * 1.2;
            let phi = 2.399_963 * f64::from(k);
            let (x, y) = (r * ops::cos(phi), r * ops::sin(phi));
            let Some((exact, reflections)) = brute.trace(x, y) else { continue };
            let through = mask_trace_through(&drop, x, y);
            // At the angle of total reflection itself the two may decide differently; light that is lost has no
            // direction to compare.
            if f64::from(reflections) != through.reflections || reflections == LOST {
                continue;
            }
            let error = largest_difference(through.direction, exact);
            worst = worst.max(error);
            compared += 1;
        }
        assert!(compared > 150, "d = {d}: only {compared} rays compared");
        assert!(worst < 1.0e-7, "d = {d}, {degrees} degrees: {worst:e}");
    }
}

/// The f32 mask has the directions of the f64 mask to 1e-5, except where the last refraction is close to total
/// reflection, and where total reflections multiply every error.
#[test]
fn f32_is_as_good_as_f64() {
    let cases = [
        (0.5e-3, 0.0),
        (1.0e-3, 0.0),
        (2.0e-3, 0.0),
        (3.0e-3, 30.0),
        (6.0e-3, 0.0),
        (9.0e-3, 0.0),
        (6.0e-3, 90.0),
        (5.0e-3, -90.0),
    ];
    for (d, degrees) in cases {
        let shape = DropShape::new(d).unwrap();
        let fast = trace_drop(&shape, &options(256, degrees)).unwrap();
        let exact = trace_drop_f64(&shape, &options(256, degrees)).unwrap();
        let (mut direct, mut outside, mut differ, mut worst) = (0, 0, 0, 0.0f32);
        for (a, b) in fast.texels.iter().zip(&exact.texels) {
            assert!((a.coverage - b.coverage).abs() < 2.0e-4, "{a:?} {b:?}");
            if a.coverage < 0.5 {
                continue;
            }
            differ += u32::from(a.reflections != b.reflections);
            if a.reflections == 0 && b.reflections == 0 {
                let error = (0..3).map(|k| (a.direction[k] - b.direction[k]).abs()).fold(0.0, f32::max);
                worst = worst.max(error);
                direct += 1;
                let dimmed = (a.transmittance - b.transmittance).abs();
                outside += u32::from(error > 1.0e-5 || dimmed > 1.0e-4);
            }
        }
        let fraction = f64::from(outside) / f64::from(direct);
        println!(
            "d = {d} m at {degrees} degrees: worst {worst:e}, fraction above 1e-5 {fraction:e}, {differ} differ"
        );
        assert!(direct > 20_000, "d = {d} at {degrees} degrees: {direct} texels of direct light");
        // Light that leaves a 9 mm drop below its hollow does so close to total reflection.
        let allowed = if d < 9.0e-3 { 1.0e-3 } else { 2.0e-3 };
        assert!(
            fraction < allowed,
            "d = {d} at {degrees} degrees: {fraction} of the texels are off by more than 1e-5"
        );
        if degrees == 0.0 && d < 7.0e-3 {
            assert!(worst < 1.0e-5, "d = {d} from the side: {worst:e}");
        }
        assert!(
            f64::from(differ) < 2.0e-3 * f64::from(direct),
            "d = {d}: {differ} texels reflect differently"
        );
    }
}

#[test]
fn lanes_and_mirror_give_the_bits_of_the_plain_loop() {
    for (size, d, degrees) in
        [(64, 2.0e-3, 0.0), (63, 6.0e-3, 25.0), (37, 9.0e-3, -70.0), (5, 4.0e-3, 0.0), (4, 1.0e-3, 0.0)]
    {
        let shape = DropShape::new(d).unwrap();
        let fast = trace_drop(&shape, &options(size, degrees)).unwrap();
        let plain = trace_drop_scalar(&shape, &options(size, degrees)).unwrap();
        for (i, (a, b)) in fast.texels.iter().zip(&plain.texels).enumerate() {
            let bits = |t: &downpour_mask::MaskTexel| -> Vec<u32> {
                t.direction
                    .iter()
                    .chain(&t.reflected)
                    .chain([&t.coverage, &t.transmittance])
                    .map(|v| (v + 0.0).to_bits())
                    .collect()
            };
            assert_eq!(bits(a), bits(b), "size {size}, texel {i}: {a:?} {b:?}");
            assert_eq!(a.reflections, b.reflections);
        }
    }
}

#[test]
fn bad_options_are_refused() {
    for size in [0, 3, 4097, 1_000_000] {
        let error = trace_drop(&sphere(), &options(size, 0.0)).unwrap_err();
        assert!(matches!(error, MaskError::Size { found, .. } if found == size), "{error}");
        assert!(matches!(error, MaskError::Size { found, .. } if found == size));
    }
    for index in [1.0, 0.5, -1.0, f64::NAN, f64::INFINITY, 4.1] {
        let options = MaskOptions { refractive_index: index, ..MaskOptions::default() };
        assert!(trace_drop(&sphere(), &options).is_err(), "{index}");
    }
    for degrees in [91.0, -90.1, f64::NAN, f64::INFINITY] {
        assert!(View::from_elevation(degrees.to_radians()).is_err(), "{degrees}");
    }
}

//! Onset of sliding: Furmidge's law on the lattice.

use downpour_lattice::glass::{Glass, GlassAir, GlassContact, GlassOptions, GlassTexture};

/// Density and surface tension of water at 20 C.
const DENSITY: f64 = 998.2;
const SIGMA: f64 = 0.07274;

fn contact(advancing: f64, receding: f64, retention: f64) -> GlassContact {
    let (advancing_rad, receding_rad) = (f64::to_radians(advancing), f64::to_radians(receding));
    GlassContact { advancing_rad, receding_rad, retention, ..GlassContact::default() }
}

/// An even pane without rain.
fn pane(contact: GlassContact, tilt: f64) -> GlassOptions {
    GlassOptions {
        size: [32, 32],
        tilt_rad: tilt.to_radians(),
        contact,
        affinity: GlassTexture::Even,
        friction: GlassTexture::Even,
        ..GlassOptions::default()
    }
}

/// True if a drop of a volume, in mm^3, has left its cell after a second and a half.
fn slides(options: &GlassOptions, mm3: f64) -> bool {
    let mut glass = Glass::new(options).expect("a pane");
    glass.pour(16, 16, mm3 * 1.0e-9).expect("a drop");
    glass.step(1.5).expect("a step");
    // It may have left a bead there.
    f64::from(glass.mass()[16 * 32 + 16]) < 0.5e3 * mm3
}

/// Diameter, in mm, of the sphere with the volume from which drops slide.
fn threshold(options: &GlassOptions) -> f64 {
    let (mut low, mut high) = (0.01, 262.0);
    for _ in 0..13 {
        let middle = f64::sqrt(low * high);
        if slides(options, middle) {
            high = middle;
        } else {
            low = middle;
        }
    }
    diameter(high)
}

fn diameter(mm3: f64) -> f64 {
    downpour_math::ops::f64::cbrt(6.0 * mm3 / std::f64::consts::PI)
}

/// Advancing and receding angle in degrees, k, and the equivalent diameter in mm at which a cap at the mean angle
/// slides down a vertical pane, by Furmidge's law (computed independently of this code, for water at 20 C).
const TABLE: [(f64, f64, f64, f64); 8] = [
    (80.0, 55.0, 1.0, 2.932),
    (80.0, 55.0, 0.774, 2.579),
    (60.0, 20.0, 0.774, 3.041),
    (60.0, 20.0, std::f64::consts::FRAC_2_PI, 2.758),
    (50.0, 10.0, 1.0, 3.218),
    (40.0, 10.0, std::f64::consts::FRAC_2_PI, 2.122),
    (70.0, 30.0, 1.0, 3.604),
    (105.0, 90.0, 0.774, 1.829),
];

#[test]
fn drops_slide_down_a_window_from_the_diameter_of_furmidge() {
    for (advancing, receding, k, expected) in TABLE {
        let found = threshold(&pane(contact(advancing, receding, k), 90.0));
        assert!(
            (found / expected - 1.0).abs() < 0.015,
            "{advancing}, {receding}, {k}: {found} mm for {expected}"
        );
        if advancing < 100.0 {
            assert!((2.1..=3.62).contains(&found), "{advancing}, {receding}, {k}: {found} mm");
        }
    }
}

#[test]
fn the_default_pane_with_its_noise_stays_in_the_range_of_plausible_glass() {
    let even = threshold(&pane(GlassContact::default(), 90.0));
    for seed in 0..6 {
        let options = GlassOptions { size: [32, 32], seed, ..GlassOptions::default() };
        let found = threshold(&options);
        assert!((2.1..=3.6).contains(&found), "seed {seed}: {found} mm, {even} mm on even glass");
    }
}

#[test]
fn a_flatter_pane_holds_larger_drops() {
    for tilt in [90.0, 60.0, 45.0, 30.0, 20.0] {
        let contact = GlassContact::default();
        let found = threshold(&pane(contact, tilt));
        let volume = contact.sliding_volume(tilt.to_radians(), DENSITY, SIGMA) * 1.0e9;
        // V^(2/3) is proportional to 1 / sin(tilt), the diameter to its root.
        let sine = downpour_math::ops::f64::sin(tilt.to_radians());
        let law = diameter(contact.sliding_volume(90f64.to_radians(), DENSITY, SIGMA) * 1.0e9) / sine.sqrt();
        assert!((diameter(volume) / law - 1.0).abs() < 1.0e-6);
        assert!((found / law - 1.0).abs() < 0.02, "{tilt} degrees: {found} mm for {law}");
    }
}

#[test]
fn nothing_slides_on_a_level_pane_in_still_air() {
    assert!(!slides(&pane(GlassContact::default(), 0.0), 262.0));
    assert!(GlassContact::default().sliding_volume(0.0, DENSITY, SIGMA).is_infinite());
}

#[test]
fn air_drives_drops_up_a_windshield_and_gravity_down() {
    let level = |speed_m_s: f64| {
        let air = GlassAir { speed_m_s, ..GlassAir::default() };
        let mut glass =
            Glass::new(&GlassOptions { air, ..pane(GlassContact::default(), 30.0) }).expect("a pane");
        glass.pour(16, 16, 25.0e-9).expect("a drop");
        glass.step(0.03).expect("a step");
        let at = glass.mass().iter().position(|&m| m > 20_000).expect("the drop is still on the pane");
        at as i32 / 32 - 16
    };
    assert_eq!(level(0.0), 0, "25 mm^3 hold at 30 degrees");
    assert!(level(25.0) < -2, "{}", level(25.0));
}

#[test]
fn running_drops_have_the_speeds_that_are_told_of_panes() {
    // 5 to 20 cm/s for 10 to 50 ul, within a factor of two at the ends; and larger drops are faster.
    let speed = |mm3: f64| {
        let mut glass = Glass::new(&GlassOptions { size: [32, 512], ..pane(GlassContact::default(), 90.0) })
            .expect("a pane");
        glass.pour(16, 20, mm3 * 1.0e-9).expect("a drop");
        glass.step(0.5).expect("a step");
        glass.velocities().iter().map(|v| f64::from(v[1])).fold(0.0, f64::max)
    };
    let [small, middle, large] = [18.0, 30.0, 50.0].map(speed);
    assert!(small < middle && middle < large, "{small}, {middle}, {large}");
    assert!(small > 0.025 && large < 0.4, "{small}, {middle}, {large}");
}

/// Water of 0 C is 2.2 times as viscous as that of 30 C (IAPWS): a drop runs that much slower, but for the friction, which is
/// as the surface tension.
#[test]
fn drops_of_cold_water_run_slower() {
    let mm3 = 40.0;
    let speed = |temperature_c: f64| {
        let options = GlassOptions { size: [32, 512], temperature_c, ..pane(GlassContact::default(), 90.0) };
        let mut glass = Glass::new(&options).expect("a pane");
        glass.pour(16, 20, mm3 * 1.0e-9).expect("a drop");
        let mut fastest = 0.0;
        for _ in 0..8 {
            glass.step(0.05).expect("a step");
            fastest = glass.velocities().iter().map(|v| f64::from(v[1])).fold(fastest, f64::max);
        }
        fastest
    };
    // The part of the weight that friction of a moving drop does not hold.
    let contact = GlassContact::default();
    let held = contact.sliding_volume(90f64.to_radians(), DENSITY, SIGMA) * 1.0e9 / mm3;
    let driven =
        |sigma: f64| 1.0 - contact.kinetic * downpour_math::ops::f64::pow(held, 2.0 / 3.0) * sigma / SIGMA;
    let expected = 1.7916 / 0.7975 * driven(0.071_19) / driven(0.075_65);
    let found = speed(30.0) / speed(0.0);
    println!("{found:.3} times as fast, {expected:.3} expected");
    // A cell of the way is straight down or aslant, and a trail takes water.
    assert!((found / expected - 1.0).abs() < 0.12, "{found} times as fast, {expected} expected");
}

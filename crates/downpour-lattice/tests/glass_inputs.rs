//! Rejected inputs and their messages.

use downpour_lattice::glass::{
    Glass, GlassError, GlassOptions, GlassTexture, GlassWiper, GlassWiperKey, GlassWiperMotion, GlassWornBand,
};
use downpour_math::OutOfRange;

fn refused(options: &GlassOptions) -> String {
    Glass::new(options).expect_err("refused").to_string()
}

fn small() -> GlassOptions {
    GlassOptions { size: [16, 16], ..GlassOptions::default() }
}

fn wiper() -> GlassWiper {
    GlassWiper {
        pivot_m: [0.005, 0.01],
        inner_m: 0.001,
        outer_m: 0.008,
        motion: GlassWiperMotion::Sweep { from_rad: 0.0, to_rad: 3.0, period_s: 1.0 },
        film_m: 0.0,
        worn: Vec::new(),
    }
}

#[test]
fn sizes_are_8_to_4096() {
    for size in [[0, 16], [7, 16], [16, 4097], [1_000_000, 16], [u32::MAX, u32::MAX]] {
        let told = refused(&GlassOptions { size, ..GlassOptions::default() });
        assert!(told.contains("8 to 4096") && told.contains("cells"), "{told}");
    }
    assert!(Glass::new(&GlassOptions { size: [8, 8], ..GlassOptions::default() }).is_ok());
}

#[test]
fn numbers_that_are_none_and_numbers_out_of_range_are_refused() {
    type Set = fn(&mut GlassOptions, f64);
    let all: [(Set, f64, &str); 21] = [
        (|o, v| o.cell_m = v, 0.1e-3, "edge of a cell"),
        (|o, v| o.tilt_rad = v, -0.1, "tilt"),
        (|o, v| o.contact.advancing_rad = v, 3.0, "advancing"),
        (|o, v| o.contact.receding_rad = v, 1.2, "receding"),
        (|o, v| o.contact.retention = v, 2.0, "retention"),
        (|o, v| o.contact.kinetic = v, 1.1, "kinetic"),
        (|o, v| o.contact.line_drag = v, 0.0, "line drag"),
        (|o, v| o.temperature_c = v, 90.0, "temperature"),
        (|o, v| o.rain.rate_mm_h = v, -1.0, "rain rate"),
        (|o, v| o.rain.towards_m_s = v, -5.0, "rain's air"),
        (|o, v| o.air.speed_m_s = v, 1.0e9, "air speed"),
        (|o, v| o.air.direction_rad = v, 11.0, "air direction"),
        (|o, v| o.air.drag = v, -0.5, "drag coefficient"),
        (|o, v| o.trail.spacing_m = v, 0.0, "spacing"),
        (|o, v| o.trail.bead_m = v, 1.0, "beads"),
        (|o, v| o.wetting.life_s = v, 0.0, "life"),
        (|o, v| o.wetting.ease = v, 1.5, "ease"),
        (|o, v| o.wetting.pull = v, -1.0, "pull"),
        (|o, v| o.affinity_pull = v, 5.0, "affinity"),
        (|o, v| o.evaporation_mm_h = v, -1.0, "evaporation"),
        (|o, v| o.speed_limit_m_s = v, 0.0, "speed limit"),
    ];
    for (set, wrong, name) in all {
        for value in [wrong, f64::NAN, f64::NEG_INFINITY] {
            let mut options = small();
            set(&mut options, value);
            let error = Glass::new(&options).expect_err(name);
            assert!(matches!(error, GlassError::OutOfRange(OutOfRange { .. })), "{error:?}");
            let told = error.to_string();
            assert!(told.contains(name) && told.contains("allowed: "), "{told}");
        }
    }
}

#[test]
fn textures_have_the_size_of_the_pane_and_values_in_range() {
    let given = |values: Vec<f32>| GlassTexture::Given(values);
    let told = refused(&GlassOptions { affinity: given(vec![0.5; 255]), ..small() });
    assert_eq!(told, "affinity has 255 cells; allowed: 256, as the pane");
    let mut values = vec![0.5; 256];
    values[37] = f32::NAN;
    let told = refused(&GlassOptions { affinity: given(values), ..small() });
    assert_eq!(told, "affinity of cell 37 is NaN; allowed: 0 to 1");
    let told = refused(&GlassOptions { friction: given(vec![2.5; 256]), ..small() });
    assert!(told.contains("friction of cell 0 is 2.5"), "{told}");
    let told = refused(&GlassOptions { obstacles: Some(vec![false; 3]), ..small() });
    assert!(told.contains("mask of obstacles has 3 cells"), "{told}");
    let noise = GlassTexture::Noise { spot_m: f64::NAN, amplitude: 1.0 };
    assert!(refused(&GlassOptions { friction: noise, ..small() }).contains("spots"));
}

#[test]
fn wipers_touch_the_pane_and_turn_as_they_can() {
    let with = |change: fn(&mut GlassWiper)| {
        let mut wiper = wiper();
        change(&mut wiper);
        refused(&GlassOptions { wipers: vec![wiper], ..small() })
    };
    assert!(Glass::new(&GlassOptions { wipers: vec![wiper()], ..small() }).is_ok());
    for told in [
        with(|w| w.pivot_m = [1.0, 1.0]),
        with(|w| w.pivot_m = [f64::NAN, 0.0]),
        with(|w| w.pivot_m = [-0.009, -0.005]),
        with(|w| (w.inner_m, w.outer_m) = (0.02, 0.03)),
    ] {
        assert!(told.contains("wiper 0") && told.contains("never touches"), "{told}");
    }
    assert!(with(|w| w.outer_m = f64::INFINITY).contains("end of a blade"));
    assert!(with(|w| w.inner_m = 0.009).contains("start of a blade"));
    assert!(
        with(|w| w.worn = vec![GlassWornBand { from_m: 0.0, to_m: 0.002, leaves: 0.5 }])
            .contains("worn band")
    );
    assert!(
        with(|w| w.worn = vec![GlassWornBand { from_m: 0.002, to_m: 0.003, leaves: -1.0 }])
            .contains("leaves")
    );
    assert!(with(|w| w.motion = GlassWiperMotion::Keys(Vec::new())).contains("keys"));
    assert!(
        with(|w| {
            let key = |time_s| GlassWiperKey { time_s, angle_rad: 0.0 };
            w.motion = GlassWiperMotion::Keys(vec![key(1.0), key(1.0)]);
        })
        .contains("rising")
    );
    assert!(
        with(|w| w.motion = GlassWiperMotion::Sweep { from_rad: -3.0, to_rad: 3.0, period_s: 0.1 })
            .contains("speed of a blade")
    );
}

#[test]
fn steps_are_above_0_and_up_to_a_minute() {
    let mut glass = Glass::new(&small()).expect("a pane");
    for dt in [0.0, -1.0, f64::NAN, f64::INFINITY, 61.0] {
        let told = glass.step(dt).expect_err("refused").to_string();
        assert!(told.contains("step is") && told.contains("above 0 to 60"), "{told}");
    }
    assert_eq!(glass.ticks(), 0);
    glass.step(1.0e-12).expect("less than a tick");
    assert_eq!(glass.ticks(), 0);
}

#[test]
fn water_is_poured_where_it_fits() {
    let mut glass = Glass::new(&small()).expect("a pane");
    assert_eq!(glass.pour(16, 0, 1.0e-9), Err(GlassError::NoSuchCell { x: 16, y: 0 }));
    assert!(glass.pour(u32::MAX, u32::MAX, 1.0e-9).is_err());
    for volume in [-1.0e-9, f64::NAN, f64::INFINITY, 263.0e-9] {
        assert!(
            matches!(glass.pour(1, 1, volume), Err(GlassError::OutOfRange(OutOfRange { .. }))),
            "{volume}"
        );
    }
    glass.pour(1, 1, 200.0e-9).expect("it fits");
    assert!(glass.pour(1, 1, 100.0e-9).is_err(), "no more than a cell holds");
    assert_eq!(glass.totals().stored, 200_000);
}

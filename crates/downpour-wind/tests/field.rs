//! Field over a box: exact at the centers of cells, of second order between them, 0 inside objects.

mod common;

use common::{singularity, tornado, wind};
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_wind::{
    WindError, WindField, WindForm, WindGrid, WindMask, WindPrimitive, WindSingularity, WindUniform,
};
use glam::Vec3;

const LOW: Vec3 = Vec3::new(-8.0, -6.0, -4.0);
const HIGH: Vec3 = Vec3::new(8.0, 10.0, 12.0);

fn grid(n: u32) -> WindGrid {
    WindGrid::new(LOW, HIGH, [n; 3]).expect("a grid")
}

/// A position in the box, at least a coarse cell away from its sides.
fn position(k: u32) -> Vec3 {
    let [x, y, z, _] = rng_draw([3, 1], k, 0, 0).map(rng_unit);
    LOW + (HIGH - LOW) * (Vec3::new(x, y, z) * 0.9 + 0.05)
}

fn worst(primitives: &[WindPrimitive], n: u32) -> f64 {
    let grid = grid(n);
    let field = WindField::new(&grid, primitives, &WindMask::open(&grid)).expect("a field");
    let exact = wind(primitives);
    (0..20_000)
        .map(position)
        .map(|at| (field.sample(at).as_dvec3() - exact(at.as_dvec3())).length())
        .fold(0.0, f64::max)
}

/// Half the cell, a quarter of the error, and at most 3/8 h^2 times the largest second derivative, which for a
/// Rosenhead vortex is below 1.5 times its strength / (2 pi e^3).
#[test]
fn the_field_is_that_of_its_primitives_to_second_order() {
    let core_radius = 3.0;
    let vortex = WindPrimitive::Vortex(WindSingularity { core_radius, ..singularity(WindForm::Line) });
    let errors = [16, 32, 64].map(|n| worst(&[vortex], n));
    for (n, error) in [16.0, 32.0, 64.0].into_iter().zip(errors) {
        let h = 16.0 / n;
        let second = 1.5 * 40.0 / (std::f64::consts::TAU * 27.0);
        assert!(error < 0.375 * h * h * second, "{n}: {error}");
        assert!(error > 0.02 * h * h * second, "{n}: {error} is too good to be a sample");
    }
    for pair in errors.windows(2) {
        assert!((3.2..4.8).contains(&(pair[0] / pair[1])), "{errors:?}");
    }
    let several = [
        vortex,
        WindPrimitive::Tornado(tornado()),
        WindPrimitive::Source(WindSingularity { core_radius, ..singularity(WindForm::Point) }),
    ];
    let (coarse, fine) = (worst(&several, 40), worst(&several, 80));
    assert!((3.0..5.0).contains(&(coarse / fine)), "{coarse} {fine}");
}

#[test]
fn uniform_wind_and_the_centers_of_cells_are_exact() {
    let size = [5, 7, 3];
    let grid = WindGrid::new(LOW, HIGH, size).expect("a grid");
    let primitives = [WindPrimitive::Tornado(tornado())];
    let field = WindField::new(&grid, &primitives, &WindMask::open(&grid)).expect("a field");
    let exact = wind(&primitives);
    for i in 0..grid.cells() {
        let cell = grid.coordinates(i);
        let at = LOW + (Vec3::from(cell.map(|c| c as f32)) + 0.5) * grid.cell();
        let wanted = exact(at.as_dvec3()).as_vec3();
        let [x, y, z, openness] = field.cells()[i];
        assert!((Vec3::new(x, y, z) - wanted).length() <= 1.0e-5 * wanted.length().max(1.0), "{cell:?}");
        assert!((field.sample(at) - wanted).length() <= 1.0e-4 * wanted.length().max(1.0), "{cell:?}");
        assert_eq!(openness, 1.0);
    }
    let uniform = [WindPrimitive::Uniform(WindUniform { speed: 3.0, direction: Vec3::Z })];
    let field = WindField::new(&grid, &uniform, &WindMask::open(&grid)).expect("a field");
    for k in 0..100 {
        assert_eq!(field.sample(position(k) * 1.7), Vec3::new(0.0, 0.0, 3.0));
    }
}

#[test]
fn beyond_the_box_the_wind_is_that_of_its_side() {
    let grid = grid(8);
    let primitives = [WindPrimitive::Vortex(singularity(WindForm::Line))];
    let field = WindField::new(&grid, &primitives, &WindMask::open(&grid)).expect("a field");
    let inside = |at: Vec3| at.clamp(LOW + 1.0, HIGH - 1.0);
    for k in 0..200 {
        let at = position(k) * 3.0;
        assert_eq!(field.sample(at), field.sample(inside(at)), "{at}");
    }
    for bad in [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 3.0e38] {
        assert!(field.sample(Vec3::new(1.0, bad, 1.0)).is_finite(), "{bad}");
        assert!(field.sample(Vec3::splat(bad)).is_finite(), "{bad}");
    }
    // A box of one cell is uniform.
    let one = WindGrid::new(LOW, HIGH, [1; 3]).expect("a grid");
    let field = WindField::new(&one, &primitives, &WindMask::open(&one)).expect("a field");
    assert_eq!(field.sample(LOW), field.sample(HIGH));
    assert!(field.sample(LOW).length() > 0.1);
}

const WALL: f32 = 2.0;

fn walled(cut_off: f32) -> WindField {
    let grid = grid(16);
    let wind = [WindPrimitive::Uniform(WindUniform { speed: 8.0, direction: Vec3::Y })];
    let mask = WindMask::from_fn(&grid, |at| at.x > WALL);
    let mask = mask.with_cut_off(&grid, cut_off).expect("a cut-off");
    WindField::new(&grid, &wind, &mask).expect("a field")
}

/// As in the paper: 0 in closed cells, the full wind in open ones, linear between their centers (1 m apart).
#[test]
fn no_wind_blows_inside_an_object() {
    let field = walled(0.0);
    for k in 0..2000 {
        let at = position(k);
        let fraction = (WALL + 0.5 - at.x).clamp(0.0, 1.0);
        let found = field.sample(at);
        assert!((found - Vec3::Y * (8.0 * fraction)).length() < 1.0e-4, "{at}: {found}");
        if at.x > WALL + 0.5 {
            assert_eq!(found, Vec3::ZERO, "{at}");
        }
    }
}

#[test]
fn a_wider_cut_off_reaches_farther() {
    let field = walled(4.0);
    for k in 0..2000 {
        let at = position(k);
        // Distance from the first closed center; the ramp ends at a center, so it is linear.
        let fraction = ((WALL + 0.5 - at.x) / 4.0).clamp(0.0, 1.0);
        let found = field.sample(at);
        assert!((found - Vec3::Y * (8.0 * fraction)).length() < 1.0e-4, "{at}: {found}");
    }
    // A width of a cell or less is the paper's cut-off.
    assert_eq!(walled(1.0), walled(0.0));
}

/// The distance is Euclidean, in all directions and for cells that are not cubes.
#[test]
fn the_cut_off_is_round() {
    let grid = WindGrid::new(Vec3::ZERO, Vec3::new(24.0, 36.0, 12.0), [24, 24, 24]).expect("a grid");
    let middle = Vec3::new(12.5, 18.75, 6.25);
    let mask = WindMask::from_fn(&grid, |at| (at - middle).length() < 0.1);
    assert_eq!(mask.openness().iter().filter(|&&open| open <= 0.0).count(), 1);
    let mask = mask.with_cut_off(&grid, 5.0).expect("a cut-off");
    for (i, &open) in mask.openness().iter().enumerate() {
        let at = (Vec3::from(grid.coordinates(i).map(|c| c as f32)) + 0.5) * grid.cell();
        let wanted = ((at - middle).length() / 5.0).min(1.0);
        assert!((open - wanted).abs() < 1.0e-5, "{at}: {open}, not {wanted}");
    }
}

#[test]
fn masks_fit_their_grid() {
    let (small, large) = (grid(4), grid(5));
    let wrong = WindError::MaskSize { found: 64, allowed: 125 };
    let mask = WindMask::open(&small);
    assert_eq!(WindField::new(&large, &[], &mask), Err(wrong.clone()));
    assert_eq!(mask.with_cut_off(&large, 1.0), Err(wrong.clone()));
    assert_eq!(WindMask::from_occupancy(&large, &[false; 64]), Err(wrong));
    for bad in [f32::NAN, -1.0, f32::INFINITY, 65.0] {
        assert!(mask.with_cut_off(&small, bad).is_err(), "{bad}");
    }
    // The same objects, given by both constructors.
    let asked = WindMask::from_fn(&small, |at| at.y > 2.0 && at.x < 0.0);
    let inside: Vec<bool> = asked.openness().iter().map(|&open| open <= 0.0).collect();
    assert_eq!(inside.iter().filter(|&&inside| inside).count(), 16);
    assert_eq!(WindMask::from_occupancy(&small, &inside), Ok(asked));
}

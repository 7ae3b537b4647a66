//! `shaders/wgsl/sim/{bounce,bounce_find,bounce_hit}.wgsl` against `downpour_sim::impacts`.

use downpour_gpu::{Gpu, GpuError};
use downpour_shaders::Kernel;
use downpour_shaders::sim::bounce::{
    BOUNCE, BOUNCE_CLEAR_KERNEL, BOUNCE_FIND_KERNEL, BOUNCE_HIT_AMONG_HOLES_KERNEL, BOUNCE_HIT_KERNEL,
    BOUNCE_LIST_KERNEL,
};
use downpour_shaders::sim::field::FIELD_BOUNCED;
use downpour_sim::field::EyeDrop;
use downpour_sim::gpu::FieldSearch;
use downpour_sim::impacts::bounce_frame::{BounceMotion, bounce_between};
use downpour_sim::impacts::bounced::bounce_slip;
use downpour_sim::shelter::{Holes, Obstacles};
use downpour_sim::simulation::Bounce;
use downpour_sim::view::View;
use glam::Vec3;

use super::field::{Kind, Setting, gusty, kind, listed_by, moving_words, paired, setting, steady, still};
use crate::Domain::Uniform;
use crate::function::Run;
use crate::words::IntoWords as _;
use crate::{FunctionCase, KernelCase, Tol};

/// Droplets as large as drops, so that there are some that the picture can show.
const BOUNCE_OF_CASES: Bounce =
    Bounce { fraction: 0.25, restitution: 0.35, grip: 0.6, size: 0.9, max_time_s: 0.8 };

/// The cases.
#[must_use]
pub(super) fn functions() -> Vec<FunctionCase> {
    let [way, speed] = [Uniform(-3.0, 3.0), Uniform(-12.0, 12.0)];
    vec![
        FunctionCase::new(
            "bounce_between",
            &BOUNCE,
            &[way, way, way, speed, speed, speed, way, way, way, speed, speed, speed, Uniform(0.0, 1.0)],
            Tol::absolute(2.0e-4, "m, and m/s of up to 150: a difference of 6 m in a sixteenth of a second"),
            |a| {
                let [before, after] = [0, 1]
                    .map(|_| BounceMotion { moved: Vec3::from(a.f32s()), velocity: Vec3::from(a.f32s()) });
                let found = bounce_between(before, after, a.f32());
                [found.moved.to_array().words(), found.velocity.to_array().words()].concat()
            },
        ),
        FunctionCase::new(
            "bounce_slip",
            &BOUNCE,
            &[speed, speed, speed, Uniform(0.0, 9.0), Uniform(0.0, 2.0)],
            Tol::absolute(3.0e-5, "m and m/s: exponentials of up to 1 times 12 m/s"),
            |a| {
                let slip = Vec3::from(a.f32s()).as_dvec3();
                let [moved, left] = bounce_slip(slip, a.f32().into(), a.f32().into());
                [moved.as_vec3().to_array().words(), left.as_vec3().to_array().words()].concat()
            },
        ),
    ]
}

/// Droplets of a picture, as both sides list them.
fn droplets_case(gpu: &Gpu, kind: Kind, bounce: Bounce) -> Result<Run, GpuError> {
    let Setting { field, view, scene, origin } = setting(kind);
    let view = View { near: 0.02, far: 8.0, ..view };
    let holes = kind.has_holes.then_some(&scene as &dyn Holes);
    let on_cpu = Obstacles { nodes: &scene.nodes, triangles: &scene.triangles, holes, origin };
    let fits = bounce.fits_device(&field, &view, view.least_pixels, kind.time_s, &on_cpu);
    assert!(fits, "too many parts of paths");
    let search = FieldSearch {
        view: &view,
        time_s: kind.time_s,
        max_room: 1 << 20,
        pane: kind.pane,
        known: &[],
        drips: None,
        splashes: None,
        bounce: Some(&bounce),
    };
    let (mut drops, least) = listed_by(gpu, &field, (&scene, kind.has_holes, origin), &search)?;
    drops.retain(|drop| drop.speed == FIELD_BOUNCED);
    let outside = |drop: downpour_sim::field::FallingDrop| match kind.pane {
        Some([x, y, z, distance]) => drop.beyond(Vec3::new(x, y, z), distance, &view),
        None => Some(drop),
    };
    let droplets = field.bounced(&on_cpu, &view, least, kind.time_s, &bounce).expect("in range");
    let expected: Vec<EyeDrop> =
        droplets.into_iter().filter_map(outside).map(|drop| EyeDrop::new(&drop, view.eye)).collect();
    assert!(expected.len() > 150, "{} droplets", expected.len());
    let finite = |time: f32| if time.abs() < 1.0e3 { time } else { 1.0e3 };
    let words = |drop: &EyeDrop| moving_words(drop, finite);
    Ok(paired(&expected, &drops, words))
}

/// The cases.
#[must_use]
pub(super) fn kernels() -> Vec<KernelCase> {
    const OTHERS: &[&Kernel] = &[&BOUNCE_CLEAR_KERNEL, &BOUNCE_FIND_KERNEL, &BOUNCE_LIST_KERNEL];
    let of = |name, kernel, wander: f64, run: fn(&Gpu) -> Result<Run, GpuError>| {
        let tol = Tol::absolute(
            wander,
            "meters, seconds and 20 m/s; droplets at an edge of the picture or of an obstacle",
        );
        KernelCase { with: OTHERS, ..KernelCase::new(name, kernel, tol.with_outliers(2.0e-3), run) }
    };
    vec![
        of("main_bounce_hit: still air, far away", &BOUNCE_HIT_KERNEL, 3.0e-5, |gpu| {
            droplets_case(gpu, Kind { far: true, ..kind(still, 7.125, 1.0 / 60.0) }, BOUNCE_OF_CASES)
        }),
        of("main_bounce_hit: steady wind", &BOUNCE_HIT_KERNEL, 3.0e-5, |gpu| {
            droplets_case(gpu, kind(steady, 7.3, 1.0 / 60.0), BOUNCE_OF_CASES)
        }),
        // Paths are straight in other spans of time.
        of("main_bounce_hit: gusts", &BOUNCE_HIT_KERNEL, 8.0e-3, |gpu| {
            droplets_case(gpu, kind(gusty, 11.3, 0.1), BOUNCE_OF_CASES)
        }),
        of("main_bounce_hit: a rate that changes, frozen", &BOUNCE_HIT_KERNEL, 3.0e-5, |gpu| {
            let bounce = Bounce { max_time_s: 2.0, ..BOUNCE_OF_CASES };
            droplets_case(gpu, Kind { changes: true, ..kind(steady, 10.0, 0.0) }, bounce)
        }),
        of("main_bounce_hit: holes, behind a pane", &BOUNCE_HIT_AMONG_HOLES_KERNEL, 3.0e-5, |gpu| {
            let pane = Some([0.0, 0.6, -0.8, 0.5]);
            let kind = Kind { has_holes: true, pane, ..kind(steady, 3.3, 1.0 / 60.0) };
            droplets_case(gpu, kind, BOUNCE_OF_CASES)
        }),
    ]
}

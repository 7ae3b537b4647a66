//! `shaders/wgsl/render/{project,profiles}.wgsl` against `downpour_render::rain::{project, profiles}`.

use downpour_drop::oscillation::Amplitudes;
use downpour_gpu::{Gpu, GpuError};
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_render::camera::{Camera, EyeMotion, Viewpoint};
use downpour_render::gpu::ProjectPipeline;
use downpour_render::rain::light::{DropLightForm, DropLightOptions};
use downpour_render::rain::profiles::{
    ProfilesFrame, StreakProfiles, profiles_coarser, profiles_groups_of, profiles_is_mean,
    profiles_is_sampled, profiles_oscillates, profiles_room, profiles_rows_of, profiles_sized,
};
use downpour_render::rain::project::{
    ProjectFrame, Projector, project_ahead, project_axis, project_class, project_grid, project_present,
    project_row, project_seen, project_turn,
};
use downpour_render::rain::{
    DropMasks, Exposure, RainOptions, ScreenDrop, StreakPath, StreakSamples, TemporalResponse,
};
use downpour_shaders::Kernel;
use downpour_shaders::render::rain::{
    PROFILES, PROFILES_CLEAR_KERNEL, PROFILES_FINISH_KERNEL, PROFILES_LEVELS, PROFILES_MEASURE_KERNEL,
    PROFILES_PLACE_KERNEL, PROJECT, PROJECT_KERNEL, PROJECT_NARROW, PROJECT_SMALL, PROJECT_THIN,
};
use downpour_sim::field::{EyeDrop, eye_drop_standing};
use glam::Vec3;

use crate::Domain::{Below, Made, OneOf, Or, Uniform, Unit3};
use crate::compare::{Cpu, Gpu as FromGpu};
use crate::function::Run;
use crate::signature::WordKind;
use crate::words::IntoWords as _;
use crate::{FunctionCase, KernelCase, Tol};

const SIZE: [u32; 2] = [320, 180];
/// More drops than one row of workgroups has.
const COUNT: u32 = 9000;
const WORDS: usize = size_of::<ScreenDrop>() / 4;

/// Words of a drop that are integers: its samples, its kind, its class, its profile and its id.
const INTEGERS: [usize; 5] = [11, 33, 34, 35, 39];

/// A streak on a picture, of any width and speed.
fn streak_words(random: [u32; 4]) -> Vec<u32> {
    let [a, b, c, d] = random.map(rng_unit);
    let drop = ScreenDrop {
        area: 600.0 * a * a * a,
        along: [0.3 * b, 2.0 * c * c],
        slope: 0.2 * b * c,
        half_extent: 1.1,
        depth_ratio: 0.7 + 0.6 * a,
        mode_phase: [if random[0].is_multiple_of(3) { 0.0 } else { 0.1 }, 0.0, 0.2, 0.4],
        cycles: [4.0 * d, 9.0 * d],
        reach: [-1.0, 0.0, 0.005, 2.0, 2.0][random[1] as usize % 5],
        kind: random[2] % 3,
        grid: [0, 1, 5, 8][random[3] as usize % 4],
        ..ScreenDrop::default()
    };
    bytemuck::cast::<ScreenDrop, [u32; WORDS]>(drop).to_vec()
}

/// Sizes of a profile.
fn sizes(random: [u32; 4]) -> Vec<u32> {
    let rows = 2 + random[0] % 128;
    let columns = [12, 16, 24][random[1] as usize % 3];
    vec![rows, columns, profiles_rows_of(rows), [1, 2, 4][random[2] as usize % 3]]
}

/// Normals of surfaces: some of level ground, some so short that their direction is that of none.
fn normals(random: [u32; 4]) -> Vec<u32> {
    let [a, b, c, _] = random.map(rng_unit);
    let normal = match random[3] % 4 {
        0 => Vec3::Y,
        1 => Vec3::new(a - 0.5, b - 0.5, c - 0.5) * 1.0e-4,
        _ => Vec3::new(a - 0.5, b, c - 0.5),
    };
    normal.to_array().map(f32::to_bits).to_vec()
}

/// Level vectors.
fn rights(random: [u32; 4]) -> Vec<u32> {
    let [a, b, ..] = random.map(rng_unit);
    [a - 0.5, 0.0, b - 0.5].map(f32::to_bits).to_vec()
}

fn rows(random: [u32; 4]) -> Vec<u32> {
    vec![1 + random[0] % 128]
}

/// A drop of the words.
fn drop(words: [u32; WORDS]) -> ScreenDrop {
    bytemuck::cast(words)
}

/// The cases.
#[must_use]
pub(super) fn functions() -> Vec<FunctionCase> {
    let exact = Tol::exact("integers and comparisons");
    let widths = Or(&Uniform(0.0, 20.0), &[PROJECT_SMALL, PROJECT_THIN, 2.0, PROJECT_NARROW, 16.0]);
    let flag = |name, twin| FunctionCase::new(name, &PROFILES, &[Made(streak_words)], exact, twin);
    vec![
        FunctionCase::new(
            "project_ahead",
            &PROJECT,
            &[Uniform(-2.0, 3.0), Uniform(-2.0, 3.0), OneOf(&[0.0, 0.5, 1.0])],
            Tol::relative(1.0e-6, 1.0e-6, "a quotient of differences (2.5 ulp)"),
            |a| project_ahead(a.f32(), a.f32(), a.f32()).words(),
        ),
        FunctionCase::new(
            "project_present",
            &PROJECT,
            &[
                OneOf(&[-1.0e30, -1.0, -0.01, 0.0, 0.001, 0.5]),
                OneOf(&[1.0e30, 1.0, 0.01, 0.0, -0.002, -0.5]),
                OneOf(&[0.0, 0.01, 0.5, 1.0]),
            ],
            Tol::absolute(2.0e-7, "a quotient (2.5 ulp) and a sum"),
            |a| project_present(a.f32s(), a.f32()).words(),
        ),
        FunctionCase::new("project_seen", &PROJECT, &[Uniform(-2.0, 2.0), Uniform(-2.0, 2.0)], exact, |a| {
            project_seen(a.f32s()).words()
        }),
        FunctionCase::new(
            "project_class",
            &PROJECT,
            &[OneOf(&[0.0, 0.49, 0.51, 1.2, 2.5, 3.99, 4.0, 4.01, 5.9, 7.7, 10.4, 10.6, 17.0])],
            exact,
            |a| project_class(a.f32()).words(),
        ),
        FunctionCase::new("project_grid", &PROJECT, &[widths, Below(2), Below(2)], exact, |a| {
            project_grid(a.f32(), a.u32() == 1, a.u32() == 1).words()
        }),
        FunctionCase::new(
            "project_turn",
            &PROJECT,
            &[Made(normals), Made(rights), Unit3],
            Tol::absolute(1.0e-6, "a quotient by a root (2.5 ulp each) of at most 1, where it is above 1e-3")
                .with_outliers(1.0e-3),
            |a| project_turn(Vec3::from(a.f32s()), Vec3::from(a.f32s()), Vec3::from(a.f32s())).words(),
        ),
        FunctionCase::new("profiles_rows_of", &PROFILES, &[Made(rows)], exact, |a| {
            profiles_rows_of(a.u32()).words()
        }),
        flag("profiles_is_sampled", |a| u32::from(profiles_is_sampled(&drop(a.u32s()))).words()),
        flag("profiles_is_mean", |a| u32::from(profiles_is_mean(&drop(a.u32s()))).words()),
        flag("profiles_oscillates", |a| u32::from(profiles_oscillates(&drop(a.u32s()))).words()),
        FunctionCase::new(
            "profiles_sized",
            &PROFILES,
            &[Made(streak_words)],
            Tol::exact("integers; an arc tangent (4096 ulp) or a root at a step may fall on either side")
                .with_outliers(2.0e-3),
            |a| profiles_sized(&drop(a.u32s())).words(),
        ),
        FunctionCase::new(
            "profiles_coarser",
            &PROFILES,
            &[Made(sizes), Below(PROFILES_LEVELS)],
            exact,
            |a| profiles_coarser(a.u32s(), a.u32()).words(),
        ),
        FunctionCase::new("profiles_room", &PROFILES, &[Made(sizes)], exact, |a| {
            profiles_room(a.u32s()).words()
        }),
        FunctionCase::new("profiles_groups_of", &PROFILES, &[Below(200_000)], exact, |a| {
            profiles_groups_of(a.u32()).words()
        }),
        FunctionCase::new(
            "camera_place",
            &downpour_shaders::render::camera::CAMERA,
            &[
                Made(camera_words),
                Uniform(-40.0, 40.0),
                Uniform(-40.0, 40.0),
                Uniform(-40.0, 40.0),
                Uniform(0.5, 40.0),
            ],
            Tol::relative(1.0e-6, 1.0e-5, "quotients (2.5 ulp) of sums of three products of up to 40 m"),
            |a| {
                let camera = bytemuck::cast::<[f32; 16], Camera>(a.f32s());
                camera.camera_place(Vec3::from(a.f32s()), a.f32()).to_array().words()
            },
        ),
        FunctionCase::new(
            "camera_project",
            &downpour_shaders::render::camera::CAMERA,
            &[Made(camera_words), Uniform(-3.0, 3.0), Uniform(-2.0, 2.0), Uniform(-9.0, -1.0)],
            Tol::relative(2.0e-5, 2.0e-3, "sums of products over a depth, times pixels"),
            |a| {
                let camera = bytemuck::cast::<[f32; 16], Camera>(a.f32s());
                camera.camera_project(Vec3::from(a.f32s())).to_array().words()
            },
        ),
        FunctionCase::new("project_axis", &PROJECT, &[Made(shown_words)], AXIS, |a| {
            let drop: ScreenDrop = bytemuck::cast(a.u32s::<WORDS>());
            project_axis(Vec3::from(a.f32s()), drop.id).words()
        }),
    ]
}

const AXIS: Tol = Tol::absolute(1.0e-6, "a root and a division (2.5 ulp); integers below 2^24");

/// A drop that is shown, and its velocity.
fn shown_words(random: [u32; 4]) -> Vec<u32> {
    let mut words = streak_words(random);
    words[39] = random[0];
    let still = random[0].is_multiple_of(7);
    words.extend(random[1..].iter().map(|&word| if still { 0 } else { (rng_unit(word) - 0.5).to_bits() }));
    words
}

fn camera() -> Camera {
    let viewpoint = Viewpoint {
        eye: Vec3::new(1.0, 2.0, 3.0),
        forward: Vec3::new(0.2, 0.05, -1.0),
        up: Vec3::Y,
        fov_y: 0.8,
    };
    viewpoint.camera(SIZE, 0).expect("a camera")
}

fn camera_words(random: [u32; 4]) -> Vec<u32> {
    let seed = random[0];
    bytemuck::cast::<Camera, [u32; 16]>(Camera { seed, ..camera() }).to_vec()
}

/// Drops about the picture: more of them near, of all sizes; some land or start during the exposure.
fn drops() -> Vec<EyeDrop> {
    let one = |k| {
        let [a, b, c, d] = rng_draw([3, 4], k, 0, 0).map(rng_unit);
        let [e, f, g, h] = rng_draw([3, 4], k, 1, 0).map(rng_unit);
        let distance = 0.1 + 12.0 * c * c;
        EyeDrop {
            offset: [(2.4 * a - 1.0) * distance, 1.3 * (b - 0.5) * distance, -distance],
            diameter: 0.3e-3 + 5.7e-3 * d * d,
            // Some stand before an eye that does not move.
            velocity: if k % 7 == 0 { [0.0; 3] } else { [2.0 * e - 1.0, -2.0 - 7.0 * d, 0.5 * f] },
            id: (k * 7919) ^ 0x55aa,
            present: match k % 9 {
                0 => [-1.0e30, 0.02 * (g - 0.5)],
                1 => [0.02 * (h - 0.5), 1.0e30],
                _ => [-1.0e30, 1.0e30],
            },
            speed: 0.0,
            id_low: 0,
        }
    };
    // Some are splashes, at any stage, or not there yet, or no longer.
    let splash = |k: u32, drop: EyeDrop| {
        let [a, b, ..] = rng_draw([3, 5], k, 0, 0).map(rng_unit);
        EyeDrop {
            diameter: 8.0 * drop.diameter,
            velocity: [0.0; 3],
            present: [0.04 * (0.05 - a), 0.04 * (0.95 - a + 0.1 * b)],
            // On level ground, and on slopes and walls.
            speed: eye_drop_standing(if k % 20 == 3 {
                Vec3::Y
            } else {
                Vec3::new(a - 0.5, b, 0.4 * a).normalize()
            }),
            ..drop
        }
    };
    let one = |k| if k % 10 == 3 { splash(k, one(k)) } else { one(k) };
    (0..COUNT).map(one).collect()
}

/// What of a picture is special.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Streaks,
    Frozen,
    /// Out of focus, fading, by a loop, an eye that moves and turns, with axes.
    Moving,
}

fn options(kind: Kind) -> RainOptions {
    let exposure = Exposure {
        shutter_s: 0.02,
        time_s: 12_345.678,
        oscillation: Amplitudes::GARG_NAYAR_EVEN,
        seed: 77,
        ..Exposure::default()
    };
    let plain = RainOptions { exposure, ..RainOptions::default() };
    match kind {
        Kind::Streaks => plain,
        Kind::Frozen => RainOptions { exposure: Exposure { shutter_s: 0.0, ..exposure }, ..plain },
        Kind::Moving => RainOptions {
            exposure: Exposure {
                response: TemporalResponse::Fading,
                samples: StreakSamples::Loop(8),
                eye: EyeMotion { velocity: Vec3::new(0.5, 0.0, -8.0), turning: Vec3::new(0.1, 1.5, 0.0) },
                aperture_m: 0.01,
                focus_m: 3.0,
                ..exposure
            },
            light: DropLightOptions { form: DropLightForm::Atlas, ..plain.light },
            ..plain
        },
    }
}

fn project_case(gpu: &Gpu, kind: Kind) -> Result<Run, GpuError> {
    let masks = DropMasks::trace(1.333).and_then(|masks| masks.with_splashes(1.333)).expect("masks");
    let (camera, options, drops) = (camera(), options(kind), drops());
    let mut frame = ProjectFrame::new(&camera, &masks, &options, COUNT);
    // Some places stay empty.
    frame.room += 70;
    let profiles = ProfilesFrame::new(&options.exposure, frame.room, options.medium.class());
    let found = ProjectPipeline::new(gpu)?.run(&drops, &masks, (&frame, &profiles), &options)?;
    let projector = Projector::new(&camera, &masks, &options);
    let mut list = Vec::new();
    let (mut lamps, mut axes) = (Vec::new(), Vec::new());
    for drop in &drops {
        let shown = projector.project_drop(drop);
        list.push(shown.map_or(ScreenDrop { reach: -1.0, ..ScreenDrop::default() }, |shown| shown.drop));
        lamps.push(shown.map_or([0.0; 4], |_| project_row(camera.eye, drop)));
        axes.push(shown.map_or([0.0, 1.0, 0.0, 0.0], |shown| project_axis(shown.velocity, drop.id)));
    }
    list.resize(frame.room as usize, ScreenDrop { reach: -1.0, ..ScreenDrop::default() });
    lamps.resize(frame.room as usize, [0.0; 4]);
    axes.resize(frame.room as usize, [0.0, 1.0, 0.0, 0.0]);
    if frame.has_axes == 1 {
        lamps.extend(axes);
    }
    // Profiles are compared by themselves.
    let of_list = |list: &[ScreenDrop], rows: &[[f32; 4]]| -> Vec<u32> {
        let one = |drop: &ScreenDrop| {
            bytemuck::cast::<ScreenDrop, [u32; WORDS]>(ScreenDrop { profile: 0, ..*drop })
        };
        let mut words: Vec<u32> = list.iter().flat_map(one).collect();
        // As many words as a drop has, so that the kinds repeat.
        words.extend(rows.iter().flat_map(|row| {
            let mut words = [0; WORDS];
            for (word, value) in words.iter_mut().zip(row) {
                *word = value.to_bits();
            }
            words
        }));
        words
    };
    let rows = found.rows.get(..lamps.len()).unwrap_or_default();
    let list_words = of_list(&list, &lamps);
    let kinds = (0..WORDS).map(|k| if INTEGERS.contains(&k) { WordKind::Integer } else { WordKind::Float });
    Ok(Run {
        arguments: (0..(list_words.len() / WORDS) as u32).map(|k| vec![k]).collect(),
        cpu: Cpu(list_words),
        gpu: FromGpu(of_list(&found.list[..list.len()], rows)),
        kinds: kinds.collect(),
    })
}

/// The profiles of the drops of a picture, by what the device made of these drops. What of it may be anywhere is put in the order of the
/// drops, with a word that says whether all places are different and none is left out.
fn profiles_case(
    gpu: &Gpu,
    room: Option<[u32; 2]>,
    fits: fn(&StreakProfiles) -> bool,
) -> Result<Run, GpuError> {
    let masks = DropMasks::trace(1.333).expect("masks");
    let (camera, options, drops) = (camera(), options(Kind::Streaks), drops());
    let frame = ProjectFrame::new(&camera, &masks, &options, COUNT);
    let mut profiles = ProfilesFrame::new(&options.exposure, frame.room, 2);
    if let Some([rays, entries]) = room {
        profiles = profiles.with_room(rays, entries);
    }
    let found = ProjectPipeline::new(gpu)?.run(&drops, &masks, (&frame, &profiles), &options)?;
    let projector = Projector::new(&camera, &masks, &options);
    // The device's drops, before they had profiles.
    let streaks = projector.frame().streaks;
    let mut list: Vec<ScreenDrop> = found.list.clone();
    for drop in &mut list {
        drop.profile = 0;
        drop.kind = if drop.kind == 0 { 0 } else { streaks };
    }
    let radii: Vec<f32> = found.rows.iter().map(|row| row[3]).collect();
    let made = StreakProfiles::with_frame(&mut list, &radii, &masks, &options.exposure, &profiles);
    assert!(fits(&made), "{} paths, {} rays, {} entries", made.paths.len(), made.rays, made.entries);
    let [rays, parts] = &found.jobs;
    let (count, parts_count) = (rays[0][0] as usize, parts[0][0] as usize);
    let (rays, parts) = (&rays[1..=count], &parts[1..=parts_count]);
    let paths = rays.iter().map(|job| job[0] + 1).max().unwrap_or(0) as usize;
    let cpu = described(&made.paths, &made.ray_jobs, &made.light_jobs, &list, profiles.first_entry);
    let gpu_words = described(&found.paths[..paths], rays, parts, &found.list, profiles.first_entry);
    let rest = |classes: &[StreakPath], rows: Vec<[f32; 4]>, groups: [u32; 6]| {
        let mut words: Vec<u32> = classes.iter().map(|class| (class.rows as f32).to_bits()).collect();
        let mut rows: Vec<[u32; 4]> = rows.iter().map(|row| row.map(f32::to_bits)).collect();
        rows.sort_unstable();
        words.extend(rows.iter().flatten());
        words.extend(groups.map(|n| (n as f32).to_bits()));
        words
    };
    let streaks = made.paths.iter().map(|path| found.rows[path.drop as usize]).collect();
    let [a, b] = [made.ray_jobs.len(), made.light_jobs.len()].map(|n| profiles_groups_of(n as u32));
    let found_groups = [0, 1, 2, 4, 5, 6].map(|k| found.groups[k]);
    let mut cpu = cpu;
    cpu.extend(rest(&made.classes, streaks, [a[0], a[1], 1, b[0], b[1], 1]));
    let mut gpu_words = gpu_words;
    let streaks: Vec<[f32; 4]> = found.streaks.iter().copied().filter(|row| row[3] > 0.0).collect();
    gpu_words.extend(rest(&found.classes, streaks, found_groups));
    Ok(Run {
        arguments: (0..cpu.len() as u32).map(|k| vec![k]).collect(),
        cpu: Cpu(cpu),
        gpu: FromGpu(gpu_words),
        kinds: vec![WordKind::Float],
    })
}

/// Words of profiles in the order of their drops. All are compared as numbers: integers below 2^24 are written as such.
fn described(
    paths: &[StreakPath],
    ray_jobs: &[[u32; 2]],
    light_jobs: &[[u32; 2]],
    list: &[ScreenDrop],
    first_entry: u32,
) -> Vec<u32> {
    let number = |n: u32| (n as f32).to_bits();
    let mut words = vec![number(paths.len() as u32)];
    // Places follow each other without a gap.
    let follow = |mut places: Vec<[u32; 2]>, first: u32| {
        places.sort_unstable();
        places.iter().try_fold(first, |next, &[at, size]| (next == at).then_some(at + size))
    };
    let of = |path: &StreakPath| profiles_room([path.rows, path.columns, path.profile_rows, path.fine]);
    let rays = paths.iter().map(|path| [path.first_ray, of(path)[0]]).collect();
    let entries = paths.iter().map(|path| [path.first_entry, of(path)[1]]).collect();
    words.extend([follow(rays, 0), follow(entries, first_entry)].map(|end| number(end.map_or(1, |_| 0))));
    let mut order: Vec<&StreakPath> = paths.iter().collect();
    order.sort_unstable_by_key(|path| path.drop);
    for path in order {
        let drop = &list[path.drop as usize];
        words.push(number(u32::from(drop.profile == path.first_entry)));
        let floats: [f32; 16] = std::array::from_fn(|k| match k {
            0..4 => path.shape.c0[k],
            4..8 => path.shape.c1[k - 4],
            8..12 => path.shape.c2[k - 8],
            _ => path.volume[k - 12],
        });
        words.extend(floats.map(f32::to_bits));
        let rest = [path.volume_last, path.wide, path.tall, path.index];
        words.extend(rest.iter().chain(&path.lobe).chain(&path.amplitudes).map(|value| value.to_bits()));
        words.extend([path.rows, path.columns, path.profile_rows, path.fine, path.drop].map(number));
    }
    for jobs in [ray_jobs, light_jobs] {
        let of_drop = |&[path, part]: &[u32; 2]| [paths[path as usize].drop, part];
        let mut jobs: Vec<[u32; 2]> = jobs.iter().map(of_drop).collect();
        jobs.sort_unstable();
        words.extend(jobs.iter().flatten().map(|&n| number(n)));
    }
    words.extend(list.iter().map(|drop| number(drop.kind)));
    words
}

/// The cases.
#[must_use]
pub(super) fn kernels() -> Vec<KernelCase> {
    const OTHERS: &[&Kernel] =
        &[&PROJECT_KERNEL, &PROFILES_CLEAR_KERNEL, &PROFILES_MEASURE_KERNEL, &PROFILES_FINISH_KERNEL];
    let project = |name, run| {
        let why = "angles (sines 2^-11, arc sines 4096 ulp); what is at a step may fall on either side";
        KernelCase::new(name, &PROJECT_KERNEL, Tol::relative(2.0e-3, 1.0e-3, why).with_outliers(2.0e-3), run)
    };
    let profiles = |name, run| KernelCase {
        name,
        kernel: &PROFILES_PLACE_KERNEL,
        with: OTHERS,
        overrides: &[],
        text: None,
        tol: Tol::absolute(1.0e-3, "tables between two entries; sines and cosines (2^-11)"),
        run,
    };
    vec![
        project("main_project: streaks", |gpu| project_case(gpu, Kind::Streaks)),
        project("main_project: frozen", |gpu| project_case(gpu, Kind::Frozen)),
        project("main_project: a moving eye, out of focus", |gpu| project_case(gpu, Kind::Moving)),
        profiles("main_profiles_place: all", |gpu| {
            profiles_case(gpu, None, |made| made.paths.len() > 200 && made.rays > 90_000)
        }),
        profiles("main_profiles_place: coarser", |gpu| {
            profiles_case(gpu, Some([500_000, 1_700_000]), |made| {
                made.paths.iter().any(|path| path.rows > 2) && made.paths.iter().all(|path| path.fine == 1)
            })
        }),
        profiles("main_profiles_place: no room", |gpu| {
            profiles_case(gpu, Some([30_000, 400_000]), |made| made.paths.is_empty())
        }),
    ]
}

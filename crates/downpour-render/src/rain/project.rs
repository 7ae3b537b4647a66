//! Falling drops on a picture: the path of each during the exposure, its oval, its oscillation, and how it is sampled. Twin of
//! `shaders/wgsl/render/project.wgsl`, where the method is described.

use downpour_drop::oscillation::{
    DropOscillationTime, Fluids, FrequencyLaw, drop_oscillation_azimuth, drop_oscillation_phase,
    drop_oscillation_turns,
};
use downpour_math::ops::{self, ops_is_finite};
use downpour_math::rng::seed_words;
use downpour_shaders::drop::oscillation::DROP_OSCILLATION_TICK;
use downpour_shaders::render::rain::{
    DROPS_LOOP, DROPS_STILL, DROPS_TABLE, PROJECT_CLASS_ROWS, PROJECT_FIRST_BITS, PROJECT_LAST_BITS,
    PROJECT_NARROW, PROJECT_NARROW_SAMPLES, PROJECT_OSCILLATES_MAX, PROJECT_OSCILLATES_MIN, PROJECT_SMALL,
    PROJECT_STILL, PROJECT_THIN, PROJECT_WIDE_SAMPLES, STREAK_TURN,
};
use downpour_shaders::sim::field::FIELD_SPLASH;
use downpour_sim::field::{EyeDrop, eye_drop_normal};
use glam::{Vec2, Vec3};

use super::exposure::{StreakSamples, TemporalResponse};
use super::glint::drop_glint_right;
use super::light::DropLightForm;
use super::streak::ScreenDrop;
use super::{DropMasks, RainOptions};
use crate::camera::Camera;

/// Bits of a diameter between two entries of the frequencies.
const FREQUENCY_STEP: u32 = 1 << 16;

/// Numbers of drops for an atlas: single precision has all integers below 2^24.
const AXIS_IDS: u32 = 0x00ff_ffff;

/// Uniforms of the kernel. The same layout as `ProjectFrame` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct ProjectFrame {
    /// Not read: a software driver makes the kernel again for each value of the first word of a block that it reads.
    pub unread: u32,
    /// 1 if drops have axes, for an atlas.
    pub has_axes: u32,
    /// 0.
    pub unused: [u32; 2],
    /// The camera.
    pub camera: Camera,
    /// Velocity of the eye, m/s.
    pub eye_velocity: Vec3,
    /// Exposure time, s.
    pub shutter: f32,
    /// Axis of the camera's rotation, with its angular speed as length, rad/s.
    pub turning: Vec3,
    /// Diameter of the lens's pupil, m.
    pub aperture: f32,
    /// Amplitudes of the modes (2,0) and (3,1), over the radius.
    pub amplitudes: [f32; 2],
    /// 1 / distance in focus, 1/m.
    pub inverse_focus: f32,
    /// Method of streaks: `DROPS_TABLE` or `DROPS_LOOP`.
    pub streaks: u32,
    /// Seed of the phases.
    pub seed: [u32; 2],
    /// Time of the picture ([`DropOscillationTime`]).
    pub ticks: u32,
    /// See `ticks`.
    pub time_offset: f32,
    /// Number of drops.
    pub count: u32,
    /// Room for drops: the places behind the last drop are marked as empty.
    pub room: u32,
    /// 1 if light fades over the exposure, 0 if it has one weight.
    pub is_fading: u32,
    /// 1 if drops of the smallest diameter look the same from everywhere.
    pub small_are_round: u32,
}

impl ProjectFrame {
    /// The frame of a picture of `count` drops, with no more room than for them.
    #[must_use]
    pub fn new(camera: &Camera, masks: &DropMasks, options: &RainOptions, count: u32) -> Self {
        let exposure = &options.exposure;
        let shutter = exposure.drops_s() as f32;
        let time = DropOscillationTime::from_seconds(exposure.time_s);
        Self {
            camera: *camera,
            eye_velocity: exposure.eye.velocity,
            shutter: if shutter.is_finite() { shutter } else { 0.0 },
            turning: exposure.eye.turning,
            aperture: exposure.aperture_m as f32,
            amplitudes: exposure.oscillation.pair().map(|a| a as f32),
            inverse_focus: (1.0 / exposure.focus_m) as f32,
            streaks: match exposure.samples {
                StreakSamples::Table => DROPS_TABLE,
                StreakSamples::Loop(_) => DROPS_LOOP,
            },
            seed: seed_words(exposure.seed),
            ticks: time.ticks,
            time_offset: time.offset,
            count,
            room: count,
            is_fading: u32::from(exposure.response == TemporalResponse::Fading),
            small_are_round: u32::from(masks.small_are_round()),
            has_axes: u32::from(options.light.form == DropLightForm::Atlas),
            unread: 0,
            unused: [0; 2],
        }
    }
}

/// Frequencies of the modes (2,0) and (3,1) in units of 2^-16 Hz, by the bits of the diameter: 128 for each octave, between
/// which 0.002 % are lost. Frequencies beyond 32 bits, of drops that do not oscillate, are the largest number.
#[must_use]
pub fn project_frequencies(fluids: &Fluids) -> Vec<[u32; 2]> {
    let entry = |k: u32| {
        let diameter = f64::from(f32::from_bits(PROJECT_FIRST_BITS + k * FREQUENCY_STEP));
        // Fluids and diameters are those of drops: without a law there is no oscillation.
        let units = |n| FrequencyLaw::Rayleigh1879.frequency(n, diameter.min(9.0e-3), fluids).unwrap_or(0.0);
        [units(2), units(3)].map(|hertz| (hertz * 65536.0) as u32)
    };
    (0..=(PROJECT_LAST_BITS + 1 - PROJECT_FIRST_BITS) / FREQUENCY_STEP).map(entry).collect()
}

/// The fraction of a path from `start` to `end` on which it is at least `least`; begin above end: none of it.
#[must_use]
pub fn project_ahead(start: f32, end: f32, least: f32) -> [f32; 2] {
    match (start >= least, end >= least) {
        (true, true) => [0.0, 1.0],
        (true, false) => [0.0, (start - least) / (start - end)],
        (false, true) => [(least - start) / (end - start), 1.0],
        (false, false) => [1.0, 0.0],
    }
}

/// The part of the exposure in which a drop is there; begin above end: none of it.
#[must_use]
pub fn project_present(present: [f32; 2], shutter: f32) -> [f32; 2] {
    if shutter == 0.0 {
        return if present[0] <= 0.0 && present[1] >= 0.0 { [0.0, 1.0] } else { [1.0, 0.0] };
    }
    let part = present.map(|time| (time / shutter + 0.5).clamp(0.0, 1.0));
    if part[0] < part[1] { part } else { [1.0, 0.0] }
}

/// Time at which a drop is seen at its position: 0 if it is there then, else when it lands or starts.
#[must_use]
pub fn project_seen(present: [f32; 2]) -> f32 {
    if present[1] < 0.0 { present[1] } else { present[0].max(0.0) }
}

/// The class of a row of the masks: the nearest.
#[must_use]
pub fn project_class(row: f32) -> u32 {
    let mut found = 0;
    for (k, at) in PROJECT_CLASS_ROWS.iter().enumerate() {
        if (at - row).abs() < (PROJECT_CLASS_ROWS[found] - row).abs() {
            found = k;
        }
    }
    found as u32
}

/// Samples of a drop so many pixels wide: of a streak those of a pixel, of a still drop those along an edge of one; 0: its light
/// is spread over the pixels about it. A splash has fewer than a drop: it shows no picture of what is around it.
#[must_use]
pub fn project_grid(width: f32, moves: bool, is_splash: bool) -> u32 {
    match width {
        d if moves && d < PROJECT_THIN => 0,
        d if moves && d < PROJECT_NARROW => PROJECT_NARROW_SAMPLES,
        _ if moves => PROJECT_WIDE_SAMPLES,
        d if d < PROJECT_SMALL => 0,
        d if d < 2.0 => {
            if is_splash {
                5
            } else {
                8
            }
        }
        d if d < 16.0 => {
            if is_splash {
                3
            } else {
                4
            }
        }
        _ => 2,
    }
}

/// The row of the light of lamps on a drop: where it is seen, and its radius.
#[must_use]
pub fn project_row(eye: Vec3, drop: &EyeDrop) -> [f32; 4] {
    let seen = Vec3::from(drop.offset) + Vec3::from(drop.velocity) * project_seen(drop.present);
    (eye + seen).extend(0.5 * drop.diameter).to_array()
}

/// The axis of a drop for an atlas, against its motion as the eye sees it (up, where it has none), and a number that stays with
/// it.
#[must_use]
pub fn project_axis(velocity: Vec3, id: u32) -> [f32; 4] {
    let square = velocity.dot(velocity);
    let axis = if square > 0.0 { -velocity / square.max(1.0e-30).sqrt() } else { Vec3::Y };
    axis.extend((id & AXIS_IDS) as f32).to_array()
}

/// A drop on the picture, and how it moves there.
#[derive(Clone, Copy, Debug)]
pub struct Projected {
    /// The drop.
    pub drop: ScreenDrop,
    /// Velocity relative to the picture, m/s.
    pub velocity: Vec3,
}

/// The part of a path that is shown.
struct ProjectPath {
    /// Positions at its begin and end, relative to the eye.
    ends: [Vec3; 2],
    /// That part of the exposure.
    part: [f32; 2],
    /// Mean depth along the direction to the drop, m.
    depth: f32,
    /// The least of it.
    nearest: f32,
    /// Depth at the end over that at the begin.
    depth_ratio: f32,
    velocity: Vec3,
    moves: bool,
}

/// Oscillation during the part of the exposure.
#[derive(Clone, Copy, Debug, Default)]
struct ProjectModes {
    mode_phase: [f32; 4],
    cycles: [f32; 2],
    /// No part of the surface goes farther, as a fraction of the radius.
    most: f32,
}

/// Puts drops on a picture.
#[derive(Debug)]
pub struct Projector<'a> {
    frame: ProjectFrame,
    masks: &'a DropMasks,
    frequencies: Vec<[u32; 2]>,
}

impl<'a> Projector<'a> {
    /// For the drops of a picture.
    #[must_use]
    pub fn new(camera: &Camera, masks: &'a DropMasks, options: &RainOptions) -> Self {
        let frame = ProjectFrame::new(camera, masks, options, 0);
        Self { frame, masks, frequencies: project_frequencies(&options.exposure.fluids) }
    }

    /// The frame of the picture; it has no drops.
    #[must_use]
    pub fn frame(&self) -> &ProjectFrame {
        &self.frame
    }

    /// Position relative to the eye at a time relative to the picture's, s.
    fn project_position(&self, drop: &EyeDrop, time: f32) -> Vec3 {
        drop.eye_drop_position(self.frame.eye_velocity, self.frame.turning, time)
    }

    /// The path of a drop whose middle is at `middle`, or of a splash, which has none; `None` if too little of it is there to be
    /// seen.
    fn project_path(
        &self,
        drop: &EyeDrop,
        middle: Vec3,
        present: [f32; 2],
        is_splash: bool,
    ) -> Option<ProjectPath> {
        let radius = 0.5 * drop.diameter;
        let distance = middle.length();
        let towards = middle / distance;
        let still = ProjectPath {
            ends: [middle; 2],
            part: [0.0, 1.0],
            depth: distance,
            nearest: distance,
            depth_ratio: 1.0,
            velocity: Vec3::ZERO,
            moves: false,
        };
        let shutter = self.frame.shutter;
        if shutter == 0.0 || is_splash {
            return Some(still);
        }
        let [open, close] = [-0.5, 0.5].map(|half| self.project_position(drop, half * shutter));
        let forward = self.frame.camera.forward;
        let in_front = project_ahead(open.dot(forward), close.dot(forward), 2.0 * radius + 0.02);
        let beside = project_ahead(open.dot(towards), close.dot(towards), 0.2 * distance);
        let part = [in_front[0].max(beside[0]).max(present[0]), in_front[1].min(beside[1]).min(present[1])];
        let ends = part.map(|fraction| open + (close - open) * fraction);
        let depths = ends.map(|p| p.dot(towards));
        let across = (ends[1] / depths[1].max(1.0e-6) - ends[0] / depths[0].max(1.0e-6)).length();
        if part[1] <= part[0] || !ops_is_finite(across) || across < PROJECT_STILL * radius / distance {
            // A drop that stands before the eye, or what is left of one that is there for a moment.
            return (present == [0.0, 1.0]).then_some(still);
        }
        Some(ProjectPath {
            ends,
            part,
            depth: 0.5 * (depths[0] + depths[1]),
            nearest: depths[0].min(depths[1]),
            depth_ratio: depths[1] / depths[0],
            velocity: (close - open) / shutter,
            moves: true,
        })
    }

    /// Frequencies of both modes for a diameter, in units of 2^-16 Hz: linear between the entries, in integers.
    fn project_frequency(&self, diameter: f32) -> [u32; 2] {
        let key = diameter.to_bits().clamp(PROJECT_FIRST_BITS, PROJECT_LAST_BITS) - PROJECT_FIRST_BITS;
        let at = (key / FREQUENCY_STEP) as usize;
        let part = key % FREQUENCY_STEP;
        std::array::from_fn(|mode| {
            let low = self.frequencies[at][mode];
            let down = low - self.frequencies[at + 1][mode];
            low - ((down >> 16) * part + (((down & 0xffff) * part) >> 16))
        })
    }

    /// The oscillation of a drop in a part of the exposure.
    fn project_modes(&self, drop: &EyeDrop, towards: Vec3, part: [f32; 2]) -> ProjectModes {
        let (frame, oscillating) = (&self.frame, PROJECT_OSCILLATES_MIN..=PROJECT_OSCILLATES_MAX);
        if frame.amplitudes == [0.0; 2] || !oscillating.contains(&drop.diameter) {
            return ProjectModes::default();
        }
        let frequency = self.project_frequency(drop.diameter);
        let phase = drop_oscillation_phase(frame.seed, drop.id);
        // Direction in which the mode (3,1) bulges, against the right of the view.
        let azimuth = STREAK_TURN * drop_oscillation_azimuth(frame.seed, drop.id);
        let right = drop_glint_right(towards);
        let cosine = ops::cos(azimuth) * right.x + ops::sin(azimuth) * right.z;
        let begin = frame.time_offset + frame.shutter * (part[0] - 0.5);
        let time = DropOscillationTime { ticks: frame.ticks, offset: begin };
        let at = [0, 1].map(|mode| {
            let turns = drop_oscillation_turns(frequency[mode], phase[mode], time);
            turns - turns.floor()
        });
        let open = frame.shutter * (part[1] - part[0]);
        let [a20, a31] = frame.amplitudes;
        ProjectModes {
            mode_phase: [a20, a31 * cosine, at[0], at[1]],
            cycles: frequency.map(|f| f as f32 * (DROP_OSCILLATION_TICK * open)),
            // P31 reaches 2.07.
            most: a20 + 2.1 * a31,
        }
    }

    /// A drop on the picture; `None` where it is on none.
    #[must_use]
    pub fn project_drop(&self, drop: &EyeDrop) -> Option<Projected> {
        let frame = &self.frame;
        let camera = &frame.camera;
        let is_splash = drop.speed <= FIELD_SPLASH;
        // A splash is there for all of the exposure, or not at all.
        let present = project_present(drop.present, if is_splash { 0.0 } else { frame.shutter });
        if present[0] > present[1] {
            return None;
        }
        // The middle of the part of its path that is there.
        let offset = self.project_position(drop, (0.5 * (present[0] + present[1]) - 0.5) * frame.shutter);
        let length = offset.length();
        let radius = 0.5 * drop.diameter;
        if !(length > 2.0 * radius && length.is_finite() && radius > 0.0) {
            return None;
        }
        let towards = offset / length;
        let cosine = towards.dot(camera.forward);
        if cosine < 0.05 {
            return None;
        }
        let path = self.project_path(drop, offset, present, is_splash)?;
        let right = drop_glint_right(towards);
        let up = right.cross(towards);
        let normal = if is_splash { eye_drop_normal(drop.speed) } else { Vec3::Y };
        let elevation = ops::asin((-towards.dot(normal)).clamp(-1.0, 1.0));
        let mask = if is_splash {
            self.masks.project_splash(drop.present, elevation)
        } else {
            self.masks.project_lookup(drop.diameter, elevation)
        };
        let distance = path.depth;
        let slope = radius / distance;
        // The plane of the picture is farther away, and slanted, away from the middle.
        let pixels = slope / (camera.pixel_angle * cosine);
        let width = 2.0 * pixels;
        // Circle of confusion of a thin lens.
        let blur = frame.aperture * (1.0 / distance - frame.inverse_focus).abs() / camera.pixel_angle;
        let is_blurred = blur >= 1.0 && blur > 0.7 * width;
        let grid = if is_blurred { 0 } else { project_grid(width, path.moves, is_splash) };
        let spread = if is_blurred { (0.75 * width * width + blur * blur).sqrt().max(1.0) } else { 1.0 };
        let modes =
            if path.moves { self.project_modes(drop, towards, path.part) } else { ProjectModes::default() };
        let larger = distance / path.nearest;
        let reach = if grid == 0 {
            0.5 * (spread + 1.0)
        } else {
            mask.half_extent * pixels * larger * (1.0 + modes.most) / cosine * 1.02 + 1.0
        };
        let [first, last] = path.ends.map(|p| camera.camera_project(p));
        let cycles = if is_splash { project_turn(normal, right, up) } else { modes.cycles };
        let [start, end] = path.ends.map(|p| Vec2::new(p.dot(right), p.dot(up)) / p.dot(towards));
        let shown = ScreenDrop {
            towards: towards.into(),
            distance,
            position: camera.camera_project(offset).into(),
            slope,
            half_extent: mask.half_extent,
            mask_index: mask.index,
            area: mask.area * pixels * pixels / cosine,
            grid,
            start: start.into(),
            along: (end - start).into(),
            first: first.into(),
            screen_delta: (last - first).into(),
            oval: mask.oval,
            depth_ratio: path.depth_ratio,
            mode_phase: modes.mode_phase,
            cycles,
            fraction: path.part[1] - path.part[0],
            spread,
            nearest: path.nearest - 2.0 * radius,
            kind: if path.moves { frame.streaks } else { DROPS_STILL },
            shape: project_class(mask.index[0]),
            profile: 0,
            weights: match path.moves && frame.is_fading == 1 {
                true => path.part.map(|part| 2.0 * part),
                false => [1.0; 2],
            },
            reach,
            id: drop.id,
        };
        Some(Projected { drop: shown, velocity: path.velocity })
    }
}

/// The turn of a splash on the picture: how far its normal goes along the up and the right of its view.
#[must_use]
pub fn project_turn(normal: Vec3, right: Vec3, up: Vec3) -> [f32; 2] {
    let turn = Vec2::new(normal.dot(up), normal.dot(right));
    let size = turn.length();
    if turn.y == 0.0 || size < 1.0e-3 {
        return [if turn.x < 0.0 { -1.0 } else { 1.0 }, 0.0];
    }
    (turn / size).to_array()
}

//! Profiles of a picture's streaks in the streak radiance table: which streaks have one, how fine it is, and where it is. Twin of
//! `shaders/wgsl/render/profiles.wgsl`, where the method is described.

use downpour_drop::oscillation::drop_oscillation_azimuth;
use downpour_math::ops;
use downpour_math::rng::seed_words;
use downpour_shaders::render::rain::{
    DROPS_LOOP, DROPS_STILL, DROPS_TABLE, PROFILES_ALONG, PROFILES_COLUMNS, PROFILES_FINE, PROFILES_KINDS,
    PROFILES_LEVELS, PROFILES_MAX, PROFILES_MIN, PROFILES_PER_TURN, PROFILES_ROWS_FOR_TWO, PROFILES_TURNED,
    PROFILES_WIDTHS, PROJECT_CLASSES, STREAK_SUMS, STREAK_TURN,
};

use super::DropMasks;
use super::exposure::Exposure;
use super::shapes;
use super::streak::ScreenDrop;
use super::streak_light::UNITS;
use super::streak_lookup::STREAK_MEAN_ENTRIES;
use super::streak_path::StreakPath;
use super::streak_span::streak_span;

/// Most rays of a picture's profiles: a million, on the CPU as on a device, so that both have the same profiles.
pub const MAX_RAYS: u32 = 1 << 20;
/// Most entries of the table: 64 MiB.
pub const MAX_ENTRIES: u32 = 64 << 20 >> 4;

/// Fewest rays of a row: four columns of as many.
const MIN_ROW: u32 = STREAK_SUMS * STREAK_SUMS;

/// Uniforms of the kernels. The same layout as `ProfilesFrame` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct ProfilesFrame {
    /// Number of drops.
    pub count: u32,
    /// Most rays.
    pub max_rays: u32,
    /// Most entries of the table.
    pub max_entries: u32,
    /// Entries of the table before the first profile.
    pub first_entry: u32,
    /// Seed of the phases.
    pub seed: [u32; 2],
    /// Amplitudes of the oscillation, over the radius.
    pub amplitudes: [f32; 2],
    /// Class of the drops that are not drawn one by one; `PROJECT_NO_CLASS`: there is none.
    pub medium: u32,
    /// 0.
    pub unused_1: u32,
    /// 0.
    pub unused_2: u32,
    /// 0.
    pub unused_3: u32,
}

impl ProfilesFrame {
    /// The frame of a picture of `count` drops; `medium` is the class of those that are not drawn one by one.
    #[must_use]
    pub fn new(exposure: &Exposure, count: u32, medium: u32) -> Self {
        Self {
            count,
            max_rays: MAX_RAYS,
            max_entries: MAX_ENTRIES,
            first_entry: PROJECT_CLASSES * STREAK_MEAN_ENTRIES,
            seed: seed_words(exposure.seed),
            amplitudes: exposure.oscillation.pair().map(|a| a as f32),
            medium,
            unused_1: 0,
            unused_2: 0,
            unused_3: 0,
        }
    }

    /// The frame with room for fewer rays and entries.
    #[must_use]
    pub fn with_room(self, max_rays: u32, max_entries: u32) -> Self {
        Self { max_rays, max_entries: max_entries.max(self.first_entry), ..self }
    }

    /// Most streaks that have a profile: the coarsest has two rows of 4 x 4 rays.
    #[must_use]
    pub fn max_paths(&self) -> u32 {
        (self.max_rays / (2 * MIN_ROW)).max(1)
    }

    /// Most jobs of each kind: rows of rays, and parts of profiles, whose points have [`STREAK_SUMS`] entries each.
    #[must_use]
    pub fn max_jobs(&self) -> [u32; 2] {
        [self.max_rays / MIN_ROW, self.max_entries / STREAK_SUMS / UNITS + self.max_paths()]
    }
}

/// Profiles of the streaks of a picture, and classes of drops with a mean radiance.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StreakProfiles {
    /// Classes of drops that are not sampled; those without rows are not wanted.
    pub classes: Vec<StreakPath>,
    /// Streaks that have a profile.
    pub paths: Vec<StreakPath>,
    /// Rows of rays: path and row.
    pub ray_jobs: Vec<[u32; 2]>,
    /// Columns of profiles: path, and the first of 64.
    pub light_jobs: Vec<[u32; 2]>,
    /// Number of rays.
    pub rays: u32,
    /// Number of entries of the table.
    pub entries: u32,
}

/// Rows and columns of the rays of a profile, its rows, and its columns for each of the rays'.
pub type Sizes = [u32; 4];

/// True if a drop is a streak that is sampled.
#[must_use]
pub fn profiles_is_sampled(drop: &ScreenDrop) -> bool {
    drop.reach > 0.0 && drop.kind == DROPS_TABLE && drop.grid > 0
}

/// True if a drop shows the mean of its class.
#[must_use]
pub fn profiles_is_mean(drop: &ScreenDrop) -> bool {
    drop.reach > 0.0 && drop.kind != DROPS_STILL && drop.grid == 0
}

/// True if a drop oscillates.
#[must_use]
pub fn profiles_oscillates(drop: &ScreenDrop) -> bool {
    drop.mode_phase[0] != 0.0 || drop.mode_phase[1] != 0.0
}

/// Rows of a profile of so many rows of rays: half as many again.
#[must_use]
pub fn profiles_rows_of(rows: u32) -> u32 {
    if rows == 2 { 2 } else { (rows - 1) * PROFILES_ROWS_FOR_TWO / 2 + 1 }
}

/// Sizes of the profile of a streak, by its width and its turns: rays are the finer the wider the streak is on the picture. The
/// light of a streak of a pixel or two has to be right as a whole, that of a wide one along and across, too.
#[must_use]
pub fn profiles_sized(drop: &ScreenDrop) -> Sizes {
    // The drop's area on the picture is that of its mask.
    let width = 2.0 * (drop.area / std::f32::consts::PI).sqrt();
    let mut kind = 0;
    while kind + 1 < PROFILES_KINDS as usize && width > PROFILES_WIDTHS[kind] {
        kind += 1;
    }
    let span = streak_span(drop);
    let [x, y] = drop.along;
    let along = (x * x + y * y).sqrt() * (1.0 + span.before + span.after);
    let turned = ops::atan2(along, 1.0) / PROFILES_TURNED;
    let turns = drop.cycles[1] * (span.last - span.first);
    let (turns, least) = if profiles_oscillates(drop) { (turns, PROFILES_MIN[kind]) } else { (0.0, 1.0) };
    let wanted = (turns * PROFILES_PER_TURN[kind]).max(turned).ceil();
    let rows = 1 + wanted.clamp(least, PROFILES_MAX[kind]) as u32;
    [rows, PROFILES_COLUMNS[kind] as u32, profiles_rows_of(rows), PROFILES_FINE[kind] as u32]
}

/// Sizes of a profile that is made coarser so many times: with four columns fewer each time, as long as there are any, and with a half, a third,
/// ... of the rows. Fewer columns cost a thin streak little, whose light has to be right as a whole.
#[must_use]
pub fn profiles_coarser(sizes: Sizes, level: u32) -> Sizes {
    if level == 0 {
        return sizes;
    }
    let rows = (sizes[0] / (level + 1)).max(2);
    let columns = sizes[1].saturating_sub(STREAK_SUMS * level).max(STREAK_SUMS);
    [rows, columns, profiles_rows_of(rows), 1]
}

/// Rays of a profile, and its entries in the table.
#[must_use]
pub fn profiles_room([rows, columns, profile_rows, fine]: Sizes) -> [u32; 2] {
    let chords = rows * columns;
    [chords * columns, 1 + chords + profile_rows * columns * fine * STREAK_SUMS]
}

/// The first level that has room, by the rays and entries of all profiles for each; `PROFILES_LEVELS`: none has.
#[must_use]
pub fn profiles_level(totals: &[[u64; 2]; PROFILES_LEVELS as usize], frame: &ProfilesFrame) -> u32 {
    let room = [frame.max_rays, frame.max_entries - frame.first_entry].map(u64::from);
    let fits = |total: &[u64; 2]| total[0] <= room[0] && total[1] <= room[1];
    totals.iter().position(fits).map_or(PROFILES_LEVELS, |level| level as u32)
}

/// Workgroups for so many jobs.
#[must_use]
pub fn profiles_groups_of(jobs: u32) -> [u32; 2] {
    [jobs.min(PROFILES_ALONG), jobs.div_ceil(PROFILES_ALONG)]
}

impl StreakProfiles {
    /// Gives each streak among `drops` its position, and its drop the way to it; streaks for which there is no room are averaged
    /// by a loop. `radii` are those of the drops; `medium` is the class of the drops that are not drawn one by one, whose mean is
    /// wanted in any case.
    #[must_use]
    pub fn new(
        drops: &mut [ScreenDrop],
        radii: &[f32],
        masks: &DropMasks,
        exposure: &Exposure,
        medium: u32,
    ) -> Self {
        let frame = ProfilesFrame::new(exposure, drops.len() as u32, medium);
        Self::with_frame(drops, radii, masks, exposure, &frame)
    }

    /// As [`StreakProfiles::new`], with the room that a frame has.
    #[must_use]
    pub fn with_frame(
        drops: &mut [ScreenDrop],
        radii: &[f32],
        masks: &DropMasks,
        exposure: &Exposure,
        frame: &ProfilesFrame,
    ) -> Self {
        let mut made = Self { classes: shapes::classes(masks, exposure), ..Self::default() };
        let means = drops.iter().filter(|drop| profiles_is_mean(drop)).map(|drop| drop.shape);
        for class in means.chain([frame.medium]) {
            if let Some(class) = made.classes.get_mut(class as usize) {
                class.rows = 1;
            }
        }
        made.entries = frame.first_entry;
        let mut totals = [[0; 2]; PROFILES_LEVELS as usize];
        for drop in drops.iter().filter(|drop| profiles_is_sampled(drop)) {
            let sizes = profiles_sized(drop);
            for (level, total) in (0..).zip(&mut totals) {
                let room = profiles_room(profiles_coarser(sizes, level));
                *total = [0, 1].map(|k| total[k] + u64::from(room[k]));
            }
        }
        let level = profiles_level(&totals, frame);
        for (index, (drop, radius)) in (0u32..).zip(drops.iter_mut().zip(radii)) {
            if !profiles_is_sampled(drop) {
                continue;
            }
            if level == PROFILES_LEVELS {
                drop.kind = DROPS_LOOP;
                continue;
            }
            let sizes = profiles_coarser(profiles_sized(drop), level);
            made.place(index, drop, &sizes, masks.profiles_shape(2.0 * radius), frame);
        }
        made
    }

    fn place(
        &mut self,
        index: u32,
        drop: &mut ScreenDrop,
        sizes: &Sizes,
        shape: StreakPath,
        frame: &ProfilesFrame,
    ) {
        let azimuth = STREAK_TURN * drop_oscillation_azimuth(frame.seed, drop.id);
        let [rows, columns, profile_rows, fine] = *sizes;
        let path = StreakPath {
            amplitudes: if profiles_oscillates(drop) { frame.amplitudes } else { [0.0; 2] },
            lobe: [ops::cos(azimuth), ops::sin(azimuth)],
            rows,
            columns,
            profile_rows,
            fine,
            drop: index,
            first_ray: self.rays,
            first_entry: self.entries,
            ..shape
        };
        let [rays, entries] = profiles_room(*sizes);
        self.rays += rays;
        self.entries += entries;
        let number = self.paths.len() as u32;
        self.ray_jobs.extend((0..rows).map(|row| [number, row]));
        let units = profile_rows * columns;
        self.light_jobs.extend((0..units).step_by(UNITS as usize).map(|first| [number, first]));
        drop.profile = path.first_entry;
        self.paths.push(path);
    }
}

//! Profiles of a picture's streaks in the streak radiance table: choice of the streaks, resolution and position in the table.
//!
//! Every streak that is sampled in its pixels has one. Rays are the finer the wider the streak is on the picture: the light of a
//! streak of a pixel or two has to be right as a whole, that of a wide one along and across, too.

use downpour_drop::oscillation::drop_oscillation_azimuth;
use downpour_math::ops;
use downpour_math::rng::seed_words;
use downpour_shaders::render::rain::{DROPS_STILL, DROPS_TABLE, STREAK_SUMS, STREAK_TURN};
use downpour_sim::field::FallingDrop;

use super::DropMasks;
use super::exposure::Exposure;
use super::project::Projected;
use super::shapes;
use super::streak::DropsDrop;
use super::streak_light::UNITS;
use super::streak_lookup::STREAK_MEAN_ENTRIES;
use super::streak_path::StreakPath;

/// The most rays, and the most entries of the table: 128 MiB each, what every device binds.
const MAX_RAYS: u64 = 128 << 20 >> 5;
const MAX_ENTRIES: u64 = 128 << 20 >> 4;

/// Radians of the picture that a row of rays stands for: the directions in which a drop is seen differ by that.
const TURNED: f32 = 0.1;

/// Resolution of a profile.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Fineness {
    /// Streaks up to this width, pixels.
    width: f32,
    columns: u32,
    /// Rows for each turn of the mode (3,1), and the least and the most of them.
    per_turn: f32,
    least: u32,
    most: u32,
    fine: u32,
}

/// From thin streaks to wide ones.
const FINENESS: [Fineness; 4] = [
    Fineness { width: 3.0, columns: 12, per_turn: 8.0, least: 3, most: 24, fine: 1 },
    Fineness { width: 6.0, columns: 16, per_turn: 12.0, least: 4, most: 48, fine: 2 },
    Fineness { width: 14.0, columns: 24, per_turn: 20.0, least: 6, most: 96, fine: 2 },
    Fineness { width: f32::INFINITY, columns: 24, per_turn: 24.0, least: 6, most: 128, fine: 4 },
];

/// Profiles have half as many rows again as rays have.
const ROWS_FOR_TWO: u32 = 3;

/// Profiles of the streaks of a picture, and classes of drops with a mean radiance.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StreakProfiles {
    /// Classes of drops that are not sampled; those without rows are unused.
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

impl StreakProfiles {
    /// Gives each streak among `drops` its position, and its drop the way to it. `given` are the drops that they are of; of
    /// the class `medium`, if there is one, the mean is wanted in any case.
    pub(super) fn new(
        drops: &mut [(u32, Projected)],
        given: &[FallingDrop],
        masks: &DropMasks,
        exposure: &Exposure,
        medium: Option<u32>,
    ) -> Self {
        let mut made = Self::default();
        let is_mean = |drop: &DropsDrop| drop.kind != DROPS_STILL && drop.grid == 0;
        let is_sampled = |drop: &DropsDrop| drop.kind == DROPS_TABLE && drop.grid > 0;
        if medium.is_some() || drops.iter().any(|(_, projected)| is_mean(&projected.drop)) {
            made.classes = shapes::classes(masks, exposure);
            if let Some(class) = medium.and_then(|class| made.classes.get_mut(class as usize)) {
                class.rows = 1;
            }
            for (_, projected) in drops.iter().filter(|(_, projected)| is_mean(&projected.drop)) {
                made.classes[projected.drop.shape as usize].rows = 1;
            }
        }
        made.entries = made.classes.len() as u32 * STREAK_MEAN_ENTRIES;
        let sampled = || (0u32..).zip(drops.iter()).filter(|(_, (_, p))| is_sampled(&p.drop));
        for (index, (k, projected)) in sampled() {
            let mut path = masks.streak_shape(given[*k as usize].diameter);
            let oscillates = projected.drop.mode_phase[0] != 0.0 || projected.drop.mode_phase[1] != 0.0;
            let pair = exposure.oscillation.pair().map(|a| a as f32);
            path.amplitudes = if oscillates { pair } else { [0.0; 2] };
            let azimuth = drop_oscillation_azimuth(seed_words(exposure.seed), projected.drop.id);
            let azimuth = STREAK_TURN * azimuth;
            path.lobe = [ops::cos(azimuth), ops::sin(azimuth)];
            path.drop = index;
            made.paths.push(sized(path, projected));
        }
        made.fit();
        for (path, k) in made.paths.iter_mut().zip(0u32..) {
            (path.first_ray, path.first_entry) = (made.rays, made.entries);
            made.rays += rays(path) as u32;
            made.entries += entries(path) as u32;
            made.ray_jobs.extend((0..path.rows).map(|row| [k, row]));
            let units = path.profile_rows * path.columns;
            made.light_jobs.extend((0..units).step_by(UNITS as usize).map(|first| [k, first]));
            drops[path.drop as usize].1.drop.profile = path.first_entry;
        }
        made
    }

    /// Makes profiles coarser in time until all fit.
    fn fit(&mut self) {
        loop {
            let all_rays: u64 = self.paths.iter().map(rays).sum();
            let all_entries: u64 = self.paths.iter().map(entries).sum::<u64>() + u64::from(self.entries);
            let coarsest = self.paths.iter().all(|path| path.rows == 2 && path.fine == 1);
            if (all_rays <= MAX_RAYS && all_entries <= MAX_ENTRIES) || coarsest {
                return;
            }
            for path in &mut self.paths {
                path.rows = (path.rows / 2).max(2);
                path.profile_rows = profile_rows(path.rows);
                path.fine = 1;
            }
        }
    }
}

/// Rows of a profile of so many rows of rays.
fn profile_rows(rows: u32) -> u32 {
    if rows == 2 { 2 } else { (rows - 1) * ROWS_FOR_TWO / 2 + 1 }
}

/// Rays of a path.
fn rays(path: &StreakPath) -> u64 {
    u64::from(path.rows) * u64::from(path.columns * path.columns)
}

/// Entries of a path in the table.
fn entries(path: &StreakPath) -> u64 {
    let chords = u64::from(path.rows) * u64::from(path.columns);
    let light = u64::from(path.profile_rows) * u64::from(path.columns * path.fine * STREAK_SUMS);
    1 + chords + light
}

/// A path with its numbers of rows and columns.
fn sized(path: StreakPath, projected: &Projected) -> StreakPath {
    let drop = &projected.drop;
    // The drop's area on the picture is that of its mask.
    let width = 2.0 * (drop.area / std::f32::consts::PI).sqrt();
    let fineness = FINENESS.into_iter().find(|f| width <= f.width).unwrap_or(FINENESS[3]);
    let [x, y] = drop.along;
    let turned = ops::atan2((x * x + y * y).sqrt(), 1.0) / TURNED;
    let oscillates = path.amplitudes != [0.0; 2];
    let (turns, least) = if oscillates { (drop.cycles[1], fineness.least) } else { (0.0, 1) };
    let wanted = (turns * fineness.per_turn).max(turned).ceil();
    let rows = 1 + (wanted as u32).clamp(least, fineness.most);
    StreakPath {
        rows,
        columns: fineness.columns,
        profile_rows: profile_rows(rows),
        fine: fineness.fine,
        ..path
    }
}

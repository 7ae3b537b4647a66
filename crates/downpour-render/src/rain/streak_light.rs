//! Lights the profiles of streaks. Twin of `shaders/wgsl/render/streak_light.wgsl`, where method and layout are described.

use downpour_math::packing::{packing_octahedral_decode, packing_unpack_snorm, packing_unpack_unorm};
use downpour_shaders::render::drop_light::DROP_GLINT_TINY;
use downpour_shaders::render::rain::{
    DROPS_SHIFT, STREAK_EXITS, STREAK_LAMPS, STREAK_NARROWEST, STREAK_QUARTER, STREAK_SPOT_ALONG,
    STREAK_SPOT_EDGE, STREAK_SPOT_FIRST, STREAK_SPOT_FLAT, STREAK_SPOT_LATER, STREAK_SPOT_NARROW,
    STREAK_SPOT_REACH, STREAK_SPOT_SECOND, STREAK_SPOT_SLACK, STREAK_SPOT_THIRD, STREAK_SPOT_WIDTH,
    STREAK_SPOTS, STREAK_SUMS,
};
use glam::{Vec2, Vec3, Vec4};
use rayon::prelude::*;

use super::drops_frame::DropsView;
use super::drops_mask::drops_mask_unit;
use super::glint::{drop_glint_right, drop_glint_rousseau};
use super::streak::ScreenDrop;
use super::streak_cell::{streak_cell_position, streak_cell_slope, streak_cell_weight};
use super::streak_path::{StreakPath, streak_path_instant};
use super::streak_rays::StreakRay;

/// Columns of the profile of a job.
pub(super) const UNITS: u32 = 64;

/// The most fine columns of a column.
const FINE: usize = 4;
const SUMS: usize = STREAK_SUMS as usize;

/// Rows of light of each path: the mean of what is not resolved by lamp, and two for each lamp.
pub(super) const LIGHT_ROWS: usize = 1 + 2 * STREAK_LAMPS as usize;

/// One exit of a ray.
#[derive(Clone, Copy, Debug, Default)]
struct StreakExit {
    direction: Vec3,
    fraction: f32,
    /// Interfaces passed; 0: there is none.
    passed: u32,
}

/// Change of an exit along an axis: first and second difference per ray of its direction and of its fraction.
#[derive(Clone, Copy, Debug, Default)]
struct StreakChange {
    first: Vec3,
    fraction: f32,
    second: Vec3,
    fraction_second: f32,
}

/// A ray's patch: its exit and how that goes across, along and in time.
#[derive(Clone, Copy, Debug)]
struct StreakPatch {
    middle: StreakExit,
    across: StreakChange,
    along: StreakChange,
    later: StreakChange,
    across_along: Vec3,
    across_later: Vec3,
    along_later: Vec3,
}

/// The change between an exit's neighbors, as far as their light went the same way.
fn streak_light_change(before: &StreakExit, here: &StreakExit, after: &StreakExit) -> StreakChange {
    let has_before = before.passed == here.passed;
    let has_after = after.passed == here.passed;
    match (has_before, has_after) {
        (true, true) => StreakChange {
            first: (after.direction - before.direction) * 0.5,
            fraction: (after.fraction - before.fraction) * 0.5,
            second: after.direction + before.direction - here.direction * 2.0,
            fraction_second: after.fraction + before.fraction - here.fraction * 2.0,
        },
        (false, true) => StreakChange {
            first: after.direction - here.direction,
            fraction: after.fraction - here.fraction,
            ..StreakChange::default()
        },
        (true, false) => StreakChange {
            first: here.direction - before.direction,
            fraction: here.fraction - before.fraction,
            ..StreakChange::default()
        },
        (false, false) => StreakChange::default(),
    }
}

/// The mixed second difference, from the two neighbors on a diagonal.
fn streak_light_mixed(
    before: &StreakExit,
    here: &StreakExit,
    after: &StreakExit,
    a: &StreakChange,
    b: &StreakChange,
) -> Vec3 {
    if before.passed != here.passed || after.passed != here.passed {
        return Vec3::ZERO;
    }
    (before.direction + after.direction - here.direction * 2.0 - a.second - b.second) * 0.5
}

/// The direction at a position of a patch: rays across, along and later, from its middle.
fn streak_light_direction(ray: &StreakPatch, position: Vec3) -> Vec3 {
    let linear = ray.middle.direction
        + ray.across.first * position.x
        + ray.along.first * position.y
        + ray.later.first * position.z;
    let squares = ray.across.second * (0.5 * position.x * position.x)
        + ray.along.second * (0.5 * position.y * position.y)
        + ray.later.second * (0.5 * position.z * position.z);
    let mixed = ray.across_along * (position.x * position.y)
        + ray.across_later * (position.x * position.z)
        + ray.along_later * (position.y * position.z);
    drops_mask_unit(linear + squares + mixed)
}

/// The fraction of the light at a position of a patch.
fn streak_light_fraction(ray: &StreakPatch, position: Vec3) -> f32 {
    let linear = ray.middle.fraction
        + ray.across.fraction * position.x
        + ray.along.fraction * position.y
        + ray.later.fraction * position.z;
    let squares = ray.across.fraction_second * (0.5 * position.x * position.x)
        + ray.along.fraction_second * (0.5 * position.y * position.y)
        + ray.later.fraction_second * (0.5 * position.z * position.z);
    (linear + squares).clamp(0.0, 1.0)
}

/// Width of a patch across and along, at a time.
fn streak_light_size(ray: &StreakPatch, later: f32) -> Vec2 {
    let across = ray.across.first + ray.across_later * later;
    let along = ray.along.first + ray.along_later * later;
    Vec2::new(across.dot(across).sqrt(), along.dot(along).sqrt())
}

/// Cell of a ray in the grid of its row: columns of rays across the motion, each of several fine columns, and rays along a chord.
#[derive(Clone, Copy, Debug)]
struct StreakCell {
    column: u32,
    tap: u32,
    columns: u32,
    fine: u32,
}

/// Light of a lamp with an irradiance of 1 in the fine columns of a ray's cell, as parts of the light of a chord: the mean over the
/// points of its patch, of which those that see the lamp's disk show its radiance. `width`: of the patch, across, along and in time; `spot`:
/// radius of a spot that some of its points meet; `reach`: the chord from the middle to the edge of the disk; `span`: rays between two
/// rows of the profile; `shift` tells the points of a patch from its neighbors'. A point stands for the part of the outline's area
/// around it; what is looked up between fine columns then has the light of the points.
fn streak_light_spot(
    ray: &StreakPatch,
    [later, span]: [f32; 2],
    [width, spot]: [f32; 2],
    lamp: Vec3,
    reach: f32,
    cell: StreakCell,
    shift: Vec3,
) -> [f32; FINE] {
    let mut spots = [0.0; FINE];
    let count = STREAK_SPOTS as f32;
    let wide = reach.max(spot);
    // The edge of a disk is as soft as points are apart.
    let edge = if spot > reach { 0.0 } else { 0.5 * spot };
    let whole = 2.0 * STREAK_QUARTER * (wide * wide + edge * edge / 3.0);
    let radiance = cell.fine as f32 / (count * whole);
    let [first, number] = if width < STREAK_SPOT_FLAT {
        streak_light_points(ray, [later, span], lamp, wide + edge, shift.x)
    } else {
        [0, STREAK_SPOTS]
    };
    // In the order of all points: those past the last one come first.
    let past = (first + number).max(STREAK_SPOTS) - STREAK_SPOTS;
    for turn in 0..number {
        let k = if turn < past { turn } else { first + turn - past };
        let number = k as f32 + 0.5;
        let steps = Vec3::new(1.0 / count, STREAK_SPOT_ALONG, STREAK_SPOT_LATER);
        let point = (steps * number + shift).fract();
        let position = Vec3::new(point.x - 0.5, point.y - 0.5, later + (point.z - 0.5) * span);
        let apart = streak_light_direction(ray, position) - lamp;
        let off = apart.dot(apart).sqrt();
        if off < wide + edge {
            // A disk, or a spot that fades toward its edge.
            let faded = if spot > reach {
                2.0 * (1.0 - off * off / (wide * wide))
            } else {
                (0.5 + 0.5 * (wide - off) / edge.max(STREAK_SPOT_EDGE)).clamp(0.0, 1.0)
            };
            let part = ((point.x * cell.fine as f32) as u32).min(cell.fine - 1);
            let along = streak_cell_slope(cell.tap as f32 + point.y, cell.columns);
            let across = streak_cell_slope(cell.column as f32 + point.x, cell.columns);
            // Chords are the shorter the farther out, and columns stand the closer.
            let density = along * across * across;
            spots[part as usize] += radiance * faded * density * streak_light_fraction(ray, position);
        }
    }
    let count = cell.columns * cell.fine;
    // Half the length of a chord is 1.
    let length = STREAK_QUARTER / cell.columns as f32;
    for (part, spot) in (0..cell.fine).zip(&mut spots) {
        *spot *= length / streak_cell_weight(cell.column * cell.fine + part, count);
    }
    spots
}

/// Radius of a spot that some of the points of a patch meet, by the patch's width across and along.
fn streak_light_radius(size: Vec2) -> f32 {
    let area = size.x.max(STREAK_SPOT_NARROW * size.y) * size.y.max(STREAK_SPOT_NARROW * size.x);
    STREAK_SPOT_WIDTH * (area / STREAK_SPOTS as f32).sqrt()
}

/// Extent of the directions of a patch along an axis beside its lines across and along: in time, and by second differences; and the
/// distance at which a lamp is looked for.
fn streak_light_bound(ray: &StreakPatch, axis: Vec3, moved: Vec3, span: f32, reach: f32) -> f32 {
    let part = |way: Vec3| way.dot(axis).abs();
    let squares = part(ray.across.second) + part(ray.along.second) + part(ray.later.second) * (span * span);
    let mixed = part(ray.across_along) + (part(ray.across_later) + part(ray.along_later)) * span;
    reach + STREAK_SPOT_SLACK * (0.5 * part(moved) + 0.125 * squares + 0.25 * mixed)
}

/// The axis of length 1 beside a way from a direction.
fn streak_light_beside(center: Vec3, way: Vec3) -> Vec3 {
    let axis = center.cross(way);
    axis / axis.dot(axis).sqrt().max(STREAK_SPOT_EDGE)
}

/// The points of a patch of which some may be nearer than `reach` to the direction of a lamp: the first, and how many follow it, from the
/// last on again from 0.
fn streak_light_points(
    ray: &StreakPatch,
    [later, span]: [f32; 2],
    lamp: Vec3,
    reach: f32,
    shift: f32,
) -> [u32; 2] {
    let center = streak_light_direction(ray, Vec3::new(0.0, 0.0, later));
    let across = ray.across.first + ray.across_later * later;
    let along = ray.along.first + ray.along_later * later;
    let moved = (ray.later.first + ray.later.second * later) * span;
    let aside = streak_light_beside(center, across);
    let slanted = 0.5 * STREAK_SPOT_SLACK * along.dot(aside).abs();
    if (lamp - center).dot(aside).abs() > streak_light_bound(ray, aside, moved, span, reach) + slanted {
        return [0, 0];
    }
    let axis = streak_light_beside(center, along);
    let per_ray = across.dot(axis);
    let off = (lamp - center).dot(axis);
    let slack = 0.5 * (STREAK_SPOT_SLACK - 1.0) * per_ray.abs();
    let half = streak_light_bound(ray, axis, moved, span, reach) + slack;
    if off.abs() > half + 0.5 * per_ray.abs() {
        return [0, 0];
    }
    let firm = if per_ray.abs() < STREAK_SPOT_EDGE { STREAK_SPOT_EDGE } else { per_ray };
    let ends = [off - half, off + half].map(|at| (at / firm).clamp(-0.5, 0.5) + 0.5 - shift);
    let count = STREAK_SPOTS as f32;
    let first = (count * ends[0].min(ends[1]) - 0.5).floor() as i32;
    let last = (count * ends[0].max(ends[1]) - 0.5).ceil() as i32;
    let number = (last + 1 - first).clamp(0, STREAK_SPOTS as i32);
    [first.rem_euclid(STREAK_SPOTS as i32) as u32, number as u32]
}

/// From the eye to a drop's middle in a row of the profile, by the fraction of the rows before it, of length 1.
fn streak_light_view(drop: &ScreenDrop, row: f32) -> Vec3 {
    let towards = Vec3::from(drop.towards);
    let right = drop_glint_right(towards);
    let up = right.cross(towards);
    let middle = streak_path_instant(drop, row).middle;
    drops_mask_unit(towards + right * middle.x + up * middle.y)
}

/// Data from which the light of a streak is computed.
struct Streak<'a> {
    view: DropsView<'a>,
    path: &'a StreakPath,
    drop: &'a ScreenDrop,
    exits: &'a [[StreakExit; 4]],
    lamps: &'a [[f32; 4]],
}

impl Streak<'_> {
    /// An exit of a ray; none outside of the streak's rays.
    fn streak_light_exit(&self, [row, column, tap]: [i32; 3], number: usize) -> StreakExit {
        let (rows, columns) = (self.path.rows as i32, self.path.columns as i32);
        if row < 0 || row >= rows || column < 0 || column >= columns || tap < 0 || tap >= columns {
            return StreakExit::default();
        }
        self.exits[((row * columns + column) * columns + tap) as usize][number]
    }

    /// The patch around the exit `here` of a ray.
    fn streak_light_patch(
        &self,
        [row, column, tap]: [i32; 3],
        number: usize,
        here: StreakExit,
    ) -> StreakPatch {
        let at = |r: i32, c: i32, t: i32| self.streak_light_exit([row + r, column + c, tap + t], number);
        let across = streak_light_change(&at(0, -1, 0), &here, &at(0, 1, 0));
        let along = streak_light_change(&at(0, 0, -1), &here, &at(0, 0, 1));
        let later = streak_light_change(&at(-1, 0, 0), &here, &at(1, 0, 0));
        StreakPatch {
            middle: here,
            across,
            along,
            later,
            across_along: streak_light_mixed(&at(0, -1, -1), &here, &at(0, 1, 1), &across, &along),
            across_later: streak_light_mixed(&at(-1, -1, 0), &here, &at(1, 1, 0), &across, &later),
            along_later: streak_light_mixed(&at(-1, 0, -1), &here, &at(1, 0, 1), &along, &later),
        }
    }

    /// Which of its lamps light a streak: a bit for each.
    fn streak_light_lit(&self) -> u32 {
        let (pairs, _) = self.lamps[1..].as_chunks::<2>();
        pairs.iter().zip(0..).fold(0, |lit, ([lamp, _], k)| lit | u32::from(lamp[3] != 0.0) << k)
    }

    /// These lamps, their irradiances and directions.
    fn lamps(&self, lit: u32) -> impl Iterator<Item = (Vec4, Vec3)> {
        let (pairs, _) = self.lamps[1..].as_chunks::<2>();
        let lit = pairs.iter().zip(0..).filter(move |(_, k)| lit >> k & 1 == 1);
        lit.map(|(&[lamp, towards], _)| (Vec4::from(lamp), Vec4::from(towards).truncate()))
    }

    /// Mean radiance of the lamps over all directions.
    fn streak_light_even(&self, lit: u32) -> Vec3 {
        let lamps = self.lamps(lit).filter(|(lamp, _)| lamp.w > 0.0);
        lamps.fold(Vec3::ZERO, |sum, (lamp, _)| sum + lamp.truncate()) * (0.125 / STREAK_QUARTER)
    }

    /// Light of the lamps in the form of Rousseau 2006 where a ray meets the drop: by the normal there, which halves the angle
    /// between the eye and what is mirrored.
    fn streak_light_facing(&self, lit: u32, view: Vec3, at: [i32; 3]) -> Vec3 {
        let mut sum = Vec3::ZERO;
        for (lamp, towards) in self.lamps(lit).filter(|(lamp, _)| lamp.w < 0.0) {
            let mirrored = self.streak_light_exit(at, 0).direction - view;
            let normal = mirrored / mirrored.dot(mirrored).max(DROP_GLINT_TINY).sqrt();
            sum += lamp.truncate()
                * drop_glint_rousseau(normal, -view, towards, self.view.frame.light_terms).max(0.0);
        }
        sum
    }

    /// The light of one column of a row of the profile, part by part: fine columns of four sums.
    fn streak_light_column(&self, row: u32, column: u32) -> [[[f32; 4]; SUMS]; FINE] {
        let (path, frame) = (self.path, self.view.frame);
        let rays_per_row = (path.rows - 1) as f32 / (path.profile_rows - 1) as f32;
        let at = row as f32 * rays_per_row;
        let nearest = ((at + 0.5) as u32).min(path.rows - 1);
        let later = at - nearest as f32;
        let none = Vec4::from(self.lamps[0]).truncate();
        let lit = self.streak_light_lit();
        let lost = self.view.drops_capture_texel(frame.capture_last, 0, 0) + self.streak_light_even(lit);
        let view = streak_light_view(self.drop, row as f32 / (path.profile_rows - 1) as f32);
        let mut made = [[[0.0; 4]; SUMS]; FINE];
        let mut sums = [Vec3::ZERO; FINE];
        let fine = path.fine as usize;
        let per_part = path.columns / STREAK_SUMS;
        let shifts = frame.form == DROPS_SHIFT;
        for tap in 0..path.columns {
            let low = streak_cell_position(tap as f32, path.columns);
            let high = streak_cell_position((tap + 1) as f32, path.columns);
            let weight = 0.5 * (high - low);
            let number = ((row * path.columns + column) * path.columns + tap) as f32;
            let shift =
                (Vec3::new(STREAK_SPOT_FIRST, STREAK_SPOT_SECOND, STREAK_SPOT_THIRD) * number).fract();
            let nodes = [nearest, column, tap].map(|n| n as i32);
            let cell = StreakCell { column, tap, columns: path.columns, fine: path.fine };
            let mut even = none + self.streak_light_facing(lit, view, nodes);
            let mut seen = Vec3::ZERO;
            let mut rest = 1.0f32;
            for exit in 0..=STREAK_EXITS as usize {
                let here = self.streak_light_exit(nodes, exit);
                if here.passed == 0 {
                    continue;
                }
                let ray = self.streak_light_patch(nodes, exit, here);
                let fraction = (ray.middle.fraction + ray.later.fraction * later).clamp(0.0, 1.0);
                rest -= fraction;
                // The papers' form has what comes through, undimmed, and nothing else.
                let shown = match (shifts, exit) {
                    (true, 1) => 1.0,
                    (true, _) => 0.0,
                    (false, _) => fraction,
                };
                let size = streak_light_size(&ray, later);
                let width = (size.x * size.y).sqrt().max(STREAK_NARROWEST * size.x.max(size.y));
                let direction = streak_light_direction(&ray, Vec3::new(0.0, 0.0, later));
                seen += self.view.drops_capture_about(self.drop.towards.into(), direction, width) * shown;
                let all = size.x + size.y + ray.later.first.dot(ray.later.first).sqrt() * rays_per_row;
                let spot = streak_light_radius(size);
                for (lamp, towards) in self.lamps(lit).filter(|(lamp, _)| lamp.w > 0.0) {
                    let near = (lamp.w + 0.5 * spot).max(spot) + STREAK_SPOT_REACH * all;
                    let apart = direction - towards;
                    if apart.dot(apart) > near * near {
                        continue;
                    }
                    let time = [later, rays_per_row];
                    let spots = streak_light_spot(&ray, time, [all, spot], towards, lamp.w, cell, shift);
                    for (sum, spot) in sums.iter_mut().zip(spots) {
                        *sum += lamp.truncate() * spot;
                    }
                }
            }
            // Between rows fractions may sum to a little more than all.
            let whole = if shifts { 1.0 } else { (1.0 - rest).max(1.0) };
            even += seen / whole + lost * if shifts { 0.0 } else { rest.max(0.0) };
            for sum in &mut sums[..fine] {
                *sum += even * weight;
            }
            if (tap + 1).is_multiple_of(per_part) {
                let sum = ((tap + 1) / per_part - 1) as usize;
                for (made, light) in made[..fine].iter_mut().zip(sums) {
                    made[sum] = light.extend(0.0).to_array();
                }
            }
        }
        made
    }
}

/// The exits of a streak's rays.
fn unpacked(rays: &[StreakRay]) -> Vec<[StreakExit; 4]> {
    let exit = |ray: &StreakRay, number: usize| {
        let passed = (ray.interfaces >> (8 * number)) & 0xff;
        if passed == 0 {
            return StreakExit::default();
        }
        let direction = packing_octahedral_decode(packing_unpack_snorm(ray.exits[number])).into();
        let fraction = packing_unpack_unorm(ray.fractions[number >> 1])[number & 1];
        StreakExit { direction, fraction, passed }
    };
    rays.iter().map(|ray| std::array::from_fn(|number| exit(ray, number))).collect()
}

/// Lights all profiles, in parallel; the same bits for any number of threads. `lamps` are [`LIGHT_ROWS`] for each path.
pub(super) fn light(
    view: DropsView<'_>,
    paths: &[StreakPath],
    drops: &[ScreenDrop],
    rays: &[StreakRay],
    lamps: &[[f32; 4]],
    table: &mut [[f32; 4]],
) {
    for (path, lamps) in paths.iter().zip(lamps.chunks_exact(LIGHT_ROWS)) {
        let count = path.rows * path.columns * path.columns;
        let exits = unpacked(&rays[path.first_ray as usize..(path.first_ray + count) as usize]);
        let drop = &drops[path.drop as usize];
        let streak = Streak { view, path, drop, exits: &exits, lamps };
        let first = (path.first_entry + 1 + path.rows * path.columns) as usize;
        let per_column = path.fine as usize * SUMS;
        let count = (path.profile_rows * path.columns) as usize * per_column;
        let (columns, fine) = (path.columns, path.fine as usize);
        table[first..first + count].par_chunks_mut(per_column).enumerate().for_each(|(unit, entries)| {
            let unit = unit as u32;
            let made = streak.streak_light_column(unit / columns, unit % columns);
            entries.copy_from_slice(made[..fine].as_flattened());
        });
    }
}

//! Drops as refractive particles that face the camera, and their streaks. Twin of `shaders/wgsl/render/drops.wgsl`, where the
//! method is described.

use downpour_math::ops;
use downpour_math::packing::packing_unpack_half;
use downpour_shaders::render::drop_light::DROP_ATLAS_ROWS;
use downpour_shaders::render::medium::{MEDIUM_SKY, MEDIUM_SKY_REACH};
use downpour_shaders::render::rain::{
    DROPS_ATLAS_TAPS, DROPS_BENT, DROPS_FAR, DROPS_LOOP, DROPS_MAX_BENT, DROPS_OPAQUE, DROPS_SMALL_GRID,
    DROPS_STILL, DROPS_TABLE, DROPS_TILE, PROJECT_DIAMETERS, STREAK_FINE, STREAK_GOLDEN, STREAK_LATTICE,
    STREAK_WHITE,
};
use glam::{Vec2, Vec3, Vec4};
use rayon::prelude::*;

use super::drops_atlas::{DropsAtlas, DropsAtlasStreak, drops_atlas_streak};
use super::drops_frame::DropsView;
use super::drops_mask::drops_mask_unit;
use super::drops_medium::drops_medium;
use super::drops_shade::DropsShade;
use super::environment::EnvironmentMap;
use super::glint::{drop_glint_right, drop_glint_rousseau};
use super::medium::MediumFrame;
use super::medium::fog::medium_fog_depth;
use super::streak::{
    ScreenDrop, StreakChord, streak_chord, streak_cover, streak_depth, streak_mask_position, streak_nearest,
    streak_time, streak_weight,
};
use super::streak_lookup::StreakTable;
use super::tiles::TileLists;
use super::{DropMasks, Rain, StreakProfiles, StreakRay, streak_light, streak_rays};
use crate::camera::Camera;

/// Position of a ray on the plane at distance 1 through a drop's center.
#[must_use]
pub fn drops_on_plane(towards: Vec3, ray: Vec3) -> Vec3 {
    ray / ray.dot(towards).max(1.0e-6) - towards
}

/// The fraction of a step by which the samples of a line of pixels are shifted: unshifted, all lines of a plumb streak would meet
/// the thin image of a lamp in it, or miss it, alike.
#[must_use]
pub fn drops_shift(line: u32) -> f32 {
    (line.wrapping_mul(STREAK_GOLDEN) & 0xffff) as f32 / 65_536.0
}

/// The phase of the mode (2,0), in turns, where a passing drop is at a fraction of its way.
#[must_use]
pub fn drops_turns(drop: &ScreenDrop, way: f32) -> f32 {
    drop.mode_phase[2] + drop.cycles[0] * streak_time(drop.depth_ratio, way)
}

/// True for a splash, whose masks are behind those of the diameters.
#[must_use]
pub fn drops_is_splash(drop: &ScreenDrop) -> bool {
    drop.mask_index[0] >= PROJECT_DIAMETERS as f32
}

/// Position on the plane at distance 1 through a drop's center, along the right and up of its view, of a place on the picture.
pub(super) fn drops_position(camera: &Camera, drop: &ScreenDrop, x: f32, y: f32) -> Vec2 {
    let towards = Vec3::from(drop.towards);
    let right = drop_glint_right(towards);
    let lean = drops_on_plane(towards, camera.camera_ray(x, y));
    Vec2::new(lean.dot(right), lean.dot(right.cross(towards)))
}

/// The depth of a drop before a pixel, m.
pub(super) fn drops_depth(camera: &Camera, drop: &ScreenDrop, x: u32, y: u32) -> f32 {
    let way = streak_nearest(drop, drops_position(camera, drop, x as f32 + 0.5, y as f32 + 0.5));
    drop.distance * streak_depth(drop.depth_ratio, streak_time(drop.depth_ratio, way))
}

/// The light of a drop over a pixel (radiance times coverage, and coverage) with another visibility, at least 0: it takes out that
/// multiple of the light behind it, at most all of it, and gives the same multiple of its own.
#[must_use]
pub fn drops_visible(shown: Vec4, visibility: f32) -> Vec4 {
    shown * visibility.min(1.0 / shown.w.max(1.0e-6))
}

/// The part of a drop at a depth that is before a scene, 0 to 1: one that meets a surface goes into it over its own size; a splash
/// stands on one, which hides it only from behind.
pub(super) fn drops_before(drop: &ScreenDrop, scene: f32, depth: f32) -> f32 {
    let sunk = (scene - depth) / (2.0 * drop.slope * drop.distance);
    (sunk + if drops_is_splash(drop) { 1.5 } else { 0.5 }).clamp(0.0, 1.0)
}

/// The light of lamps on a part of a splash, over that of a sphere: what is bent as little as by a sheet of water stays where it is.
#[must_use]
pub fn drops_bent(direction: Vec3) -> f32 {
    let square = direction.x * direction.x + direction.y * direction.y;
    (square * DROPS_BENT).min(DROPS_MAX_BENT)
}

/// The tile of the lists that has a block of 8 by 8 pixels of a picture so wide, where tiles are so wide.
#[must_use]
pub fn drops_tile(block: [u32; 2], edge: u32, width: u32) -> u32 {
    let [column, row] = block.map(|place| place * DROPS_TILE / edge);
    row * width.div_ceil(edge) + column
}

/// What streaks show together that were summed up: radiance times coverage, and coverage.
#[must_use]
pub fn drops_sums_shown(sums: [u32; 4]) -> Vec4 {
    let [_, low, high, cover] = sums;
    let green = (low >> 21) | ((high & 0x3ff) << 11);
    let [red, green, blue] = [low & 0x1f_ffff, green, high >> 10].map(|color| f32::from_bits(color << 10));
    Vec4::new(red, green, blue, (cover & 0xffff) as f32 / 65_535.0)
}

/// How far away they are on the mean, m.
#[must_use]
pub fn drops_sums_distance(sums: [u32; 4]) -> f32 {
    f32::from_bits(sums[3] & 0xffff_0000)
}

/// What is before a pixel besides drops of its list.
struct DropsAir<'a> {
    frame: &'a MediumFrame,
    /// The pixel's ray.
    direction: Vec3,
    /// The part of it in which drops are drawn.
    span: Vec3,
    /// Distance of the scene, m.
    scene: f32,
    /// Where the medium ends before it, m.
    end: f32,
    /// Optical depth of the medium.
    depth: f32,
    /// Its factor.
    thinned: f32,
    /// What drops of the medium show.
    medium: Vec3,
    /// What fog shows.
    fog: Vec3,
    /// Light of lamps on the medium.
    lamps: Vec3,
    /// Its mean distance, m.
    lamps_at: f32,
    /// Streaks that were summed up: radiance times coverage, coverage.
    streaks: Vec4,
    /// Their mean distance, m.
    streaks_at: f32,
}

/// What is seen of a pixel from the eye to some distance.
#[derive(Clone, Copy)]
struct DropsSeen {
    radiance: Vec3,
    /// What drops let through.
    transmittance: f32,
    /// What the medium lets through.
    left: f32,
    /// What fog lets through.
    clear: f32,
    /// True if the light of lamps on the medium is in it.
    has_lamps: bool,
    /// True if the streaks that were summed up are.
    has_streaks: bool,
}

/// Goes on to a drop at a distance, with the medium and the fog before it.
fn drops_behind(seen: &mut DropsSeen, air: &DropsAir<'_>, shown: Vec4, distance: f32) {
    let at = distance.min(air.end);
    if !seen.has_lamps && at > air.lamps_at {
        seen.radiance += air.lamps * seen.transmittance;
        seen.has_lamps = true;
    }
    let here = ops::exp(-air.frame.medium_depth(at, air.span, 1.0) * air.thinned).min(seen.left);
    let through = air.frame.medium_fog(air.direction, at);
    // What a part of the way takes out, left * clear - here * through, is shared by medium and fog.
    let between = air.medium * ((seen.left - here) * (0.5 * (seen.clear + through)));
    let fog = air.fog * ((seen.clear - through) * (0.5 * (seen.left + here)));
    seen.radiance += seen.transmittance * (between + fog + shown.truncate() * (here * through));
    seen.clear = through;
    seen.transmittance *= 1.0 - shown.w;
    seen.left = here;
}

/// Goes on to the streaks that were summed up, if they are nearer than a distance.
fn drops_behind_streaks(seen: &mut DropsSeen, air: &DropsAir<'_>, distance: f32) {
    if !seen.has_streaks && air.streaks.max_element() > 0.0 && air.streaks_at < distance {
        drops_behind(seen, air, air.streaks, air.streaks_at);
        seen.has_streaks = true;
    }
}

/// The rain over a pixel: radiance, and the transmittance of the scene behind it, by what is seen up to the last drop.
fn drops_whole(mut seen: DropsSeen, air: &DropsAir<'_>) -> Vec4 {
    drops_behind_streaks(&mut seen, air, DROPS_FAR);
    let DropsSeen { mut radiance, transmittance, left, clear, has_lamps, .. } = seen;
    if !has_lamps {
        radiance += air.lamps * transmittance;
    }
    let last = ops::exp(-air.depth).min(left);
    let whole = air.frame.medium_fog(air.direction, air.scene);
    radiance += air.medium * (transmittance * (left - last) * (0.5 * (clear + whole)));
    radiance += air.fog * (transmittance * (clear - whole) * (0.5 * (left + last)));
    radiance.extend(transmittance * last * whole)
}

/// Data that the kernels read.
pub(super) struct Buffers<'a> {
    pub(super) view: DropsView<'a>,
    pub(super) rain: &'a Rain,
    table: &'a StreakTable,
    light: &'a [[f32; 4]],
    pub(super) clean: &'a [[f32; 4]],
    medium: &'a [[f32; 4]],
}

impl Buffers<'_> {
    /// A drop's numbers of light.
    pub(super) fn drops_glint_row(&self, index: u32) -> &[[f32; 4]] {
        let stride = 1 + self.view.frame.glints as usize;
        let first = index as usize * stride;
        self.light.get(first..first + stride).unwrap_or(&[[0.0; 4]])
    }

    /// Light of lamps in the form of Rousseau 2006 at a position of a drop's mask, by the normal there, which halves the angle
    /// between the eye and what is mirrored: what it is more than the mean over the drop.
    fn drops_facing(&self, index: u32, drop: &ScreenDrop, x: f32, y: f32) -> Vec3 {
        let row = self.drops_glint_row(index);
        let mut light = Vec3::ZERO;
        // An atlas has streaks, other forms have glints.
        if self.view.frame.atlas > 0 || row.len() < 3 || row[1][3] >= 0.0 {
            return light;
        }
        let towards = Vec3::from(drop.towards);
        let right = drop_glint_right(towards);
        let up = right.cross(towards);
        let turned = drops_mask_unit(self.view.drops_mask_at(drop.mask_index, x, y).reflected + Vec3::Z);
        let normal = right * turned.x + up * turned.y - towards * turned.z;
        let (lamps, _) = row[1..].as_chunks::<2>();
        for [lamp, way] in lamps.iter().filter(|[lamp, _]| lamp[3] < 0.0) {
            let shown = drop_glint_rousseau(
                normal,
                -towards,
                Vec4::from(*way).truncate(),
                self.view.frame.light_terms,
            );
            light += Vec4::from(*lamp).truncate() * (shown.max(0.0) + 1.0 + lamp[3]);
        }
        light
    }

    /// The streaks of a drop's row of light: their colors, and where they are in the atlas.
    fn streaks(&self, index: u32) -> impl Iterator<Item = (Vec3, DropsAtlasStreak)> {
        let (streaks, _) = self.drops_glint_row(index)[1..].as_chunks::<{ DROP_ATLAS_ROWS as usize }>();
        streaks.iter().filter(|[first, ..]| first[3] != 0.0).map(|rows| {
            let [first, second, third] = rows.map(Vec4::from);
            (first.truncate(), drops_atlas_streak(first, second, third))
        })
    }

    fn atlas(&self) -> DropsAtlas<'_> {
        DropsAtlas { masks: self.view.masks, first: self.view.frame.atlas }
    }

    /// Light of lamps on a passing drop by the streaks of an atlas, for as long as it passes a position on the plane.
    fn drops_streaks(&self, index: u32, drop: &ScreenDrop, chord: &StreakChord, at: Vec2) -> Vec3 {
        let row = self.drops_glint_row(index);
        let part = (chord.high - chord.low) * 0.5;
        let turns = drops_turns(drop, streak_nearest(drop, at));
        let mut light = Vec4::from(row[0]).truncate() * chord.fraction;
        for (color, streak) in self.streaks(index) {
            let shown = self.atlas().drops_atlas_across(&streak, -chord.aside, turns);
            light += color * (shown * 2.0 * chord.pace - chord.fraction);
        }
        light.max(Vec3::ZERO) * part
    }

    /// Light of lamps on a drop that is not sampled, as a radiance over all of it: with an atlas bright and dark along its
    /// path.
    fn drops_beads(&self, index: u32, drop: &ScreenDrop, x: u32, y: u32) -> Vec3 {
        let mut light = Vec4::from(self.drops_glint_row(index)[0]).truncate();
        if self.view.frame.atlas == 0 || drop.spread > 1.0 {
            return light;
        }
        let way = Vec2::from(drop.screen_delta);
        let square = way.dot(way).max(1.0);
        let at = (Vec2::new(x as f32, y as f32) + 0.5 - Vec2::from(drop.first)).dot(way) / square;
        let pixel = 1.0 / square.sqrt();
        for (color, streak) in self.streaks(index) {
            let mut mean = 0.0;
            for n in 0..DROPS_ATLAS_TAPS {
                let off = (n as f32 + 0.5) / DROPS_ATLAS_TAPS as f32 - 0.5;
                let turns = drops_turns(drop, (at + off * pixel).clamp(0.0, 1.0));
                mean += self.atlas().drops_atlas_along(&streak, turns);
            }
            light += color * (mean / DROPS_ATLAS_TAPS as f32 - 1.0);
        }
        light.max(Vec3::ZERO)
    }

    /// A still drop over a pixel: radiance times coverage, and coverage. Below a pixel it is its mean radiance.
    fn drops_still(&self, index: u32, drop: &ScreenDrop, x: u32, y: u32) -> Vec4 {
        let small = drop.grid == 0;
        let spread = streak_cover(drop, x, y);
        if small && spread <= 0.0 {
            return Vec4::ZERO;
        }
        let towards = Vec3::from(drop.towards);
        let mut right = drop_glint_right(towards);
        if drops_is_splash(drop) {
            right = right * drop.cycles[0] - right.cross(towards) * drop.cycles[1];
        }
        let up = right.cross(towards);
        let n = if small { DROPS_SMALL_GRID } else { drop.grid };
        let extent = drop.half_extent * drop.slope;
        let spacing = if small {
            2.0 * drop.half_extent / n as f32
        } else {
            self.view.frame.camera.pixel_angle / (drop.slope * n as f32)
        };
        let mut sum = Vec4::ZERO;
        for k in 0..n * n {
            let dx = ((k % n) as f32 + 0.5) / n as f32;
            let dy = ((k / n) as f32 + 0.5) / n as f32;
            let (mut sx, mut sy, mut lean) = (2.0 * dx - 1.0, 2.0 * dy - 1.0, Vec3::ZERO);
            if !small {
                lean =
                    drops_on_plane(towards, self.view.frame.camera.camera_ray(x as f32 + dx, y as f32 + dy));
                sx = lean.dot(right) / extent;
                sy = lean.dot(up) / extent;
            }
            if sx.abs() < 1.0 && sy.abs() < 1.0 {
                let shade = DropsShade {
                    towards,
                    half_extent: drop.half_extent,
                    right,
                    lean,
                    spacing,
                    mask_index: drop.mask_index,
                };
                let texel = self.view.drops_mask_at(drop.mask_index, sx, sy);
                let mut shown = self.view.drops_shade_texel(&shade, &texel, sx, sy);
                if !small {
                    let light = if drops_is_splash(drop) {
                        // Lamps shine on its rims as on so many small drops: no glint has its place on it.
                        let bends = drops_bent(texel.direction);
                        Vec4::from(self.drops_glint_row(index)[0]).truncate() * bends
                    } else {
                        self.view.drops_glint_rest(self.drops_glint_row(index))
                            + self.drops_facing(index, drop, sx, sy)
                    };
                    shown += (light * shown.w).extend(0.0);
                }
                sum += shown;
            }
        }
        if small {
            let light = Vec4::from(self.drops_glint_row(index)[0]).truncate();
            return (sum.truncate() / sum.w.max(1.0e-20) + light).extend(1.0) * spread;
        }
        sum /= (n * n) as f32;
        if !drops_is_splash(drop) {
            sum += self.view.drops_glint_light(self.drops_glint_row(index), drop, x, y).extend(0.0);
        }
        sum
    }

    /// The part of a chord that passes during the exposure, by the weighted mean over its middle points.
    fn drops_chord(&self, index: u32, drop: &ScreenDrop, chord: &StreakChord, ray: Vec3) -> Vec4 {
        let frame = self.view.frame;
        let shade = DropsShade {
            towards: drops_mask_unit(ray),
            half_extent: drop.half_extent,
            right: drop_glint_right(drops_mask_unit(ray)),
            lean: Vec3::ZERO,
            spacing: 2.0 * drop.oval[0] / STREAK_FINE as f32,
            mask_index: drop.mask_index,
        };
        let mut sum = Vec4::ZERO;
        for k in 0..frame.streak_samples {
            let part = (k as f32 + 0.5) / frame.streak_samples as f32;
            let at = streak_mask_position(drop, chord, chord.low + (chord.high - chord.low) * part);
            if at.x.abs() < 1.0 && at.y.abs() < 1.0 {
                let shown = self.view.drops_shade_ray(&shade, at.x, at.y);
                let light = shown + (self.drops_facing(index, drop, at.x, at.y) * shown.w).extend(0.0);
                sum += light * streak_weight(chord.weights.to_array(), part);
            }
        }
        (sum.truncate() / sum.w.max(1.0e-20)).extend(1.0) * ((chord.high - chord.low) * 0.5)
    }

    /// The streak of a drop that is not sampled over a pixel: radiance times coverage, and coverage.
    pub(super) fn drops_thin(&self, index: u32, drop: &ScreenDrop, x: u32, y: u32) -> Vec4 {
        let cover = streak_cover(drop, x, y);
        if cover <= 0.0 {
            return Vec4::ZERO;
        }
        let size = Vec2::new(self.view.frame.camera.width as f32, self.view.frame.camera.height as f32);
        let position = Vec2::new(x as f32 + 0.5, y as f32 + 0.5) / size;
        let light = self.drops_beads(index, drop, x, y);
        (self.table.streak_lookup_mean(drop.shape, position) + light).extend(1.0) * cover
    }

    /// The streak of a drop that is sampled over a pixel.
    pub(super) fn drops_wide(&self, index: u32, drop: &ScreenDrop, x: u32, y: u32) -> Vec4 {
        let towards = Vec3::from(drop.towards);
        let right = drop_glint_right(towards);
        let up = right.cross(towards);
        let shift = Vec2::new(drops_shift(y), drops_shift(x));
        let mut sum = Vec4::ZERO;
        for k in 0..drop.grid {
            // A lattice whose points differ in every direction.
            let turned = (k * STREAK_LATTICE) % drop.grid;
            let at = Vec2::new(x as f32, y as f32)
                + (Vec2::new(k as f32, turned as f32) + shift) / drop.grid as f32;
            let ray = self.view.frame.camera.camera_ray(at.x, at.y);
            let lean = drops_on_plane(towards, ray);
            let position = Vec2::new(lean.dot(right), lean.dot(up));
            let by_profile = drop.kind == DROPS_TABLE;
            if by_profile {
                sum += self.table.streak_lookup_shown(drop, position);
            }
            if by_profile && self.view.frame.atlas == 0 {
                continue;
            }
            let chord = streak_chord(drop, position);
            if chord.high <= chord.low {
                continue;
            }
            if !by_profile && self.view.frame.streak_color == STREAK_WHITE {
                sum.w += 0.5 * (chord.high - chord.low) * chord.fraction;
            } else if !by_profile {
                sum += self.drops_chord(index, drop, &chord, ray) * chord.fraction;
            }
            let lines = if self.view.frame.atlas > 0 {
                self.drops_streaks(index, drop, &chord, position)
            } else {
                let rest = self.view.drops_glint_rest(self.drops_glint_row(index));
                rest * (chord.fraction * (chord.high - chord.low) * 0.5)
            };
            sum += lines.extend(0.0);
        }
        sum /= drop.grid as f32;
        sum /= sum.w.max(1.0);
        if drop.kind == DROPS_LOOP {
            sum += self.view.drops_glint_light(self.drops_glint_row(index), drop, x, y).extend(0.0);
        }
        sum
    }

    /// What a drop over a pixel shows before a scene that is `scene` meters away.
    pub(super) fn drops_shown(&self, drop: &ScreenDrop, light: Vec4, x: u32, y: u32, scene: f32) -> Vec4 {
        let mut shown = light;
        if shown.max_element() <= 0.0 {
            return Vec4::ZERO;
        }
        if self.view.frame.streak_color == STREAK_WHITE {
            let white = self.view.drops_capture_texel(self.view.frame.capture_last, 0, 0);
            shown = (white * shown.w).extend(shown.w);
        }
        let seen = shown * drops_before(drop, scene, drops_depth(&self.view.frame.camera, drop, x, y));
        drops_visible(seen, self.view.frame.visibility)
    }

    /// A drop over a pixel whose scene is `scene` meters away: radiance times coverage, and coverage.
    fn drops_pixel(&self, index: u32, x: u32, y: u32, scene: f32) -> Vec4 {
        let drop = &self.rain.list[index as usize];
        let shown = if drop.kind == DROPS_STILL {
            self.drops_still(index, drop, x, y)
        } else if drop.grid == 0 {
            self.drops_thin(index, drop, x, y)
        } else {
            self.drops_wide(index, drop, x, y)
        };
        self.drops_shown(drop, shown, x, y, scene)
    }

    /// Mean radiance that fog scatters into a ray: the capture about the ray, over the solid angle of an even cone whose mean cosine
    /// is the asymmetry of the phase function.
    fn drops_fog(&self, direction: Vec3) -> Vec3 {
        let medium = &self.rain.medium;
        self.view.drops_capture_about(direction, direction, medium.fog_phase[0]) * medium.fog[3]
    }

    /// What is before a pixel besides drops of its list.
    fn drops_air(&self, x: u32, y: u32, sums: [u32; 4]) -> DropsAir<'_> {
        let (frame, medium) = (self.view.frame, &self.rain.medium);
        let index = (y * frame.camera.width + x) as usize;
        let scene = f32::from_bits(sums[0]);
        let lamps = self.medium.get(index).copied().map_or(Vec4::ZERO, Vec4::from);
        // Mean distance of the medium's light of lamps, and its optical depth.
        let [mean, mut depth] = packing_unpack_half(lamps.w.to_bits());
        let mut lamps = lamps.truncate();
        let direction = drops_mask_unit(self.view.frame.camera.camera_ray(x as f32 + 0.5, y as f32 + 0.5));
        let span = medium.medium_span(direction);
        let end = if scene >= MEDIUM_SKY { MEDIUM_SKY_REACH } else { scene };
        // More or fewer drops than are to be expected.
        if depth > 0.0 {
            let drops = medium.medium_streaks_at(direction, span, end, mean, frame.camera.pixel_angle);
            let mut rainy = 1.0;
            if medium.fog[0] > 0.0 {
                rainy = depth / (depth + medium_fog_depth(medium.fog.into(), direction.y, mean));
            }
            lamps *= 1.0 + (drops.y - 1.0) * rainy;
            depth *= drops.x;
        }
        DropsAir {
            frame: medium,
            direction,
            span,
            scene,
            end,
            depth,
            // Air that rain does not reach thins the medium; evenly, as far as drops between it go.
            thinned: depth / medium.medium_depth(end, span, 1.0).max(1.0e-12),
            medium: if depth > 0.0 { drops_medium(&self.view, self.table, medium, x, y) } else { Vec3::ZERO },
            fog: if medium.fog[0] > 0.0 { self.drops_fog(direction) } else { Vec3::ZERO },
            lamps,
            lamps_at: mean,
            streaks: drops_sums_shown(sums),
            streaks_at: drops_sums_distance(sums),
        }
    }

    /// The rain over a pixel with a list of drops in order of their nearest points, with the medium and the fog between them.
    fn drops_over(&self, x: u32, y: u32, list: &[u32], sums: [u32; 4]) -> Vec4 {
        let air = self.drops_air(x, y, sums);
        let mut seen = DropsSeen {
            radiance: Vec3::ZERO,
            transmittance: 1.0,
            left: 1.0,
            clear: 1.0,
            has_lamps: false,
            has_streaks: false,
        };
        for &index in list {
            let drop = &self.rain.list[index as usize];
            if drop.nearest >= air.scene || seen.transmittance < DROPS_OPAQUE {
                break;
            }
            let shown = self.drops_pixel(index, x, y, air.scene);
            if shown.max_element() <= 0.0 {
                continue;
            }
            drops_behind_streaks(&mut seen, &air, drop.distance);
            drops_behind(&mut seen, &air, shown, drop.distance);
        }
        drops_whole(seen, &air)
    }
}

impl Rain {
    /// The streak radiance table of the picture. `lamps` is what lamps add to the streaks that have profiles
    /// ([`Rain::streak_lights`]).
    #[must_use]
    pub fn streak_table(
        &self,
        masks: &DropMasks,
        environment: &EnvironmentMap,
        lamps: &[[f32; 4]],
    ) -> StreakTable {
        let view = DropsView { frame: &self.frame, masks: &masks.words, capture: &environment.texels };
        let StreakProfiles { classes, paths, ray_jobs, rays, entries: count, .. } = &self.profiles;
        let mut entries = view.streak_means(classes);
        entries.resize(*count as usize, [0.0; 4]);
        let mut traced = vec![StreakRay::default(); *rays as usize];
        streak_rays::trace(paths, &self.list, ray_jobs, &mut entries, &mut traced);
        streak_light::light(view, paths, &self.list, &traced, lamps, &mut entries);
        StreakTable { entries }
    }

    /// What streaks show of each pixel that are summed up, in the shader's layout; arguments as of [`Rain::layer`].
    #[must_use]
    pub fn sums(
        &self,
        clean: &[[f32; 4]],
        masks: &DropMasks,
        environment: &EnvironmentMap,
        table: &StreakTable,
        light: &[[f32; 4]],
    ) -> Vec<[u32; 4]> {
        let view = DropsView { frame: &self.frame, masks: &masks.words, capture: &environment.texels };
        Buffers { view, rain: self, table, light, clean, medium: &[] }.sums()
    }

    /// The rain over a scene: radiance, and the transmittance of the scene behind it; rows from the top. `clean` is the
    /// scene's picture with its distances, `light` what lamps add to each drop of the list
    /// ([`DropLights::light`](super::light::DropLights::light); nothing where it is empty), `medium` the drops that are not
    /// drawn ([`MediumLight::layer`](super::medium::MediumLight::layer); none where it is empty).
    #[must_use]
    pub fn layer(
        &self,
        clean: &[[f32; 4]],
        masks: &DropMasks,
        environment: &EnvironmentMap,
        table: &StreakTable,
        light: &[[f32; 4]],
        medium: &[[f32; 4]],
    ) -> Vec<[f32; 4]> {
        let view = DropsView { frame: &self.frame, masks: &masks.words, capture: &environment.texels };
        let tiles = TileLists::new(&self.list, self.frame.camera.size());
        let buffers = Buffers { view, rain: self, table, light, clean, medium };
        let sums = buffers.sums();
        let (width, buffers, tiles, sums) = (self.frame.camera.width, &buffers, &tiles, sums.as_slice());
        let pixel =
            |x, y| buffers.drops_over(x, y, tiles.of_pixel(x, y), sums[(y * width + x) as usize]).to_array();
        (0..self.frame.camera.height)
            .into_par_iter()
            .flat_map_iter(|y| (0..width).map(move |x| pixel(x, y)))
            .collect()
    }
}

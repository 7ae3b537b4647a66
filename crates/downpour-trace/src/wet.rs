//! Surfaces that rain has made wet. Twin of `shaders/wgsl/render/wet.wgsl`.
//!
//! 1. How wet a surface is: the law of [`downpour_drop::wetness`] for the flux of rain that it meets, which is
//!    `n . d / d.y` of that of a level one, with its normal `n` and the direction `d` that the rain comes from: a wall meets rain
//!    in a wind only. One ray against the mean fall asks whether the rain is kept off; under a roof all is dry. The ray strays with the
//!    position by up to [`WET_SPREAD`], so that the edge is uneven and soft, as drops of many sizes and small gusts make it.
//! 2. Pores fill first ([`WET_PORES`]), then a film covers more and more of the surface, from its hollows to its grains' tops.
//! 3. A porous surface whose pores are full is darker: light is thrown back at the water's surface to what it came from
//!    (J. Lekner and M. Dorf, Applied Optics 27, 1988; [`puddle_water_albedo`]). A smooth one is not: there the light is thrown back
//!    in any case, where its own medium ends.
//! 4. Under the film the base lies behind an interface of water: what the coat reflects, in the mean over its microfacets, is taken
//!    from what goes in and from what comes out, over the mean of both, so that white stays white. The coat is in the place of
//!    the surface's own gloss, of which 0.3 % are left under water, and reflects as Fresnel's law has it of water. A metal keeps its
//!    lobe.
//! 5. The film follows the grains: noise of 3, 10 and 31 mm tilts it and makes it patchy. What a footprint does not resolve of the
//!    slopes makes the coat rougher (M. Olano and D. Baker, LEAN Mapping, 2010), so that nothing flickers far away; so does what it does not
//!    resolve of the surface's own relief.
//!
//! What lets light through stays as it is; drops on it are of [`glazing`](crate::glazing). Light that has been thrown back twice finds dry
//! surfaces.

use std::sync::{Mutex, OnceLock, PoisonError};

use downpour_drop::fall_speed::terminal_speed;
use downpour_math::ops;
use downpour_math::rng::{rng_pcg4d, rng_unit};
use downpour_shaders::bvh::BVH_FAR;
use downpour_shaders::render::brdf::BRDF_GRAZING;
use downpour_shaders::render::glazing::GLAZING_ROWS;
use downpour_shaders::render::puddle_water::PUDDLE_WATER_NORMAL;
use downpour_shaders::render::scene::{SCENE_BLENDED, SCENE_LIGHT_ROWS, SCENE_UNLIT};
use downpour_shaders::render::wet::{
    WET_COARSER, WET_COAT_COSINES, WET_COAT_ROWS, WET_COAT_STEPS, WET_DIELECTRIC, WET_DIMENSION, WET_EDGE,
    WET_FINE, WET_GRAINS, WET_HEAD_ROWS, WET_METAL, WET_MIN, WET_OCTAVES, WET_PATCH, WET_PORES,
    WET_POROUS_ALPHA, WET_SMOOTH_ALPHA, WET_SMOOTH_STORAGE, WET_SPREAD, WET_SQUARE, WET_STEEP,
};
use downpour_weather::{Rain, Weather, WetnessAt};
use glam::{DVec3, IVec3, Vec2, Vec3, Vec4};

use crate::brdf::{brdf_masking, brdf_rise, brdf_visibility, brdf_visible_normal};
use crate::data::SceneData;
use crate::scatter::scatter_alpha;
use crate::scene::SceneView;
use crate::scene::water::{puddle_water_albedo, puddle_water_reflectance};
use crate::surface::Surface;

/// Positions are shifted by a whole number of meters below this, so that the relief keeps its precision.
const SHIFT_M: f64 = 512.0;

/// Rays per direction for the coat's reflectance, along both of their numbers.
const COAT_RAYS: u16 = 48;

/// Rows of a table that differ from time to time: those at [`SceneData::wetness`] that say how wet.
pub(crate) const WET_ROWS_THAT_CHANGE: usize = 1;

/// Wetness of the surfaces of a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SceneWetness {
    /// Wetness.
    pub at: WetnessAt,
    /// Direction that the rain comes from; its height is above 0.
    pub towards: Vec3,
    /// Added to positions of the scene where the relief is looked up, m.
    pub shift: Vec3,
}

impl SceneWetness {
    /// The wetness of a weather at a time in s, for buffers relative to `origin`. `None`: all is dry.
    #[must_use]
    pub fn of(weather: &Weather, time_s: f64, origin: DVec3) -> Option<Self> {
        Self::of_falling(weather, time_s, origin, &KnownFall::default())
    }

    /// The same where the fall speed of the rain may be known.
    pub(crate) fn of_falling(
        weather: &Weather,
        time_s: f64,
        origin: DVec3,
        known: &KnownFall,
    ) -> Option<Self> {
        let at = weather.wetness_at(time_s)?;
        // The wind that the rain has come with: that of time 0, without gusts.
        let velocity = weather.wind.air().mean(0.0) - DVec3::Y * known.speed(&weather.heaviest_rain());
        let towards = (-velocity).normalize_or(DVec3::Y).as_vec3();
        let shift = origin.map(|x| x.rem_euclid(SHIFT_M)).as_vec3();
        Some(Self { at, towards, shift })
    }
}

/// Fall speed, m/s, of the rain that was asked for last: it is an integral over all sizes.
#[derive(Debug, Default)]
pub(crate) struct KnownFall(Mutex<Option<(Rain, f64)>>);

impl KnownFall {
    /// That of a rain.
    fn speed(&self, rain: &Rain) -> f64 {
        let mut last = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        match &*last {
            Some((known, speed)) if known == rain => *speed,
            _ => last.insert((*rain, fall_speed(rain))).1,
        }
    }
}

/// Fall speed of the drop of the median volume, m/s.
fn fall_speed(rain: &Rain) -> f64 {
    let falling = Rain { rate_mm_h: rain.rate_mm_h.max(1.0), ..*rain };
    let speed = falling
        .sizes()
        .and_then(|law| terminal_speed(rain.fall_speed, law.median_volume_diameter(), &rain.air));
    // Of a drop of 1.5 mm.
    speed.unwrap_or(5.4).max(0.1)
}

/// Wetness of a scene as the shaders read it. Twin of the WGSL struct of the same name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RenderWet {
    /// Rain before a pause, in storages.
    pub before: f32,
    /// Fraction of the wetness that is kept after the pause.
    pub kept: f32,
    /// Rain after it, in storages.
    pub since: f32,
    /// Direction that the rain comes from.
    pub towards: Vec3,
    /// Added to positions, m.
    pub shift: Vec3,
}

/// Unevenness of a film.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WetRelief {
    /// Gradient of the height.
    pub slope: Vec3,
    /// Height, about -1 to 1.
    pub height: f32,
    /// Variance of the slope that a footprint does not resolve.
    pub variance: f32,
}

/// Wetness of a surface that meets a flux of rain, relative to that of a level one.
#[must_use]
pub fn wet_fraction(before: f32, kept: f32, since: f32, flux: f32) -> f32 {
    let paused = (1.0 - ops::exp(-before * flux)) * kept;
    1.0 - (1.0 - paused) * ops::exp(-since * flux)
}

/// A corner of the lattice of the noise, -1 to 1.
#[must_use]
pub fn wet_corner(cell: [i32; 3], seed: u32) -> f32 {
    let [x, y, z] = cell.map(|k| k as u32);
    rng_unit(rng_pcg4d([x, y, z, seed])[0]) * 2.0 - 1.0
}

/// Noise from -1 to 1 with its gradient (x, y, z; then the value), at a position in cells.
#[must_use]
pub fn wet_noise(at: Vec3, seed: u32) -> Vec4 {
    let low = at.floor();
    let cell = low.as_ivec3();
    let f = at - low;
    let u = f * f * (Vec3::splat(3.0) - f * 2.0);
    let rise = f * (Vec3::ONE - f) * 6.0;
    let mut sum = Vec4::ZERO;
    for k in 0..8 {
        let bits = [k & 1, (k >> 1) & 1, k >> 2];
        let weight = Vec3::from_array([0, 1, 2].map(|i| if bits[i] == 1 { u[i] } else { 1.0 - u[i] }));
        let change = Vec3::from_array([0, 1, 2].map(|i| if bits[i] == 1 { rise[i] } else { -rise[i] }));
        let value = wet_corner(cell.wrapping_add(IVec3::from(bits)).to_array(), seed);
        sum += Vec4::new(
            change.x * weight.y * weight.z,
            weight.x * change.y * weight.z,
            weight.x * weight.y * change.z,
            weight.x * weight.y * weight.z,
        ) * value;
    }
    sum
}

/// Relief of a film at a position, as a footprint (m) shows it.
#[must_use]
pub fn wet_relief(position: Vec3, footprint: f32) -> WetRelief {
    let mut relief = WetRelief { slope: Vec3::ZERO, height: 0.0, variance: 0.0 };
    let mut cell = WET_FINE;
    for k in 0..WET_OCTAVES {
        let seen = (2.0 - 2.0 * footprint / cell).clamp(0.0, 1.0);
        if seen > 0.0 {
            let noise = wet_noise(position / cell, WET_DIMENSION + k);
            relief.slope += noise.truncate() * (WET_STEEP * seen);
            relief.height += noise.w * (0.6 * seen);
        }
        relief.variance += (1.0 - seen * seen) * (WET_STEEP * WET_STEEP * WET_SQUARE);
        cell *= WET_COARSER;
    }
    relief
}

/// Direction that the rain comes from at a position: it strays from place to place, so that the edge of what is wet is uneven.
#[must_use]
pub fn wet_arrival(towards: Vec3, position: Vec3) -> Vec3 {
    let at = position / WET_EDGE;
    let x = wet_noise(at, WET_DIMENSION + WET_OCTAVES).w;
    let z = wet_noise(at, WET_DIMENSION + WET_OCTAVES + 1).w;
    let along = towards / towards.y.max(0.05) + Vec3::new(x, 0.0, z) * WET_SPREAD;
    along / along.dot(along).sqrt()
}

/// Reflectance at normal incidence of a surface under a film of water: of both interfaces.
#[must_use]
pub fn wet_reflectance(in_air: Vec3) -> Vec3 {
    let below = puddle_water_reflectance(in_air);
    let through = 1.0 - PUDDLE_WATER_NORMAL;
    Vec3::splat(PUDDLE_WATER_NORMAL) + below * (through * through) / (Vec3::ONE - below * PUDDLE_WATER_NORMAL)
}

/// A surface as it looks when it is wet, seen along a direction.
pub(crate) fn wet_surface(dry: &Surface, wetness: f32, along: Vec3, relief: &WetRelief) -> Surface {
    let pores = WET_PORES * dry.porosity;
    let soaked = dry.porosity * (wetness / WET_PORES).min(1.0);
    let filled = ((wetness - pores) / (1.0 - pores)).clamp(0.0, 1.0);
    let level = filled * (1.0 - WET_GRAINS * dry.porosity);
    let patchy = dry.porosity * WET_PATCH * (4.0 * filled).min(1.0);
    let film = (level - relief.height * patchy).clamp(0.0, 1.0);
    let reflectance = wet_reflectance(dry.normal_reflectance);
    // Of a narrow lobe and a wide one the narrow one is seen. A metal shines as it is through the film.
    let strongest = dry.normal_reflectance.max_element();
    let bare = (1.0 - film) * (1.0 - film) * (1.0 - film);
    let coated =
        (1.0 - bare) * (1.0 - ((strongest - WET_DIELECTRIC) / (WET_METAL - WET_DIELECTRIC)).clamp(0.0, 1.0));
    let smooth_alpha = WET_SMOOTH_ALPHA + (WET_POROUS_ALPHA - WET_SMOOTH_ALPHA) * dry.porosity;
    let coat = (smooth_alpha * smooth_alpha + relief.variance * dry.porosity + dry.variance).sqrt();
    let alpha = dry.roughness * dry.roughness;
    // The film's own relief, along the surface.
    let across = relief.slope - dry.normal * relief.slope.dot(dry.normal);
    let mut normal = dry.normal - across * (film * dry.porosity);
    normal /= normal.dot(normal).sqrt();
    let away = normal.dot(along);
    if away > -0.01 {
        normal -= along * (away + 0.01);
        normal /= normal.dot(normal).sqrt();
    }
    Surface {
        diffuse: dry.diffuse + (puddle_water_albedo(dry.diffuse) - dry.diffuse) * soaked,
        normal_reflectance: dry.normal_reflectance + (reflectance - dry.normal_reflectance) * film,
        roughness: (alpha + (coat.min(alpha) - alpha) * coated).sqrt(),
        film: 1.0 - bare,
        normal,
        ..*dry
    }
}

impl SceneData {
    /// Sets how wet the surfaces are; `None`: dry. What comes after it in the table - rain on panes, puddles, a pane before the camera -
    /// is removed unless the scene was wet before and still is.
    pub fn set_wetness(&mut self, wetness: Option<&SceneWetness>) {
        let first = (self.lights + self.light_count * SCENE_LIGHT_ROWS) as usize;
        if (wetness.is_some()) != (self.wetness > 0) {
            self.cut_table(first);
        }
        let Some(wetness) = wetness else { return };
        let words = |v: Vec4| v.to_array().map(f32::to_bits);
        let WetnessAt { before, kept, since } = wetness.at;
        let head = [
            words(Vec4::new(before as f32, kept as f32, since as f32, 0.0)),
            words(wetness.towards.extend(0.0)),
            words(wetness.shift.extend(0.0)),
        ];
        if self.wetness > 0 {
            self.table[first..first + head.len()].copy_from_slice(&head);
            return;
        }
        self.wetness = first as u32;
        self.table.extend(head);
        self.table.extend(coat_rows());
    }

    /// Sets rows of the rain on panes of the scene, which is wet; none: they are dry. Puddles and a pane before the camera are removed
    /// unless there were as many rows before.
    #[doc(hidden)]
    pub fn set_glazing(&mut self, rows: &[[u32; 4]]) {
        if self.wetness == 0 {
            return;
        }
        let first = (self.wetness + WET_HEAD_ROWS) as usize + coat_rows().len();
        let known = self.glazing_rows().len();
        if known != rows.len() {
            self.cut_table(first);
            self.glazing = if rows.is_empty() { 0 } else { first as u32 };
            self.table.extend(rows);
        } else if self.glazing > 0 {
            self.table[first..first + known].copy_from_slice(rows);
        }
    }

    /// Rows of the rain on panes of the scene.
    pub(crate) fn glazing_rows(&self) -> &[[u32; 4]] {
        let first = self.glazing as usize;
        if first == 0 {
            return &[];
        }
        let count = self.table[first + 1][0] * GLAZING_ROWS + 2;
        &self.table[first..first + count as usize]
    }

    /// Reads the wetness.
    pub(crate) fn wet_load(&self) -> RenderWet {
        let first = self.wetness as usize;
        let numbers = |k: usize| Vec4::from(self.table[first + k].map(f32::from_bits));
        let state = numbers(0);
        RenderWet {
            before: state.x,
            kept: state.y,
            since: state.z,
            towards: numbers(1).truncate(),
            shift: numbers(2).truncate(),
        }
    }

    /// Two parts of the reflectance of microfacets: the factor of that at normal incidence, and the rest.
    fn wet_parts(&self, row: u32, index: u32) -> Vec2 {
        let [a, b, c, d] = self.table[(row + index / 2) as usize].map(f32::from_bits);
        if index % 2 == 1 { Vec2::new(c, d) } else { Vec2::new(a, b) }
    }

    /// The same between the cosines of the table.
    fn wet_coat_at(&self, row: u32, cosine: f32) -> Vec2 {
        let u = cosine.clamp(0.0, 1.0).sqrt() * (WET_COAT_COSINES - 1) as f32;
        let low = (u as u32).min(WET_COAT_COSINES - 2);
        let part = u - low as f32;
        self.wet_parts(row, low) * (1.0 - part) + self.wet_parts(row, low + 1) * part
    }

    /// Fraction of an even environment that microfacets reflect toward a cosine, or that of light from all directions
    /// (`of_mean`).
    pub(crate) fn wet_coat(
        &self,
        normal_reflectance: Vec3,
        roughness: f32,
        cosine: f32,
        of_mean: bool,
    ) -> Vec3 {
        let x = roughness.clamp(0.0, 1.0) * WET_COAT_STEPS as f32;
        let low = (x as u32).min(WET_COAT_STEPS - 1);
        let part = x - low as f32;
        let first = self.wetness + WET_HEAD_ROWS + low * WET_COAT_ROWS;
        let (lower, upper) = if of_mean {
            (self.wet_parts(first + WET_COAT_ROWS - 1, 0), self.wet_parts(first + 2 * WET_COAT_ROWS - 1, 0))
        } else {
            (self.wet_coat_at(first, cosine), self.wet_coat_at(first + WET_COAT_ROWS, cosine))
        };
        let parts = lower * (1.0 - part) + upper * part;
        normal_reflectance * parts.x + Vec3::splat(parts.y)
    }

    /// Factor of the light that comes out of a surface with a film toward a cosine, per what goes in.
    pub(crate) fn wet_out(&self, surface: &Surface, cosine: f32) -> Vec3 {
        let reflected = self.wet_coat(surface.normal_reflectance, surface.roughness, cosine, false);
        let mean = self.wet_coat(surface.normal_reflectance, surface.roughness, 0.0, true);
        (Vec3::ONE - reflected) / (Vec3::ONE - mean).max(Vec3::splat(1.0e-3))
    }

    /// Fraction of light from a cosine that goes into a surface with a film.
    pub(crate) fn wet_in(&self, surface: &Surface, cosine: f32) -> Vec3 {
        Vec3::ONE - self.wet_coat(surface.normal_reflectance, surface.roughness, cosine, false)
    }
}

impl SceneView<'_> {
    /// Wetness of a surface: 0 where no rain reaches it.
    pub(crate) fn wet_exposure(&self, surface: &Surface, wet: &RenderWet) -> f32 {
        let flux = surface.facet.dot(wet.towards) / wet.towards.y.max(0.05);
        if surface.flags & (SCENE_BLENDED | SCENE_UNLIT) != 0 || surface.transmission > 0.0 || flux <= 0.0 {
            return 0.0;
        }
        let storage = WET_SMOOTH_STORAGE + (1.0 - WET_SMOOTH_STORAGE) * surface.porosity;
        let wetness = wet_fraction(wet.before, wet.kept, wet.since, flux / storage);
        if wetness < WET_MIN {
            return 0.0;
        }
        let nearest = self.frame.nearest;
        let start = surface.position + surface.facet * nearest;
        let along = wet_arrival(wet.towards, surface.position + wet.shift);
        if self.data.surface_blocker(start, along, nearest, BVH_FAR).is_some() { 0.0 } else { wetness }
    }
}

/// Rows of the coat's reflectance: per roughness those of the cosines, two in a row, then the mean.
fn coat_rows() -> &'static [[u32; 4]] {
    static ROWS: OnceLock<Vec<[u32; 4]>> = OnceLock::new();
    ROWS.get_or_init(|| (0..=WET_COAT_STEPS as u16).flat_map(coat_of).collect())
}

/// Rows of a roughness, in steps.
fn coat_of(step: u16) -> Vec<[u32; 4]> {
    let roughness = f32::from(step) / WET_COAT_STEPS as f32;
    let last = WET_COAT_COSINES as u16 - 1;
    let parts: Vec<Vec2> = (0..=last)
        .map(|k| {
            let u = f32::from(k) / f32::from(last);
            coat_parts(scatter_alpha(roughness), (u * u).max(BRDF_GRAZING))
        })
        .collect();
    // The mean over the hemisphere is the integral of 4 u^3 over u, the root of the cosine, of what is linear in u.
    let (mut mean, fine) = (Vec2::ZERO, 16);
    for k in 0..last * fine {
        let u = (f32::from(k) + 0.5) / f32::from(fine);
        let low = (u as usize).min(usize::from(last) - 1);
        let at = parts[low].lerp(parts[low + 1], u - low as f32);
        let x = u / f32::from(last);
        mean += at * (4.0 * x * x * x / (f32::from(fine) * f32::from(last)));
    }
    let words = |a: Vec2, b: Vec2| [a.x, a.y, b.x, b.y].map(f32::to_bits);
    let mut rows: Vec<_> = parts.chunks(2).map(|pair| words(pair[0], pair[1])).collect();
    rows.push(words(mean, Vec2::ZERO));
    rows
}

/// Parts of the reflectance of an even environment under a film: by the normals that a viewer sees, as rays are drawn.
fn coat_parts(alpha: f32, cosine: f32) -> Vec2 {
    let view = Vec3::new((1.0 - cosine * cosine).max(0.0).sqrt(), 0.0, cosine);
    let mut sum = Vec2::ZERO;
    for i in 0..COAT_RAYS {
        for j in 0..COAT_RAYS {
            let number = |k: u16| (f32::from(k) + 0.5) / f32::from(COAT_RAYS);
            let half = brdf_visible_normal(view, alpha, number(i), number(j));
            let along = half * (2.0 * view.dot(half)) - view;
            if along.z <= 0.0 {
                continue;
            }
            let seen = brdf_visibility(alpha, cosine, along.z) * along.z * 4.0 * cosine
                / brdf_masking(alpha, cosine).max(1.0e-6);
            let rise = brdf_rise(1.0, view.dot(half));
            sum += Vec2::new(1.0 - rise, rise) * seen;
        }
    }
    sum / (f32::from(COAT_RAYS) * f32::from(COAT_RAYS))
}

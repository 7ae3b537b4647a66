//! The pane of a weather, from picture to picture.

use std::f64::consts::PI;
use std::sync::OnceLock;

use downpour_drop::optics::water_index_in_air;
use downpour_lattice::glass::{GlassOptions, GlassState};
use downpour_math::ops::f64 as ops;
use downpour_shaders::render::glass::{
    GLASS_PICTURE_BLADES, GLASS_PICTURE_EXACT, GLASS_PICTURE_GLASS, GLASS_PICTURE_SCENE,
    GLASS_PICTURE_TATARCHUK,
};
use downpour_weather::{Pane, PaneFocus, PaneFresnel, PaneShadow, Weather};
use glam::DVec3;

use super::blade::GlassPictureBlade;
use super::drops::{Binned, binned};
use super::error::PaneError;
use super::frame::{GlassPicture, GlassPictureFrame, levels, samples};
use super::lattice::PaneLattice;
use super::light::{GlassPictureLight, sources};
use super::shade::{PaneShade, PaneShadows};
use crate::camera::{Camera, PictureEdge, Viewpoint};
use crate::plate::Lighting;
use crate::rain::PanePlane;

/// Largest width and height of a pane whose size is that of the picture, m.
const MAX_SIZE_M: f64 = 2.4;

/// Ratio of the size of such a pane to that of the picture.
const MARGIN: f64 = 1.04;

/// Air and rain on the pane follow their keys at times this far apart, s.
const WEATHER_S: f64 = 0.1;

/// Water where its index is not known.
const WATER_INDEX: f64 = 1.333;

/// The line of sodium, m.
const SODIUM_M: f64 = 589.3e-9;

/// A pane of glass in front of the camera, with the rain on it.
#[derive(Debug)]
pub struct WetPane {
    pane: Pane,
    /// The weather it is in.
    weather: Weather,
    /// Rain rate, mm/h, and speed of the air, m/s, that the lattice has.
    met: [f64; 2],
    /// View direction of the first picture, and its time, s.
    forward: DVec3,
    first_s: f64,
    size: [f64; 2],
    begin_s: f64,
    water: f64,
    /// Rows of the lattice above what is seen of it.
    above: u32,
    lattice: PaneLattice,
    /// The water on it, until it is stepped.
    state: OnceLock<GlassState>,
}

impl WetPane {
    /// Creates the dry pane of a weather, if it has one; `first_s` is the time of the first picture, before which it has
    /// rained for as long as the weather says.
    ///
    /// # Errors
    /// [`PaneError`] if the pane cannot be what is asked for, or the camera does not look through it.
    pub fn new(weather: &Weather, viewpoint: &Viewpoint, first_s: f64) -> Result<Option<Self>, PaneError> {
        Self::with(weather, viewpoint, first_s, &|options| Ok(PaneLattice::on_cpu(options)?))
    }

    /// The same with its lattice on a GPU.
    ///
    /// # Errors
    /// As [`WetPane::new`], or what the GPU says.
    #[cfg(feature = "wgpu")]
    pub fn on_gpu(
        gpu: &downpour_gpu::Gpu,
        weather: &Weather,
        viewpoint: &Viewpoint,
        first_s: f64,
    ) -> Result<Option<Self>, PaneError> {
        Self::with(weather, viewpoint, first_s, &|options| PaneLattice::on_gpu(gpu, options))
    }

    fn with(
        weather: &Weather,
        viewpoint: &Viewpoint,
        first_s: f64,
        lattice: &dyn Fn(&GlassOptions) -> Result<PaneLattice, PaneError>,
    ) -> Result<Option<Self>, PaneError> {
        let Some(pane) = &weather.glass else { return Ok(None) };
        let position = PanePosition::new(pane, viewpoint)?;
        let size = pane.size.unwrap_or_else(|| position.shown(viewpoint, weather.size));
        let begin_s = first_s - pane.before;
        let mut lattice = lattice(&pane.options(size, &weather.heaviest_rain(), begin_s))?;
        let forward = viewpoint.forward.as_dvec3();
        let speed = weather.pane_speed(begin_s, first_s, forward);
        let rain = weather.rain_at(begin_s);
        let met = [rain.rate_mm_h, speed];
        let (rain, air) = pane.weather(&rain, speed);
        lattice.set_weather(&rain, &air)?;
        let water = water_index_in_air(SODIUM_M, &weather.rain.air).unwrap_or(WATER_INDEX);
        let above = pane.rows_above(size);
        let (pane, weather, state) = (pane.clone(), weather.clone(), OnceLock::new());
        Ok(Some(Self { pane, weather, met, forward, first_s, size, begin_s, water, above, lattice, state }))
    }

    /// Steps rain and wipers to a time in seconds. The drops do not depend on how the time is divided.
    ///
    /// # Errors
    /// As [`PaneLattice::step`].
    pub fn advance(&mut self, time_s: f64) -> Result<(), PaneError> {
        let tick = self.lattice.tick_s();
        let until = ((time_s - self.begin_s) / tick + 1.0e-6).floor().max(0.0) as u64;
        let every = (WEATHER_S / tick).ceil().max(1.0) as u64;
        while self.lattice.ticks() < until {
            self.state = OnceLock::new();
            let done = self.lattice.ticks();
            if done.is_multiple_of(every) {
                self.meet(self.begin_s + done as f64 * tick)?;
            }
            let count = (every - done % every).min(until - done);
            self.lattice.step(count as f64 * tick)?;
        }
        Ok(())
    }

    /// Sets rain and air of a time in seconds, if they are others: their tables take a while.
    fn meet(&mut self, time_s: f64) -> Result<(), PaneError> {
        let rain = self.weather.rain_at(time_s);
        let speed = self.weather.pane_speed(time_s, self.first_s, self.forward);
        let met = [rain.rate_mm_h, speed];
        if met != self.met {
            let (rain, air) = self.pane.weather(&rain, speed);
            self.lattice.set_weather(&rain, &air)?;
            self.met = met;
        }
        Ok(())
    }

    /// Time that rain and wipers have been stepped to, s.
    #[must_use]
    pub fn time_s(&self) -> f64 {
        self.begin_s + self.lattice.ticks() as f64 * self.lattice.tick_s()
    }

    /// Lattice of the drops on it.
    #[must_use]
    pub fn lattice(&self) -> &PaneLattice {
        &self.lattice
    }

    /// The water on the pane now.
    ///
    /// # Errors
    /// As [`PaneLattice::state`].
    pub fn state(&self) -> Result<&GlassState, PaneError> {
        if let Some(state) = self.state.get() {
            return Ok(state);
        }
        let state = self.lattice.state()?;
        Ok(self.state.get_or_init(|| state))
    }

    /// Width and height of the pane, m.
    #[must_use]
    pub fn size_m(&self) -> [f64; 2] {
        self.size
    }

    /// Corner (upper left), right, down and outward of the pane before an eye: positions relative to the same origin as the
    /// eye, meters, and unit vectors.
    ///
    /// # Errors
    /// [`PaneError::EdgeOn`] if the eye looks along the pane, or what is wrong with the eye.
    pub fn axes(&self, viewpoint: &Viewpoint) -> Result<[DVec3; 4], PaneError> {
        let position = PanePosition::new(&self.pane, viewpoint)?;
        let corner = position.corner(self.size) + DVec3::from(viewpoint.eye);
        Ok([corner, position.across, position.down, position.outward])
    }

    /// True if drops on the pane cast shadows in the light of lamps behind it.
    #[must_use]
    pub fn has_shadows(&self) -> bool {
        self.pane.shadows != PaneShadow::None
    }

    /// Returns the shadows of the drops now on the pane; `None` if shadows are off.
    ///
    /// # Errors
    /// [`PaneError::Glass`] if the drops are more than bins can hold; what the GPU says.
    pub fn shade(&self) -> Result<Option<PaneShade>, PaneError> {
        let form = match self.pane.shadows {
            PaneShadow::Lens => PaneShadows::Lens,
            PaneShadow::Tatarchuk2006 => PaneShadows::Tatarchuk2006,
            PaneShadow::None => return Ok(None),
        };
        let drops = self.binned()?.drops;
        Ok(Some(PaneShade::new(self.size, &drops, form, self.highlight_radius(), self.water as f32)))
    }

    fn binned(&self) -> Result<Binned, PaneError> {
        Ok(binned(self.lattice.options(), self.state()?, self.above)?)
    }

    /// Radius, m, of the disks of drops from which on they are bright.
    fn highlight_radius(&self) -> f32 {
        let diameter = self.pane.highlight;
        self.lattice.options().contact.radius(PI / 6.0 * diameter * diameter * diameter) as f32
    }

    /// The wipers that are drawn, and their number.
    fn blades(&self, shutter_s: f64) -> ([GlassPictureBlade; GLASS_PICTURE_BLADES as usize], u32) {
        let options = self.lattice.options();
        let above = f64::from(self.above) * options.cell_m;
        let time_s = self.lattice.ticks() as f64 * self.lattice.tick_s();
        let mut blades = [GlassPictureBlade::default(); GLASS_PICTURE_BLADES as usize];
        let drawn = options.wipers.iter().zip(&self.pane.wipers_drawn).filter(|(_, is_drawn)| **is_drawn);
        let mut count = 0;
        for (blade, (wiper, _)) in blades.iter_mut().zip(drawn) {
            *blade = GlassPictureBlade::new(wiper, time_s, shutter_s, above);
            count += 1;
        }
        (blades, count)
    }

    /// Returns the pane in its present state, in front of a picture of `grid` samples along an edge of a pixel.
    /// `environment_texels` is the number of texels of the environment map, all levels. Blades of wipers move for `shutter_s` seconds,
    /// half of them before the time of the pane.
    ///
    /// # Errors
    /// As [`WetPane::new`].
    pub fn picture(
        &self,
        viewpoint: &Viewpoint,
        camera: &Camera,
        grid: u32,
        lighting: &dyn Lighting,
        environment_texels: usize,
        shutter_s: f64,
    ) -> Result<GlassPicture, PaneError> {
        let position = PanePosition::new(&self.pane, viewpoint)?;
        let binned = self.binned()?;
        let [width, height] = self.size;
        let corner = position.corner(self.size);
        let options = self.lattice.options();
        let vector = |v: DVec3| v.as_vec3().to_array();
        let (levels, last) = levels(camera.size());
        // (4 n^2 - 1) / 3 texels in all levels of n x n.
        let capture_size = ((environment_texels as f64 * 0.75).sqrt().round() as u32).max(1);
        let lens = (0.5 * self.pane.aperture) as f32;
        let lens_points = samples(grid, lens);
        let [columns, rows] = options.size;
        let hidden = (columns * self.above) as usize;
        let state = self.state()?;
        let visible = state.traversal.iter().zip(&state.tails).skip(hidden);
        let heights: Vec<u32> = visible.map(|(&wet, &tail)| film_units(self.pane.film, wet, tail)).collect();
        let (blades, blade_count) = self.blades(shutter_s);
        let lights = sources(lighting, camera.eye);
        Ok(GlassPicture {
            frame: GlassPictureFrame {
                camera: *camera,
                across: vector(position.across),
                columns: binned.columns,
                down: vector(position.down),
                rows: binned.rows,
                outward: vector(position.outward),
                bins: binned.per_meter as f32,
                corner: vector(corner),
                cells: (1.0 / options.cell_m) as f32,
                size: [width as f32, height as f32],
                wet_size: [columns, rows - self.above],
                lens,
                focus: match self.pane.focus {
                    PaneFocus::Scene => GLASS_PICTURE_SCENE,
                    PaneFocus::Glass => GLASS_PICTURE_GLASS,
                },
                fresnel: match self.pane.fresnel {
                    PaneFresnel::Exact => GLASS_PICTURE_EXACT,
                    PaneFresnel::Tatarchuk2006 => GLASS_PICTURE_TATARCHUK,
                },
                room: self.pane.interior_ambient as f32,
                samples: lens_points.len() as u32,
                last,
                capture_size,
                capture_last: capture_size.ilog2(),
                capture_texel: ((4.0 * PI).sqrt() / f64::from(capture_size)) as f32,
                film: if self.pane.film > 0.0 { MAX_FILM_M } else { 0.0 },
                water: self.water as f32,
                first_row: 0,
                lights: lights.len() as u32,
                lit_from: self.highlight_radius(),
                blade_count,
                unread: 0,
                levels,
                blades,
            },
            // A buffer has at least one element.
            drops: if binned.drops.is_empty() { vec![Default::default()] } else { binned.drops },
            bins: binned.bins,
            wet: heights.chunks(2).map(|pair| pair[0] | (pair.get(1).unwrap_or(&0) << 16)).collect(),
            lens: lens_points,
            lights: if lights.is_empty() { vec![GlassPictureLight::default()] } else { lights },
        })
    }
}

/// Largest height of the film and the tails of drops, m.
const MAX_FILM_M: f32 = (u16::MAX as f64 / GlassState::TAIL_UNITS_PER_M) as f32;

/// Height of the film of a cell in the units of tails: that of its wetness, of `film_m` at most, and the tail of a drop.
fn film_units(film_m: f64, wet: u8, tail: u16) -> u32 {
    let film = (film_m * GlassState::TAIL_UNITS_PER_M * f64::from(wet) / 255.0).round() as u32;
    film.saturating_add(u32::from(tail)).min(65535)
}

/// Returns the plane of a weather's pane in front of an eye, if there is one.
///
/// # Errors
/// [`PaneError::EdgeOn`] if the eye looks along it, or what is wrong with the eye.
pub fn pane_plane(weather: &Weather, viewpoint: &Viewpoint) -> Result<Option<PanePlane>, PaneError> {
    let Some(pane) = &weather.glass else { return Ok(None) };
    let position = PanePosition::new(pane, viewpoint)?;
    let distance = position.middle.dot(position.outward) as f32;
    Ok(Some(PanePlane { outward: position.outward.as_vec3(), distance }))
}

/// Position and axes of a pane, relative to the eye.
struct PanePosition {
    across: DVec3,
    down: DVec3,
    outward: DVec3,
    middle: DVec3,
}

impl PanePosition {
    fn new(pane: &Pane, viewpoint: &Viewpoint) -> Result<Self, PaneError> {
        let [right, _, forward] = viewpoint.axes()?.map(DVec3::from);
        // A pane stands upright however the camera is turned about its own axis.
        let level = DVec3::Y.cross(right);
        let across = DVec3::new(right.x, 0.0, right.z).try_normalize().unwrap_or(DVec3::X);
        let ahead = DVec3::Y.cross(across);
        debug_assert!(ahead.dot(level) >= 0.0, "right stays right");
        let (sin, cos) = (ops::sin(pane.tilt), ops::cos(pane.tilt));
        let outward = ahead * sin + DVec3::Y * cos;
        let down = ahead * cos - DVec3::Y * sin;
        if forward.dot(outward) < ops::sin(2f64.to_radians()) {
            let pitch_deg = ops::asin(forward.y.clamp(-1.0, 1.0)).to_degrees();
            return Err(PaneError::EdgeOn { tilt_deg: pane.tilt.to_degrees(), pitch_deg });
        }
        Ok(Self { across, down, outward, middle: forward * pane.distance })
    }

    /// The upper left corner of a pane of a size.
    fn corner(&self, [width, height]: [f64; 2]) -> DVec3 {
        self.middle - self.across * (0.5 * width) - self.down * (0.5 * height)
    }

    /// Width and height of the pane that the picture shows, m.
    fn shown(&self, viewpoint: &Viewpoint, size: [u32; 2]) -> [f64; 2] {
        let mut half = [0.0f64; 2];
        let Ok(view) = PictureEdge::new(viewpoint, size) else { return [MAX_SIZE_M; 2] };
        for k in 0..4u32 {
            let sign = |bit: u32| if k & bit == 0 { -1.0 } else { 1.0 };
            let ray = view.forward
                + view.right * (view.half_width * sign(1))
                + view.up * (view.half_height * sign(2));
            let towards = ray.dot(self.outward);
            // A ray that misses the pane sees it up to its end.
            let far = self.middle.dot(self.outward) / towards.max(1.0e-3);
            let off = ray * far - self.middle;
            half[0] = half[0].max(off.dot(self.across).abs());
            half[1] = half[1].max(off.dot(self.down).abs());
        }
        half.map(|half| (2.0 * MARGIN * half).clamp(0.02, MAX_SIZE_M))
    }
}

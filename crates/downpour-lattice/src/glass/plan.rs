//! Options as integers, for both the CPU and the GPU version.

use downpour_math::in_range;
use std::f64::consts::PI;

use downpour_drop::air::STANDARD_GRAVITY;
use downpour_drop::water;
use downpour_math::ops::f64 as ops;
use downpour_math::rng::seed_words;
use downpour_shaders::lattice::glass::{GLASS_CELL, GLASS_CLASSES, GLASS_LANDING_QUADS, GLASS_MAX_MASS};

use super::blade::GlassBlade;
use super::error::GlassError;
use super::frame::GlassFrame;
use super::lattice::UNIT_M3;
use super::options::{GlassAir, GlassOptions, GlassRain};
use super::rain::{BLOCK, Landing, MAX_PER_BLOCK};
use super::size::{GlassSizeRow, GlassTable, glass_size_floor};
use super::tail::TailLaw;
use super::wiper::GlassWiper;

/// Clock ticks per second.
const CLOCK_HZ: f64 = 4096.0;

/// Units of mass of a cell up to which it stands for the droplets of a film.
const FILM_UNITS: u32 = 2;

/// Time for which a ridge takes the drops that it touches after a blade has pushed it, s.
const FRESH_S: f64 = 0.15;

/// Maximum step, s.
const MAX_STEP_S: f64 = 60.0;

/// A pane as integers.
#[derive(Clone, Debug)]
pub(crate) struct Plan {
    options: GlassOptions,
    tick_s: f64,
    frame: GlassFrame,
    pub(crate) table: Box<GlassTable>,
    tail: TailLaw,
    done: u64,
    backlog_s: f64,
}

/// Ticks of a step.
#[derive(Clone, Debug)]
pub(crate) struct Ticks {
    /// Parameters common to all of them.
    pub(crate) frame: GlassFrame,
    /// Number of ticks.
    pub(crate) count: u32,
    /// Blade parts of each tick.
    pub(crate) blades: Vec<GlassBlade>,
}

impl Plan {
    pub(crate) fn new(options: &GlassOptions) -> Result<Self, GlassError> {
        options.check()?;
        let landing = Landing::new(options)?;
        let tick_s = tick(options, &landing);
        let table = table(options, &landing, tick_s)?;
        Ok(Self {
            frame: frame(options, &landing, tick_s)?,
            options: options.clone(),
            tick_s,
            table,
            tail: TailLaw::new(options, CLOCK_HZ)?,
            done: 0,
            backlog_s: 0.0,
        })
    }

    /// Sets rain and air from now on. The length of a tick stays.
    pub(crate) fn set_weather(&mut self, rain: &GlassRain, air: &GlassAir) -> Result<(), GlassError> {
        let options = GlassOptions { rain: *rain, air: *air, ..self.options.clone() };
        options.check()?;
        let landing = Landing::new(&options)?;
        let edge = BLOCK * options.cell_m;
        in_range(
            "rain on the pane",
            landing.number * edge * edge * self.tick_s,
            "drops in a block and tick",
            &(0.0..=1.001 * MAX_PER_BLOCK),
            1.0,
            "0 to 0.5: make the pane with its heaviest rain, which sets the tick",
        )?;
        self.table = table(&options, &landing, self.tick_s)?;
        let new = frame(&options, &landing, self.tick_s)?;
        let (first_step, first_clock) = (self.frame.first_step, self.frame.first_clock);
        self.frame = GlassFrame { first_step, first_clock, ..new };
        self.options = options;
        Ok(())
    }

    pub(crate) fn options(&self) -> &GlassOptions {
        &self.options
    }

    /// Tails of running drops, from the times when water last moved over the cells.
    pub(crate) fn tails(&self, clocks: &[u32]) -> Vec<u16> {
        self.tail.tails(self.options.size[0] as usize, clocks, self.frame.first_clock)
    }

    pub(crate) fn frame(&self) -> &GlassFrame {
        &self.frame
    }

    pub(crate) fn tick_s(&self) -> f64 {
        self.tick_s
    }

    pub(crate) fn done(&self) -> u64 {
        self.done
    }

    /// Whole ticks of a step of `dt_s`; the remainder counts for the next step.
    pub(crate) fn ticks(&mut self, dt_s: f64) -> Result<Ticks, GlassError> {
        in_range("step", dt_s, "s", &(f64::MIN_POSITIVE..=MAX_STEP_S), 1.0, "above 0 to 60")?;
        let whole = (self.backlog_s + dt_s) / self.tick_s;
        // Steps that are whole multiples of a tick must not lose one to rounding.
        let count = (whole + 1.0e-6).floor();
        let clock = (self.done as f64 + count) * f64::from(self.frame.clock_step);
        in_range(
            "time of the pane",
            clock / CLOCK_HZ,
            "s",
            &(0.0..=f64::from(u32::MAX) / CLOCK_HZ),
            1.0,
            "up to 12 days",
        )?;
        self.backlog_s = self.backlog_s + dt_s - count * self.tick_s;
        let count = count as u32;
        let frame = self.frame;
        let mut blades = Vec::with_capacity(frame.blades as usize * count as usize);
        for tick in self.done..self.done + u64::from(count) {
            let time = |tick: u64| tick as f64 * self.tick_s;
            for wiper in &self.options.wipers {
                wiper.blades(time(tick), time(tick + 1), self.options.cell_m, &mut blades);
            }
        }
        self.done += u64::from(count);
        self.frame.first_step += count;
        self.frame.first_clock += count * frame.clock_step;
        Ok(Ticks { frame, count, blades })
    }
}

/// Longest tick in which no drop moves further than a cell, gravity adds less than half of that, no block gets more
/// drops than are counted and no blade passes more than eight cells.
fn tick(options: &GlassOptions, landing: &Landing) -> f64 {
    let cell = options.cell_m;
    let fall = (0.48 * cell / STANDARD_GRAVITY).sqrt();
    let edge = BLOCK * cell;
    let rain = MAX_PER_BLOCK / (landing.number * edge * edge);
    let wiper = |w: &GlassWiper| 8.0 * cell / (w.max_speed() * w.outer_m);
    let limits = [cell / options.speed_limit_m_s, fall, rain];
    limits.into_iter().chain(options.wipers.iter().map(wiper)).fold(f64::INFINITY, f64::min)
}

fn frame(options: &GlassOptions, landing: &Landing, tick_s: f64) -> Result<GlassFrame, GlassError> {
    let velocity = options.cell_m / tick_s / f64::from(GLASS_CELL);
    let gravity = STANDARD_GRAVITY * ops::sin(options.tilt_rad) * tick_s / velocity;
    let unit = |c: f64| (c * f64::from(GLASS_CELL)).round() as i32;
    let chance = (options.cell_m / options.trail.spacing_m).min(1.0);
    let bead = PI / 6.0 * options.trail.bead_m * options.trail.bead_m * options.trail.bead_m / UNIT_M3;
    let sixteenths = |x: f64| (x * 16.0).round() as u32;
    let [a, b, c, d, e, f, g, h] = landing.limits(options.cell_m, tick_s);
    let direction = options.air.direction_rad;
    let (density, sigma, mu) = water_at(options.temperature_c)?;
    let weight = density * STANDARD_GRAVITY * ops::sin(options.tilt_rad);
    // A ridge with a unit of mass in each cell of its length.
    let (area, cell) = (UNIT_M3 / options.cell_m, options.cell_m);
    let drain = options.contact.ridge_speed(area, weight, mu) * tick_s / cell;
    // Furmidge's retention of a length of the ridge, whose contact lines are as long as that.
    let sags = options.contact.hold(0.5 * cell, sigma) / weight.max(1.0e-9) / UNIT_M3;
    Ok(GlassFrame {
        size: options.size,
        seed: seed_words(options.seed),
        first_step: 0,
        first_clock: 1,
        clock_step: (tick_s * CLOCK_HZ).round().max(1.0) as u32,
        blades: options.wipers.iter().map(GlassWiper::parts).sum::<usize>() as u32,
        gravity: [0, gravity.round() as i32],
        air: [unit(ops::cos(direction)), unit(-ops::sin(direction))],
        kinetic: (256.0 * options.contact.kinetic).round() as u32,
        trail_chance: (chance * 4_294_967_295.0) as u32,
        trail_mass: bead.round() as u32,
        wet_life: (options.wetting.life_s * CLOCK_HZ / 64.0).round().max(1.0) as u32,
        wet_ease: (256.0 * options.wetting.ease).round() as u32,
        affinity_pull: sixteenths(options.affinity_pull),
        wet_pull: sixteenths(options.wetting.pull),
        ridge_drain: (drain * 262_144.0).round().min(8191.0) as u32,
        ridge_hold: sags.min(f64::from(GLASS_MAX_MASS)) as u32,
        ridge_fresh: (FRESH_S / tick_s).ceil().clamp(1.0, 65535.0) as u32,
        unused_1: 0,
        unused_2: 0,
        rain_few: [a, b, c, d],
        rain_many: [e, f, g, h],
    })
}

/// Density, surface tension and viscosity of water at a temperature, SI.
pub(super) fn water_at(celsius: f64) -> Result<(f64, f64, f64), GlassError> {
    Ok((water::density(celsius)?, water::surface_tension(celsius)?, water::viscosity(celsius)?))
}

fn table(options: &GlassOptions, landing: &Landing, tick_s: f64) -> Result<Box<GlassTable>, GlassError> {
    let contact = &options.contact;
    let (density, sigma, mu) = water_at(options.temperature_c)?;
    let velocity = options.cell_m / tick_s / f64::from(GLASS_CELL);
    let wind =
        0.5 * options.rain.air.density() * options.air.speed_m_s * options.air.speed_m_s * options.air.drag;
    let dries = options.evaporation_mm_h * 1.0e-3 / 3600.0 * tick_s / UNIT_M3;
    let fades = if options.wipers.is_empty() { 0.0 } else { 65536.0 * tick_s / options.wetting.film_life_s };
    let film = |class: u32| if class <= FILM_UNITS { fades * f64::from(class) } else { 0.0 };
    let row = |class: u32| {
        let volume = f64::from(glass_size_floor(class).max(1)) * UNIT_M3;
        let mass = volume * density;
        let radius = contact.radius(volume);
        let cells = |m: f64, most: f64| (256.0 * m / options.cell_m).round().min(most) as u32;
        let push = |force: f64, most: f64| (force / mass * tick_s / velocity).round().min(most) as u32;
        GlassSizeRow {
            // 32 cells: the maximum search distance of a drop.
            radius: cells(radius, 8192.0),
            hold: push(contact.hold(radius, sigma), 1_048_575.0),
            slow: (f64::from(GLASS_CELL) / (1.0 + contact.drag(radius, mu) / mass * tick_s)).round() as u32,
            air: push(wind * contact.frontal_area(radius), 16383.0),
            sphere: cells(contact.sphere(radius), 45_000.0).max(cells(radius, 8192.0)),
            loss: (dries * PI * radius * radius * 65536.0).max(film(class)).round().min(4_000_000.0) as u32,
            ridge: cells(contact.ridge(volume / options.cell_m), 8192.0),
            ahead: cells(GlassWiper::LIP_M + contact.ridge(volume / options.cell_m), 16383.0),
        }
    };
    let mut table = Box::new(GlassTable {
        rows: [[GlassSizeRow::default(); 13]; 10],
        landing: [[0; 4]; GLASS_LANDING_QUADS as usize],
    });
    for (class, entry) in (0..GLASS_CLASSES).zip(table.rows.as_flattened_mut()) {
        *entry = row(class);
    }
    for (entry, &mass) in table.landing.iter_mut().flatten().zip(&landing.masses) {
        *entry = mass;
    }
    Ok(table)
}

//! Points that drip in a steady wind, as a device gets them: rows in cells, of which only those before a picture need room in its list.

use downpour_shaders::sim::field::FIELD_ALWAYS;
use glam::{DVec3, Vec3};

use super::Drips;
use super::emitter::Emitter;
use super::row::{DripFrame, DripRow};
use crate::field::chain::FieldTime;
use crate::impacts::SplashOptions;
use crate::impacts::splashes::{MAX_CROWN_S, is_shown};
use crate::view::{View, within};

/// Edge of a cell, m.
const CELL_M: f64 = 4.0;

/// Upper bound of the speed of a falling drop, m/s.
const MAX_FALL_M_S: f64 = 12.0;

/// Rows of the points that drip.
#[derive(Clone, Debug)]
pub(crate) struct DripTable {
    /// Origin of the rows, m.
    origin: DVec3,
    /// Velocity of the wind along the ground, m/s.
    wind: Vec3,
    /// End of the rain, s.
    end_s: f64,
    rows: Vec<DripRow>,
    cells: Vec<DripCell>,
}

/// Points near each other.
#[derive(Clone, Copy, Debug)]
struct DripCell {
    /// A ball that holds all of their drops, m.
    middle: DVec3,
    radius: f64,
    /// Diameter of the largest drop, m.
    largest: f64,
    /// Upper bound of the number of drops in an exposure: at an instant, and per second of half its time.
    most: [f64; 2],
    /// Upper bounds of the diameter of what falls, m, and of its speed in still air, m/s.
    falling: [f64; 2],
    /// Drops per second.
    per_s: f64,
}

/// Drops of points that a picture may show.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DripQuery {
    pub(crate) frame: DripFrame,
    /// Places that hold all drops and their crowns.
    pub(crate) room: u32,
    /// True if there may be crowns.
    pub(crate) has_crowns: bool,
}

impl DripTable {
    /// Rows of points; `None` where the wind is not steady.
    pub(crate) fn new(drips: &Drips) -> Option<Self> {
        if !drips.options.wind.is_steady() {
            return None;
        }
        let wind = drips.options.wind.velocity(0.0).as_vec3();
        // Points that are set by hand drip in any rain.
        let end_s = drips.emitters.iter().find_map(Emitter::rain_end).unwrap_or(f64::INFINITY);
        let balls = drips.emitters.iter().map(|emitter| emitter.around(0.0));
        let mut order: Vec<_> = drips.emitters.iter().zip(balls).collect();
        let cell_of = |middle: DVec3| (middle / CELL_M).floor().to_array().map(|part| part as i64);
        order.sort_by_key(|(_, (middle, _))| cell_of(*middle));
        let origin = order.first().map_or(DVec3::ZERO, |(_, (middle, _))| middle.round());
        let rows = order.iter().map(|(emitter, _)| emitter.row(origin)).collect();
        let cells = order.chunk_by(|(_, a), (_, b)| cell_of(a.0) == cell_of(b.0)).map(|points| {
            let middle = points.iter().map(|(_, ball)| ball.0).sum::<DVec3>() / points.len() as f64;
            let mut cell =
                DripCell { middle, radius: 0.0, largest: 0.0, most: [0.0; 2], falling: [0.0; 2], per_s: 0.0 };
            for (emitter, (at, radius)) in points {
                cell.radius = cell.radius.max(at.distance(middle) + radius);
                cell.largest = cell.largest.max(emitter.largest());
                let most = emitter.most();
                cell.most = [cell.most[0] + most[0], cell.most[1] + most[1]];
                let [diameter, speed] = emitter.falling();
                cell.falling = [cell.falling[0].max(diameter), cell.falling[1].max(speed)];
                cell.per_s += emitter.per_s();
            }
            cell
        });
        Some(Self { origin, wind: Vec3::new(wind.x, 0.0, wind.z), end_s, cells: cells.collect(), rows })
    }

    /// The rows.
    pub(crate) fn rows(&self) -> &[DripRow] {
        &self.rows
    }

    /// Asks for the drops of a picture at a time in seconds in as much room as `view.max_drops`: where more might be, for the nearest. And
    /// for their crowns, with splashes.
    pub(crate) fn query(
        &self,
        view: &View,
        least_pixels: f64,
        time_s: f64,
        splashes: Option<&SplashOptions>,
    ) -> DripQuery {
        let half = 0.5 * view.shutter_s;
        let fastest = view.velocity.length() + MAX_FALL_M_S;
        let swept = view.swept_sides();
        let shown = |cell: &DripCell| {
            let offset = cell.middle - view.eye;
            let margin = cell.radius + half * fastest;
            let nearest = offset.length() - margin;
            let is_shown =
                nearest <= view.range(cell.largest, least_pixels) && within(&swept, offset, margin);
            is_shown.then(|| (nearest.max(0.0), (cell.most[0] + cell.most[1] * half).ceil()))
        };
        let mut cells: Vec<(f64, f64)> = self.cells.iter().filter_map(shown).collect();
        cells.sort_by(|a, b| a.0.total_cmp(&b.0));
        let (mut farthest, mut room) = (view.far, 0.0);
        for (nearest, most) in cells {
            if room + most > f64::from(view.max_drops) {
                farthest = nearest;
                break;
            }
            room += most;
        }
        let crowns = splashes.map_or(0.0, |splashes| self.crowns(view, splashes));
        let time = FieldTime::new(time_s);
        let frame = DripFrame {
            unread: 0,
            seconds: time.seconds,
            fraction: time.fraction,
            is_before: time.is_before,
            eye: (view.eye - self.origin).as_vec3(),
            points: self.rows.len() as u32,
            wind: self.wind,
            end: (self.end_s - time_s).min(FIELD_ALWAYS.into()) as f32,
            farthest: farthest as f32,
            fastest: fastest as f32,
            unused: [0; 2],
        };
        DripQuery { frame, room: (room + crowns) as u32, has_crowns: crowns > 0.0 }
    }

    /// Room for the crowns of a picture.
    fn crowns(&self, view: &View, splashes: &SplashOptions) -> f64 {
        let sides = view.sides();
        let wind = f64::from(self.wind.length());
        let per_s = |cell: &DripCell| {
            let [diameter, speed] = cell.falling;
            let crown = splashes.largest_crown(view, diameter, speed + wind)?;
            is_shown(view, &sides, (cell.middle, cell.radius), crown).then_some(cell.per_s)
        };
        let landed: f64 = self.cells.iter().filter_map(per_s).sum::<f64>() * MAX_CROWN_S;
        // Points drip each at its own times: 8 standard deviations more than their mean do not come.
        if landed > 0.0 { (landed + 8.0 * landed.sqrt()).ceil() + 16.0 } else { 0.0 }
    }
}

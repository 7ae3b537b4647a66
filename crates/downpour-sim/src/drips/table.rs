//! Points that drip in a steady wind, as a device gets them: rows in cells, of which only those before a picture need room in its list.

use downpour_shaders::sim::field::FIELD_ALWAYS;
use glam::{DVec3, Vec3};

use super::Drips;
use super::emitter::Emitter;
use super::row::{DripFrame, DripRow};
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
}

/// Drops of points that a picture may show.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DripQuery {
    pub(crate) frame: DripFrame,
    /// Places that hold all drops.
    pub(crate) room: u32,
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
            let mut cell = DripCell { middle, radius: 0.0, largest: 0.0, most: [0.0; 2] };
            for (emitter, (at, radius)) in points {
                cell.radius = cell.radius.max(at.distance(middle) + radius);
                cell.largest = cell.largest.max(emitter.largest());
                let most = emitter.most();
                cell.most = [cell.most[0] + most[0], cell.most[1] + most[1]];
            }
            cell
        });
        Some(Self { origin, wind: Vec3::new(wind.x, 0.0, wind.z), end_s, cells: cells.collect(), rows })
    }

    /// The rows.
    pub(crate) fn rows(&self) -> &[DripRow] {
        &self.rows
    }

    /// Asks for the drops of a picture at a time in seconds in as much room as `view.max_drops`: where more might be, for the nearest.
    pub(crate) fn query(&self, view: &View, least_pixels: f64, time_s: f64) -> DripQuery {
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
        let frame = DripFrame {
            eye: (view.eye - self.origin).as_vec3(),
            points: self.rows.len() as u32,
            wind: self.wind,
            end: (self.end_s - time_s).min(FIELD_ALWAYS.into()) as f32,
            farthest: farthest as f32,
            fastest: fastest as f32,
            unread: 0,
            unused_2: 0,
        };
        DripQuery { frame, room: room as u32 }
    }
}

//! Uniforms and tables with which a GPU finds the drops of a picture. The structs have the layout of those in `shaders/wgsl/sim/field.wgsl` and
//! `shaders/wgsl/sim/shelter.wgsl`.

use bytemuck::{Pod, Zeroable};
use downpour_shaders::sim::field::{FIELD_SIDES, FIELD_THRESHOLDS};
use glam::{DVec3, Vec3};

use super::thinning::Thinning;
use super::{Class, RainField, Reach, check_time};
use crate::SimError;
use crate::drift::Drift;
use crate::field::chain::FieldTime;
use crate::resolved::Resolved;
use crate::view::{Bounds, View, side_rows};

/// Columns of a class that a picture may show.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct FieldClass {
    /// Seed of the class.
    pub seed: [u32; 2],
    /// Edge of a column, m.
    pub edge: f32,
    /// Period along the vertical, m.
    pub period: f32,
    /// First node of its sizes.
    pub first_node: u32,
    /// First of its two rows of thresholds.
    pub first_threshold: u32,
    /// Whole portions of the number of chains.
    pub portions: u32,
    /// Number of its first column.
    pub first_column: u32,
    /// First column along x and z.
    pub columns: [i32; 2],
    /// Number of columns along x and z.
    pub counts: [u32; 2],
    /// Column in which the eye is; the drift is taken off.
    pub eye_column: [i32; 2],
    /// Position of the eye in it.
    pub eye_in_column: [f32; 2],
    /// Periods to the height of the eye: whole ones, and a fraction in units of 2^-32.
    pub eye_periods: [u32; 2],
    /// Lowest and highest drops of interest, relative to the eye, m.
    pub heights: [f32; 2],
    /// Middle of the drift along x and z, m.
    pub drift: [f32; 2],
    /// Radius of the part of a column within these heights with all margins, m.
    pub reach: f32,
    /// Its middle height, m.
    pub middle: f32,
    /// Height at which a rate that changes holds, in periods: whole ones, and a fraction in units of 2^-32.
    pub gauge: [u32; 2],
    /// First node of the class in a row of the parts that fall.
    pub first_kept: u32,
    /// Its least diameter, in units.
    pub least_units: u32,
    /// Intervals of these parts per unit of diameter, in units of 2^-32.
    pub kept_inverse: u32,
    /// Largest distance of a drop of the class, m.
    pub farthest: f32,
    /// Distance, m, by which what is seen is larger than so many diameters.
    pub margin: f32,
    /// 0.
    pub unused: u32,
}

/// Uniforms of the search for the drops of a picture.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct FieldFrame {
    /// Outward normals of the pyramid of the picture.
    pub sides: [[f32; 4]; FIELD_SIDES as usize],
    /// Those of all that the camera sees during the exposure.
    pub swept: [[f32; 4]; FIELD_SIDES as usize],
    /// Velocity of the eye, m/s.
    pub velocity: Vec3,
    /// Half the exposure time, s.
    pub half_shutter: f32,
    /// Axis of the camera's rotation, with its angular speed as length, rad/s.
    pub turning: Vec3,
    /// Least distance of a drop, m.
    pub nearest: f32,
    /// Distance up to which a drop is searched for, by its diameter.
    pub per_diameter: f32,
    /// Further distance, m.
    pub beyond: f32,
    /// Time ([`FieldTime`]).
    pub seconds: u32,
    /// See `seconds`.
    pub fraction: u32,
    /// See `seconds`.
    pub is_before: u32,
    /// Number of classes.
    pub classes: u32,
    /// Number of columns of all classes.
    pub columns: u32,
    /// Room for drops.
    pub room: u32,
    /// Pane before the eye: its unit normal, away from the eye, and its distance, m; 0 for none.
    pub pane: [f32; 4],
    /// Places of the list before the first that is searched for.
    pub first: u32,
    /// Of a rate that changes, the number of times at which rows of the parts that fall begin.
    pub begins: u32,
    /// The length of a row; 0: all drops fall.
    pub kept_row: u32,
    /// Radius of what is seen, in diameters.
    pub radius: f32,
}

impl FieldFrame {
    /// A picture of a time in seconds, of which nothing is searched for yet.
    #[must_use]
    pub fn of_view(view: &View, time_s: f64) -> Self {
        let time = FieldTime::new(time_s);
        Self {
            sides: side_rows(view.sides()),
            swept: side_rows(view.swept_sides()),
            velocity: view.velocity.as_vec3(),
            half_shutter: (0.5 * view.shutter_s) as f32,
            turning: view.turning.as_vec3(),
            nearest: view.near as f32,
            seconds: time.seconds,
            fraction: time.fraction,
            is_before: time.is_before,
            ..Self::zeroed()
        }
    }
}

/// Uniforms of the search for what obstacles stop.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct ShelterFrame {
    /// Not read: a software driver makes the kernel again for each value of the first word of a block that it reads.
    pub unread: u32,
    /// Places of the list that are asked for.
    pub room: u32,
    /// First of them.
    pub first: u32,
    /// 1: only drops that are stopped while the shutter is open are asked for.
    pub stopped: u32,
    /// Position of the eye relative to the obstacles, m.
    pub eye: Vec3,
    /// Half the exposure time, s.
    pub half_shutter: f32,
    /// Lower corner of the bounds of all obstacles.
    pub low: Vec3,
    /// Time from the last whole quarter of a second to the opening of the shutter, s.
    pub since_cut: f32,
    /// Upper corner of these bounds.
    pub high: Vec3,
    /// Number of quarters of a second that paths are followed back; 0 in a steady wind.
    pub cuts: u32,
}

/// Drops of a picture, as a GPU is asked for them.
#[derive(Clone, Debug)]
pub(crate) struct FieldQuery {
    pub(crate) frame: FieldFrame,
    pub(crate) classes: Vec<FieldClass>,
    /// By terminal speed: drift, less that of the middle speed, m; velocity due to the wind, m/s.
    pub(crate) drift: Vec<[f32; 4]>,
    /// The whole drift.
    pub(crate) now: Drift,
    pub(crate) resolved: Resolved,
    /// Terminal speed of the slowest drop, m/s, and height of the lowest, m.
    pub(crate) slowest: f64,
    pub(crate) deepest: f64,
}

impl RainField {
    /// The question for the drops of a picture; at most `max_room` drops have room.
    ///
    /// # Errors
    /// As [`RainField::visible`].
    pub(crate) fn query(&self, view: &View, time_s: f64, max_room: u32) -> Result<FieldQuery, SimError> {
        view.check()?;
        check_time(time_s)?;
        let drift = Drift::new(&self.wind, time_s);
        let [least_pixels, room] = self.roomy(view, &drift, max_room);
        let reach = Reach::of_view(view, least_pixels);
        let of_class = |class: &Class| (reach.range(class.largest) >= view.near).then_some(reach);
        let room = (room as u32).min(max_room).max(1);
        let resolved = Resolved::of(view, least_pixels);
        Ok(self.query_of(view, (time_s, drift), of_class, room, resolved))
    }

    /// The question for drops of some classes at a time that the wind has moved so far. What all classes share is taken from the first.
    pub(crate) fn query_of(
        &self,
        view: &View,
        (time_s, drift): (f64, Drift),
        of_class: impl Fn(&Class) -> Option<Reach>,
        room: u32,
        resolved: Resolved,
    ) -> FieldQuery {
        let base = drift.middle();
        let shared = self.classes.iter().find_map(&of_class);
        let shared = shared.unwrap_or_else(|| Reach::of_view(view, view.least_pixels));
        let row = |class: &Class, drift: &Drift| class.row(view, &of_class(class)?, drift, base);
        self.query_rows(view, (time_s, drift), row, shared, room, resolved)
    }

    /// The question for drops of some classes in columns.
    pub(crate) fn query_rows(
        &self,
        view: &View,
        (time_s, drift): (f64, Drift),
        of_class: impl Fn(&Class, &Drift) -> Option<FieldClass>,
        shared: Reach,
        room: u32,
        resolved: Resolved,
    ) -> FieldQuery {
        let base = drift.middle();
        let (mut classes, mut columns) = (Vec::new(), 0u32);
        let (mut slowest, mut deepest) = (f64::INFINITY, f64::INFINITY);
        for (k, class) in (0u32..).zip(&self.classes) {
            let Some(mut row) = of_class(class, &drift) else { continue };
            row.first_node = k * self.nodes_of_class();
            row.first_threshold = k * 2 * FIELD_THRESHOLDS;
            row.first_column = columns;
            if let Some(thinning) = &self.thinning {
                let kind = thinning.classes[class.number];
                row.first_kept = Thinning::first_of(class.number) as u32;
                (row.gauge, row.least_units, row.kept_inverse) = (kind.height, kind.low, kind.inverse);
            }
            columns = columns.saturating_add(row.counts[0].saturating_mul(row.counts[1]));
            slowest = slowest.min(class.speeds[0]);
            deepest = deepest.min(view.eye.y + f64::from(row.heights[0]));
            classes.push(row);
        }
        let frame = FieldFrame {
            per_diameter: (1.0 / shared.angle) as f32,
            beyond: shared.beyond as f32,
            classes: classes.len() as u32,
            columns,
            room,
            begins: self.thinning.as_ref().map_or(0, |thinning| thinning.begins.len() as u32),
            kept_row: self.thinning.as_ref().map_or(0, |thinning| thinning.row_len() as u32),
            radius: shared.radius as f32,
            ..FieldFrame::of_view(view, time_s)
        };
        let now = drift;
        let table = now
            .entries()
            .flat_map(|[moved, wind]| [*moved - base, *wind].map(|v| v.as_vec3().extend(0.0).to_array()));
        FieldQuery { frame, classes, drift: table.collect(), now, resolved, slowest, deepest }
    }

    /// Number of nodes of the sizes of each class.
    pub(crate) fn nodes_of_class(&self) -> u32 {
        self.classes.first().map_or(0, |class| class.sizes.nodes.len() as u32)
    }
}

impl Class {
    /// The columns of a class in which a search may find drops; `base` is taken off the drift.
    fn row(&self, view: &View, reach: &Reach, drift: &Drift, base: DVec3) -> Option<FieldClass> {
        let seen = self.seen(view, reach, drift)?;
        let middle = seen.middle - base;
        Some(FieldClass {
            drift: [middle.x as f32, middle.z as f32],
            reach: seen.radius as f32,
            middle: (seen.middle.y - view.eye.y) as f32,
            farthest: reach.farthest as f32,
            margin: reach.margin as f32,
            ..self.row_within(view, &seen.bounds, drift, base)
        })
    }

    /// The columns of a class that may hold drops in a box; `base` is taken off the drift.
    pub(crate) fn row_within(&self, view: &View, bounds: &Bounds, drift: &Drift, base: DVec3) -> FieldClass {
        let [xs, zs] = self.columns(bounds, drift);
        let eye = view.eye - base;
        let at = [eye.x / self.edge, eye.z / self.edge];
        let periods = (eye.y / self.period * 4_294_967_296.0).round() as i64 as u64;
        FieldClass {
            seed: self.seed,
            edge: self.edge as f32,
            period: self.period as f32,
            portions: self.count.portions,
            columns: [*xs.start() as i32, *zs.start() as i32],
            counts: [xs, zs].map(|range| (range.end() - range.start() + 1) as u32),
            eye_column: at.map(|at| at.floor() as i32),
            eye_in_column: at.map(|at| (at - at.floor()) as f32),
            eye_periods: [(periods >> 32) as u32, periods as u32],
            heights: [bounds.low.y, bounds.high.y].map(|height| (height - view.eye.y) as f32),
            ..FieldClass::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use downpour_drop::distribution::{DropSizeDistribution, DropSizeLaw};

    #[test]
    fn there_is_room_for_all_drops_however_the_camera_moves() {
        let rain = DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, 300.0).unwrap();
        let field = RainField::new(&rain, 3).unwrap();
        let still = View { far: 20.0, ..View::default() };
        let fast = View { shutter_s: 1.0 / 30.0, velocity: DVec3::new(80.0, 0.0, -30.0), ..still };
        let turning = View { shutter_s: 1.0 / 24.0, turning: DVec3::new(0.0, 12.0, 1.0), ..still };
        let long = View { shutter_s: 0.25, least_pixels: 1.0, ..still };
        let narrow = View { half_width: 0.02, half_height: 0.01, pixel_angle: 2.0e-5, far: 50.0, ..fast };
        for view in [still, fast, turning, long, narrow] {
            let found = field.visible(&view, 5.0).unwrap().drops.len();
            let room = field.query(&view, 5.0, u32::MAX).unwrap().frame.room;
            assert!(found > 100 && (found as u32) < room, "{found} drops, room for {room}: {view:?}");
            assert!(room < 8 * found as u32 + 8192, "{found} drops, room for {room}: {view:?}");
            // Where there is less room, fewer drops are resolved.
            let few = field.query(&view, 5.0, 10_000).unwrap();
            let resolved = View { least_pixels: few.resolved.least_pixels, ..view };
            let found = field.visible(&resolved, 5.0).unwrap().drops.len();
            assert!(found as u32 <= few.frame.room && few.frame.room <= 10_000, "{found} drops: {view:?}");
        }
    }
}

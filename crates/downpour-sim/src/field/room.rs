//! Room for the drops of a picture in a list of a given length.

use super::{Class, RainField, check_time};
use crate::SimError;
use crate::drift::Drift;
use crate::resolved::Resolved;
use crate::view::View;

/// Room beyond what is expected, for chance and for classes of few drops.
pub(crate) const ROOM: f64 = 1.25;
pub(crate) const SPARE_ROOM: f64 = 4096.0;

/// Drops of so many pixels are so rare that there is room for them.
const MAX_MIN_PIXELS: f64 = 1.0e4;

impl RainField {
    /// Limits of the list of a picture for which a device has room for `max_room` drops.
    ///
    /// # Errors
    /// As [`RainField::visible`].
    pub fn resolved(&self, view: &View, time_s: f64, max_room: u32) -> Result<Resolved, SimError> {
        view.check()?;
        check_time(time_s)?;
        let [least_pixels, _] = self.roomy(view, &Drift::new(&self.wind, time_s), max_room);
        Ok(Resolved::of(view, least_pixels))
    }

    /// Minimum diameter in pixels of the drops that have room, and that room.
    pub(crate) fn roomy(&self, view: &View, drift: &Drift, max_room: u32) -> [f64; 2] {
        let room = |least_pixels: f64| {
            let expected = |class: &Class| {
                let range = view.range(class.largest, least_pixels);
                let is_seen = range >= view.near;
                if is_seen {
                    class.density * view.swept_volume(range, class.half_way(view, drift))
                } else {
                    0.0
                }
            };
            self.classes.iter().map(expected).sum::<f64>() * ROOM + SPARE_ROOM
        };
        let mut least_pixels = self.affordable(view);
        // 3 % at a time, as in what is affordable, until the drops that move into the picture have room as well.
        while room(least_pixels) > f64::from(max_room) && least_pixels < MAX_MIN_PIXELS {
            least_pixels = (least_pixels * 1.03).max(1.0e-3);
        }
        [least_pixels, room(least_pixels)]
    }
}

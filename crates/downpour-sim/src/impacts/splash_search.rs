//! Uniforms with which a GPU lists the crowns of the impacts of a slice of time; see `shaders/wgsl/sim/splash_find.wgsl`.

use downpour_shaders::sim::splash::{SPLASH_MAX_S, SPLASH_MAX_SIZE};
use glam::{DVec3, Vec3};

use super::SplashOptions;
use super::slices::Slice;
use super::splash_frame::SplashFrame;
use super::splashes::MIN_PIXELS;
use crate::field::frame::FieldQuery;
use crate::field::{Class, ROOM, RainField, Reach, SPARE_ROOM};
use crate::resolved::Resolved;
use crate::shelter::Obstacles;
use crate::view::{Bounds, View};

/// Length of the slices of time in which impacts are searched, s: longer than that of crowns.
const SLICE_S: f64 = 1.0 / 16.0;

/// The search for the crowns of a slice.
#[derive(Debug)]
pub(crate) struct SplashSearch {
    pub(crate) slice: Slice,
    /// The eye that stands still for as long.
    pub(crate) view: View,
    pub(crate) query: FieldQuery,
    pub(crate) frame: SplashFrame,
}

/// Drops of all slices of a picture that a GPU is asked for, at most: beyond, a CPU looks where surfaces are.
const MAX_DROPS: f64 = 4_194_304.0;

/// Crowns of a picture for which there is room on a GPU.
const MAX_CROWNS: u32 = 65_536;

impl SplashOptions {
    /// True if a GPU is to find the crowns of a picture at a time in s.
    #[must_use]
    pub fn fits_device(
        &self,
        field: &RainField,
        view: &View,
        time_s: f64,
        obstacles: &Obstacles<'_>,
    ) -> bool {
        let Some(corners) = obstacles.corners() else { return true };
        let searches = self.searches(field, view, time_s, (corners, obstacles.origin));
        searches.iter().map(|search| f64::from(search.frame.drops)).sum::<f64>() <= MAX_DROPS
    }

    /// Room for the crowns of some searches.
    pub(crate) fn room(searches: &[SplashSearch]) -> u32 {
        searches.iter().map(|search| search.frame.drops).fold(0, u32::saturating_add).min(MAX_CROWNS)
    }

    /// Searches for the crowns of a picture at a time in s, one for each slice of time; `corners` are those of all obstacles.
    pub(crate) fn searches(
        &self,
        field: &RainField,
        view: &View,
        time_s: f64,
        (corners, origin): ([Vec3; 2], DVec3),
    ) -> Vec<SplashSearch> {
        let of_slice = |slice: Slice| {
            let around = slice.around(field, corners, origin);
            let reach = self.reach(field, view, &slice, around);
            let still = slice.view(view);
            let expected = |class: &Class| {
                let Some(reach) = reach(class) else { return 0.0 };
                let Some(seen) = class.seen(&still, &reach, &slice.drift) else { return 0.0 };
                let margin = class.half_way(&still, &slice.drift) + reach.radius(class.largest);
                let volume = still.swept_volume(reach.range(class.largest), margin);
                let whole = (seen.bounds.high - seen.bounds.low).element_product();
                class.density * volume.min(whole)
            };
            let room = field.classes.iter().map(expected).sum::<f64>() * ROOM + SPARE_ROOM;
            let middle_s = slice.middle_s();
            let resolved = Resolved::of(view, MIN_PIXELS);
            let query =
                field.query_of(&still, (middle_s, slice.drift.clone()), &reach, room as u32, resolved);
            let frame = SplashFrame {
                eye: (view.eye - origin).as_vec3(),
                half_time: slice.half_s() as f32,
                now: (time_s - middle_s) as f32,
                drops: query.frame.room,
                ..SplashFrame::of_picture(Some(self), view)
            };
            SplashSearch { slice, view: still, query, frame }
        };
        let span_s = [time_s - f64::from(SPLASH_MAX_S), time_s];
        Slice::all(field, span_s, SLICE_S).into_iter().map(of_slice).collect()
    }

    /// Which drops of a class may have hit in a slice where a picture shows their crown.
    fn reach(
        &self,
        field: &RainField,
        view: &View,
        slice: &Slice,
        within: Bounds,
    ) -> impl Fn(&Class) -> Option<Reach> + use<> {
        let widest: Vec<Option<f64>> = field.classes.iter().map(|class| self.widest(class, slice)).collect();
        // For the largest of its class; all of them are nearer than this.
        let ratio = |(class, radius): (&Class, &Option<f64>)| radius.unwrap_or(0.0) / class.largest;
        let ratio = field.classes.iter().zip(&widest).map(ratio).fold(0.0, f64::max);
        let largest = widest.iter().flatten().copied().fold(0.0, f64::max);
        let (view, beyond) = (*view, 0.5 * slice.longest_way(field) + largest);
        move |class: &Class| {
            let radius = widest.get(class.number).copied().flatten()?;
            let range = view.range(2.0 * radius, MIN_PIXELS);
            (range >= view.near).then(|| Reach {
                angle: view.least_angle(MIN_PIXELS) / (2.0 * ratio),
                beyond,
                farthest: range + beyond,
                radius: 0.0,
                margin: 1.5 * radius,
                within,
            })
        }
    }

    /// Radius, m, of the widest crown of a class; `None` if none of its drops splashes.
    fn widest(&self, class: &Class, slice: &Slice) -> Option<f64> {
        // The wind adds to the speed of a drop toward a slope.
        let wind = slice.drift.of(class.speeds[1])[1].length();
        let splash = self.law.splash(class.largest, class.speeds[1] + wind)?;
        Some(splash.radius_m * self.size * f64::from(SPLASH_MAX_SIZE))
    }
}

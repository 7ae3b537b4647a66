//! Crowns of splashes, as a picture shows them; twin of `shaders/wgsl/sim/splash.wgsl`, whose struct has the layout of [`SplashFrame`],
//! and of `shaders/wgsl/sim/impact.wgsl`.

use bytemuck::{Pod, Zeroable};
use downpour_bvh::BvhTriangle;
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_shaders::sim::field::FIELD_SIDES;
use downpour_shaders::sim::splash::{
    SPLASH_FINGERS, SPLASH_HIGH, SPLASH_LEVEL, SPLASH_LOW, SPLASH_MAX_S, SPLASH_MAX_SIZE, SPLASH_MIN_SIZE,
    SPLASH_RISE_SHARE, SPLASH_RISE_TIMES, SPLASH_SIZE, SPLASH_THRESHOLD, SPLASH_WALL,
};
use glam::Vec3;

use super::SplashOptions;
use super::splashes::MIN_PIXELS;
use crate::falling::{EyeDrop, eye_drop_standing};
use crate::view::{View, side_rows};

/// Uniforms of the crowns of a picture, of the impacts of a slice of time if a device searches for them.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct SplashFrame {
    /// Outward normals of the pyramid of the picture.
    pub sides: [[f32; 4]; FIELD_SIDES as usize],
    /// Pane before the eye: its unit normal, away from the eye, and its distance, m; 0 for none.
    pub pane: [f32; 4],
    /// Position of the eye relative to the obstacles, m.
    pub eye: Vec3,
    /// Half the length of the slice, s.
    pub half_time: f32,
    /// Time of the picture from the middle of the slice, s.
    pub now: f32,
    /// Root of the Weber number of a drop of 1 m at 1 m/s.
    pub strength: f32,
    /// Radius of the crown of a drop of 1 m, m.
    pub radius: f32,
    /// Distance up to which crowns are listed, by their radius.
    pub per_radius: f32,
    /// Largest distance of a crown, m.
    pub farthest: f32,
    /// Room for the drops of the slice.
    pub drops: u32,
    /// Places of the list before the first that is searched for.
    pub first: u32,
    /// Room after them.
    pub room: u32,
}

impl SplashFrame {
    /// Crowns before a picture without a pane; none without options.
    #[must_use]
    pub fn of_picture(options: Option<&SplashOptions>, view: &View) -> Self {
        Self {
            sides: side_rows(view.sides()),
            strength: options.map_or(0.0, |options| options.law.strength() as f32),
            radius: options.map_or(0.0, |options| (options.law.unit_radius() * options.size) as f32),
            per_radius: (2.0 / view.least_angle(MIN_PIXELS)) as f32,
            farthest: view.far as f32,
            ..Self::zeroed()
        }
    }
}

/// Root of the Weber number of a drop that meets a surface with a speed toward it, in m and m/s.
#[must_use]
pub fn splash_parameter(strength: f32, diameter: f32, speed: f32) -> f32 {
    strength * speed * diameter.sqrt()
}

/// Part of the energy of a drop that is beyond the energy of one that just splashes, from the root of its Weber number.
#[must_use]
pub fn splash_surplus(root: f32) -> f32 {
    let ratio = SPLASH_THRESHOLD / root.max(SPLASH_THRESHOLD);
    1.0 - ratio * ratio
}

/// Half the height of a crown at a stage, in its radius.
#[must_use]
pub fn splash_middle(stage: f32) -> f32 {
    let rise = (stage / SPLASH_RISE_SHARE).clamp(0.0, 1.0);
    let fall = ((stage - SPLASH_RISE_SHARE) / (1.0 - SPLASH_RISE_SHARE)).clamp(0.0, 1.0);
    let left = 1.0 - fall;
    let up = rise * (2.0 - rise);
    let height = 0.05 + (SPLASH_WALL - 0.05) * up * left * left.sqrt() - 0.045 * fall;
    let fingers = 0.01 + (SPLASH_FINGERS - 0.01) * up * (1.0 - fall * fall) - 0.008 * fall;
    0.5 * (height + fingers)
}

/// Unit normal of a triangle on the side that a drop of a velocity came from.
#[must_use]
pub fn impact_facing(triangle: &BvhTriangle, velocity: Vec3) -> Vec3 {
    let facet = Vec3::from(triangle.edge_1).cross(triangle.edge_2.into());
    let normal = facet.normalize_or(Vec3::Y);
    if normal.dot(velocity) > 0.0 { -normal } else { normal }
}

impl SplashFrame {
    /// Crown of a drop that has met a surface with a normal at the end of its presence, as the picture shows it, if there is one.
    #[must_use]
    pub fn splash_crown(&self, drop: &EyeDrop, normal: Vec3) -> Option<EyeDrop> {
        let met = drop.present[1];
        let velocity = Vec3::from(drop.velocity);
        let (age, toward) = (self.now - met, -velocity.dot(normal));
        let surplus = splash_surplus(splash_parameter(self.strength, drop.diameter, toward));
        if normal.y < SPLASH_LEVEL || surplus <= 0.0 {
            return None;
        }
        let duration =
            (SPLASH_RISE_TIMES * surplus * drop.diameter / toward / SPLASH_RISE_SHARE).min(SPLASH_MAX_S);
        if !(0.0..duration).contains(&age) {
            return None;
        }
        let [chance, ..] = rng_draw([drop.id_low, drop.id ^ drop.id_low], 0, 0, SPLASH_SIZE).map(rng_unit);
        let random = SPLASH_MIN_SIZE + (SPLASH_MAX_SIZE - SPLASH_MIN_SIZE) * chance;
        let radius = self.radius * drop.diameter * (drop.diameter.sqrt() * surplus).sqrt() * random;
        let offset =
            Vec3::from(drop.offset) + velocity * met + normal * (radius * splash_middle(age / duration));
        let range = (radius * self.per_radius).min(self.farthest);
        let [x, y, z, distance] = self.pane;
        // The mask reaches beyond the largest radius, to the droplets of the rim.
        let within = |side: &[f32; 4]| Vec3::from_slice(side).dot(offset) <= 1.5 * radius;
        let is_seen = offset.length() < range
            && Vec3::new(x, y, z).dot(offset) >= distance
            && self.sides.iter().all(within);
        is_seen.then(|| EyeDrop {
            offset: offset.into(),
            diameter: 2.0 * radius,
            velocity: [0.0; 3],
            id: drop.id ^ SPLASH_HIGH ^ SPLASH_LOW,
            present: [-age, duration - age],
            speed: eye_drop_standing(normal),
            id_low: drop.id_low ^ SPLASH_LOW,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use downpour_drop::splash::{FILM_M, SplashLaw, crown};

    /// The forms of a GPU are the law and the shape of `downpour_drop`.
    #[test]
    fn crowns_are_those_of_the_law() {
        let law = SplashLaw::new(FILM_M, 20.0).unwrap();
        for (diameter, speed) in [(0.7e-3, 3.1), (1.3e-3, 5.0), (2.0e-3, 6.5), (5.0e-3, 9.1)] {
            let found = splash_parameter(law.strength() as f32, diameter as f32, speed as f32);
            assert!((f64::from(found) / law.weber_root(diameter, speed) - 1.0).abs() < 1.0e-5, "{diameter}");
            let expected = law.splash(diameter, speed).map(|splash| splash.radius_m);
            let surplus = f64::from(splash_surplus(found));
            assert_eq!(expected.is_some(), surplus > 0.0, "{diameter}");
            let found = law.unit_radius() * diameter * (diameter.sqrt() * surplus).sqrt();
            assert!(expected.is_none_or(|radius| (found / radius - 1.0).abs() < 1.0e-5), "{diameter}");
        }
        for k in 0..=100 {
            let stage = f64::from(k) / 100.0;
            assert!(
                (f64::from(splash_middle(stage as f32)) - crown::middle(stage)).abs() < 1.0e-6,
                "{stage}"
            );
        }
    }
}

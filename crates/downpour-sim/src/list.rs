//! Drops of a state that a picture shows: their positions at the picture's time, and the part of the exposure in which
//! they exist.
//!
//! A drop moves from the state at its velocity. One that is stopped while the shutter is open is listed with the time
//! at which it exists, and so is the droplet that rebounds. Nothing is stored: the next step computes the same.

use downpour_math::rng::seed_words;
use downpour_shaders::sim::collision::COLLISION_SURFACE;
use downpour_shaders::sim::step::{
    STEP_BOUNCED, STEP_CLEAR, STEP_COUNT, STEP_DIAMETER, STEP_FALLING, STEP_HIDDEN, STEP_KIND, VOLUME_RADIUS,
};
use glam::{DVec3, Vec3};
use rayon::prelude::*;

use crate::collision::{CollisionHit, CollisionMap};
use crate::field::{DropKind, FallingDrop, VisibleDrops};
use crate::motion::speed_of;
use crate::motion::{motion_bounce, motion_diameter, motion_relax};
use crate::options::SimVolume;
use crate::plan::Plan;
use crate::population::box_center;
use crate::step::{
    StepDrop, bounces, step_column, step_count, step_image, step_kind, step_pack, step_shown, step_word,
};
use crate::view::View;

/// Query for the drops of a picture.
pub(crate) struct Listing<'a> {
    pub(crate) plan: &'a Plan,
    pub(crate) speeds: &'a [f32],
    pub(crate) view: &'a View,
    /// Time from the state to the picture, s.
    pub(crate) after_s: f64,
    /// Collision map.
    pub(crate) map: Option<&'a CollisionMap>,
}

/// Drops that a picture can show.
pub(crate) fn listed(listing: &Listing<'_>, drops: &[StepDrop]) -> VisibleDrops {
    let sides = listing.view.sides();
    let shown = |(number, drop): (usize, &StepDrop)| listing.shown(number as u32, drop, &sides);
    VisibleDrops {
        drops: drops.par_iter().enumerate().flat_map_iter(shown).collect(),
        simulated: drops.len() as u64,
        resolved: listing.plan.resolved(listing.view),
    }
}

impl Listing<'_> {
    /// A drop and its rebounding droplet, at their positions in the picture.
    fn shown(
        &self,
        number: u32,
        drop: &StepDrop,
        sides: &[DVec3; 5],
    ) -> impl Iterator<Item = FallingDrop> + use<> {
        let kind = drop.kind();
        if kind != STEP_FALLING && kind != STEP_BOUNCED {
            return [None, None].into_iter().flatten();
        }
        let (view, after) = (self.view, self.after_s);
        let half = 0.5 * view.shutter_s;
        let velocity = Vec3::from(drop.velocity);
        let (word, here) = self.there(number, drop, velocity);
        if step_kind(word) == STEP_HIDDEN {
            return [None, None].into_iter().flatten();
        }
        let diameter = step_shown(word, self.plan.options.bounce.size);
        let seen = |at: Vec3, velocity: Vec3, diameter: f32, part: [f64; 2]| {
            let position = self.plan.origin() + at.as_dvec3();
            let range = view.range(diameter.into(), self.plan.least_pixels);
            let radius = f64::from(VOLUME_RADIUS * diameter);
            view.shows(sides, position, velocity.as_dvec3(), radius, range, part).then_some(position)
        };
        if seen(here, velocity, diameter, [-half, half]).is_none() {
            return [None, None].into_iter().flatten();
        }
        let hit = self.map.and_then(|map| {
            let [from, to] = [-after, half].map(|time| here + velocity * time as f32);
            map.find(from, to)
        });
        let until = hit.map_or(f64::INFINITY, |hit| f64::from(hit.fraction) * (after + half) - after);
        let kind_of = |kind: u32| if kind == STEP_BOUNCED { DropKind::Bounced } else { DropKind::Falling };
        let listed = |at: Vec3, velocity: Vec3, word: u32, present: [f64; 2]| {
            let diameter = step_shown(word, self.plan.options.bounce.size);
            let within = present[0] <= half && present[1] >= -half && present[0] <= present[1];
            let position = within.then(|| seen(at, velocity, diameter, present)).flatten()?;
            let mut drop = FallingDrop {
                position,
                velocity: velocity.to_array(),
                diameter,
                id: self.id(number, word, drop.last),
                kind: kind_of(step_kind(word)),
                present_s: present.map(|time| time as f32),
            };
            drop.position += (velocity * drop.seen_s()).as_dvec3();
            Some(drop)
        };
        let itself = listed(here, velocity, word, [f64::NEG_INFINITY, until]);
        let back = hit.and_then(|hit| {
            let (at, velocity, word) = self.back(&hit, number, drop.last, word, here, velocity, until)?;
            listed(at, velocity, word, [until, f64::INFINITY])
        });
        [itself, back].into_iter().flatten()
    }

    /// Word and position of a drop at the picture's time; in a box it may have re-entered.
    fn there(&self, number: u32, drop: &StepDrop, velocity: Vec3) -> (u32, Vec3) {
        let here = Vec3::from(drop.position) + velocity * self.after_s as f32;
        let SimVolume::Box { size_m } = self.plan.options.volume else { return (drop.word, here) };
        let size = DVec3::from(size_m);
        let center = box_center(self.view, size) - self.plan.origin();
        let images = |at: DVec3| ((at - center) / size + 0.5).floor();
        let away = images(here.as_dvec3());
        if away == DVec3::ZERO {
            return (drop.word, here);
        }
        let count = step_count(drop.word);
        let mut image = step_image(count, step_pack(away.as_vec3()));
        let mut at = here.as_dvec3() - size * away;
        if away.y != 0.0 {
            let seed = seed_words(self.plan.options.seed);
            let column = |image: u32| step_column(seed, number, image, size.as_vec3()).as_dvec2();
            let moved = column(image) - column(count);
            at += DVec3::new(moved.x, 0.0, moved.y);
            let across = images(at) * DVec3::new(1.0, 0.0, 1.0);
            image = step_image(image, step_pack(across.as_vec3()));
            at -= size * across;
        }
        let at = at.as_vec3();
        let open = self.map.is_none_or(|map| map.open(at - velocity * self.after_s as f32));
        let kind = if open { STEP_FALLING } else { STEP_HIDDEN };
        (step_word(drop.word & STEP_DIAMETER, kind, image), at)
    }

    /// Droplet that rebounds from a surface: its position at the picture's time if it had always moved, its velocity
    /// and its word.
    #[expect(clippy::too_many_arguments, reason = "what is known of a drop and of its impact")]
    fn back(
        &self,
        hit: &CollisionHit,
        number: u32,
        last: u32,
        word: u32,
        start: Vec3,
        velocity: Vec3,
        until: f64,
    ) -> Option<(Vec3, Vec3, u32)> {
        let options = &self.plan.options;
        let (bits, count) = (word & STEP_DIAMETER, step_count(word));
        let key = if self.plan.is_open() { [bits | count << STEP_KIND, last] } else { [number, count] };
        let falls = step_kind(word) == STEP_FALLING && hit.kind == COLLISION_SURFACE;
        if !(falls && bounces(seed_words(options.seed), key, options.bounce.fraction)) {
            return None;
        }
        let at = start + velocity * until as f32 + hit.normal * STEP_CLEAR;
        let leaves = motion_bounce(velocity, hit.normal, options.bounce.restitution, options.bounce.grip);
        // Half of the remaining exposure slows it down.
        let left = (0.5 * (0.5 * self.view.shutter_s - until)).max(0.0) as f32;
        let speed = speed_of(self.speeds, motion_diameter(bits) * options.bounce.size);
        let air = velocity + Vec3::Y * speed_of(self.speeds, motion_diameter(bits));
        let slowed = motion_relax(leaves, air, speed, left).velocity;
        let step = self.plan.step_after(until + self.after_s);
        let count = if self.plan.is_open() { step & STEP_COUNT } else { count };
        Some((at - slowed * until as f32, slowed, step_word(bits, STEP_BOUNCED, count)))
    }

    /// Id of a drop: unique, and constant while the drop exists.
    fn id(&self, number: u32, word: u32, last: u32) -> u64 {
        let bounced = u32::from(step_kind(word) == STEP_BOUNCED);
        let [high, low] = if self.plan.is_open() {
            [last, word & STEP_DIAMETER | step_count(word) << STEP_KIND | bounced << 30]
        } else {
            [step_count(word) | bounced << 30, number]
        };
        // A bijection that spreads the bits (Steele, Lea, Flood 2014).
        let mut id = u64::from(high) << 32 | u64::from(low);
        id = (id ^ id >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        id = (id ^ id >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
        id ^ id >> 31
    }
}

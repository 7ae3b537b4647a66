//! Drops of a state that a picture shows: where they are at its time, and the part of the exposure in which they exist. Twin of
//! `shaders/wgsl/sim/step_list.wgsl`.
//!
//! A drop moves from the state at its velocity. One that is stopped while the shutter is open is listed with the time
//! at which it is, and so are the droplet that rebounds and the crown of the splash. Nothing is stored: the next step
//! computes the same. Crowns of the impacts of earlier steps: [`crate::step_splash`].

use bytemuck::{Pod, Zeroable};
use downpour_math::rng::seed_words;
use downpour_shaders::sim::collision::COLLISION_SURFACE;
use downpour_shaders::sim::field::{FIELD_ALWAYS, FIELD_BOUNCED, FIELD_SIDES};
use downpour_shaders::sim::step::{
    STEP_BOUNCED, STEP_CLEAR, STEP_COUNT, STEP_DIAMETER, STEP_FALLING, STEP_HIDDEN, STEP_KIND,
    STEP_VOLUME_BOX, STEP_VOLUME_VIEW, VOLUME_RADIUS,
};
use downpour_shaders::sim::step_list::{STEP_LIST_MULTIPLIER, STEP_LIST_TURNS};
use glam::Vec3;
use rayon::prelude::*;

use crate::collision::{CollisionHit, CollisionMap};
use crate::falling::eye_drop_outside;
use crate::field::{DropKind, EyeDrop, FallingDrop, VisibleDrops};
use crate::impacts::SplashOptions;
use crate::impacts::splash_frame::SplashFrame;
use crate::motion::{motion_bounce, motion_diameter, motion_relax, speed_of};
use crate::plan::Plan;
use crate::step::{
    StepDrop, StepEvent, bounces, step_column, step_count, step_image, step_kind, step_pack, step_shown,
    step_word,
};
use crate::step_splash::step_splash_drop;
use crate::view::{View, side_rows};
use crate::volume::volume_images;

/// Query for the drops of a picture.
pub(crate) struct Listing<'a> {
    pub(crate) plan: &'a Plan,
    pub(crate) speeds: &'a [f32],
    pub(crate) view: &'a View,
    /// Time from the state to the picture, s.
    pub(crate) after_s: f64,
    /// Collision map.
    pub(crate) map: Option<&'a CollisionMap>,
    /// Splashes, if drops splash.
    pub(crate) splashes: Option<&'a SplashOptions>,
}

/// Drops that a picture can show; `kept` are the impacts of each span of the last steps.
pub(crate) fn listed(listing: &Listing<'_>, drops: &[StepDrop], kept: &[Vec<StepEvent>]) -> VisibleDrops {
    let frame = StepListFrame::new(listing.plan, listing.view, listing.after_s);
    let splash = SplashFrame::of_picture(listing.splashes, listing.view);
    let world = StepListWorld { frame: &frame, speeds: listing.speeds, map: listing.map, splash: &splash };
    let eye = listing.view.eye;
    let shown = |(number, drop): (usize, &StepDrop)| {
        let kind = if drop.kind() == STEP_BOUNCED { DropKind::Bounced } else { DropKind::Falling };
        let [itself, rebound, crown] = world.step_list_drop(number as u32, drop);
        let in_world =
            |drop: EyeDrop, kind: DropKind| (drop.diameter > 0.0).then(|| drop.to_falling(eye, kind));
        let droplets = [in_world(rebound, DropKind::Bounced), in_world(crown, DropKind::Splash)];
        in_world(itself, kind).into_iter().chain(droplets.into_iter().flatten())
    };
    let mut visible: Vec<FallingDrop> = drops.par_iter().enumerate().flat_map_iter(shown).collect();
    let spans = listing.plan.recent.before(listing.after_s, eye);
    for (events, span) in kept.iter().zip(spans) {
        let crowns = events.iter().filter_map(|event| {
            let crown = splash.splash_crown(&step_splash_drop(event, span), event.normal())?;
            Some(crown.to_falling(eye, DropKind::Splash))
        });
        visible.extend(crowns);
    }
    VisibleDrops {
        drops: visible,
        simulated: drops.len() as u64,
        resolved: listing.plan.resolved(listing.view),
    }
}

/// Parameters of a list of drops, in the layout of `StepListFrame` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct StepListFrame {
    /// Not read: a software driver makes the kernel again for each value of the first word of a block that it reads.
    pub unread: u32,
    /// Places of the list that are free.
    pub room: u32,
    /// Padding of the WGSL layout.
    pub unused_2: u32,
    /// Padding of the WGSL layout.
    pub unused_3: u32,
    /// Eye, m, relative to the origin of the state.
    pub eye: [f32; 3],
    /// Time from the state to the picture, s.
    pub after: f32,
    /// Velocity of the eye, m/s.
    pub velocity: [f32; 3],
    /// Half the exposure, s.
    pub half_shutter: f32,
    /// Axis of the camera's rotation, rad/s.
    pub turning: [f32; 3],
    /// Least distance of drops, m.
    pub nearest: f32,
    /// Center of a box, m.
    pub center: [f32; 3],
    /// Greatest distance of drops, m.
    pub farthest: f32,
    /// Edges of a box, m.
    pub size: [f32; 3],
    /// One of `STEP_VOLUME_*`.
    pub volume: u32,
    /// Outward normals of the sides of the picture's pyramid, and of the plane behind the eye.
    pub sides: [[f32; 4]; FIELD_SIDES as usize],
    /// A pane before the eye: its unit normal, away from the eye, and its distance, m; 0 without one.
    pub pane: [f32; 4],
    /// Seed: low and high word.
    pub seed: [u32; 2],
    /// Distance per diameter at which a drop is resolved.
    pub range: f32,
    /// Fraction of impacts that bounce.
    pub bounce: f32,
    /// Fraction of the normal speed that is reflected.
    pub restitution: f32,
    /// Fraction of the tangential speed that is lost.
    pub grip: f32,
    /// Diameter of a bounced drop relative to that of the falling one.
    pub bounced_size: f32,
    /// Number of the step after the state.
    pub step: u32,
    /// Steps per second.
    pub per_second: f32,
    /// Drops or slots of a dispatch.
    pub count: u32,
    /// Number of the first of them.
    pub first: u32,
    /// Places of the list that are taken.
    pub known: u32,
}

impl StepListFrame {
    /// Creates the parameters of a picture some time after the state of a plan, s; without count, room and pane.
    pub(crate) fn new(plan: &Plan, view: &View, after_s: f64) -> Self {
        let (volume, size, center) = plan.volume(view);
        let bounce = &plan.options.bounce;
        let (step, time_s) = plan.next_step();
        Self {
            eye: (view.eye - plan.origin()).as_vec3().to_array(),
            after: after_s as f32,
            velocity: view.velocity.as_vec3().to_array(),
            half_shutter: (0.5 * view.shutter_s) as f32,
            turning: view.turning.as_vec3().to_array(),
            nearest: view.near as f32,
            center: (center - plan.origin()).as_vec3().to_array(),
            farthest: view.far as f32,
            size: size.as_vec3().to_array(),
            volume,
            sides: side_rows(view.sides()),
            pane: [0.0; 4],
            seed: seed_words(plan.options.seed),
            range: (1.0 / view.least_angle(plan.least_pixels)) as f32,
            bounce: bounce.fraction,
            restitution: bounce.restitution,
            grip: bounce.grip,
            bounced_size: bounce.size,
            step,
            per_second: (1.0 / time_s) as f32,
            count: 0,
            first: 0,
            known: 0,
            room: 0,
            unread: 0,
            unused_2: 0,
            unused_3: 0,
        }
    }
}

/// Id of a drop by what it is known by, constant while the drop exists: a Feistel network, which maps no two of 64 bits to one. Droplets of a
/// view that rebounded in one step from drops that entered in one step and are alike share one.
#[must_use]
pub fn step_list_id(high: u32, low: u32) -> [u32; 2] {
    let mut words = [high, low];
    for turn in 0..STEP_LIST_TURNS {
        let [a, b] = words;
        let mut mixed = (b ^ b >> 16).wrapping_mul(STEP_LIST_MULTIPLIER).wrapping_add(turn);
        mixed = (mixed ^ mixed >> 15).wrapping_mul(STEP_LIST_MULTIPLIER);
        words = [b, a ^ mixed ^ mixed >> 16];
    }
    words
}

/// Position of a drop at the picture's time if nothing stops it, m, and its word then.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StepListPlace {
    position: Vec3,
    word: u32,
}

/// Inputs of a list beside its drops.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StepListWorld<'a> {
    /// Parameters common to all drops.
    pub(crate) frame: &'a StepListFrame,
    /// Terminal speeds ([`crate::motion::motion_table`]).
    pub(crate) speeds: &'a [f32],
    /// Collision map; `None`: no obstacles.
    pub(crate) map: Option<&'a CollisionMap>,
    /// Crowns of splashes.
    pub(crate) splash: &'a SplashFrame,
}

/// Times of a drop that exists all the time.
const ALWAYS: [f32; 2] = [-FIELD_ALWAYS, FIELD_ALWAYS];

impl StepListWorld<'_> {
    fn is_open(&self) -> bool {
        self.frame.volume == STEP_VOLUME_VIEW
    }

    /// Position of a drop at the picture's time; in a box it may have come in again.
    fn step_list_place(&self, number: u32, drop: &StepDrop) -> StepListPlace {
        let frame = self.frame;
        let velocity = Vec3::from(drop.velocity);
        let here = Vec3::from(drop.position) + velocity * frame.after;
        if frame.volume != STEP_VOLUME_BOX {
            return StepListPlace { position: here, word: drop.word };
        }
        let (center, size) = (Vec3::from(frame.center), Vec3::from(frame.size));
        let away = volume_images(here, center, size);
        if away == Vec3::ZERO {
            return StepListPlace { position: here, word: drop.word };
        }
        let count = step_count(drop.word);
        let mut image = step_image(count, step_pack(away));
        let mut at = here - size * away;
        if away.y != 0.0 {
            let column = |image: u32| step_column(frame.seed, number, image, size);
            let moved = column(image) - column(count);
            at += Vec3::new(moved.x, 0.0, moved.y);
            let across = volume_images(at, center, size) * Vec3::new(1.0, 0.0, 1.0);
            image = step_image(image, step_pack(across));
            at -= size * across;
        }
        let open = self.map.is_none_or(|map| map.open(at - velocity * frame.after));
        let kind = if open { STEP_FALLING } else { STEP_HIDDEN };
        StepListPlace { position: at, word: step_word(drop.word & STEP_DIAMETER, kind, image) }
    }

    /// A drop as the eye sees it.
    fn step_list_seen(
        &self,
        at: Vec3,
        velocity: Vec3,
        [number, word, last]: [u32; 3],
        present: [f32; 2],
    ) -> EyeDrop {
        let is_bounced = step_kind(word) == STEP_BOUNCED;
        let bounced = u32::from(is_bounced) << 30;
        let diameter = step_shown(word, self.frame.bounced_size);
        let [high, low] = if self.is_open() {
            step_list_id(last, word & STEP_DIAMETER | step_count(word) << STEP_KIND | bounced)
        } else {
            step_list_id(step_count(word) | bounced, number)
        };
        EyeDrop {
            offset: (at - Vec3::from(self.frame.eye)).to_array(),
            diameter,
            velocity: velocity.to_array(),
            id: high ^ low,
            present,
            speed: if is_bounced { FIELD_BOUNCED } else { speed_of(self.speeds, diameter) },
            id_low: low,
        }
    }

    /// The drop in the part of the exposure in which the picture shows it; its diameter is 0 if there is none.
    fn step_list_shown(&self, drop: &EyeDrop) -> EyeDrop {
        let frame = self.frame;
        let mut shown = EyeDrop { diameter: 0.0, ..*drop };
        let half_time = frame.half_shutter;
        let (velocity, turning) = (Vec3::from(frame.velocity), Vec3::from(frame.turning));
        let at = |time: f32| drop.eye_drop_position(velocity, turning, time);
        let [normal_x, normal_y, normal_z, beyond] = frame.pane;
        let pane = Vec3::new(normal_x, normal_y, normal_z);
        let [open, close] = [-half_time, half_time].map(|time| pane.dot(at(time)) - beyond);
        let outside = eye_drop_outside(open, close, half_time);
        shown.present = [drop.present[0].max(outside[0]), drop.present[1].min(outside[1])];
        let (from_time, to_time) = (drop.present[0].max(-half_time), drop.present[1].min(half_time));
        let distance = Vec3::from(drop.offset).length();
        let range = (drop.diameter * frame.range).min(frame.farthest);
        let is_there = shown.present[0] <= shown.present[1] && from_time <= to_time;
        if !is_there || distance < frame.nearest || distance > range {
            return shown;
        }
        let (begin, end) = (at(from_time), at(to_time));
        let touches = |&[x, y, z, _]: &[f32; 4]| {
            let side = Vec3::new(x, y, z);
            side.dot(begin).min(side.dot(end)) <= VOLUME_RADIUS * drop.diameter
        };
        if frame.sides.iter().all(touches) {
            shown.diameter = drop.diameter;
        }
        shown
    }

    /// Droplet that rebounds from a surface that a drop meets `until` seconds after the picture's time: as if it had always moved.
    fn step_list_rebound(
        &self,
        place: &StepListPlace,
        velocity: Vec3,
        [number, last]: [u32; 2],
        hit: &CollisionHit,
        until: f32,
    ) -> EyeDrop {
        let frame = self.frame;
        let bits = place.word & STEP_DIAMETER;
        let at = place.position + velocity * until + hit.normal * STEP_CLEAR;
        let leaves = motion_bounce(velocity, hit.normal, frame.restitution, frame.grip);
        // Half of the remaining exposure slows it down.
        let left = (0.5 * (frame.half_shutter - until)).max(0.0);
        let air = velocity + Vec3::Y * speed_of(self.speeds, motion_diameter(bits));
        let speed = speed_of(self.speeds, motion_diameter(bits) * frame.bounced_size);
        let slowed = motion_relax(leaves, air, speed, left).velocity;
        let mut count = step_count(place.word);
        if self.is_open() {
            let steps = ((until + frame.after) * frame.per_second).max(0.0) as u32;
            count = frame.step.wrapping_add(steps) & STEP_COUNT;
        }
        let word = step_word(bits, STEP_BOUNCED, count);
        self.step_list_seen(at - slowed * until, slowed, [number, word, last], [until, FIELD_ALWAYS])
    }

    /// True if a drop that falls onto a surface rebounds.
    fn step_list_bounces(&self, number: u32, word: u32, last: u32) -> bool {
        let count = step_count(word);
        let key =
            if self.is_open() { [word & STEP_DIAMETER | count << STEP_KIND, last] } else { [number, count] };
        step_kind(word) == STEP_FALLING && bounces(self.frame.seed, key, self.frame.bounce)
    }

    /// A drop, its rebounding droplet and the crown of its splash, as the picture shows them; their diameters are 0 where it does not.
    pub(crate) fn step_list_drop(&self, number: u32, drop: &StepDrop) -> [EyeDrop; 3] {
        let nothing = EyeDrop::default();
        let kind = drop.kind();
        if kind != STEP_FALLING && kind != STEP_BOUNCED {
            return [nothing; 3];
        }
        let place = self.step_list_place(number, drop);
        if step_kind(place.word) == STEP_HIDDEN {
            return [nothing; 3];
        }
        let velocity = Vec3::from(drop.velocity);
        let seen = self.step_list_seen(place.position, velocity, [number, place.word, drop.last], ALWAYS);
        let shown = self.step_list_shown(&seen);
        let is_shown = shown.diameter > 0.0;
        // A picture may show the crown of a drop that it would not show behind the surface.
        let Some(map) = self.map.filter(|_| is_shown || self.splash.strength > 0.0) else {
            return [shown, nothing, nothing];
        };
        let (after, half_time) = (self.frame.after, self.frame.half_shutter);
        let start = place.position - velocity * after;
        let Some(hit) = map.find(start, place.position + velocity * half_time) else {
            return [shown, nothing, nothing];
        };
        let until = hit.fraction * (after + half_time) - after;
        let falling = EyeDrop { present: [-FIELD_ALWAYS, until], ..seen };
        let [mut itself, mut rebound, mut crown] = [nothing; 3];
        if is_shown {
            itself = self.step_list_shown(&falling);
        }
        let on_surface = hit.kind == COLLISION_SURFACE;
        if on_surface && step_kind(place.word) == STEP_FALLING {
            crown = self.splash.splash_crown(&falling, hit.normal).unwrap_or(nothing);
        }
        if is_shown && on_surface && self.step_list_bounces(number, place.word, drop.last) {
            let droplet = self.step_list_rebound(&place, velocity, [number, drop.last], &hit, until);
            rebound = self.step_list_shown(&droplet);
        }
        [itself, rebound, crown]
    }
}

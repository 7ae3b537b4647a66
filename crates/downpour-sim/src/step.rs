//! One step of every drop: Algorithm 1 of Rousseau 2008. Twin of `shaders/wgsl/sim/step.wgsl`.
//!
//! A drop that meets a surface bounces or goes on unseen, at its speed, until it leaves the volume: what comes back on the
//! other side is open rain again if nothing stands above it. So nothing is lost and nothing born, and the rain in the open
//! keeps its density.

use bytemuck::{Pod, Zeroable};
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_shaders::sim::collision::COLLISION_SURFACE;
use downpour_shaders::sim::step::{
    STEP_AREA, STEP_BACKS, STEP_BOUNCED, STEP_CHANCE, STEP_CLEAR, STEP_DIAMETER, STEP_EVENT_KIND,
    STEP_FALLING, STEP_GAUGE_PER_CUBE, STEP_HIDDEN, STEP_KIND, STEP_TOP, STEP_TRIES, STEP_VOLUME_AREA,
    STEP_VOLUME_BOX, STEP_VOLUME_TARIQ, STEP_VOLUME_VIEW,
};
use downpour_wind::WindField;
use glam::{Vec2, Vec3, Vec3Swizzles as _};

use crate::collision::CollisionMap;
use crate::motion::{
    motion_average, motion_bounce, motion_diameter, motion_relax, motion_settled, motion_table_entry,
    motion_table_speed,
};
use crate::volume::{
    VolumeBack, VolumeEye, volume_back, volume_in_area, volume_in_sphere, volume_in_view, volume_local,
    volume_offset, volume_on_disc, volume_wrap,
};

/// What all drops share in a step. The same layout as `StepFrame` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct StepFrame {
    /// The eye before the step, relative to the origin of that time.
    pub before: VolumeEye,
    /// The eye after it, relative to the origin of now.
    pub now: VolumeEye,
    /// What the origin has moved, m; in a box, up to whole boxes.
    pub shift: [f32; 3],
    /// Drops of this dispatch.
    pub count: u32,
    /// Edges of a box; radius, height and unused of a cylinder. m.
    pub size: [f32; 3],
    /// Number of the first drop.
    pub first: u32,
    /// Middle of a box or cylinder, m.
    pub centre: [f32; 3],
    /// One of `STEP_VOLUME_*`.
    pub volume: u32,
    /// Wind where there is no field, m/s.
    pub wind: [f32; 3],
    /// Duration, s.
    pub time: f32,
    /// Low and high word.
    pub seed: [u32; 2],
    /// Number of the step.
    pub step: u32,
    /// 1: the eye is elsewhere altogether; no drop has come from where it was.
    pub elsewhere: u32,
    /// Distance at which a drop is resolved, per diameter.
    pub range: f32,
    /// At most, m.
    pub farthest: f32,
    /// 1: drag as Rousseau 2008.
    pub average: u32,
    /// Events that the buffer holds.
    pub events: u32,
    /// Share of impacts that bounce.
    pub bounce: f32,
    /// Share of the speed along the normal that comes back.
    pub restitution: f32,
    /// Share of the rest that is lost.
    pub grip: f32,
    /// Diameter of a bounced drop in that of the falling one.
    pub bounced_size: f32,
    /// The longest time of a bounced drop, s.
    pub bounced_time: f32,
    /// Height of the gauge, m.
    pub gauge_height: f32,
    /// 1: there is a gauge.
    pub gauge: u32,
    /// Padding of the WGSL layout.
    pub unused: u32,
    /// The gauge's rectangle: lower x and z, upper x and z, m.
    pub gauge_area: [f32; 4],
    /// 1, 2, 4, ... steps back.
    pub back: [VolumeBack; STEP_BACKS as usize],
}

/// A drop between two steps: 32 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct StepDrop {
    /// m, relative to the origin.
    pub place: [f32; 3],
    /// Diameter in 16 bits, and kind.
    pub word: u32,
    /// m/s.
    pub velocity: [f32; 3],
    /// How long a bounced drop has been on its way, or how far an unseen one is behind, s.
    pub seconds: f32,
}

impl StepDrop {
    /// One of `STEP_FALLING`, `STEP_BOUNCED`, `STEP_HIDDEN`.
    #[must_use]
    pub fn kind(&self) -> u32 {
        self.word >> STEP_KIND
    }

    /// Diameter of the falling drop, m.
    #[must_use]
    pub fn diameter(&self) -> f32 {
        motion_diameter(self.word & STEP_DIAMETER)
    }
}

/// What is noted of an impact. The same layout as `StepEvent` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct StepEvent {
    /// m, relative to the origin.
    pub place: [f32; 3],
    /// m.
    pub diameter: f32,
    /// m/s, before the impact.
    pub velocity: [f32; 3],
    /// Number of the drop, and in the highest two bits how it met what.
    pub drop: u32,
}

/// What went through the gauge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StepCaught {
    /// Drops.
    pub drops: u64,
    /// Their volume in units of 1e-13 m^3.
    pub volume: u64,
}

/// What a step reads beside its drops.
#[derive(Clone, Copy, Debug)]
pub struct StepWorld<'a> {
    /// What all drops share.
    pub frame: &'a StepFrame,
    /// Terminal speeds ([`crate::motion::motion_table`]).
    pub speeds: &'a [f32],
    /// The wind; `None`: that of the frame, everywhere.
    pub field: Option<&'a WindField>,
    /// What stops drops; `None`: nothing does.
    pub map: Option<&'a CollisionMap>,
}

/// What became of a drop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepMade {
    /// The drop after the step.
    pub drop: StepDrop,
    /// Its impact.
    pub event: Option<StepEvent>,
    /// The volume that went through the gauge, in its units.
    pub caught: Option<u32>,
}

/// The diameter that a drop shows: a bounced one is smaller.
#[must_use]
pub fn step_shown(word: u32, bounced_size: f32) -> f32 {
    let diameter = motion_diameter(word & STEP_DIAMETER);
    if word >> STEP_KIND == STEP_BOUNCED { diameter * bounced_size } else { diameter }
}

/// The volume of a drop in units of the gauge.
#[must_use]
pub fn step_measure(diameter: f32) -> u32 {
    (STEP_GAUGE_PER_CUBE * diameter * diameter * diameter + 0.5) as u32
}

impl StepWorld<'_> {
    /// Terminal speed of a diameter.
    fn step_speed(&self, diameter: f32) -> f32 {
        let entry = motion_table_entry(diameter) as usize;
        let at = |k: usize| self.speeds.get(k).copied().unwrap_or(0.0);
        motion_table_speed(at(entry), at(entry + 1), diameter)
    }

    /// The wind at a place.
    fn step_wind(&self, at: Vec3) -> Vec3 {
        self.field.map_or(Vec3::from(self.frame.wind), |field| field.sample(at))
    }

    /// Whether a fall from `high` to `low` goes through the gauge.
    fn step_through(&self, high: Vec3, low: Vec3) -> bool {
        let frame = self.frame;
        if frame.gauge == 0 || high.y < frame.gauge_height || low.y >= frame.gauge_height {
            return false;
        }
        let share = (high.y - frame.gauge_height) / (high.y - low.y);
        let at = high + (low - high) * share;
        let [left, front, right, back] = frame.gauge_area;
        at.x >= left && at.z >= front && at.x < right && at.z < back
    }

    /// Where the path that leads to a place in view came into view.
    fn step_entry(&self, local: Vec3, way: Vec3, range: f32) -> Vec3 {
        self.frame.back.iter().rev().fold(local, |found, back| {
            let earlier = volume_back(back, found, way);
            if volume_in_view(&self.frame.now, earlier, range) { earlier } else { found }
        })
    }

    /// A place of the rain area of Im & Sung.
    fn step_area(&self, drop: u32) -> Vec3 {
        let frame = self.frame;
        let tries = (0..STEP_TRIES).map(|k| {
            let [x, y, z, _] = rng_draw(frame.seed, drop, frame.step, STEP_AREA + k).map(rng_unit);
            volume_in_sphere(Vec3::new(x, y, z), frame.farthest)
        });
        tries
            .into_iter()
            .find(|&local| volume_in_area(&frame.now, local, frame.farthest))
            .unwrap_or(Vec3::new(0.0, 0.0, 0.5 * frame.farthest))
    }

    /// Where a drop is that moved from `before` (relative to the origin then) to `place`.
    fn step_relocate(&self, drop: u32, word: u32, before: Vec3, place: Vec3, displacement: Vec3) -> Vec3 {
        let frame = self.frame;
        let (eye, eye_place) = (&frame.now, Vec3::from(frame.now.place));
        let (centre, size) = (Vec3::from(frame.centre), Vec3::from(frame.size));
        match frame.volume {
            STEP_VOLUME_BOX => volume_wrap(place, centre, size),
            STEP_VOLUME_VIEW => {
                let range = (motion_diameter(word & STEP_DIAMETER) * frame.range).min(frame.farthest);
                if volume_in_view(eye, volume_local(eye, place - eye_place), range) {
                    return place;
                }
                let eye_before = Vec3::from(frame.before.place);
                let local = volume_local(&frame.before, before - eye_before);
                // What the drop would have moved in the picture if it had been at the eye.
                let way = volume_local(eye, eye_before - Vec3::from(frame.shift) + displacement - eye_place);
                eye_place + volume_offset(eye, self.step_entry(local, way, range))
            }
            STEP_VOLUME_AREA => {
                if volume_in_area(eye, volume_local(eye, place - eye_place), frame.farthest) {
                    return place;
                }
                eye_place + volume_offset(eye, self.step_area(drop))
            }
            _ => {
                let [x, y, ..] = rng_draw(frame.seed, drop, frame.step, STEP_TOP).map(rng_unit);
                let random = Vec2::new(x, y);
                let offset = place - centre;
                let half = 0.5 * size.y;
                if frame.volume == STEP_VOLUME_TARIQ {
                    if offset.y >= -half {
                        return place;
                    }
                    let across = (random - 0.5) * size.xz();
                    return centre + Vec3::new(across.x, offset.y + size.y, across.y);
                }
                let radius = size.x;
                if offset.y >= -half && offset.xz().dot(offset.xz()) <= radius * radius {
                    return place;
                }
                let disc = radius * volume_on_disc(random);
                let height = offset.y + if offset.y < -half { size.y } else { 0.0 };
                centre + Vec3::new(disc.x, height, disc.y)
            }
        }
    }

    /// A step of the drop with number `drop`.
    #[must_use]
    pub fn step(&self, drop: u32, stored: &StepDrop) -> StepMade {
        let frame = self.frame;
        let before = Vec3::from(stored.place);
        let from_place = before - Vec3::from(frame.shift);
        let (word, mut kind) = (stored.word, stored.kind());
        let (mut velocity, mut seconds) = (Vec3::from(stored.velocity), stored.seconds);
        let diameter = step_shown(word, frame.bounced_size);
        let speed = self.step_speed(diameter);

        // Next velocity and place.
        let wind = self.step_wind(from_place + velocity * (0.5 * frame.time));
        let moved = if frame.average == 1 {
            motion_average(velocity, wind, speed, frame.time)
        } else {
            motion_relax(velocity, wind, speed, frame.time)
        };
        velocity = moved.velocity;
        let mut displacement = moved.displacement;
        if kind == STEP_BOUNCED {
            seconds += frame.time;
        } else if seconds > 0.0 {
            // It catches up with the rain that it would have been.
            let late = seconds.min(frame.time);
            displacement += motion_settled(wind, speed) * late;
            seconds -= late;
        }
        let mut place = from_place + displacement;

        // What stands in its way.
        let mut event = None;
        if let Some(map) = self.map {
            if kind != STEP_HIDDEN
                && frame.elsewhere == 0
                && let Some(hit) = map.find(from_place, place)
            {
                let at = from_place + displacement * hit.share;
                let how = hit.kind - 1 + if kind == STEP_BOUNCED { 2 } else { 0 };
                event = Some(StepEvent {
                    place: at.to_array(),
                    diameter,
                    velocity: velocity.to_array(),
                    drop: drop | how << STEP_EVENT_KIND,
                });
                let [chance, ..] = rng_draw(frame.seed, drop, frame.step, STEP_CHANCE).map(rng_unit);
                if kind == STEP_FALLING && hit.kind == COLLISION_SURFACE && chance < frame.bounce {
                    kind = STEP_BOUNCED;
                    velocity = motion_bounce(velocity, hit.normal, frame.restitution, frame.grip);
                    place = at + hit.normal * STEP_CLEAR;
                    seconds = 0.0;
                } else {
                    kind = STEP_HIDDEN;
                }
            }
            if kind == STEP_BOUNCED && seconds > frame.bounced_time {
                kind = STEP_HIDDEN;
            }
        }
        let caught = kind == STEP_FALLING && self.step_through(from_place, place);

        // What has left the volume.
        let kept = self.step_relocate(drop, word, before, place, displacement);
        if kept != place || frame.elsewhere == 1 {
            place = kept;
            seconds = 0.0;
            let open = self.map.is_none_or(|map| map.open(place));
            kind = if open { STEP_FALLING } else { STEP_HIDDEN };
            let speed = self.step_speed(motion_diameter(word & STEP_DIAMETER));
            velocity = motion_settled(self.step_wind(place), speed);
        }
        StepMade {
            drop: StepDrop {
                place: place.to_array(),
                word: word & STEP_DIAMETER | kind << STEP_KIND,
                velocity: velocity.to_array(),
                seconds,
            },
            event,
            caught: caught.then(|| step_measure(diameter)),
        }
    }
}

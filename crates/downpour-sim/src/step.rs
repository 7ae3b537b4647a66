//! One step of every drop: Algorithm 1 of Rousseau 2008. Twin of `shaders/wgsl/sim/step.wgsl`.
//!
//! In a frustum a drop that meets a surface bounces or is gone, and so is one that leaves; others come in
//! ([`crate::enter`]). The other volumes keep their number of drops: one that meets a surface bounces or goes on unseen, at
//! its speed, until it leaves the volume and comes in elsewhere, where it is open rain again if nothing stands above it.

use bytemuck::{Pod, Zeroable};
use downpour_drop::fall_speed::fall_speed_relaxation;
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_shaders::sim::collision::COLLISION_SURFACE;
use downpour_shaders::sim::enter::ENTER_SIZES;
use downpour_shaders::sim::step::{
    STEP_AGO_1, STEP_AGO_2, STEP_AREA, STEP_BOUNCED, STEP_CHANCE, STEP_CLEAR, STEP_COLUMN, STEP_COUNT,
    STEP_COUNT_SHIFT, STEP_DIAMETER, STEP_EVENT_KIND, STEP_FALLING, STEP_GAUGE_PER_CUBE, STEP_GONE,
    STEP_HIDDEN, STEP_IMAGE_X, STEP_IMAGE_Y, STEP_IMAGE_Z, STEP_KIND, STEP_LAGS, STEP_TOP, STEP_TRIES,
    STEP_VOLUME_AREA, STEP_VOLUME_BOX, STEP_VOLUME_TARIQ, STEP_WEIGHT_1, STEP_WEIGHT_2, VOLUME_INSIDE,
    VOLUME_PLANES,
};
use downpour_wind::WindField;
use glam::{Vec2, Vec3, Vec3Swizzles as _, Vec4, Vec4Swizzles as _};

use crate::collision::CollisionMap;
use crate::motion::{
    motion_average, motion_bounce, motion_diameter, motion_relax, motion_settled, motion_table_entry,
    motion_table_speed,
};
use crate::region::EnterRegion;
use crate::volume::{
    VolumeEye, VolumeFrustum, volume_images, volume_in_area, volume_in_sphere, volume_limit, volume_local,
    volume_offset, volume_on_disc,
};

/// What all drops share in a step. The same layout as `StepFrame` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct StepFrame {
    /// The eye after the step.
    pub now: VolumeEye,
    /// What the origin has moved, m; in a box, up to whole boxes.
    pub shift: [f32; 3],
    /// Drops of this dispatch, or slots.
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
    /// The rain area of Im & Sung ends so far from the eye, m.
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
    /// Boxes by which the origin has moved and `shift` does not say, as [`step_pack`] has them.
    pub boxes: u32,
    /// Padding of the WGSL layout.
    pub unused_1: u32,
    /// The gauge's rectangle: lower x and z, upper x and z, m.
    pub gauge_area: [f32; 4],
    /// The frustum after the step.
    pub frustum: VolumeFrustum,
    /// The frustum before the step, relative to the origin of now.
    pub frustum_before: VolumeFrustum,
    /// A direction in each plane of the frustum before the step.
    pub tangents: [[f32; 4]; VOLUME_PLANES as usize],
    /// By how much drops lag behind the uniform part of the wind, m/s, by their terminal speed.
    pub lags: [[f32; 4]; STEP_LAGS as usize],
    /// Steps after which a drop of a frustum is gone.
    pub oldest: u32,
    /// Candidates that may come in.
    pub candidates: u32,
    /// Their regions.
    pub regions: u32,
    /// First word of the regions in the tables.
    pub regions_first: u32,
    /// First word of the bins' sizes in the tables.
    pub sizes_first: u32,
    /// Pieces that the drops are in.
    pub pieces: u32,
    /// Number of this piece.
    pub piece: u32,
    /// Padding of the WGSL layout.
    pub unused_2: u32,
}

/// A drop between two steps: 32 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct StepDrop {
    /// m, relative to the origin.
    pub place: [f32; 3],
    /// Diameter in 16 bits, kind, and count.
    pub word: u32,
    /// m/s.
    pub velocity: [f32; 3],
    /// In a frustum the number of the step in which it came. In other volumes the bits of the seconds that a bounced drop has
    /// been on its way, or an unseen one is behind.
    pub last: u32,
}

impl StepDrop {
    /// One of `STEP_FALLING`, `STEP_BOUNCED`, `STEP_HIDDEN`, `STEP_GONE`.
    #[must_use]
    pub fn kind(&self) -> u32 {
        step_kind(self.word)
    }

    /// Diameter of the falling drop, m.
    #[must_use]
    pub fn diameter(&self) -> f32 {
        motion_diameter(self.word & STEP_DIAMETER)
    }
}

/// A drop on its way through a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StepFlight {
    pub(crate) place: Vec3,
    pub(crate) kind: u32,
    pub(crate) velocity: Vec3,
    pub(crate) seconds: f32,
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
    /// Number of the drop (in a frustum its diameter and count), and in the highest two bits how it met what.
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
    /// Quantiles of the diameters of each bin, in steps of the 16 bits.
    pub sizes: &'a [[f32; ENTER_SIZES as usize]],
    /// Regions of what comes into a frustum, and one that marks their end.
    pub regions: &'a [EnterRegion],
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

/// Kind of a drop.
#[must_use]
pub fn step_kind(word: u32) -> u32 {
    (word >> STEP_KIND) & 3
}

/// Count of a drop: in a frustum its number among those that came with it, or the step in which it bounced; in a box the image
/// of the box that it is in; else how often it has come in.
#[must_use]
pub fn step_count(word: u32) -> u32 {
    word >> STEP_COUNT_SHIFT
}

/// A drop's word.
#[must_use]
pub fn step_word(diameter: u32, kind: u32, count: u32) -> u32 {
    diameter | kind << STEP_KIND | count << STEP_COUNT_SHIFT
}

/// The diameter that a drop shows: a bounced one is smaller.
#[must_use]
pub fn step_shown(word: u32, bounced_size: f32) -> f32 {
    let diameter = motion_diameter(word & STEP_DIAMETER);
    if step_kind(word) == STEP_BOUNCED { diameter * bounced_size } else { diameter }
}

/// Images of a box, in the bits of a count.
#[must_use]
pub fn step_pack(images: Vec3) -> u32 {
    let [x, y, z] = images.to_array().map(|image| image as i32 as u32);
    y & STEP_IMAGE_Y | (x & 7) << STEP_IMAGE_X | (z & 7) << STEP_IMAGE_Z
}

/// The image of a box that is some images away.
#[must_use]
pub fn step_image(count: u32, away: u32) -> u32 {
    let x = ((count >> STEP_IMAGE_X) + (away >> STEP_IMAGE_X)) & 7;
    let z = ((count >> STEP_IMAGE_Z) + (away >> STEP_IMAGE_Z)) & 7;
    count.wrapping_add(away) & STEP_IMAGE_Y | x << STEP_IMAGE_X | z << STEP_IMAGE_Z
}

/// Where the column of a drop of a box stands in the image of the box with a number, m along x and z.
#[must_use]
pub fn step_column(seed: [u32; 2], drop: u32, count: u32, size: Vec3) -> Vec2 {
    let [x, z, ..] = rng_draw(seed, drop, count & STEP_IMAGE_Y, STEP_COLUMN).map(rng_unit);
    Vec2::new(x, z) * size.xz()
}

/// The volume of a drop in units of the gauge.
#[must_use]
pub fn step_measure(diameter: f32) -> u32 {
    (STEP_GAUGE_PER_CUBE * diameter * diameter * diameter + 0.5) as u32
}

impl StepWorld<'_> {
    /// Terminal speed of a diameter.
    pub(crate) fn step_speed(&self, diameter: f32) -> f32 {
        let entry = motion_table_entry(diameter) as usize;
        let at = |k: usize| self.speeds.get(k).copied().unwrap_or(0.0);
        motion_table_speed(at(entry), at(entry + 1), diameter)
    }

    /// The wind at a place.
    pub(crate) fn step_wind(&self, at: Vec3) -> Vec3 {
        self.field.map_or(Vec3::from(self.frame.wind), |field| field.sample(at))
    }

    /// Velocity of a drop that comes to a place from the rain around: what it keeps of the wind on its way.
    pub(crate) fn step_coming(&self, at: Vec3, speed: f32) -> Vec3 {
        let wind = self.step_wind(at);
        let mut kept = wind;
        if self.field.is_some() {
            let way = motion_settled(wind, speed) * fall_speed_relaxation(speed)[1];
            let first = self.step_wind(at - way * STEP_AGO_1);
            kept = first * STEP_WEIGHT_1 + self.step_wind(at - way * STEP_AGO_2) * STEP_WEIGHT_2;
            // Along the fall it is forgotten twice as fast.
            kept.y = 0.5 * (wind.y + first.y);
        }
        let entry = (speed as u32).min(STEP_LAGS - 2) as usize;
        let lag = |entry: usize| Vec4::from(self.frame.lags[entry]).xyz();
        let lag = lag(entry).lerp(lag(entry + 1), speed - entry as f32);
        motion_settled(kept + lag, speed)
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

    /// What becomes of a drop within the time of a step, and what happens to it. `key` says who it is.
    pub(crate) fn step_fly(
        &self,
        key: [u32; 2],
        number: u32,
        word: u32,
        flight: &StepFlight,
    ) -> (StepFlight, Option<StepEvent>, Option<u32>) {
        let frame = self.frame;
        let StepFlight { place: from_place, mut kind, mut velocity, mut seconds } = *flight;
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
        if kind == STEP_HIDDEN && seconds > 0.0 {
            // It catches up with the rain that it would have been.
            let late = seconds.min(frame.time);
            displacement += motion_settled(wind, speed) * late;
            seconds -= late;
        }
        let mut place = from_place + displacement;

        // What stands in its way.
        let mut event = None;
        if let Some(map) = self.map
            && kind != STEP_HIDDEN
            && frame.elsewhere == 0
            && let Some(hit) = map.find(from_place, place)
        {
            let at = from_place + displacement * hit.share;
            let how = hit.kind - 1 + if kind == STEP_BOUNCED { 2 } else { 0 };
            event = Some(StepEvent {
                place: at.to_array(),
                diameter,
                velocity: velocity.to_array(),
                drop: number | how << STEP_EVENT_KIND,
            });
            if kind == STEP_FALLING && hit.kind == COLLISION_SURFACE && self.step_bounces(key) {
                kind = STEP_BOUNCED;
                velocity = motion_bounce(velocity, hit.normal, frame.restitution, frame.grip);
                place = at + hit.normal * STEP_CLEAR;
                seconds = 0.0;
            } else {
                kind = STEP_HIDDEN;
            }
        }
        let caught = kind == STEP_FALLING && self.step_through(from_place, place);
        (StepFlight { place, kind, velocity, seconds }, event, caught.then(|| step_measure(diameter)))
    }

    /// Whether the drop of a key comes back from a surface.
    fn step_bounces(&self, key: [u32; 2]) -> bool {
        bounces(self.frame.seed, key, self.frame.bounce)
    }

    /// Whether a drop is in the frustum after the step: where it will be in the middle of the horizon.
    fn step_inside(&self, place: Vec3, velocity: Vec3, diameter: f32) -> bool {
        let frustum = &self.frame.frustum;
        let offset = place + velocity * frustum.half_horizon - Vec3::from(frustum.eye);
        volume_limit(frustum, offset, diameter, self.step_speed(diameter)) == VOLUME_INSIDE
    }

    /// A step of a drop of a frustum, whose position is relative to the origin after the step.
    #[must_use]
    pub fn step_view(&self, drop: &StepDrop) -> StepMade {
        let frame = self.frame;
        let (kind, bits) = (drop.kind(), drop.word & STEP_DIAMETER);
        let mut count = step_count(drop.word);
        let number = bits | count << STEP_KIND;
        let start =
            StepFlight { place: drop.place.into(), kind, velocity: drop.velocity.into(), seconds: 0.0 };
        let (flight, event, caught) = self.step_fly([number, drop.last], number, drop.word, &start);
        let mut then = flight.kind;
        if then == STEP_BOUNCED {
            if kind == STEP_FALLING {
                count = frame.step & STEP_COUNT;
            } else if (frame.step.wrapping_sub(count) & STEP_COUNT) as f32 * frame.time > frame.bounced_time {
                then = STEP_HIDDEN;
            }
        }
        let old = frame.step.wrapping_sub(drop.last) > frame.oldest;
        if then == STEP_HIDDEN
            || old
            || !self.step_inside(flight.place, flight.velocity, motion_diameter(bits))
        {
            then = STEP_GONE;
        }
        let drop = StepDrop {
            place: flight.place.to_array(),
            word: step_word(bits, then, count),
            velocity: flight.velocity.to_array(),
            last: drop.last,
        };
        StepMade { drop, event, caught }
    }

    /// A drop of a frustum that is filled anew, of which the position is known where it will be in the middle of the horizon.
    pub(crate) fn step_begin(&self, drop: &StepDrop) -> StepDrop {
        let bits = drop.word & STEP_DIAMETER;
        let velocity = self.step_coming(drop.place.into(), self.step_speed(motion_diameter(bits)));
        let place = Vec3::from(drop.place) - velocity * self.frame.frustum.half_horizon;
        let open = self.map.is_none_or(|map| map.open(place));
        StepDrop {
            place: place.to_array(),
            word: step_word(bits, if open { STEP_FALLING } else { STEP_GONE }, step_count(drop.word)),
            velocity: velocity.to_array(),
            last: drop.last,
        }
    }

    /// Where a drop is that came to `place`, and its count, which changes where it has come in anew.
    pub(crate) fn step_relocate(&self, drop: u32, count: u32, place: Vec3) -> (Vec3, u32) {
        let frame = self.frame;
        let (eye, eye_place) = (&frame.now, Vec3::from(frame.now.place));
        let (centre, size) = (Vec3::from(frame.centre), Vec3::from(frame.size));
        let next = count.wrapping_add(1) & STEP_COUNT;
        match frame.volume {
            STEP_VOLUME_BOX => {
                let images = volume_images(place, centre, size);
                let kept = place - size * images;
                let image = step_image(step_image(count, step_pack(images)), frame.boxes);
                if (image ^ count) & STEP_IMAGE_Y == 0 {
                    return (kept, image);
                }
                // No drop keeps its column (Rousseau 2006, 7.3), and all boxes of one rain agree.
                let column =
                    step_column(frame.seed, drop, image, size) - step_column(frame.seed, drop, count, size);
                let moved = kept + Vec3::new(column.x, 0.0, column.y);
                let across = volume_images(moved, centre, size) * Vec3::new(1.0, 0.0, 1.0);
                (moved - size * across, step_image(image, step_pack(across)))
            }
            STEP_VOLUME_AREA => {
                if volume_in_area(eye, volume_local(eye, place - eye_place), frame.farthest) {
                    return (place, count);
                }
                (eye_place + volume_offset(eye, self.step_area(drop)), next)
            }
            _ => {
                let [x, y, ..] = rng_draw(frame.seed, drop, frame.step, STEP_TOP).map(rng_unit);
                let random = Vec2::new(x, y);
                let offset = place - centre;
                let half = 0.5 * size.y;
                if frame.volume == STEP_VOLUME_TARIQ {
                    if offset.y >= -half {
                        return (place, count);
                    }
                    let across = (random - 0.5) * size.xz();
                    return (centre + Vec3::new(across.x, offset.y + size.y, across.y), next);
                }
                let radius = size.x;
                if offset.y >= -half && offset.xz().dot(offset.xz()) <= radius * radius {
                    return (place, count);
                }
                let disc = radius * volume_on_disc(random);
                let height = offset.y + if offset.y < -half { size.y } else { 0.0 };
                (centre + Vec3::new(disc.x, height, disc.y), next)
            }
        }
    }

    /// A step of the drop with a number, of a volume that keeps its number of drops. Its position is relative to the origin
    /// after the step.
    #[must_use]
    pub fn step_slot(&self, number: u32, drop: &StepDrop) -> StepMade {
        let frame = self.frame;
        let bits = drop.word & STEP_DIAMETER;
        let count = step_count(drop.word);
        let mut seconds = f32::from_bits(drop.last);
        if drop.kind() == STEP_BOUNCED {
            seconds += frame.time;
        }
        let start = StepFlight {
            place: drop.place.into(),
            kind: drop.kind(),
            velocity: drop.velocity.into(),
            seconds,
        };
        let (flight, event, caught) = self.step_fly([number, count], number, drop.word, &start);
        let StepFlight { place, mut kind, mut velocity, mut seconds } = flight;
        if kind == STEP_BOUNCED && seconds > frame.bounced_time {
            kind = STEP_HIDDEN;
        }

        // What has left the volume.
        let (kept, count) = self.step_relocate(number, count, place);
        if kept != place || frame.elsewhere == 1 {
            seconds = 0.0;
            let open = self.map.is_none_or(|map| map.open(kept));
            kind = if open { STEP_FALLING } else { STEP_HIDDEN };
            velocity = motion_settled(self.step_wind(kept), self.step_speed(motion_diameter(bits)));
        }
        let drop = StepDrop {
            place: kept.to_array(),
            word: step_word(bits, kind, count),
            velocity: velocity.to_array(),
            last: seconds.to_bits(),
        };
        StepMade { drop, event, caught }
    }
}

/// Whether the drop of a key comes back from a surface, of which a share does.
pub(crate) fn bounces(seed: [u32; 2], key: [u32; 2], share: f32) -> bool {
    let [chance, ..] = rng_draw(seed, key[0], key[1], STEP_CHANCE).map(rng_unit);
    chance < share
}

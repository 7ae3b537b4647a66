//! One step of every drop: Algorithm 1 of Rousseau 2008. Twin of `shaders/wgsl/sim/step.wgsl`.
//!
//! In a frustum a drop that hits a surface bounces or is gone, and so is one that leaves; others enter
//! ([`crate::enter`]). The other volumes keep their number of drops: one that hits a surface bounces or continues
//! hidden, at its speed, until it leaves the volume and re-enters elsewhere, where it is visible again if nothing is
//! above it.

use bytemuck::{Pod, Zeroable};
use downpour_drop::fall_speed::fall_speed_relaxation;
use downpour_math::packing::{packing_octahedral_decode, packing_octahedral_encode};
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_shaders::sim::collision::COLLISION_SURFACE;
use downpour_shaders::sim::enter::ENTER_SIZES;
use downpour_shaders::sim::splash::SPLASH_LEVEL;
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
    volume_offset, volume_on_disk,
};

/// Parameters common to all drops of a step, in the layout of `StepFrame` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct StepFrame {
    /// Not read: a software driver makes the kernel again for each value of the first word of a block that it reads.
    pub unread: u32,
    /// Time from the beginning of `kept_span` to the step, s.
    pub kept_since: f32,
    /// Padding of the WGSL layout.
    pub unused_2: u32,
    /// Padding of the WGSL layout.
    pub unused_3: u32,
    /// The eye after the step.
    pub now: VolumeEye,
    /// Displacement of the origin, m; in a box, modulo whole boxes.
    pub shift: [f32; 3],
    /// Number of drops of this dispatch, or of slots.
    pub count: u32,
    /// Edges of a box; radius, height and unused of a cylinder. m.
    pub size: [f32; 3],
    /// Number of the first drop.
    pub first: u32,
    /// Center of a box or cylinder, m.
    pub center: [f32; 3],
    /// One of `STEP_VOLUME_*`.
    pub volume: u32,
    /// Wind without a field, m/s.
    pub wind: [f32; 3],
    /// Duration, s.
    pub time: f32,
    /// Seed: low and high word.
    pub seed: [u32; 2],
    /// Number of the step.
    pub step: u32,
    /// 1 after a jump of the eye: no drop of the old position is in view.
    pub elsewhere: u32,
    /// Radius of the rain area of Im & Sung around the eye, m.
    pub farthest: f32,
    /// 1 for the drag of Rousseau 2008.
    pub average: u32,
    /// Capacity of the event buffer.
    pub events: u32,
    /// Fraction of impacts that bounce.
    pub bounce: f32,
    /// Fraction of the normal speed that is reflected.
    pub restitution: f32,
    /// Fraction of the tangential speed that is lost.
    pub grip: f32,
    /// Diameter of a bounced drop relative to that of the falling one.
    pub bounced_size: f32,
    /// Maximum time of a bounced drop, s.
    pub bounced_time: f32,
    /// Height of the gauge, m.
    pub gauge_height: f32,
    /// 1 if there is a gauge.
    pub gauge: u32,
    /// Displacement of the origin in whole boxes, not included in `shift`, packed by [`step_pack`].
    pub boxes: u32,
    /// Room for the impacts of a span of time that are kept.
    pub kept_room: u32,
    /// Rectangle of the gauge: lower x and z, upper x and z, m.
    pub gauge_area: [f32; 4],
    /// The frustum after the step.
    pub frustum: VolumeFrustum,
    /// Frustum before the step, relative to the current origin.
    pub frustum_before: VolumeFrustum,
    /// Direction in each plane of the frustum before the step.
    pub tangents: [[f32; 4]; VOLUME_PLANES as usize],
    /// Lag of drops behind the uniform part of the wind, m/s, by their terminal speed.
    pub lags: [[f32; 4]; STEP_LAGS as usize],
    /// Number of steps after which a drop of a frustum is removed.
    pub oldest: u32,
    /// Number of candidates that may enter.
    pub candidates: u32,
    /// Number of their regions.
    pub regions: u32,
    /// Index of the first word of the regions in the tables.
    pub regions_first: u32,
    /// Index of the first word of the bins' sizes in the tables.
    pub sizes_first: u32,
    /// Number of pieces of the drops.
    pub pieces: u32,
    /// Index of this piece.
    pub piece: u32,
    /// Span of time whose impacts are kept with those of this step.
    pub kept_span: u32,
}

/// A drop between two steps: 32 bytes.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct StepDrop {
    /// Position, m, relative to the origin.
    pub position: [f32; 3],
    /// Diameter in 16 bits, kind, and count.
    pub word: u32,
    /// Velocity, m/s.
    pub velocity: [f32; 3],
    /// In a frustum the number of the step in which it entered. In other volumes the bits of a time in seconds: since
    /// the bounce of a bounced drop, or the delay of a hidden one.
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

/// A moving drop within a step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct StepFlight {
    pub(crate) position: Vec3,
    pub(crate) kind: u32,
    pub(crate) velocity: Vec3,
    pub(crate) seconds: f32,
}

/// Record of an impact, in the layout of `StepEvent` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable)]
pub struct StepEvent {
    /// Position, m, relative to the origin.
    pub position: [f32; 3],
    /// Diameter, m.
    pub diameter: f32,
    /// Velocity before the impact, m/s.
    pub velocity: [f32; 3],
    /// Number of the drop (in a frustum its diameter and count), and in the highest two bits the kind of drop and
    /// surface.
    pub drop: u32,
    /// Unit vector from the surface toward the side that the drop came from: octahedral ([`StepEvent::normal`]).
    pub normal: [f32; 2],
    /// Time from the beginning of the step to the impact, s; of an impact that is kept, from the beginning of its span.
    pub time: f32,
    /// With the number what the drop is known by: in a frustum the step in which it entered, else its count.
    pub last: u32,
}

impl StepEvent {
    /// Unit vector from the surface toward the side that the drop came from.
    #[must_use]
    pub fn normal(&self) -> Vec3 {
        packing_octahedral_decode(self.normal).into()
    }
}

/// True if an impact may make a splash: that of a drop that fell, on a surface that does not look down.
#[must_use]
pub fn step_splashes(event: &StepEvent) -> bool {
    event.drop >> STEP_EVENT_KIND == 0 && event.normal().y >= SPLASH_LEVEL
}

/// Rain through the gauge.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct StepCaught {
    /// Number of drops.
    pub drops: u64,
    /// Their volume in units of 1e-13 m^3.
    pub volume: u64,
}

/// Inputs of a step beside its drops.
#[derive(Clone, Copy, Debug)]
pub struct StepWorld<'a> {
    /// Parameters common to all drops.
    pub frame: &'a StepFrame,
    /// Terminal speeds ([`crate::motion::motion_table`]).
    pub speeds: &'a [f32],
    /// Quantiles of the diameters of each bin, in steps of the 16 bits.
    pub sizes: &'a [[f32; ENTER_SIZES as usize]],
    /// Regions of drops that enter a frustum, and one that marks their end.
    pub regions: &'a [EnterRegion],
    /// Wind field; `None`: the wind of the frame everywhere.
    pub field: Option<&'a WindField>,
    /// Collision map; `None`: no obstacles.
    pub map: Option<&'a CollisionMap>,
}

/// Result of a step for a drop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepMade {
    /// The drop after the step.
    pub drop: StepDrop,
    /// Its impact, if any.
    pub event: Option<StepEvent>,
    /// Volume through the gauge, in its units, if any.
    pub caught: Option<u32>,
}

/// Kind of a drop.
#[must_use]
pub fn step_kind(word: u32) -> u32 {
    (word >> STEP_KIND) & 3
}

/// Count of a drop: in a frustum its number among those that entered with it, or the step in which it bounced; in a
/// box the image of the box that it is in; else the number of its re-entries.
#[must_use]
pub fn step_count(word: u32) -> u32 {
    word >> STEP_COUNT_SHIFT
}

/// Word of a drop.
#[must_use]
pub fn step_word(diameter: u32, kind: u32, count: u32) -> u32 {
    diameter | kind << STEP_KIND | count << STEP_COUNT_SHIFT
}

/// Visible diameter of a drop: a bounced one is smaller.
#[must_use]
pub fn step_shown(word: u32, bounced_size: f32) -> f32 {
    let diameter = motion_diameter(word & STEP_DIAMETER);
    if step_kind(word) == STEP_BOUNCED { diameter * bounced_size } else { diameter }
}

/// Packs images of a box into the bits of a count.
#[must_use]
pub fn step_pack(images: Vec3) -> u32 {
    let [x, y, z] = images.to_array().map(|image| image as i32 as u32);
    y & STEP_IMAGE_Y | (x & 7) << STEP_IMAGE_X | (z & 7) << STEP_IMAGE_Z
}

/// Image of a box at an offset of some images.
#[must_use]
pub fn step_image(count: u32, away: u32) -> u32 {
    let x = ((count >> STEP_IMAGE_X) + (away >> STEP_IMAGE_X)) & 7;
    let z = ((count >> STEP_IMAGE_Z) + (away >> STEP_IMAGE_Z)) & 7;
    count.wrapping_add(away) & STEP_IMAGE_Y | x << STEP_IMAGE_X | z << STEP_IMAGE_Z
}

/// Position of the column of a drop in an image of the box, m along x and z.
#[must_use]
pub fn step_column(seed: [u32; 2], drop: u32, count: u32, size: Vec3) -> Vec2 {
    let [x, z, ..] = rng_draw(seed, drop, count & STEP_IMAGE_Y, STEP_COLUMN).map(rng_unit);
    Vec2::new(x, z) * size.xz()
}

/// Volume of a drop in units of the gauge.
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

    /// Wind at a position.
    pub(crate) fn step_wind(&self, at: Vec3) -> Vec3 {
        self.field.map_or(Vec3::from(self.frame.wind), |field| field.sample(at))
    }

    /// Velocity of a drop that arrives at a position from the surrounding rain: its relaxation to the wind on its path.
    pub(crate) fn step_coming(&self, at: Vec3, speed: f32) -> Vec3 {
        let wind = self.step_wind(at);
        let mut kept = wind;
        if self.field.is_some() {
            let way = motion_settled(wind, speed) * fall_speed_relaxation(speed)[1];
            let first = self.step_wind(at - way * STEP_AGO_1);
            kept = first * STEP_WEIGHT_1 + self.step_wind(at - way * STEP_AGO_2) * STEP_WEIGHT_2;
            // Along the fall it relaxes twice as fast.
            kept.y = 0.5 * (wind.y + first.y);
        }
        let entry = (speed as u32).min(STEP_LAGS - 2) as usize;
        let lag = |entry: usize| Vec4::from(self.frame.lags[entry]).xyz();
        let lag = lag(entry).lerp(lag(entry + 1), speed - entry as f32);
        motion_settled(kept + lag, speed)
    }

    /// True if a fall from `high` to `low` passes through the gauge.
    fn step_through(&self, high: Vec3, low: Vec3) -> bool {
        let frame = self.frame;
        if frame.gauge == 0 || high.y < frame.gauge_height || low.y >= frame.gauge_height {
            return false;
        }
        let fraction = (high.y - frame.gauge_height) / (high.y - low.y);
        let at = high + (low - high) * fraction;
        let [left, front, right, back] = frame.gauge_area;
        at.x >= left && at.z >= front && at.x < right && at.z < back
    }

    /// Random position in the rain area of Im & Sung.
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

    /// Moves a drop for the duration of a step; returns its new state and its events. `key` identifies the drop.
    pub(crate) fn step_fly(
        &self,
        key: [u32; 2],
        number: u32,
        word: u32,
        flight: &StepFlight,
    ) -> (StepFlight, Option<StepEvent>, Option<u32>) {
        let frame = self.frame;
        let StepFlight { position: from_position, mut kind, mut velocity, mut seconds } = *flight;
        let diameter = step_shown(word, frame.bounced_size);
        let speed = self.step_speed(diameter);

        // Next velocity and position.
        let wind = self.step_wind(from_position + velocity * (0.5 * frame.time));
        let moved = if frame.average == 1 {
            motion_average(velocity, wind, speed, frame.time)
        } else {
            motion_relax(velocity, wind, speed, frame.time)
        };
        velocity = moved.velocity;
        let mut displacement = moved.displacement;
        if kind == STEP_HIDDEN && seconds > 0.0 {
            // It catches up with the rain that it replaces.
            let late = seconds.min(frame.time);
            displacement += motion_settled(wind, speed) * late;
            seconds -= late;
        }
        let mut position = from_position + displacement;

        // Obstacles on its path.
        let mut event = None;
        if let Some(map) = self.map
            && kind != STEP_HIDDEN
            && frame.elsewhere == 0
            && let Some(hit) = map.find(from_position, position)
        {
            let at = from_position + displacement * hit.fraction;
            let how = hit.kind - 1 + if kind == STEP_BOUNCED { 2 } else { 0 };
            event = Some(StepEvent {
                position: at.to_array(),
                diameter,
                velocity: velocity.to_array(),
                drop: number | how << STEP_EVENT_KIND,
                normal: packing_octahedral_encode(hit.normal.to_array()),
                time: hit.fraction * frame.time,
                last: key[1],
            });
            if kind == STEP_FALLING && hit.kind == COLLISION_SURFACE && self.step_bounces(key) {
                kind = STEP_BOUNCED;
                velocity = motion_bounce(velocity, hit.normal, frame.restitution, frame.grip);
                position = at + hit.normal * STEP_CLEAR;
                seconds = 0.0;
            } else {
                kind = STEP_HIDDEN;
            }
        }
        let caught = kind == STEP_FALLING && self.step_through(from_position, position);
        (StepFlight { position, kind, velocity, seconds }, event, caught.then(|| step_measure(diameter)))
    }

    /// True if the drop of a key bounces from a surface.
    fn step_bounces(&self, key: [u32; 2]) -> bool {
        bounces(self.frame.seed, key, self.frame.bounce)
    }

    /// True if a drop is in the frustum after the step, by its position in the middle of the horizon.
    fn step_inside(&self, position: Vec3, velocity: Vec3, diameter: f32) -> bool {
        let frustum = &self.frame.frustum;
        let offset = position + velocity * frustum.half_horizon - Vec3::from(frustum.eye);
        volume_limit(frustum, offset, diameter, self.step_speed(diameter)) == VOLUME_INSIDE
    }

    /// Makes a step of a drop of a frustum, whose position is relative to the origin after the step.
    #[must_use]
    pub fn step_view(&self, drop: &StepDrop) -> StepMade {
        let frame = self.frame;
        let (kind, bits) = (drop.kind(), drop.word & STEP_DIAMETER);
        let mut count = step_count(drop.word);
        let number = bits | count << STEP_KIND;
        let start =
            StepFlight { position: drop.position.into(), kind, velocity: drop.velocity.into(), seconds: 0.0 };
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
            || !self.step_inside(flight.position, flight.velocity, motion_diameter(bits))
        {
            then = STEP_GONE;
        }
        let drop = StepDrop {
            position: flight.position.to_array(),
            word: step_word(bits, then, count),
            velocity: flight.velocity.to_array(),
            last: drop.last,
        };
        StepMade { drop, event, caught }
    }

    /// Initial state of a drop of a refilled frustum, from its position in the middle of the horizon.
    pub(crate) fn step_begin(&self, drop: &StepDrop) -> StepDrop {
        let bits = drop.word & STEP_DIAMETER;
        let velocity = self.step_coming(drop.position.into(), self.step_speed(motion_diameter(bits)));
        let position = Vec3::from(drop.position) - velocity * self.frame.frustum.half_horizon;
        let open = self.map.is_none_or(|map| map.open(position));
        StepDrop {
            position: position.to_array(),
            word: step_word(bits, if open { STEP_FALLING } else { STEP_GONE }, step_count(drop.word)),
            velocity: velocity.to_array(),
            last: drop.last,
        }
    }

    /// Wraps the position of a drop into the volume; returns it and its count, which changes on re-entry.
    pub(crate) fn step_relocate(&self, drop: u32, count: u32, position: Vec3) -> (Vec3, u32) {
        let frame = self.frame;
        let (eye, eye_position) = (&frame.now, Vec3::from(frame.now.position));
        let (center, size) = (Vec3::from(frame.center), Vec3::from(frame.size));
        let next = count.wrapping_add(1) & STEP_COUNT;
        match frame.volume {
            STEP_VOLUME_BOX => {
                let images = volume_images(position, center, size);
                let kept = position - size * images;
                let image = step_image(step_image(count, step_pack(images)), frame.boxes);
                if (image ^ count) & STEP_IMAGE_Y == 0 {
                    return (kept, image);
                }
                // No drop keeps its column (Rousseau 2006, 7.3), and all boxes of one rain agree.
                let column =
                    step_column(frame.seed, drop, image, size) - step_column(frame.seed, drop, count, size);
                let moved = kept + Vec3::new(column.x, 0.0, column.y);
                let across = volume_images(moved, center, size) * Vec3::new(1.0, 0.0, 1.0);
                (moved - size * across, step_image(image, step_pack(across)))
            }
            STEP_VOLUME_AREA => {
                if volume_in_area(eye, volume_local(eye, position - eye_position), frame.farthest) {
                    return (position, count);
                }
                (eye_position + volume_offset(eye, self.step_area(drop)), next)
            }
            _ => {
                let [x, y, ..] = rng_draw(frame.seed, drop, frame.step, STEP_TOP).map(rng_unit);
                let random = Vec2::new(x, y);
                let offset = position - center;
                let half = 0.5 * size.y;
                if frame.volume == STEP_VOLUME_TARIQ {
                    if offset.y >= -half {
                        return (position, count);
                    }
                    let across = (random - 0.5) * size.xz();
                    return (center + Vec3::new(across.x, offset.y + size.y, across.y), next);
                }
                let radius = size.x;
                if offset.y >= -half && offset.xz().dot(offset.xz()) <= radius * radius {
                    return (position, count);
                }
                let disk = radius * volume_on_disk(random);
                let height = offset.y + if offset.y < -half { size.y } else { 0.0 };
                (center + Vec3::new(disk.x, height, disk.y), next)
            }
        }
    }

    /// Makes a step of a drop, by its number, of a volume with a constant number of drops. Its position is relative to
    /// the origin after the step.
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
            position: drop.position.into(),
            kind: drop.kind(),
            velocity: drop.velocity.into(),
            seconds,
        };
        let (flight, event, caught) = self.step_fly([number, count], number, drop.word, &start);
        let StepFlight { position, mut kind, mut velocity, mut seconds } = flight;
        if kind == STEP_BOUNCED && seconds > frame.bounced_time {
            kind = STEP_HIDDEN;
        }

        // It may have left the volume.
        let (kept, count) = self.step_relocate(number, count, position);
        if kept != position || frame.elsewhere == 1 {
            seconds = 0.0;
            let open = self.map.is_none_or(|map| map.open(kept));
            kind = if open { STEP_FALLING } else { STEP_HIDDEN };
            velocity = motion_settled(self.step_wind(kept), self.step_speed(motion_diameter(bits)));
        }
        let drop = StepDrop {
            position: kept.to_array(),
            word: step_word(bits, kind, count),
            velocity: velocity.to_array(),
            last: seconds.to_bits(),
        };
        StepMade { drop, event, caught }
    }
}

/// True if the drop of a key bounces from a surface, for a fraction of bouncing impacts.
pub(crate) fn bounces(seed: [u32; 2], key: [u32; 2], fraction: f32) -> bool {
    let [chance, ..] = rng_draw(seed, key[0], key[1], STEP_CHANCE).map(rng_unit);
    chance < fraction
}

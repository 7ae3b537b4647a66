//! Ground that is taken: ways to doors, parked cars, and what stands on the pavements.
//!
//! Whatever is put into a street asks here first, so that no two things stand in each other, people can walk between them, and
//! nothing stands before a door.

/// Sorts of taken ground, which keep different distances from each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Use {
    /// The way from a door to the curb.
    Doorway,
    /// A parked car.
    Car,
    /// A lamp post.
    Lamp,
    /// A tree in its grate, which one can walk on.
    Tree,
    /// Something at the curb: a bollard, a bin, a sign.
    Curb,
    /// Something before the houses: a bench, a table, a bicycle, a tub.
    Front,
}

/// Width that stays free for walking between curb and houses, meters.
const PASSAGE_M: f32 = 0.8;

/// Distance that two sorts keep from each other, meters.
fn clearance_m(a: Use, b: Use) -> f32 {
    match (a, b) {
        // A way is as wide as one needs, and cars keep their distance from the curb.
        (Use::Doorway | Use::Car, _) | (_, Use::Doorway | Use::Car) => 0.0,
        // A crown is 1.5 m wide on each side: it does not reach into a lantern or another crown.
        (Use::Tree, Use::Lamp) | (Use::Lamp, Use::Tree) => 1.2,
        (Use::Tree, Use::Tree) => 1.8,
        (Use::Tree, Use::Front) | (Use::Front, Use::Tree) => 0.1,
        (Use::Front, Use::Front) => 0.25,
        (Use::Front, _) | (_, Use::Front) => PASSAGE_M,
        _ => 0.45,
    }
}

/// A rectangle of ground along the axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Footprint {
    pub(super) sort: Use,
    /// x and z of its middle, meters.
    pub(super) center_m: [f32; 2],
    /// Half its edges along x and z, meters.
    pub(super) half_size_m: [f32; 2],
}

impl Footprint {
    pub(super) fn new(sort: Use, center_m: [f32; 2], half_size_m: [f32; 2]) -> Self {
        Self { sort, center_m, half_size_m }
    }

    /// The same ground elsewhere along the street.
    fn at(self, z: f32) -> Self {
        Self { center_m: [self.center_m[0], z], ..self }
    }

    /// True if two of them are nearer to each other than their sorts may be.
    fn conflicts(&self, other: &Self) -> bool {
        let clearance = clearance_m(self.sort, other.sort);
        (0..2).all(|axis| {
            let between = (self.center_m[axis] - other.center_m[axis]).abs();
            between < self.half_size_m[axis] + other.half_size_m[axis] + clearance
        })
    }
}

/// Ground that is taken.
#[derive(Clone, Debug)]
pub(super) struct Occupancy {
    /// z of the ends of the straight curb, meters, the lower one first.
    ends: [f32; 2],
    taken: Vec<Footprint>,
}

impl Occupancy {
    /// Nothing is taken yet between two ends along z, the lower one first.
    pub(super) fn new(ends: [f32; 2]) -> Self {
        Self { ends, taken: Vec::new() }
    }

    /// Takes ground, free or not.
    pub(super) fn take(&mut self, footprint: Footprint) {
        self.taken.push(footprint);
    }

    /// Takes ground if it is free; returns true if it was.
    pub(super) fn take_free(&mut self, footprint: Footprint) -> bool {
        let is_free = self.is_free(&footprint);
        if is_free {
            self.take(footprint);
        }
        is_free
    }

    /// Takes the nearest free ground along the street, no farther than `reach_m` away. Returns its z, or `None` if none is free.
    pub(super) fn settle(&mut self, footprint: Footprint, reach_m: f32) -> Option<f32> {
        const STEP_M: f32 = 0.1;
        let steps = (reach_m / STEP_M) as i32;
        let shifts = (0..=steps).flat_map(|k| [k as f32 * STEP_M, k as f32 * -STEP_M]);
        let mut candidates = shifts.map(|shift| footprint.at(footprint.center_m[1] + shift));
        let found = candidates.find(|candidate| self.is_free(candidate))?;
        self.take(found);
        Some(found.center_m[1])
    }

    fn is_free(&self, footprint: &Footprint) -> bool {
        let ([_, z], [_, half]) = (footprint.center_m, footprint.half_size_m);
        let is_inside = z - half >= self.ends[0] && z + half <= self.ends[1];
        is_inside && !self.taken.iter().any(|other| other.conflicts(footprint))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bollard(z: f32) -> Footprint {
        Footprint::new(Use::Curb, [3.5, z], [0.1; 2])
    }

    #[test]
    fn taken_ground_is_not_given_twice() {
        let mut ground = Occupancy::new([-20.0, 0.0]);
        assert!(ground.take_free(bollard(-5.0)));
        assert!(!ground.take_free(bollard(-5.1)));
        assert!(ground.take_free(bollard(-6.0)));
        // There is no room between the two: it moves past one of them, to 0.65 m from its middle.
        let z = ground.settle(bollard(-5.4), 1.5).expect("free ground");
        assert!((z + 4.3).abs() < 0.06 || (z + 6.7).abs() < 0.06, "{z}");
        assert_eq!(ground.settle(bollard(-5.4), 0.5), None);
        // None beyond the ends, and the other pavement is free.
        assert!(!ground.take_free(bollard(-0.05)) && !ground.take_free(bollard(-20.0)));
        assert!(ground.take_free(Footprint::new(Use::Curb, [-3.5, -5.0], [0.1; 2])));
    }

    #[test]
    fn one_can_walk_between_curb_and_houses() {
        let mut ground = Occupancy::new([-20.0, 0.0]);
        ground.take(bollard(-5.0));
        let bench = |x: f32| Footprint::new(Use::Front, [x, -5.0], [0.3, 0.9]);
        assert!(!ground.take_free(bench(4.6)) && ground.take_free(bench(4.75)));
    }
}

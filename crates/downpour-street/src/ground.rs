//! Ground: a carriageway with crown and hollows, gutters, curbs and pavements, between a lane across at either end.
//!
//! The street runs along -z from z = 0 to z = -length, its middle at x = 0. Heights are above the bottom of the gutters. The crown
//! and the fall of the pavements are those of common practice: 2.5 % and 2 %; curbs stand 12 cm high.

mod covers;
mod pavement;
mod road;

use covers::Gully;
use downpour_math::ops;
use glam::Vec3;

use crate::dice::Dice;
use crate::material::Material;
use crate::mesh::{Mesh, plain};
use crate::noise::{smooth, world};
use crate::settings::{Paving, StreetSettings};

/// Width of the lanes across, between their curbs.
pub(crate) const LANE_M: f32 = 4.6;
/// Distance to which the lanes reach behind the corners.
pub(crate) const LANE_REACH_M: f32 = 9.0;
/// Width of the gutters of setts.
const GUTTER_M: f32 = 0.3;
/// Distance from the curb up to which the gutter is lowest.
const GUTTER_LOW_M: f32 = 0.05;
/// Height of the middle of the road over its edges.
const CROWN_M: f32 = 0.08;
/// Height of the curbs.
const CURB_HEIGHT_M: f32 = 0.12;
/// Fall of the pavements toward the road.
pub(crate) const PAVEMENT_FALL: f32 = 0.02;
/// Width of a curb stone.
const CURB_M: f32 = 0.17;

/// A hollow of the carriageway, where water would stand.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hollow {
    /// x and z of the middle, meters.
    pub center_m: [f32; 2],
    /// Distances along x and z at which a 1/e of the depth is left, meters.
    pub radii_m: [f32; 2],
    /// Depth in the middle, meters.
    pub depth_m: f32,
}

/// A repaired rectangle of asphalt.
#[derive(Clone, Copy, Debug)]
struct Repair {
    x: [f32; 2],
    z: [f32; 2],
    tint: f32,
}

/// Plan and heights of the ground.
#[derive(Clone, Debug)]
pub(crate) struct Ground {
    /// Half the width of the carriageway between the curbs.
    pub(crate) half_road: f32,
    /// Width of curb and pavement.
    pub(crate) pavement: f32,
    /// Length of the rows of houses.
    pub(crate) length: f32,
    pub(crate) hollows: Vec<Hollow>,
    /// x and z of the manhole covers.
    covers: Vec<[f32; 2]>,
    gullies: Vec<Gully>,
    paving: Paving,
    age: f32,
    repairs: Vec<Repair>,
    seed: u32,
}

impl Ground {
    pub(crate) fn new(settings: &StreetSettings) -> Self {
        let half_road = settings.carriageway_m / 2.0;
        let mut dice = Dice::new(settings.seed, 101);
        let mut hollows = Vec::new();
        let mut z = -dice.range(1.5, 4.0);
        while z > -settings.length_m + 1.5 {
            let reach = half_road - 1.3;
            let (x, radii_m) = (dice.range(-reach, reach), [dice.range(0.5, 0.95), dice.range(0.6, 1.5)]);
            let depth_m = dice.range(0.013, 0.021) * (0.8 + 0.5 * settings.age);
            // Deeper where the crown falls, or the water would run out on its lower side.
            let fall = 2.0 * CROWN_M * x.abs() / (half_road * half_road);
            let depth_m = depth_m + 0.8 * fall * radii_m[0];
            hollows.push(Hollow { center_m: [x, z], radii_m, depth_m });
            z -= dice.range(3.2, 6.0);
        }
        let mut repairs = Vec::new();
        if settings.paving == Paving::Asphalt {
            let count = (settings.length_m * (0.06 + 0.16 * settings.age)) as usize;
            for _ in 0..count {
                let (x, z) =
                    (dice.range(-half_road + 0.6, half_road - 1.6), -dice.range(0.0, settings.length_m));
                let (wide, long) = if dice.chance(0.4) {
                    (0.6, dice.range(6.0, 18.0))
                } else {
                    (dice.range(0.7, 1.8), dice.range(0.8, 3.0))
                };
                repairs.push(Repair {
                    x: [x, (x + wide).min(half_road - 0.45)],
                    z: [(z - long).max(-settings.length_m), z],
                    tint: dice.pick(&[0.70, 0.78, 0.84, 1.16]),
                });
            }
        }
        let (covers, gullies) = covers::plan(settings.seed, settings.length_m, half_road);
        Self {
            half_road,
            pavement: settings.pavement_m,
            length: settings.length_m,
            hollows,
            covers,
            gullies,
            paving: settings.paving,
            age: settings.age,
            repairs,
            seed: (settings.seed as u32).wrapping_mul(2_654_435_761) >> 8,
        }
    }

    /// Distance of the houses from the middle.
    pub(crate) fn half_street(&self) -> f32 {
        self.half_road + self.pavement
    }

    /// Distance from the middle to which the lanes reach.
    pub(crate) fn reach(&self) -> f32 {
        self.half_street() + LANE_REACH_M
    }

    /// z of the ends of the straight part of the curbs, the lower one first.
    pub(crate) fn straight_curb(&self) -> [f32; 2] {
        let end = self.corner() - self.pavement;
        [end - self.length, -end]
    }

    /// z of the houses across at the far end.
    pub(crate) fn far_front(&self) -> f32 {
        -(self.length + 2.0 * self.pavement + LANE_M)
    }

    /// Material of the carriageway.
    fn surface(&self) -> Material {
        match self.paving {
            Paving::Cobbles => Material::Setts,
            Paving::Asphalt => Material::Asphalt,
        }
    }

    /// Height of the pavement at a distance from the middle of the street.
    pub(crate) fn pavement_height(&self, x: f32) -> f32 {
        CURB_HEIGHT_M + PAVEMENT_FALL * (x.abs() - self.half_road - CURB_M).max(0.0)
    }

    /// Height of the pavement before the houses.
    pub(crate) fn front_height(&self) -> f32 {
        self.pavement_height(self.half_street())
    }

    /// 0 at the lanes to 1 in the street.
    fn open(&self, z: f32) -> f32 {
        let inside = (-z).min(self.length + z) + self.pavement;
        smooth(0.0, 7.0, inside)
    }

    /// Unevenness along a gutter, meters: water stands in its low parts, and runs to the gullies.
    fn gutter_wave(&self, z: f32, side: u32) -> f32 {
        let wave = world(z, side as f32 * 31.0, 4.6, 2, 201 + side + self.seed) - 0.5;
        wave * 0.03 * (0.6 + 0.8 * self.age) - self.gutter_dip(z, side)
    }

    /// Height of the edge of the carriageway, at the gutter.
    fn edge(&self) -> f32 {
        let t = (self.half_road - GUTTER_M) / self.half_road;
        CROWN_M * (1.0 - t * t)
    }

    /// Height of the carriageway.
    pub(crate) fn road_height(&self, x: f32, z: f32) -> f32 {
        let t = x / self.half_road;
        let open = self.open(z);
        let crown = self.edge() + (CROWN_M * (1.0 - t * t) - self.edge()).max(0.0) * open;
        let side = u32::from(x > 0.0);
        let wave = self.gutter_wave(z, side)
            * smooth(0.3 * self.half_road, self.half_road - GUTTER_M, x.abs())
            * open;
        let uneven = match self.paving {
            Paving::Cobbles => (world(x, z, 0.9, 2, 205 + self.seed) - 0.5) * 0.022,
            Paving::Asphalt => (world(x, z, 2.2, 2, 206 + self.seed) - 0.5) * 0.010,
        };
        let inner = smooth(self.half_road - GUTTER_M, self.half_road - GUTTER_M - 0.5, x.abs());
        crown + wave + uneven * open * inner * (0.5 + self.age) - self.hollow_depth(x, z)
    }

    fn hollow_depth(&self, x: f32, z: f32) -> f32 {
        let near = |hollow: &&Hollow| (hollow.center_m[1] - z).abs() < 6.0;
        let depth = |hollow: &Hollow| {
            let (a, b) =
                ((x - hollow.center_m[0]) / hollow.radii_m[0], (z - hollow.center_m[1]) / hollow.radii_m[1]);
            hollow.depth_m * ops::exp(-(a * a + b * b))
        };
        self.hollows.iter().filter(near).map(depth).sum()
    }

    /// The whole ground.
    pub(crate) fn mesh(&self) -> Mesh {
        let mut mesh = Mesh::default();
        road::carriageway(self, &mut mesh);
        for is_far in [false, true] {
            road::lane(self, &mut mesh, is_far);
            pavement::across(self, &mut mesh, is_far);
        }
        for mirror in [1.0, -1.0] {
            pavement::along(self, &mut mesh, mirror);
        }
        covers::covers(self, &mut mesh);
        // Below everything, so that gaps are not visible.
        let (x, y) = (self.reach() + 12.0, -0.3);
        let (near, far) = (-self.far_front() - self.length + 12.0, self.far_front() - 12.0);
        let corner = |x: f32, z: f32| Vec3::new(x, y, z);
        mesh.quad(
            plain(Material::Soil),
            [corner(-x, near), corner(x, near), corner(x, far), corner(-x, far)],
        );
        mesh
    }
}

/// Sorted cuts without those that are closer than two millimeters.
fn cuts(mut all: Vec<f32>) -> Vec<f32> {
    all.sort_by(f32::total_cmp);
    all.dedup_by(|a, b| (*a - *b).abs() < 2.0e-3);
    all
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Water runs off the middle and stands in the hollows.
    #[test]
    fn the_road_has_a_crown_and_hollows() {
        for paving in [Paving::Cobbles, Paving::Asphalt] {
            let ground = Ground::new(&StreetSettings { paving, ..StreetSettings::default() });
            let mean = |x: f32| (0..40).map(|k| ground.road_height(x, -20.0 - k as f32)).sum::<f32>() / 40.0;
            assert!(mean(0.0) > mean(2.7) + 0.03, "{} {}", mean(0.0), mean(2.7));
            assert!(ground.hollows.len() > 10);
            for hollow in &ground.hollows {
                let ([x, z], [_, reach]) = (hollow.center_m, hollow.radii_m);
                let alone = Ground { hollows: vec![*hollow], ..ground.clone() };
                let none = Ground { hollows: Vec::new(), ..ground.clone() };
                let fall = none.road_height(x, z) - alone.road_height(x, z);
                assert!((fall - hollow.depth_m).abs() < 1e-5 && hollow.depth_m > 0.01 && reach < 2.0);
            }
        }
    }
}

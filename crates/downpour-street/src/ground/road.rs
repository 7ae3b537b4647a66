//! The carriageway, and the lanes across.

use downpour_math::ops;
use glam::{Vec2, Vec3};

use super::{CROWN_M, GUTTER_M, Ground, LANE_M, cuts};
use crate::material::Material;
use crate::mesh::Mesh;
use crate::noise::{mix, smooth, world};
use crate::settings::Paving;

impl Ground {
    /// Radius of the curbs at the corners.
    pub(super) fn corner(&self) -> f32 {
        self.pavement + 0.4
    }

    /// Tint of the carriageway: tires polish and darken, dust gathers at the edges, repairs differ.
    fn road_tint(&self, x: f32, z: f32) -> Vec3 {
        let patchy = mix(0.84, 1.0, world(x, z, 5.0, 4, 211 + self.seed));
        let track = |at: f32| {
            let d = (x.abs() - at) / 0.30;
            ops::exp(-d * d)
        };
        let tires = 1.0 - 0.12 * (track(0.42 * self.half_road) + track(0.72 * self.half_road)).min(1.0);
        let oil = 1.0 - 0.16 * self.age * smooth(0.58, 0.8, world(x, z, 1.6, 3, 213 + self.seed));
        let gutter = mix(1.0, 0.80, smooth(self.half_road - 0.9, self.half_road - 0.3, x.abs()));
        let repair = self
            .repairs
            .iter()
            .rev()
            .find(|r| (r.x[0]..r.x[1]).contains(&x) && (r.z[0]..r.z[1]).contains(&z))
            .map_or(1.0, |repair| repair.tint);
        let tone = (patchy * tires * oil * gutter * repair * 0.94).min(1.0);
        // Dust is warm.
        let dust = smooth(0.40, 0.75, world(x, z, 3.1, 3, 214 + self.seed));
        Vec3::new(tone, tone * mix(1.0, 0.985, dust), tone * mix(1.0, 0.95, dust)).min(Vec3::ONE)
    }
}

pub(super) fn carriageway(ground: &Ground, mesh: &mut Mesh) {
    const JOINT: f32 = 0.03;
    let half = ground.half_road - GUTTER_M;
    let columns = ((half * 2.0 / 0.27).ceil() as i32).max(8);
    let mut across: Vec<f32> = (0..=columns).map(|k| mix(-half, half, k as f32 / columns as f32)).collect();
    let (near, far) = (ground.pavement - GUTTER_M, -(ground.length + ground.pavement) + GUTTER_M);
    let (near, far) = (near + 2.0 * GUTTER_M, far - 2.0 * GUTTER_M);
    // Long streets have longer cells.
    let step = (ground.length / 320.0).clamp(0.27, 1.0);
    let rows = ((near - far) / step).ceil() as i32;
    let mut along: Vec<f32> = (0..=rows).map(|k| mix(near, far, k as f32 / rows as f32)).collect();
    for repair in &ground.repairs {
        across.extend(repair.x.iter().flat_map(|&x| [x - JOINT * 0.5, x + JOINT * 0.5]));
        along.extend(repair.z.iter().flat_map(|&z| [z - JOINT * 0.5, z + JOINT * 0.5]));
    }
    let across = cuts(across.into_iter().map(|x| x.clamp(-half, half)).collect());
    let mut along = cuts(along);
    along.reverse();
    let radius = ground.corner() + GUTTER_M;
    // Between the corners' arcs the surface widens.
    let width = |z: f32| {
        let inside = (-z).min(ground.length + z) + ground.pavement;
        let down = (ground.corner() - inside).clamp(0.0, radius);
        ground.half_road + ground.corner() - (radius * radius - down * down).max(0.0).sqrt()
    };
    let surface = ground.surface();
    let seam = |x: f32, z: f32| {
        ground.paving == Paving::Asphalt
            && ground.repairs.iter().any(|r| {
                let outside = (r.x[0] - x).max(x - r.x[1]).max((r.z[0] - z).max(z - r.z[1]));
                outside.abs() < JOINT
            })
    };
    mesh.grid(
        [across.len() - 1, along.len() - 1],
        |i, j| {
            let z = along[j];
            let x = across[i] / half * width(z);
            let tint = if seam(x, z) { Vec3::splat(0.45) } else { ground.road_tint(x, z) };
            (Vec3::new(x, ground.road_height(across[i], z), z), Vec2::new(x, z) / surface.tile_m(), tint)
        },
        |_, _| Some(surface),
    );
}

/// The lane across at the near or the far end.
pub(super) fn lane(ground: &Ground, mesh: &mut Mesh, is_far: bool) {
    let curb = if is_far { -(ground.length + ground.pavement) } else { ground.pavement + LANE_M };
    let (near, far) = (curb - GUTTER_M, curb - LANE_M + GUTTER_M);
    let reach = ground.reach() + 0.5;
    let columns = (reach * 2.0) as usize;
    mesh.grid(
        [columns, 10],
        |i, j| {
            let x = mix(-reach, reach, i as f32 / columns as f32);
            let t = j as f32 / 10.0;
            let z = mix(near, far, t);
            let y = ground.edge() + (CROWN_M - ground.edge()) * 4.0 * t * (1.0 - t);
            let tint = mix(0.76, 0.95, world(x, z, 4.0, 3, 231 + ground.seed));
            let material = Material::Setts;
            (Vec3::new(x, y, z), Vec2::new(z, x) / material.tile_m(), Vec3::splat(tint))
        },
        |_, _| Some(Material::Setts),
    );
}

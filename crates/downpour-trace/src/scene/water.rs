//! Water as rays meet it. Twin of `shaders/wgsl/render/puddle_water.wgsl`.
//!
//! A ray that has met something in a puddle's depth map has come through the surface: on ground lower than the surface, or
//! on what stands in the water. Where the map has depth without such ground (a painted puddle, a road whose unevenness is
//! smaller than its model shows), the surface lies on the model and the ground is taken to be beneath it.
//!
//! Ripples are one lattice for all water (Tatarchuk & Isidoro 2006, section 4). So that its square is not seen again and
//! again, pieces of it are mixed over a mesh of triangles with weights whose squares sum to 1: the variance of the slopes
//! stays (E. Heitz and F. Neyret, High-Performance By-Example Noise, 2018, for a field that is normal already). What a
//! pixel does not resolve is a variance of the slope (M. Olano and D. Baker, LEAN Mapping, 2010). Near the eye the larger
//! drops have rings of their own (`puddle_rings`), and the lattice has what is left of the variance. Running water takes both along
//! (`puddle_flow`).
//!
//! Diffuse ground under water is darker: light is thrown back between ground and surface, and what comes out spreads over a
//! larger cone (J. Lekner and M. Dorf, Applied Optics 27, 1988).

use downpour_math::ops;
use downpour_math::rng::{rng_draw, rng_unit};
use downpour_shaders::render::puddle_water::{
    PUDDLE_WATER_DIMENSION, PUDDLE_WATER_GRAZING, PUDDLE_WATER_INDEX, PUDDLE_WATER_INSIDE, PUDDLE_WATER_MESH,
    PUDDLE_WATER_MIN_DEPTH, PUDDLE_WATER_OUTSIDE, PUDDLE_WATER_SLACK,
};
use glam::{Vec2, Vec3, Vec4};

use super::SceneView;
use super::puddle_flow::{puddle_flow_moves, puddle_flow_phase, puddle_flow_place};
use super::puddle_rings::{puddle_rings_shown, smoothstep};
use crate::puddle::RenderPuddle;

/// Water over a position.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PuddleWater {
    /// Number of the puddle.
    pub(crate) puddle: u32,
    /// Depth, m.
    pub(crate) depth: f32,
    /// Height of the surface over the position, m.
    pub(crate) rise: f32,
    /// Fraction of the rain that arrives.
    pub(crate) open: f32,
}

impl SceneView<'_> {
    /// A texel of a map: ground over the map's height (m), rise of the surface over the ground (m), depth (m, below 0 on
    /// land), fraction of the rain that arrives.
    fn puddle_water_texel(&self, map: [u32; 3], x: i32, y: i32) -> Vec4 {
        let [columns, rows, first] = map;
        let column = x.clamp(0, columns as i32 - 1) as u32;
        let line = y.clamp(0, rows as i32 - 1) as u32;
        self.data.puddle_texel(first + line * columns + column)
    }

    /// The map over a position, bilinear. Beyond the map all is land.
    fn puddle_water_map(&self, puddle: &RenderPuddle, position: Vec3) -> Vec4 {
        let (axes, map) = (puddle.axes, puddle.map);
        let [columns, rows, _] = map;
        let (dx, dz) = (position.x - puddle.middle.x, position.z - puddle.middle.z);
        let along = dx * axes.x + dz * axes.y;
        let across = dz * axes.x - dx * axes.y;
        if along.abs() >= axes.z || across.abs() >= axes.w {
            return Vec4::new(0.0, 0.0, -1.0, 0.0);
        }
        let u = (along / axes.z * 0.5 + 0.5) * columns as f32 - 0.5;
        let v = (across / axes.w * 0.5 + 0.5) * rows as f32 - 0.5;
        let (x, y) = (u.floor() as i32, v.floor() as i32);
        let (fx, fy) = (u - u.floor(), v - v.floor());
        let texel = |x, y| self.puddle_water_texel(map, x, y);
        let upper = texel(x, y) * (1.0 - fx) + texel(x + 1, y) * fx;
        let lower = texel(x, y + 1) * (1.0 - fx) + texel(x + 1, y + 1) * fx;
        upper * (1.0 - fy) + lower * fy
    }

    /// The water over a position that a ray has met, on ground whose facet rises by `upward`, or in the water.
    pub(crate) fn puddle_water_find(&self, position: Vec3, upward: f32) -> Option<PuddleWater> {
        (0..self.frame.puddle_count).find_map(|puddle| {
            let water = self.data.puddle_load(puddle);
            let found = self.puddle_water_map(&water, position);
            if found.z < PUDDLE_WATER_MIN_DEPTH {
                return None;
            }
            let height = position.y - water.middle.y - found.x;
            let rise = (found.y - height).clamp(0.0, found.y.max(0.0));
            let stands = height > 0.0 && rise > 0.0;
            let lies = height.abs() <= PUDDLE_WATER_SLACK && upward > 0.7;
            let depth = (found.z - height.max(0.0)).max(0.0);
            let open = found.w.clamp(0.0, 1.0);
            (stands || lies).then_some(PuddleWater { puddle, depth, rise, open })
        })
    }

    /// A texel of a level of the ripples: slopes along the lattice's axes, and the mean of the square of the slope.
    fn puddle_water_slope(&self, first: u32, size: u32, x: i32, y: i32) -> Vec4 {
        let column = x.clamp(0, size as i32 - 1) as u32;
        let line = y.clamp(0, size as i32 - 1) as u32;
        self.data.puddle_texel(first + line * size + column)
    }

    /// A piece of the ripples around a vertex of the mesh: slopes, and the variance that the level does not show. `offset` is
    /// from the vertex, in the mesh's steps; the level begins at row `first`, with `steps` texels per step.
    fn puddle_water_piece(&self, vertex: [i32; 2], offset: Vec2, first: u32, size: u32, steps: f32) -> Vec3 {
        let words = rng_draw([0; 2], vertex[0] as u32, vertex[1] as u32, PUDDLE_WATER_DIMENSION);
        // Anywhere as long as the piece lies within the lattice: a step to each side of its middle.
        let room = (size as f32 - 2.0 * steps).max(0.0);
        let u = steps + rng_unit(words[0]) * room + offset.x * steps - 0.5;
        let v = steps + rng_unit(words[1]) * room + offset.y * steps - 0.5;
        let (x, y) = (u.floor() as i32, v.floor() as i32);
        let (fx, fy) = (u - u.floor(), v - v.floor());
        let texel = |x, y| self.puddle_water_slope(first, size, x, y);
        let upper = texel(x, y) * (1.0 - fx) + texel(x + 1, y) * fx;
        let lower = texel(x, y + 1) * (1.0 - fx) + texel(x + 1, y + 1) * fx;
        let mixed = upper * (1.0 - fy) + lower * fy;
        let slope = mixed.truncate().truncate();
        slope.extend((mixed.z - slope.dot(slope)).max(0.0))
    }

    /// The ripples at a place in steps of the mesh: slopes, and the variance that the level does not show. The level begins at row
    /// `first`, with `steps` texels per step.
    fn puddle_water_mixed(&self, place: Vec2, first: u32, size: u32, steps: f32) -> Vec3 {
        // Skewed, so that triangles become halves of squares.
        let sx = place.x - place.y * 0.577_350_27;
        let sz = place.y * 1.154_700_5;
        let corner = [sx.floor() as i32, sz.floor() as i32];
        let (fx, fz) = (sx - sx.floor(), sz - sz.floor());
        let third = 1.0 - fx - fz;
        let (weights, steps_to) = if fx + fz < 1.0 {
            ([third, fz, fx], [[0, 0], [0, 1], [1, 0]])
        } else {
            ([-third, 1.0 - fz, 1.0 - fx], [[1, 1], [1, 0], [0, 1]])
        };
        let (mut sum, mut spread, mut square) = (Vec2::ZERO, 0.0, 0.0);
        for (weight, step) in weights.into_iter().zip(steps_to) {
            let vertex = [corner[0].wrapping_add(step[0]), corner[1].wrapping_add(step[1])];
            let middle = Vec2::new(vertex[0] as f32 + 0.5 * vertex[1] as f32, 0.866_025_4 * vertex[1] as f32);
            let piece = self.puddle_water_piece(vertex, place - middle, first, size, steps);
            sum += piece.truncate() * weight;
            spread += piece.z * weight * weight;
            square += weight * weight;
        }
        (sum / square.sqrt()).extend(spread / square)
    }

    /// Slopes along x and z of the water's surface, and the variance of the slope within a footprint (m).
    pub(crate) fn puddle_water_ripple(
        &self,
        puddle: u32,
        position: Vec3,
        footprint: f32,
        depth: f32,
        open: f32,
    ) -> Vec3 {
        let water = self.data.puddle_load(puddle);
        let (look, more) = (water.ripples, water.own);
        let head = self.data.puddle_ripples();
        let cell = head.cell;
        let flow = self.data.puddle_flow_load(puddle);
        // Velocity, and slopes of the surface.
        let runs = match flow.first {
            0 => Vec4::ZERO,
            first => self.data.puddle_flow_at(first, &water, position),
        };
        // Scale, cosine and sine of the angle, influence.
        let strength = look.w * open * smoothstep(0.0, more.x.max(1.0e-6), depth);
        if head.size == 0 || strength <= 0.0 {
            return Vec3::new(runs.z, runs.w, 0.0);
        }
        let finest = footprint / (look.x * cell);
        let level = ((ops::log2(finest.max(1.0)) + 0.5).floor().max(0.0) as u32).min(head.levels - 1);
        // Levels of n x n, n / 2 x n / 2, ...: 4/3 n^2 (1 - 4^-level) texels before this one.
        let size = (head.size >> level).max(1);
        let first = head.first + (head.size * head.size - size * size) / 3 * 4;
        let steps = PUDDLE_WATER_MESH / cell * size as f32 / head.size as f32;

        let px = (position.x * look.y + position.z * look.z) / (look.x * PUDDLE_WATER_MESH) + more.y;
        let pz = (position.z * look.y - position.x * look.z) / (look.x * PUDDLE_WATER_MESH) + more.z;
        let place = Vec2::new(px, pz);
        let moves = puddle_flow_moves((runs.x * runs.x + runs.y * runs.y).sqrt());
        let weighted = |place: Vec2, weight: f32| {
            self.puddle_water_mixed(place, first, size, steps) * Vec3::new(weight, weight, weight * weight)
        };
        let (mut mixed, mut square) = (Vec3::ZERO, 0.0);
        if moves < 1.0 {
            let weight = 1.0 - moves;
            mixed = weighted(place, weight);
            square = weight * weight;
        }
        if moves > 0.0 {
            let along = Vec2::new(runs.x * look.y + runs.y * look.z, runs.y * look.y - runs.x * look.z)
                / (look.x * PUDDLE_WATER_MESH);
            for second in 0..2 {
                let part = puddle_flow_phase(flow.phase, second);
                let weight = moves * part.y;
                let own = puddle_flow_place(flow.phase, flow.cycle, second);
                mixed += weighted(place - along * part.x + own, weight);
                square += weight * weight;
            }
        }
        let (mut lattice, mut rings) = (1.0, Vec2::ZERO);
        if water.rings > 0.0 {
            let drops = self.data.puddle_rings_load();
            let place = Vec2::new(position.x, position.z);
            let shown = puddle_rings_shown(place - drops.middle, drops.reach, footprint);
            let shown = if drops.cells[0] > 0 { shown } else { 0.0 };
            if shown > 0.0 {
                rings = self.data.puddle_rings_sum(&drops, place) * (shown * strength);
                // The lattice keeps what rings do not have.
                lattice = (1.0 - shown * shown * drops.part).sqrt();
            }
        }
        let slope = mixed.truncate() * (strength * lattice / square.sqrt());
        // Back to the world's axes.
        Vec3::new(
            slope.x * look.y - slope.y * look.z + rings.x + runs.z,
            slope.y * look.y + slope.x * look.z + rings.y + runs.w,
            mixed.z / square * (strength * strength * lattice * lattice),
        )
    }
}

/// The normal of a surface with these slopes, and with a deviation drawn by two numbers in [0, 1).
#[must_use]
pub fn puddle_water_normal(ripple: Vec3, a: f32, b: f32) -> Vec3 {
    // Normal deviates along both axes, each with half of the variance.
    let radius = (-ripple.z * ops::ln((1.0 - a).max(1.0e-6))).sqrt();
    let angle = std::f32::consts::TAU * b;
    let x = -(ripple.x + radius * ops::cos(angle));
    let z = -(ripple.y + radius * ops::sin(angle));
    Vec3::new(x, 1.0, z) / (1.0 + x * x + z * z).sqrt()
}

/// A mirrored direction above the water.
#[must_use]
pub fn puddle_water_mirrored(direction: Vec3, normal: Vec3) -> Vec3 {
    let along = direction - normal * (2.0 * direction.dot(normal));
    let raised = Vec3::new(along.x, along.y.abs().max(PUDDLE_WATER_GRAZING), along.z);
    raised / raised.dot(raised).sqrt()
}

/// The direction beneath the surface.
#[must_use]
pub fn puddle_water_refracted(direction: Vec3, normal: Vec3) -> Vec3 {
    let eta = 1.0 / PUDDLE_WATER_INDEX;
    let cosine = (-direction.dot(normal)).max(0.0);
    let inner = (1.0 - eta * eta * (1.0 - cosine * cosine)).max(0.0).sqrt();
    let along = direction * eta + normal * (eta * cosine - inner);
    along / along.dot(along).sqrt()
}

/// The direction beneath level water of light from above, both toward where it comes from.
#[must_use]
pub fn puddle_water_beneath(direction: Vec3) -> Vec3 {
    let (x, z) = (direction.x / PUDDLE_WATER_INDEX, direction.z / PUDDLE_WATER_INDEX);
    Vec3::new(x, (1.0 - x * x - z * z).max(0.0).sqrt(), z)
}

/// Point where light that falls on a position under a depth of level water enters the surface, relative to the point of
/// the surface above that position.
#[must_use]
pub fn puddle_water_entry(direction: Vec3, depth: f32) -> Vec3 {
    let below = puddle_water_beneath(direction);
    let aside = depth / below.y.max(0.1);
    Vec3::new(below.x * aside, 0.0, below.z * aside)
}

/// The direction above level water of light from beneath it; its height is 0 where it does not come out.
#[must_use]
pub fn puddle_water_above(direction: Vec3) -> Vec3 {
    let (x, z) = (direction.x * PUDDLE_WATER_INDEX, direction.z * PUDDLE_WATER_INDEX);
    Vec3::new(x, (1.0 - x * x - z * z).max(0.0).sqrt(), z)
}

/// Albedo of what lies under water, as seen through its surface over the fraction that comes out along the ray: light goes
/// in diffusely, and is thrown back between ground and surface. White stays white.
#[must_use]
pub fn puddle_water_albedo(albedo: Vec3) -> Vec3 {
    let out = (1.0 - PUDDLE_WATER_OUTSIDE) / (PUDDLE_WATER_INDEX * PUDDLE_WATER_INDEX);
    albedo * out / (Vec3::ONE - albedo * PUDDLE_WATER_INSIDE)
}

/// Reflectance at normal incidence of what lies under water, from that in air.
#[must_use]
pub fn puddle_water_reflectance(in_air: Vec3) -> Vec3 {
    let root = in_air.clamp(Vec3::ZERO, Vec3::splat(0.98)).map(f32::sqrt);
    let index = (Vec3::ONE + root) / (Vec3::ONE - root);
    let ratio = (index - PUDDLE_WATER_INDEX) / (index + PUDDLE_WATER_INDEX);
    ratio * ratio
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::builder::SceneBuilder;
    use crate::data::{RenderFrame, SceneData};
    use crate::puddle::{FlowMap, Ground, PuddleLook, PuddleMap, PuddleRows, slope_levels};
    use crate::sky_light::SkyLight;
    use downpour_math::packing::packing_pack_half;
    use downpour_render::camera::Viewpoint;

    /// Water with a lattice of waves some centimeters long, at a time, s, that runs with a velocity, m/s; and the mean square of its slope.
    fn rippled(velocity: [f32; 2], time_s: f64) -> (SceneData, f32) {
        let size = 256u16;
        let wave = |k: f32, x: u16, y: u16| ops::sin(k * (f32::from(x) + 0.6 * f32::from(y)));
        let finest: Vec<[f32; 4]> = (0..u32::from(size) * u32::from(size))
            .map(|i| {
                let (x, y) = ((i % 256) as u16, (i / 256) as u16);
                let slopes = [0.1 * wave(1.1, x, y), 0.08 * wave(0.37, y, x) + 0.05 * wave(0.11, x, y)];
                [slopes[0], slopes[1], slopes[0] * slopes[0] + slopes[1] * slopes[1], 0.0]
            })
            .collect();
        let mean_square = finest.iter().map(|slope| slope[2]).sum::<f32>() / finest.len() as f32;
        let mut scene = SceneBuilder::new().build(&SkyLight::new(1, 1, &[[1.0; 3]]));
        let ground = Ground { middle: Vec3::ZERO, size: Vec2::splat(100.0), turn: 0.0, reach: 1.0 };
        let words = [packing_pack_half(velocity), 0];
        let flow =
            (velocity != [0.0; 2]).then(|| FlowMap([[words, words].concat().try_into().unwrap(); 2].into()));
        let map = PuddleMap { ground, size: [2, 2], cells: [[0.0, 0.0, 0.1, 1.0]; 4].into(), flow };
        scene.set_puddles(&PuddleRows {
            puddles: &[(map, PuddleLook { angle: 0.5, ..PuddleLook::default() })],
            shape: (u32::from(size), 8, 5.0e-3),
            slopes: &slope_levels(finest, usize::from(size)),
            shift: Vec3::ZERO,
            rings: None,
            wakes: &[],
            time_s,
        });
        (scene, mean_square)
    }

    /// Ripples of some water at many places, m, seen with a footprint, m.
    fn ripples(scene: &SceneData, footprint: f32, places: impl Iterator<Item = Vec3>) -> Vec<Vec3> {
        let view = Viewpoint { eye: Vec3::Y, forward: Vec3::NEG_Y, up: Vec3::X, fov_y: 1.0 };
        let frame = RenderFrame::new(scene, &view, [1, 1], 1, 0, 0).unwrap();
        let view = SceneView { data: scene, frame: &frame };
        places.map(|position| view.puddle_water_ripple(0, position, footprint, 0.1, 1.0)).collect()
    }

    fn places() -> impl Iterator<Item = Vec3> {
        (0..10_000u16)
            .map(|k| Vec3::new(f32::from(k % 100), 0.0, f32::from(k / 100)) * 0.377 - Vec3::splat(18.0))
    }

    /// The square of the slope, what is seen of it and what is not together, is the lattice's at any distance, whether the water stands
    /// or runs, slowly or fast, at any time.
    #[test]
    fn mixing_pieces_keeps_the_variance_at_any_footprint() {
        for (velocity, time_s) in
            [([0.0; 2], 0.0), ([0.01, 0.012], 3.3), ([0.4, -0.3], 3.2), ([0.4, -0.3], 3.33)]
        {
            let (scene, mean_square) = rippled(velocity, time_s);
            for footprint in [0.0, 0.03, 0.3, 5.0] {
                let (mut shown, mut hidden) = (0.0, 0.0);
                for ripple in ripples(&scene, footprint, places()) {
                    shown += (ripple.x * ripple.x + ripple.y * ripple.y) / 1.0e4;
                    hidden += ripple.z / 1.0e4;
                }
                let ratio = (shown + hidden) / mean_square;
                assert!(
                    (ratio - 1.0).abs() < 0.08,
                    "{velocity:?} {footprint}: {ratio} ({shown} and {hidden})"
                );
                assert_eq!(hidden > shown, footprint > 0.01, "{footprint}: {shown} and {hidden}");
            }
        }
    }

    /// Where the water has gone to, its ripples are; where they were are others.
    #[test]
    fn ripples_go_with_the_water() {
        let (velocity, step_s) = (Vec2::new(1.0, -0.5), 0.04);
        let correlation = |from: &[Vec3], to: &[Vec3]| {
            let product =
                |a: &[Vec3], b: &[Vec3]| a.iter().zip(b).map(|(a, b)| a.x * b.x + a.y * b.y).sum::<f32>();
            product(from, to) / (product(from, from) * product(to, to)).sqrt()
        };
        let way = Vec3::new(velocity.x, 0.0, velocity.y) * step_s as f32;
        for time_s in [0.0, 0.21, 0.38, 0.79, 5.3] {
            let [before, after] =
                [time_s, time_s + step_s].map(|time_s| rippled(velocity.to_array(), time_s).0);
            let from = ripples(&before, 0.0, places());
            let along = correlation(&from, &ripples(&after, 0.0, places().map(|place| place + way)));
            let fixed = correlation(&from, &ripples(&after, 0.0, places()));
            assert!(along > 0.97 && fixed < 0.8, "{time_s}: {along} {fixed}");
        }
    }
}

//! Part of the exposure in which a ray passes a moving drop, and its chord. Twin of `shaders/wgsl/render/streak.wgsl`, where the
//! method is described.

use downpour_drop::oscillation::{
    drop_oscillation_outline, drop_oscillation_radius, drop_oscillation_sine, drop_oscillation_state,
};
use downpour_shaders::render::rain::{
    DROPS_STILL, STREAK_GAUSS, STREAK_SUM_COVER, STREAK_SUM_REACH, STREAK_SUM_THIN,
};
use glam::{Vec2, Vec3};

/// A drop in the picture. The same layout as `ScreenDrop` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct ScreenDrop {
    /// Unit vector from the eye to the drop's center at mid-exposure.
    pub towards: [f32; 3],
    /// Distance from the eye in the middle of its path, m.
    pub distance: f32,
    /// Position of the middle on the picture, pixels from the top left.
    pub position: [f32; 2],
    /// Equivalent radius divided by distance.
    pub slope: f32,
    /// Half the width of its mask, in equivalent radii.
    pub half_extent: f32,
    /// Index of its mask, fractional: diameter, elevation.
    pub mask_index: [f32; 2],
    /// Area on the picture, pixels.
    pub area: f32,
    /// Samples along an edge of a pixel; of a streak: samples of a pixel. 0: below a pixel, or out of focus.
    pub grid: u32,
    /// Position when the exposure begins: on the plane at distance 1, along the right and up of the drop's view.
    pub start: [f32; 2],
    /// Displacement during the exposure, on the same plane.
    pub along: [f32; 2],
    /// `start` on the picture, pixels.
    pub first: [f32; 2],
    /// `along` on the picture, pixels.
    pub screen_delta: [f32; 2],
    /// Half the width and half the height of the oval around its outline, and how far its middle is up, in equivalent
    /// radii.
    pub oval: [f32; 3],
    /// Depth at the end divided by that at the beginning.
    pub depth_ratio: f32,
    /// Amplitudes of the modes (2,0) and (3,1), the latter times the cosine of its azimuth, and phases at the beginning,
    /// in turns.
    pub mode_phase: [f32; 4],
    /// Cycles of both modes during the exposure.
    pub cycles: [f32; 2],
    /// Fraction of the exposure in which it is in front of the eye.
    pub fraction: f32,
    /// Width over which a drop that is not sampled is spread, pixels.
    pub spread: f32,
    /// Minimum distance of any part of it, m.
    pub nearest: f32,
    /// `DROPS_STILL`, `DROPS_TABLE` or `DROPS_LOOP`.
    pub kind: u32,
    /// Index of its mean in the streak radiance table.
    pub shape: u32,
    /// First entry of its profile in the table.
    pub profile: u32,
    /// Weight of the light at the beginning and at the end of its way; over the whole exposure the mean weight is 1.
    pub weights: [f32; 2],
    /// Largest distance from its path that it covers, pixels.
    pub reach: f32,
    /// Its id in 32 bits.
    pub id: u32,
}

/// True for a streak that covers so little of each pixel, and is so narrow, that it is summed up ([`super::drops_sum`]).
#[must_use]
pub fn streak_is_summed(drop: &ScreenDrop) -> bool {
    let (along, [first, last]) = (Vec2::from(drop.along), drop.weights);
    let across = 2.0 * drop.slope * first.max(last);
    let most = if drop.grid == 0 { STREAK_SUM_THIN } else { STREAK_SUM_COVER };
    let covers = across * across <= most * most * along.dot(along);
    drop.kind != DROPS_STILL && drop.reach > 0.0 && drop.reach <= STREAK_SUM_REACH && covers
}

/// First and last column (or row) of those within a range of pixels; `None` if there is none.
#[must_use]
pub fn streak_pixels(low: f32, high: f32, count: u32) -> Option<[u32; 2]> {
    let (first, last) = (low.floor(), high.ceil() - 1.0);
    // The comparison is false for what is no number.
    (last >= 0.0 && first < count as f32 && first <= last)
        .then(|| [first, last].map(|v| v.clamp(0.0, count as f32 - 1.0) as u32))
}

/// Chord along which a ray passes a moving drop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StreakChord {
    /// Unit direction of the motion on the oval, which is a circle of radius 1 here.
    pub direction: Vec2,
    /// Position of the chord across the motion, -1 to 1.
    pub across: f32,
    /// Half its length.
    pub half: f32,
    /// Start of the part that passes during the exposure, in units of `half`; empty unless `high` is above `low`.
    pub low: f32,
    /// End of that part.
    pub high: f32,
    /// Fraction of the exposure in which the whole chord would pass, by weight.
    pub fraction: f32,
    /// Fraction of the exposure in which it moves by an equivalent radius, by weight.
    pub pace: f32,
    /// Weights of the light at `low` and at `high`.
    pub weights: Vec2,
    /// Position of the ray across the path, in equivalent radii.
    pub aside: f32,
    /// Unit direction of the motion.
    pub path: Vec2,
}

/// Time, as a fraction of the exposure, at which the drop is at a fraction of its path in the picture.
#[must_use]
pub fn streak_time(depth_ratio: f32, way: f32) -> f32 {
    way / (way + (1.0 - way) * depth_ratio).max(1.0e-20)
}

/// Weight of the light at a time, 0 to 1, by the weights at the beginning and at the end of the way.
#[must_use]
pub fn streak_weight(weights: [f32; 2], time: f32) -> f32 {
    weights[0] + (weights[1] - weights[0]) * time.clamp(0.0, 1.0)
}

/// Fraction of the path that is nearest to a position on the plane.
#[must_use]
pub fn streak_nearest(drop: &ScreenDrop, at: Vec2) -> f32 {
    let along = Vec2::from(drop.along);
    ((at - Vec2::from(drop.start)).dot(along) / along.dot(along).max(1.0e-20)).clamp(0.0, 1.0)
}

/// Depth at a time, relative to mid-exposure.
#[must_use]
pub fn streak_depth(depth_ratio: f32, time: f32) -> f32 {
    (1.0 + (depth_ratio - 1.0) * time) * 2.0 / (1.0 + depth_ratio)
}

/// Scales of the oval at a time: width on the right and on the left, and height.
#[must_use]
pub fn streak_stretch(mode_phase: [f32; 4], turns: [f32; 2], time: f32) -> Vec3 {
    let s2 = mode_phase[0] * drop_oscillation_sine(mode_phase[2] + turns[0] * time);
    let s3 = mode_phase[1] * drop_oscillation_sine(mode_phase[3] + turns[1] * time);
    let state = drop_oscillation_state([s2, s3]);
    let [right, left] = drop_oscillation_outline(state, 1.0);
    Vec3::new(right, left, drop_oscillation_radius(state, 1.0, 0.0))
}

/// Returns the chord along which a ray through a point of the plane passes the drop.
#[must_use]
pub fn streak_chord(drop: &ScreenDrop, at: Vec2) -> StreakChord {
    let (start, path) = (Vec2::from(drop.start), Vec2::from(drop.along));
    let way = streak_nearest(drop, at);
    let time = streak_time(drop.depth_ratio, way);
    let scale = drop.slope / streak_depth(drop.depth_ratio, time);
    let stretch = streak_stretch(drop.mode_phase, drop.cycles, time);
    let offset = (at - start - path * way) / scale;
    let side = if offset.x < 0.0 { stretch.y } else { stretch.x };
    let oval = Vec2::new(drop.oval[0] * side, drop.oval[1] * stretch.z);
    let on_oval = (offset - Vec2::new(0.0, drop.oval[2] * stretch.z)) / oval;
    let moved = path / (scale * oval);
    let length = moved.dot(moved).sqrt().max(1.0e-12);
    let direction = moved / length;
    let across = on_oval.x * direction.y - on_oval.y * direction.x;
    let along = on_oval.dot(direction);
    let half = (1.0 - across * across).max(0.0).sqrt();
    let per_half = 1.0 / half.max(1.0e-6);
    let faster = way + (1.0 - way) * drop.depth_ratio;
    let rate = drop.fraction * drop.depth_ratio / (faster * faster).max(1.0e-12);
    let moves = path.dot(path).sqrt().max(1.0e-20);
    let path = path / moves;
    let low = ((along - length * (1.0 - way)) * per_half).max(-1.0);
    let high = if half <= 1.0e-6 { -2.0 } else { ((along + length * way) * per_half).min(1.0) };
    // Points ahead on the chord have passed earlier.
    let time = |v: f32| streak_time(drop.depth_ratio, (way + (along - half * v) / length).clamp(0.0, 1.0));
    let weights = Vec2::new(streak_weight(drop.weights, time(low)), streak_weight(drop.weights, time(high)));
    let weight = 0.5 * (weights.x + weights.y);
    StreakChord {
        direction,
        across,
        half,
        low,
        high,
        fraction: 2.0 * half / length * rate * weight,
        pace: rate * scale / moves * weight,
        weights,
        aside: offset.x * path.y - offset.y * path.x,
        path,
    }
}

/// Position in the mask, in units of half its width, of a position on a chord, in units of half its length.
#[must_use]
pub fn streak_mask_position(drop: &ScreenDrop, chord: &StreakChord, v: f32) -> Vec2 {
    let away = Vec2::new(chord.direction.y, -chord.direction.x);
    let at =
        (away * chord.across + chord.direction * (v * chord.half)) * Vec2::new(drop.oval[0], drop.oval[1]);
    (at + Vec2::new(0.0, drop.oval[2])) / drop.half_extent
}

/// The fraction of a pixel's width that a box of some width (1 or more), `off` pixels from the pixel's middle, covers, over that
/// width: over all pixels it is 1.
#[must_use]
pub fn streak_box(width: f32, off: f32) -> f32 {
    ((width + 1.0) * 0.5 - off.abs()).clamp(0.0, 1.0) / width
}

/// Both edges, as fractions of the way, of where a path is less than `reach` from 0.
#[must_use]
pub fn streak_within(from: f32, way: f32, reach: f32) -> Vec2 {
    if way.abs() < 1.0e-6 {
        return if from.abs() < reach { Vec2::new(0.0, 1.0) } else { Vec2::new(2.0, -1.0) };
    }
    let a = (-reach - from) / way;
    let b = (reach - from) / way;
    Vec2::new(a.min(b), a.max(b))
}

/// Weighted mean of the box filter over a path: exact, by pieces in which both edges are straight.
#[must_use]
pub fn streak_mean(from: Vec2, way: Vec2, width: f32, weights: [f32; 2]) -> f32 {
    let outer_x = streak_within(from.x, way.x, (width + 1.0) * 0.5);
    let outer_y = streak_within(from.y, way.y, (width + 1.0) * 0.5);
    let low = outer_x.x.max(outer_y.x).max(0.0);
    let high = outer_x.y.min(outer_y.y).min(1.0);
    if high <= low {
        return 0.0;
    }
    let inner_x = streak_within(from.x, way.x, (width - 1.0) * 0.5);
    let inner_y = streak_within(from.y, way.y, (width - 1.0) * 0.5);
    // Edges of pieces, in order: two pairs, each in order, merged.
    let x = inner_x.clamp(Vec2::splat(low), Vec2::splat(high));
    let y = inner_y.clamp(Vec2::splat(low), Vec2::splat(high));
    let first = x.x.min(x.y).min(y.x.min(y.y));
    let last = x.x.max(x.y).max(y.x.max(y.y));
    let starts = x.x.min(x.y).max(y.x.min(y.y));
    let ends = x.x.max(x.y).min(y.x.max(y.y));
    let edges = [low, first, starts.min(ends), starts.max(ends), last, high];
    let mut sum = 0.0;
    for pair in edges.windows(2) {
        let middle = (pair[0] + pair[1]) * 0.5;
        let reach = (pair[1] - pair[0]) * 0.5;
        // Gauss's two points are exact for cubics.
        for side in [-1.0, 1.0] {
            let time = middle + side * reach * STREAK_GAUSS;
            let at = from + way * time;
            sum += streak_box(width, at.x) * streak_box(width, at.y) * reach * streak_weight(weights, time);
        }
    }
    sum
}

/// Weighted fraction of a pixel that an unsampled drop covers.
#[must_use]
pub fn streak_cover(drop: &ScreenDrop, x: u32, y: u32) -> f32 {
    let from = Vec2::from(drop.first) - Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
    let mean = streak_mean(from, Vec2::from(drop.screen_delta), drop.spread, drop.weights);
    (drop.area * drop.fraction * mean).min(1.0)
}

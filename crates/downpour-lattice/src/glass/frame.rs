//! Parameters of a call, and indices of cells. Twin of `shaders/wgsl/lattice/glass_frame.wgsl`.

use glam::IVec2;

/// Parameters common to all ticks of a call, in the layout of `GlassFrame` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct GlassFrame {
    /// Number of cells along x and y.
    pub size: [u32; 2],
    /// Low and high word of the seed.
    pub seed: [u32; 2],
    /// Number of the first tick.
    pub first_step: u32,
    /// Time of the first tick, in 1/4096 s.
    pub first_clock: u32,
    /// Length of a tick, in 1/4096 s.
    pub clock_step: u32,
    /// Number of blade parts per tick.
    pub blades: u32,
    /// Change of velocity by gravity in one tick.
    pub gravity: [i32; 2],
    /// Direction of the air along the pane: a unit vector of length 16384.
    pub air: [i32; 2],
    /// Friction of a moving drop relative to that of a resting one, in units of 1/256.
    pub kinetic: u32,
    /// A drop that moves by a cell leaves a bead if a random word is below this.
    pub trail_chance: u32,
    /// Mean mass of a bead.
    pub trail_mass: u32,
    /// Time that glass stays wet, in 1/64 s.
    pub wet_life: u32,
    /// Fraction by which wetness reduces friction, in units of 1/256.
    pub wet_ease: u32,
    /// Attraction by affinity, in sixteenths.
    pub affinity_pull: u32,
    /// Attraction by wetness, in sixteenths.
    pub wet_pull: u32,
    /// Fraction of its water that flows down a vertical ridge by a cell in one tick, in units of 1/262144 for each unit
    /// of mass.
    pub ridge_drain: u32,
    /// Mass of a cell of a level ridge from which on it sags.
    pub ridge_hold: u32,
    /// Ticks for which a ridge takes all drops that it touches after a blade has pushed it.
    pub ridge_fresh: u32,
    /// Padding, 0.
    pub unused_1: u32,
    /// Padding, 0.
    pub unused_2: u32,
    /// Probability that at least 1, 2, 3, 4 drops land in a block in one tick, in units of 2^-32.
    pub rain_few: [u32; 4],
    /// The same for 5, 6, 7, 8.
    pub rain_many: [u32; 4],
}

/// Index of a cell in memory.
#[inline]
#[must_use]
pub fn glass_frame_index(frame: &GlassFrame, cell: IVec2) -> u32 {
    cell.y as u32 * frame.size[0] + cell.x as u32
}

/// Cell at an index in memory.
#[inline]
#[must_use]
pub fn glass_frame_cell(frame: &GlassFrame, index: u32) -> IVec2 {
    IVec2::new((index % frame.size[0]) as i32, (index / frame.size[0]) as i32)
}

/// True if a cell is on the pane.
#[inline]
#[must_use]
pub fn glass_frame_holds(frame: &GlassFrame, cell: IVec2) -> bool {
    cell.x >= 0 && cell.y >= 0 && cell.x < frame.size[0] as i32 && cell.y < frame.size[1] as i32
}

/// Number of drops that land in a block of cells, from a random word.
#[inline]
#[must_use]
pub fn glass_frame_landing(frame: &GlassFrame, word: u32) -> u32 {
    frame.rain_few.iter().chain(&frame.rain_many).map(|&limit| u32::from(word < limit)).sum()
}

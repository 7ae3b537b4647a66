//! What holds for all ticks of a call, and places on the pane. Twin of `shaders/wgsl/lattice/glass_frame.wgsl`.

use glam::IVec2;

/// What holds for all ticks of a call. The same layout as `GlassFrame` in WGSL.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, bytemuck::Pod, bytemuck::Zeroable)]
pub struct GlassFrame {
    /// Cells along x and y.
    pub size: [u32; 2],
    /// Low and high word of the seed.
    pub seed: [u32; 2],
    /// Number of the first tick.
    pub first_step: u32,
    /// Time of the first tick, in 1/4096 s.
    pub first_clock: u32,
    /// Length of a tick, in 1/4096 s.
    pub clock_step: u32,
    /// How many parts of blades there are in a tick.
    pub blades: u32,
    /// What gravity adds to a velocity in one tick.
    pub gravity: [i32; 2],
    /// Direction of the air along the pane: a unit vector of 16384.
    pub air: [i32; 2],
    /// Friction of a moving drop, of 256 of that of a resting one.
    pub kinetic: u32,
    /// A drop that moves by a cell leaves a bead if a word is below this.
    pub trail_chance: u32,
    /// Mean mass of a bead.
    pub trail_mass: u32,
    /// How long glass stays wet, in 1/64 s.
    pub wet_life: u32,
    /// Share of the friction that wet glass takes away, of 256.
    pub wet_ease: u32,
    /// How strongly affinity draws a drop, in sixteenths.
    pub affinity_pull: u32,
    /// How strongly wetness draws a drop, in sixteenths.
    pub wet_pull: u32,
    /// 0.
    pub unused: u32,
    /// Probability that at least 1, 2, 3, 4 drops land in a block in one tick, of 2^32.
    pub rain_few: [u32; 4],
    /// The same for 5, 6, 7, 8.
    pub rain_many: [u32; 4],
}

/// Where a cell stands in memory.
#[inline]
#[must_use]
pub fn glass_frame_index(frame: &GlassFrame, cell: IVec2) -> u32 {
    cell.y as u32 * frame.size[0] + cell.x as u32
}

/// The cell that stands at a place of memory.
#[inline]
#[must_use]
pub fn glass_frame_cell(frame: &GlassFrame, index: u32) -> IVec2 {
    IVec2::new((index % frame.size[0]) as i32, (index / frame.size[0]) as i32)
}

/// Whether a cell is on the pane.
#[inline]
#[must_use]
pub fn glass_frame_holds(frame: &GlassFrame, cell: IVec2) -> bool {
    cell.x >= 0 && cell.y >= 0 && cell.x < frame.size[0] as i32 && cell.y < frame.size[1] as i32
}

/// How many drops land in a block of cells, from a random word.
#[inline]
#[must_use]
pub fn glass_frame_landing(frame: &GlassFrame, word: u32) -> u32 {
    frame.rain_few.iter().chain(&frame.rain_many).map(|&limit| u32::from(word < limit)).sum()
}

//! Interface of what is timed.

use downpour::gpu::wgpu;

/// Something that makes frames on the shared device.
pub(crate) trait Contender {
    /// Makes and submits a frame, without waiting for the device.
    ///
    /// # Errors
    /// The reason why there is no frame.
    fn frame(&mut self) -> Result<(), String>;

    /// Picture of the last frame; `None` if nothing is drawn.
    fn picture(&self) -> Option<&wgpu::Texture> {
        None
    }

    /// Called once when the first drops are on the picture.
    fn settled(&mut self) {}
}

/// A contender, and its row in the table.
pub(crate) struct Entry {
    /// Name in the table.
    pub(crate) name: String,
    /// Number of drops of a frame, 0 for an empty frame.
    pub(crate) drops: u64,
    /// Index of the same without drops, if there is such an entry.
    pub(crate) empty: Option<usize>,
    /// Maker of the frames.
    pub(crate) contender: Box<dyn Contender>,
}

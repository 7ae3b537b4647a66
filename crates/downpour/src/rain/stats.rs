//! Numbers of frames with rain.

/// Numbers of a frame that was recorded.
///
/// What [`RainSettings`](super::RainSettings) ask for is beside what the frame has, so that nothing is reduced in silence. The device
/// alone knows how many drops it finds: that comes with [`RainStats::counts`], some frames later.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct RainStats {
    /// Number of the frame: 1 for the first that a [`Rain`](super::Rain) records, one more for each.
    pub frame: u64,
    /// Drops that the settings allow to be drawn one by one, 1 to 16 777 216: [`RainSettings::max_drops`](super::RainSettings::max_drops).
    pub drops_asked: u32,
    /// Drops of these for which the device's limits leave room; more are drawn as those that are not drawn one by one.
    pub max_drops: u32,
    /// Length of the list of drops, which drops, splashes and droplets share: a quarter more than are expected, and some thousand.
    pub room: u32,
    /// Columns of air that are searched for drops.
    pub columns: u32,
    /// Least diameter on the picture, pixels, from which drops would be drawn one by one if there were room for any number.
    pub least_pixels_asked: f64,
    /// Least diameter on the picture, pixels, of the drops that are drawn one by one; smaller ones are an extinction and a light of
    /// their own, with the same mean. It follows from view, settings and the device's limits alone.
    pub least_pixels: f64,
    /// Buffers that were created so far, in all frames: after the first frames of a size there are hardly any more.
    pub buffers_made: u64,
    /// Bytes that were written to the device for this frame.
    pub bytes_uploaded: u64,
    /// True if the frame has splashes; false without obstacles, or where more drops hit them than the device looks for.
    pub has_splashes: bool,
    /// True if the frame has droplets that rebounded; false as for splashes.
    pub has_droplets: bool,
    /// Drops that the device has found in the newest frame whose numbers have arrived; `None` until the first have.
    pub counts: Option<RainCounts>,
}

impl RainStats {
    /// Returns true if fewer drops are drawn one by one than the picture resolves, because
    /// [`RainSettings::max_drops`](super::RainSettings::max_drops) or the device's limits leave no room for them.
    #[must_use]
    pub fn is_reduced(&self) -> bool {
        self.least_pixels > self.least_pixels_asked
    }
}

/// Drops that the device has found for a frame.
///
/// They come to the host without a wait, when one of its later submissions finds that the frame is done: after a frame or two as a
/// rule. While the numbers of three frames are on their way, further frames have none. No frame depends on them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct RainCounts {
    /// Number of their frame, as [`RainStats::frame`].
    pub frame: u64,
    /// Drops, splashes and droplets in the picture, before obstacles stop some of the drops.
    pub found: u32,
    /// Those of them that are missing from the picture because the list was full; which ones, the order of the device's threads
    /// decides. 0 in all but the oddest views: [`RainStats::least_pixels`] is chosen so that the list has room for more drops than are
    /// expected. Fewer [`RainSettings::max_drops`](super::RainSettings::max_drops) help.
    pub without_room: u32,
    /// Drops that the device has looked at to find the falling ones.
    pub looked_at: u32,
}

impl RainCounts {
    /// Reads the numbers of a list, little-endian words as the device writes them: found, looked at, left out before the list.
    pub(super) fn new(frame: u64, room: u32, bytes: &[u8]) -> Self {
        let word = |k: usize| bytes.get(4 * k..4 * k + 4).and_then(|word| word.try_into().ok());
        let [found, looked_at, left_out] = [0, 1, 2].map(|k| word(k).map_or(0, u32::from_le_bytes));
        Self { frame, found, without_room: found.saturating_sub(room).saturating_add(left_out), looked_at }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn drops_beyond_the_room_are_counted() {
        let bytes: Vec<u8> = [120u32, 4000, 3].iter().flat_map(|word| word.to_le_bytes()).collect();
        let counts = |room| {
            let RainCounts { frame, found, without_room, looked_at } = RainCounts::new(7, room, &bytes);
            [frame, found.into(), without_room.into(), looked_at.into()]
        };
        assert_eq!(counts(100), [7, 120, 23, 4000]);
        assert_eq!(counts(120), [7, 120, 3, 4000]);
        assert_eq!(counts(5000), [7, 120, 3, 4000]);
        assert_eq!(RainCounts::new(1, 10, &[]), RainCounts { frame: 1, ..RainCounts::default() });
    }
}

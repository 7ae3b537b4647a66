//! Flashes of a clip as its viewer sees them: general flashes by WCAG 2.2, measured on the pixels.
//!
//! A general flash is a pair of opposing changes in relative luminance of 0.1 or more, where the darker one is below 0.8; not more
//! than three within any one second are safe (success criterion 2.3.1). The criterion counts what happens on a quarter of a field
//! of 10 degrees, 341 x 256 of 1024 x 768 pixels on a usual screen. Here a field is a ninth of the picture, and the mean over it is
//! taken.

use downpour_math::ops::f64 as ops;

/// Fields along an edge of the picture.
const FIELDS: usize = 3;

/// Minimum change of relative luminance.
const CHANGE: f64 = 0.1;

/// The darker luminance of a change is below this.
const DARK: f64 = 0.8;

/// Relative luminances of the frames of a clip, field by field.
#[derive(Clone, Debug)]
pub struct FlashMeter {
    fps: f64,
    frames: Vec<[f64; FIELDS * FIELDS]>,
}

impl FlashMeter {
    /// A meter for a clip of so many frames per second.
    #[must_use]
    pub fn new(fps: f64) -> Self {
        Self { fps, frames: Vec::new() }
    }

    /// Takes the next frame: sRGB pixels, rows from the top.
    pub fn add_frame(&mut self, size: [u32; 2], pixels: &[[u8; 3]]) {
        let [width, height] = size.map(|edge| edge.max(1) as usize);
        let (mut sums, mut counts) = ([0.0; FIELDS * FIELDS], [0u32; FIELDS * FIELDS]);
        for (k, pixel) in pixels.iter().enumerate() {
            let [column, row] = [(k % width) * FIELDS / width, (k / width) * FIELDS / height];
            let field = row.min(FIELDS - 1) * FIELDS + column;
            sums[field] += relative_luminance(*pixel);
            counts[field] += 1;
        }
        self.frames.push(std::array::from_fn(|k| sums[k] / f64::from(counts[k].max(1))));
    }

    /// The most general flashes within any one second, in any field.
    #[must_use]
    pub fn worst_second(&self) -> usize {
        (0..FIELDS * FIELDS).map(|field| self.worst_second_of(field)).max().unwrap_or(0)
    }

    /// The most general flashes of a field within any one second.
    fn worst_second_of(&self, field: usize) -> usize {
        let times = self.changes(field);
        let within = |begin: &f64| times.iter().filter(|time| (0.0..1.0).contains(&(**time - begin))).count();
        times.iter().map(|begin| within(begin) / 2).max().unwrap_or(0)
    }

    /// Times, in s, of the changes of a field: they rise and fall by turns.
    fn changes(&self, field: usize) -> Vec<f64> {
        let mut times = Vec::new();
        let Some(first) = self.frames.first() else { return times };
        // The extremes since the last change, and its direction.
        let (mut low, mut high) = (first[field], first[field]);
        let mut rises: Option<bool> = None;
        for (k, frame) in self.frames.iter().enumerate() {
            let here = frame[field];
            (low, high) = (low.min(here), high.max(here));
            let has_risen = here - low >= CHANGE && low < DARK && rises != Some(true);
            let has_fallen = high - here >= CHANGE && here < DARK && rises != Some(false);
            if has_risen || has_fallen {
                times.push(k as f64 / self.fps);
                rises = Some(has_risen);
                (low, high) = (here, here);
            }
        }
        times
    }
}

/// Relative luminance of an sRGB pixel, 0 to 1 (WCAG 2.2).
#[must_use]
pub fn relative_luminance(pixel: [u8; 3]) -> f64 {
    let [r, g, b] = pixel.map(|value| {
        let part = f64::from(value) / 255.0;
        if part <= 0.04045 { part / 12.92 } else { ops::pow((part + 0.055) / 1.055, 2.4) }
    });
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A clip of gray frames, 30 a second.
    fn worst(grays: impl IntoIterator<Item = u8>) -> usize {
        let mut meter = FlashMeter::new(30.0);
        for gray in grays {
            meter.add_frame([4, 3], &[[gray; 3]; 12]);
        }
        meter.worst_second()
    }

    #[test]
    fn luminance_is_that_of_the_standard() {
        assert_eq!((relative_luminance([0; 3]), relative_luminance([255; 3])), (0.0, 1.0));
        assert!((relative_luminance([255, 0, 0]) - 0.2126).abs() < 1.0e-12);
        // Middle gray of 18.4 % is 119 of 255 (IEC 61966-2-1).
        assert!((relative_luminance([119; 3]) - 0.184).abs() < 1.0e-3);
    }

    /// n flashes of one frame each in a second are n, and slow, faint or bright ones are none.
    #[test]
    fn flashes_are_counted_as_in_the_standard() {
        for n in [1, 2, 3, 4, 5, 7] {
            let flashes = (0..30u32).map(|k| if k % (30 / n) == 2 { 255 } else { 40 });
            assert_eq!(worst(flashes), n as usize, "{n}");
        }
        // One rise without a fall.
        assert_eq!(worst((0..30).map(|k| if k < 9 { 30 } else { 230 })), 0);
        // Changes below a tenth of the largest luminance.
        assert_eq!(worst((0..30).map(|k| if k % 4 == 0 { 60 } else { 90 })), 0);
        // Both bright: 231 is 0.80 of white.
        assert_eq!(worst((0..30).map(|k| if k % 4 == 0 { 255 } else { 236 })), 0);
        // A rise over several frames is one change, not several.
        assert_eq!(worst([0, 90, 130, 160, 190, 220, 255, 220, 190, 160, 130, 90, 0]), 1);
        assert_eq!((worst([]), worst([255])), (0, 0));
        // Four in two seconds are not more than three in one.
        assert_eq!(worst((0..60u32).map(|k| if k % 15 == 2 { 255 } else { 40 })), 2);
    }

    /// A corner that flashes is seen although the picture's mean hardly changes.
    #[test]
    fn a_part_of_the_picture_counts() {
        let mut meter = FlashMeter::new(30.0);
        for k in 0..30 {
            let mut pixels = [[40; 3]; 81];
            if k % 6 == 2 {
                for (column, row) in [(0, 0), (1, 0), (2, 0), (0, 1), (1, 1), (2, 1)] {
                    pixels[row * 9 + column] = [255; 3];
                }
            }
            meter.add_frame([9, 9], &pixels);
        }
        assert_eq!(meter.worst_second(), 5);
    }
}

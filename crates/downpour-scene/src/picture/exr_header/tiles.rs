//! The tiles of an OpenEXR file and the levels that they make up.
//!
//! Source: Academy Software Foundation, "OpenEXR File Layout": one level, mipmap levels (both sides halved), or
//! ripmap levels (each side halved by itself), down to one pixel, rounded down or up.

use super::cursor::Bytes;
use crate::error::SceneError;

/// The largest side of a tile.
const MAX_TILE: u32 = 1 << 16;

/// Tiling of an image.
#[derive(Clone, Copy, Debug)]
pub(in crate::picture) struct Tiles {
    width: u32,
    height: u32,
    levels: Levels,
    up: bool,
}

#[derive(Clone, Copy, Debug)]
enum Levels {
    One,
    Mip,
    Rip,
}

impl Tiles {
    pub(super) fn read(value: &mut Bytes<'_>) -> Result<Self, SceneError> {
        let (width, height, mode) = (value.u32()?, value.u32()?, value.u8()?);
        if !(1..=MAX_TILE).contains(&width) || !(1..=MAX_TILE).contains(&height) {
            let found = format!("{width} x {height}");
            return Err(SceneError::bad("tiles", found, format!("1 x 1 to {MAX_TILE} x {MAX_TILE}")));
        }
        let levels = match mode & 0x0f {
            0 => Levels::One,
            1 => Levels::Mip,
            2 => Levels::Rip,
            other => return Err(SceneError::bad("tiles", format!("level mode {other}"), "0, 1 or 2")),
        };
        let up = match mode >> 4 {
            0 => false,
            1 => true,
            other => return Err(SceneError::bad("tiles", format!("rounding {other}"), "0 or 1")),
        };
        Ok(Self { width, height, levels, up })
    }

    /// All tiles of all levels.
    pub(super) fn count(&self, width: u32, height: u32) -> u64 {
        let across = |side: u32| u64::from(side.div_ceil(self.width));
        let down = |side: u32| u64::from(side.div_ceil(self.height));
        match self.levels {
            Levels::One => across(width).saturating_mul(down(height)),
            Levels::Mip => {
                let pair = |(w, h): (u32, u32)| across(w).saturating_mul(down(h));
                let longer = self.sides(width.max(height)).count();
                let columns = self.sides(width).chain(std::iter::repeat(1));
                let rows = self.sides(height).chain(std::iter::repeat(1));
                columns.zip(rows).take(longer).map(pair).fold(0, u64::saturating_add)
            }
            Levels::Rip => {
                let sum = |sides: &mut dyn Iterator<Item = u64>| sides.fold(0, u64::saturating_add);
                sum(&mut self.sides(width).map(across)).saturating_mul(sum(&mut self.sides(height).map(down)))
            }
        }
    }

    /// The pixels of the largest tile.
    pub(super) fn area(&self, width: u32, height: u32) -> u64 {
        u64::from(self.width.min(width)).saturating_mul(u64::from(self.height.min(height)))
    }

    /// A side of every level, from the largest to 1.
    fn sides(&self, side: u32) -> impl Iterator<Item = u32> + use<> {
        let up = self.up;
        std::iter::successors(Some(side), move |&side| {
            (side > 1).then(|| if up { side.div_ceil(2) } else { side / 2 })
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tiles(side: u32, levels: Levels, up: bool) -> Tiles {
        Tiles { width: side, height: side, levels, up }
    }

    #[test]
    fn counts_are_those_of_the_format() {
        assert_eq!(tiles(64, Levels::One, false).count(130, 64), 3);
        // 5 x 3, 2 x 1, 1 x 1; rounded up 5 x 3, 3 x 2, 2 x 1, 1 x 1.
        assert_eq!(tiles(1, Levels::Mip, false).count(5, 3), 15 + 2 + 1);
        assert_eq!(tiles(1, Levels::Mip, true).count(5, 3), 15 + 6 + 2 + 1);
        // (4 + 2 + 1) columns by (2 + 1) rows.
        assert_eq!(tiles(1, Levels::Rip, false).count(4, 2), 21);
        // 16384^2 tiles of one pixel with all their mipmap levels.
        assert_eq!(tiles(1, Levels::Mip, false).count(16_384, 16_384), 357_913_941);
    }
}

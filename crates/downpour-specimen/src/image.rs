//! A picture in linear light.

/// Linear radiance, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Image {
    /// Pixels along a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green and blue radiance of each pixel, in the units of the sky map.
    pub pixels: Vec<[f32; 3]>,
}

impl Image {
    /// The pixel in column `column` of row `row`, counted from the left and from the top.
    ///
    /// # Panics
    /// If there is no such pixel.
    #[must_use]
    pub fn pixel(&self, column: u32, row: u32) -> [f32; 3] {
        assert!(column < self.width && row < self.height, "pixel ({column}, {row}) is outside the picture");
        self.pixels[row as usize * self.width as usize + column as usize]
    }
}

//! Pictures beside and below each other.

use image::{Rgb, RgbImage, imageops};

/// Pixels between pictures.
const GAP: u32 = 8;

/// Color between pictures.
const PAPER: Rgb<u8> = Rgb([255; 3]);

/// Rows of pictures of one size on white paper; a smaller row ends earlier.
pub(super) fn sheet(rows: &[Vec<RgbImage>]) -> Result<RgbImage, String> {
    let first = rows.iter().flatten().next().ok_or("no pictures for a sheet")?;
    let (width, height) = first.dimensions();
    if let Some(other) = rows.iter().flatten().find(|picture| picture.dimensions() != (width, height)) {
        return Err(format!("pictures of {width} x {height} and {:?} on one sheet", other.dimensions()));
    }
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0) as u32;
    let along = |count: u32, edge: u32| count * (edge + GAP) - GAP;
    let mut sheet = RgbImage::from_pixel(along(columns, width), along(rows.len() as u32, height), PAPER);
    for (row, pictures) in rows.iter().enumerate() {
        for (column, picture) in pictures.iter().enumerate() {
            let offset = |number: usize, edge: u32| number as i64 * i64::from(edge + GAP);
            imageops::replace(&mut sheet, picture, offset(column, width), offset(row, height));
        }
    }
    Ok(sheet)
}

/// Half as wide and high.
pub(super) fn halved(picture: &RgbImage) -> RgbImage {
    let (width, height) = picture.dimensions();
    imageops::resize(picture, (width / 2).max(1), (height / 2).max(1), imageops::FilterType::Triangle)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn gray(value: u8) -> RgbImage {
        RgbImage::from_pixel(4, 3, Rgb([value; 3]))
    }

    #[test]
    fn pictures_are_in_their_places() {
        let sheet = sheet(&[vec![gray(10), gray(20)], vec![gray(30)]]).expect("a sheet");
        assert_eq!(sheet.dimensions(), (4 + 8 + 4, 3 + 8 + 3));
        for (x, y, value) in
            [(0, 0, 10), (3, 2, 10), (4, 0, 255), (12, 0, 20), (0, 3, 255), (3, 13, 30), (12, 13, 255)]
        {
            assert_eq!(sheet.get_pixel(x, y).0[0], value, "{x}, {y}");
        }
    }

    #[test]
    fn sizes_that_differ_are_refused() {
        let wrong = RgbImage::new(5, 3);
        assert!(sheet(&[vec![gray(10), wrong]]).is_err());
        assert!(sheet(&[]).is_err());
    }
}

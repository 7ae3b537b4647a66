//! Drops as drawn in the papers: a bright streak each, as long as the fall of a drop in a sixtieth of a second, under any
//! light. So all of them are visible, and gaps too.

use downpour_math::ops::f64 as ops;
use image::{Rgb, RgbImage};

use super::walk::Eye;

/// Time of a streak, s.
const STREAK_S: f64 = 1.0 / 60.0;

/// Weight of the picture behind the streaks.
const BEHIND: f64 = 0.4;

/// Whiteness of a streak, 0 to 1.
const WHITE: f64 = 0.35;

/// A drop in the world: m and m/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Drop {
    position: [f64; 3],
    velocity: [f64; 3],
}

/// The drops of a list of `--dump-drops`.
pub(super) fn read(list: &str) -> Result<Vec<Drop>, String> {
    let mut lines = list.lines();
    let names: Vec<&str> = lines.next().unwrap_or_default().split(',').collect();
    let column = |name: &str| {
        names.iter().position(|n| *n == name).ok_or_else(|| format!("the list of drops has no \"{name}\""))
    };
    let position = [column("x_m")?, column("y_m")?, column("z_m")?];
    let velocity = [column("vx_m_s")?, column("vy_m_s")?, column("vz_m_s")?];
    lines
        .map(|line| {
            let cells: Vec<&str> = line.split(',').collect();
            let number = |column: usize| cells.get(column).and_then(|cell| cell.parse::<f64>().ok());
            let three = |[x, y, z]: [usize; 3]| Some([number(x)?, number(y)?, number(z)?]);
            let drop = three(position).zip(three(velocity));
            drop.map(|(position, velocity)| Drop { position, velocity })
                .ok_or_else(|| format!("no drop in \"{line}\""))
        })
        .collect()
}

/// Projection of a position to a picture: columns from the left, rows from the top; `None` behind the eye.
fn project(eye: &Eye, fov_deg: f64, [width, height]: [u32; 2], position: [f64; 3]) -> Option<[f64; 2]> {
    let [x, y, z]: [f64; 3] = std::array::from_fn(|axis| position[axis] - eye.position[axis]);
    let (sin, cos) = (ops::sin(eye.yaw), ops::cos(eye.yaw));
    let (right, ahead) = (x * cos - z * sin, -x * sin - z * cos);
    if ahead <= 1.0e-3 {
        return None;
    }
    let pixels = 0.5 * f64::from(height) / (ops::tan(0.5 * fov_deg.to_radians()) * ahead);
    Some([0.5 * f64::from(width) + pixels * right, 0.5 * f64::from(height) - pixels * y])
}

/// A picture, darker, with the drops' streaks.
pub(super) fn draw(picture: &RgbImage, eye: &Eye, fov_deg: f64, drops: &[Drop]) -> RgbImage {
    let mut drawn = picture.clone();
    for pixel in drawn.pixels_mut() {
        *pixel = Rgb(pixel.0.map(|value| (f64::from(value) * BEHIND) as u8));
    }
    let size = [picture.width(), picture.height()];
    for drop in drops {
        let at = |time: f64| std::array::from_fn(|axis| drop.position[axis] + drop.velocity[axis] * time);
        let end = |time: f64| project(eye, fov_deg, size, at(time));
        let ends = end(-0.5 * STREAK_S).zip(end(0.5 * STREAK_S));
        if let Some((from, to)) = ends {
            line(&mut drawn, from, to);
        }
    }
    drawn
}

fn line(picture: &mut RgbImage, from: [f64; 2], to: [f64; 2]) {
    // Longer than the picture is high happens at the eye alone.
    let steps = (to[0] - from[0]).abs().max((to[1] - from[1]).abs()).ceil().clamp(1.0, 4096.0);
    for step in 0..=steps as u32 {
        let fraction = f64::from(step) / steps;
        let [x, y] = [0, 1].map(|axis| (from[axis] + (to[axis] - from[axis]) * fraction).floor());
        if x < 0.0 || y < 0.0 || x >= f64::from(picture.width()) || y >= f64::from(picture.height()) {
            continue;
        }
        let pixel = picture.get_pixel_mut(x as u32, y as u32);
        *pixel = Rgb(pixel.0.map(|value| (f64::from(value) + (255.0 - f64::from(value)) * WHITE) as u8));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const SIZE: [u32; 2] = [64, 36];

    fn near(found: Option<[f64; 2]>, expected: [f64; 2]) {
        let found = found.expect("before the eye");
        assert!((0..2).all(|k| (found[k] - expected[k]).abs() < 1.0e-9), "{found:?}, {expected:?}");
    }

    #[test]
    fn places_are_where_a_camera_sees_them() {
        let half_height = ops::tan(0.2);
        let fov = 0.4f64.to_degrees();
        let ahead = Eye { position: [1.0, 2.0, 3.0], yaw: 0.0 };
        near(project(&ahead, fov, SIZE, [1.0, 2.0, -7.0]), [32.0, 18.0]);
        near(project(&ahead, fov, SIZE, [1.0, 2.0 + 10.0 * half_height, -7.0]), [32.0, 0.0]);
        near(project(&ahead, fov, SIZE, [1.0 + 10.0 * half_height, 2.0, -7.0]), [50.0, 18.0]);
        assert_eq!(project(&ahead, fov, SIZE, [1.0, 2.0, 4.0]), None);
        // A quarter of a circle to the left: -X is ahead, and -Z to the right.
        let left = Eye { yaw: std::f64::consts::FRAC_PI_2, ..ahead };
        near(project(&left, fov, SIZE, [-9.0, 2.0, 3.0]), [32.0, 18.0]);
        near(project(&left, fov, SIZE, [-9.0, 2.0, 3.0 - 10.0 * half_height]), [50.0, 18.0]);
    }

    #[test]
    fn a_streak_is_about_its_drop() {
        let list = "id,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,diameter_mm,kind\n7,0,0,-10,0,-6,0,3,falling\n";
        let drops = read(list).expect("a drop");
        let eye = Eye { position: [0.0; 3], yaw: 0.0 };
        let picture = RgbImage::from_pixel(SIZE[0], SIZE[1], Rgb([100; 3]));
        let drawn = draw(&picture, &eye, 10.0, &drops);
        let lit: Vec<(u32, u32)> =
            drawn.enumerate_pixels().filter(|(_, _, p)| p.0[0] > 40).map(|(x, y, _)| (x, y)).collect();
        // 0.1 m at 10 m: 2.06 of the 36 rows of 1.75 m.
        assert_eq!(lit, [(32, 16), (32, 17), (32, 18), (32, 19)]);
        assert_eq!(drawn.get_pixel(0, 0).0, [40; 3]);
    }

    #[test]
    fn what_is_no_drop_is_named() {
        assert_eq!(read("id\n"), Err("the list of drops has no \"x_m\"".to_owned()));
        let list = "x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s\n1,2,3,4,5,six\n";
        assert_eq!(read(list), Err("no drop in \"1,2,3,4,5,six\"".to_owned()));
    }
}

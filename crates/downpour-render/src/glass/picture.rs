//! A picture through a pane of glass with water on it, ray by ray through the lens. Twin of
//! `shaders/wgsl/render/glass_picture.wgsl`.

use downpour_drop::optics::{optics_fresnel, optics_fresnel_tatarchuk, optics_reflect, optics_refract};
use downpour_math::ops;
use downpour_math::packing::packing_octahedral_encode;
use downpour_shaders::render::glass::{
    GLASS_PICTURE_APART, GLASS_PICTURE_FAR, GLASS_PICTURE_GLASS, GLASS_PICTURE_INDEX, GLASS_PICTURE_MIRROR,
    GLASS_PICTURE_TATARCHUK,
};
use glam::{IVec2, UVec2, Vec2, Vec3, Vec4};
use rayon::prelude::*;

use super::GlassPicture;
use super::water::{glass_picture_water_cap, glass_picture_water_leave, glass_picture_water_normal};

/// What a ray finds on the pane.
#[derive(Clone, Copy, Debug)]
struct Met {
    normal: Vec3,
    wet: bool,
    /// How fast the normal turns, 1/m.
    curvature: f32,
}

/// A ray that meets the pane.
#[derive(Clone, Copy, Debug)]
struct Ray {
    /// Where, on the pane.
    place: Vec2,
    /// Its direction, in the pane's axes.
    d: Vec3,
    /// Where, from the eye.
    from_eye: Vec3,
    /// From the sample's place in its pixel to the middle, pixels.
    shift: Vec2,
    /// The angle between neighbouring rays.
    angle: f32,
    /// Their distance on the pane.
    apart: f32,
}

/// All that a pixel is made of.
#[derive(Clone, Copy, Debug)]
pub(super) struct Look<'a> {
    pub(super) glass: &'a GlassPicture,
    /// The picture behind the pane with its distances, all levels.
    pub(super) behind: &'a [[f32; 4]],
    /// What is round the eye, all levels.
    pub(super) capture: &'a [[f32; 4]],
}

/// Weight of the cell before, at or after a place, and how it changes; t is -0.5 to 0.5.
#[must_use]
pub fn glass_picture_spline(t: f32, which: i32) -> Vec2 {
    match which {
        0 => Vec2::new(0.5 * (0.5 - t) * (0.5 - t), t - 0.5),
        1 => Vec2::new(0.75 - t * t, -2.0 * t),
        _ => Vec2::new(0.5 * (0.5 + t) * (0.5 + t), t + 0.5),
    }
}

fn refract(incident: Vec3, normal: Vec3, eta: f32) -> Vec4 {
    let (direction, squared) = optics_refract(incident.to_array(), normal.to_array(), eta);
    Vec3::from(direction).extend(squared)
}

impl Look<'_> {
    /// The whole picture, rows from the top.
    pub(super) fn picture(&self) -> Vec<[f32; 3]> {
        let frame = &self.glass.frame;
        let pixel = |y| (0..frame.width).map(move |x| self.glass_picture_pixel(x, y).to_array());
        (0..frame.height).into_par_iter().flat_map_iter(pixel).collect()
    }

    /// How wet a cell is, 0 to 1.
    fn glass_picture_wetness(&self, column: i32, row: i32) -> f32 {
        let [width, height] = self.glass.frame.wet_size;
        let x = column.clamp(0, width as i32 - 1) as u32;
        let y = row.clamp(0, height as i32 - 1) as u32;
        let index = y * width + x;
        let byte = (self.glass.wet[index as usize / 4] >> (8 * (index % 4))) & 255;
        byte as f32 / 255.0
    }

    /// Height of the film and its slopes: the quadratic B-spline over the cells.
    fn glass_picture_film(&self, place: Vec2) -> Vec3 {
        let frame = &self.glass.frame;
        let at = place * frame.cells - 0.5;
        let middle = (at + 0.5).floor();
        let t = at - middle;
        let mut sum = Vec3::ZERO;
        for j in 0..3 {
            let wy = glass_picture_spline(t.y, j);
            for i in 0..3 {
                let wet = self.glass_picture_wetness(middle.x as i32 + i - 1, middle.y as i32 + j - 1);
                let wx = glass_picture_spline(t.x, i);
                sum += Vec3::new(wx.x * wy.x, wx.y * wy.x, wx.x * wy.y) * wet;
            }
        }
        let per_metre = frame.film * frame.cells;
        Vec3::new(sum.x * frame.film, sum.y * per_metre, sum.z * per_metre)
    }

    /// The surface that a ray leaves by, which enters the water at a place of the glass.
    fn glass_picture_meet(&self, place: Vec2, aside: Vec2) -> Met {
        let frame = &self.glass.frame;
        let column = ((place.x * frame.bins).max(0.0) as u32).min(frame.columns - 1);
        let row = ((place.y * frame.bins).max(0.0) as u32).min(frame.rows - 1);
        let bin = (row * frame.columns + column) as usize;
        let bins = &self.glass.bins;
        let mut highest = 0.0;
        let mut found = 0;
        for &index in &bins[bins[bin] as usize..bins[bin + 1] as usize] {
            let height = glass_picture_water_cap(&self.glass.drops[index as usize], place).x;
            if height > highest {
                highest = height;
                found = index;
            }
        }
        if highest > 0.0 {
            let drop = &self.glass.drops[found as usize];
            let z = glass_picture_water_leave(drop, place, aside);
            let cap = glass_picture_water_cap(drop, place + aside * z);
            let normal = glass_picture_water_normal(Vec2::new(cap.y, cap.z));
            return Met { normal, wet: true, curvature: 1.0 / drop.sphere };
        }
        if frame.film <= 0.0 {
            return Met { normal: Vec3::Z, wet: false, curvature: 0.0 };
        }
        let film = self.glass_picture_film(place);
        let normal = glass_picture_water_normal(Vec2::new(film.y, film.z));
        Met { normal, wet: film.x > 0.0, curvature: 0.0 }
    }

    /// A texel of a level of the picture; the nearest where there is none.
    fn glass_picture_texel(&self, level: u32, column: i32, row: i32) -> Vec4 {
        let [width, height, first, _] = self.glass.frame.levels[level as usize];
        let x = column.clamp(0, width as i32 - 1) as u32;
        let y = row.clamp(0, height as i32 - 1) as u32;
        Vec4::from(self.behind[(first + y * width + x) as usize])
    }

    /// A texel of a level of the capture. Beyond an edge the octahedral map goes on at the edge's mirror image.
    fn glass_picture_round_texel(&self, level: u32, column: i32, row: i32) -> Vec4 {
        let whole = self.glass.frame.capture_size;
        let size = whole >> level;
        let edge = size as i32;
        let (mut x, mut y) = (column, row);
        if x < 0 || x >= edge {
            x = x.clamp(0, edge - 1);
            y = edge - 1 - y;
        }
        if y < 0 || y >= edge {
            y = y.clamp(0, edge - 1);
            x = edge - 1 - x;
        }
        let first = 4 * (whole * whole - size * size) / 3;
        let (x, y) = (x.clamp(0, edge - 1) as u32, y.clamp(0, edge - 1) as u32);
        Vec4::from(self.capture[(first + y * size + x) as usize])
    }

    /// A level of the picture or of the capture at a place of [0, 1], bilinear.
    fn glass_picture_level(&self, of_capture: bool, level: u32, place: Vec2) -> Vec3 {
        let frame = &self.glass.frame;
        let size = if of_capture {
            Vec2::splat((frame.capture_size >> level) as f32)
        } else {
            let [width, height, ..] = frame.levels[level as usize];
            UVec2::new(width, height).as_vec2()
        };
        let at = place * size - 0.5;
        let low = at.floor();
        let part = at - low;
        let mut sum = Vec3::ZERO;
        for k in 0..4 {
            let step = IVec2::new(k & 1, k >> 1);
            let share_x = if step.x == 1 { part.x } else { 1.0 - part.x };
            let share = share_x * if step.y == 1 { part.y } else { 1.0 - part.y };
            let cell = low.as_ivec2() + step;
            if share > 0.0 {
                let texel = if of_capture {
                    self.glass_picture_round_texel(level, cell.x, cell.y)
                } else {
                    self.glass_picture_texel(level, cell.x, cell.y)
                };
                sum += texel.truncate() * share;
            }
        }
        sum
    }

    /// The picture or the capture at a place of [0, 1], for a footprint in texels of its finest level.
    fn glass_picture_at(&self, of_capture: bool, place: Vec2, footprint: f32) -> Vec3 {
        let frame = &self.glass.frame;
        let last = (if of_capture { frame.capture_last } else { frame.last }) as f32;
        let level = ops::log2(footprint.max(1.0e-6)).clamp(0.0, last);
        let low = level.floor();
        let part = level - low;
        let mut sum = self.glass_picture_level(of_capture, low as u32, place) * (1.0 - part);
        if part > 0.0 {
            sum += self.glass_picture_level(of_capture, low as u32 + 1, place) * part;
        }
        sum
    }

    /// What stands round the eye in a direction, for a footprint of some angle.
    fn glass_picture_round(&self, direction: Vec3, footprint: f32) -> Vec3 {
        let place = Vec2::from(packing_octahedral_encode(direction.to_array())) * 0.5 + 0.5;
        self.glass_picture_at(true, place, footprint / self.glass.frame.capture_texel)
    }

    /// Where a direction is on the picture: -1 to 1 right and up, and its depth.
    fn glass_picture_project(&self, direction: Vec3) -> Vec3 {
        let frame = &self.glass.frame;
        let [right, up, forward] = [frame.right, frame.up, frame.forward].map(Vec3::from);
        let depth = direction.dot(forward);
        let near = depth.max(1.0e-6);
        Vec3::new(
            direction.dot(right) / right.dot(right) / near,
            direction.dot(up) / up.dot(up) / near,
            depth,
        )
    }

    /// What a ray shows that begins at an offset from the eye. Its footprint is an angle.
    fn glass_picture_seen(&self, from_eye: Vec3, direction: Vec3, shift: Vec2, footprint: f32) -> Vec3 {
        let frame = &self.glass.frame;
        let size = Vec2::new(frame.width as f32, frame.height as f32);
        let guess = self.glass_picture_project(direction);
        let distance = if guess.z > 0.0 && guess.x.abs() < 1.0 && guess.y.abs() < 1.0 {
            let pixel = Vec2::new(0.5 + 0.5 * guess.x, 0.5 - 0.5 * guess.y) * size;
            self.glass_picture_texel(0, pixel.x as i32, pixel.y as i32).w
        } else {
            let square = Vec2::from(packing_octahedral_encode(direction.to_array()));
            let texel = (square * 0.5 + 0.5) * frame.capture_size as f32;
            self.glass_picture_round_texel(0, texel.x as i32, texel.y as i32).w
        };
        let to = direction + from_eye / distance.clamp(0.1, GLASS_PICTURE_FAR);
        let place = self.glass_picture_project(to);
        let texels = (footprint / frame.pixel_angle).max(1.0);
        // Towards the picture's edge the capture takes over, within the footprint.
        let at = Vec2::new(0.5 + 0.5 * place.x, 0.5 - 0.5 * place.y) + shift / size;
        let inside = (at.x.min(1.0 - at.x) * size.x).min(at.y.min(1.0 - at.y) * size.y);
        let share = if place.z > 0.0 { ((inside + 0.5) / texels).clamp(0.0, 1.0) } else { 0.0 };
        let mut sum = Vec3::ZERO;
        if share > 0.0 {
            sum = self.glass_picture_at(false, at, texels) * share;
        }
        if share < 1.0 {
            sum += self.glass_picture_round(to, footprint) * (1.0 - share);
        }
        sum
    }

    /// A direction of the pane in the world.
    fn glass_picture_world(&self, v: Vec3) -> Vec3 {
        let frame = &self.glass.frame;
        let [across, down, outward] = [frame.across, frame.down, frame.outward].map(Vec3::from);
        across * v.x + down * v.y + outward * v.z
    }

    /// What of the room a ray shows that leaves water towards the eye's side in a direction of the pane.
    fn glass_picture_inside(&self, v: Vec3) -> Vec3 {
        let aside = v.truncate() * self.glass.frame.water;
        let out = aside.extend(-(1.0 - aside.dot(aside)).max(1.0e-4).sqrt());
        self.glass_picture_round(self.glass_picture_world(out), GLASS_PICTURE_MIRROR) * self.glass.frame.room
    }

    /// Share of the light that the outer surface reflects: that of water under a normal, or that of dry glass.
    fn glass_picture_outer(&self, cosine: f32, met: &Met, within: f32) -> f32 {
        let frame = &self.glass.frame;
        if !met.wet {
            return optics_fresnel(cosine, GLASS_PICTURE_INDEX);
        }
        let mut surface = optics_fresnel(within, 1.0 / frame.water);
        if frame.fresnel == GLASS_PICTURE_TATARCHUK && surface < 1.0 {
            surface = optics_fresnel_tatarchuk(within);
        }
        let glass =
            (1.0 - (1.0 - cosine * cosine) / (GLASS_PICTURE_INDEX * GLASS_PICTURE_INDEX)).max(0.0).sqrt();
        let inner = optics_fresnel(glass, frame.water / GLASS_PICTURE_INDEX);
        1.0 - (1.0 - surface) * (1.0 - inner)
    }

    /// What a ray shows that meets the pane.
    fn glass_picture_through(&self, ray: &Ray) -> Vec3 {
        let (water, room) = (self.glass.frame.water, self.glass.frame.room);
        let (d, shift) = (ray.d, ray.shift);
        let aside = d.truncate() / water;
        let w = aside.extend((1.0 - aside.dot(aside)).max(0.0).sqrt());
        let met = self.glass_picture_meet(ray.place, w.truncate() / w.z);
        let within = w.dot(met.normal);
        let first = optics_fresnel(d.z, GLASS_PICTURE_INDEX);
        let outer = self.glass_picture_outer(d.z, &met, within.max(0.0));
        let bent = refract(w, -met.normal, water);
        let total = met.wet && (bent.w <= 0.0 || within <= 0.0);
        let leaves = match (total, met.wet) {
            (true, _) => w,
            (_, true) => bent.truncate(),
            _ => d,
        };
        let through = if total { 0.0 } else { (1.0 - first) * (1.0 - outer) / (1.0 - first * outer) };
        let mut sum = Vec3::ZERO;
        if through > 0.0 {
            let turned = (water - 1.0) * met.curvature / leaves.dot(met.normal).max(0.2);
            let footprint = ray.angle + ray.apart * turned;
            let seen = self.glass_picture_world(leaves);
            sum = self.glass_picture_seen(ray.from_eye, seen, shift, footprint) * through;
        }
        let back = Vec3::from(optics_reflect(w.to_array(), (-met.normal).to_array()));
        let mut rest = 1.0 - through;
        if total && back.z > 0.0 {
            // Out on the other side of the drop.
            let footprint = ray.angle + 2.0 * ray.apart * met.curvature;
            let seen = self.glass_picture_world(back);
            sum = self.glass_picture_seen(ray.from_eye, seen, shift, footprint) * (1.0 - first);
            rest = first;
        }
        if room > 0.0 {
            let mirror = self.glass_picture_world(Vec3::new(d.x, d.y, -d.z));
            sum += self.glass_picture_round(mirror, GLASS_PICTURE_MIRROR) * (room * first);
            let away = if back.z > 0.0 { Vec3::new(back.x, back.y, -back.z) } else { back };
            sum += self.glass_picture_inside(away) * (rest - first).max(0.0);
        }
        sum
    }

    /// The ray through a place of the picture, in pixels from the top left, of length 1.
    fn glass_picture_ray(&self, x: f32, y: f32) -> Vec3 {
        let frame = &self.glass.frame;
        let u = 2.0 * x / frame.width as f32 - 1.0;
        let v = 1.0 - 2.0 * y / frame.height as f32;
        let ray = Vec3::from(frame.forward) + Vec3::from(frame.right) * u + Vec3::from(frame.up) * v;
        ray / ray.dot(ray).sqrt()
    }

    /// A sample of a pixel: a place of the lens (in its radius) and of the pixel.
    fn glass_picture_sample(&self, x: f32, y: f32, distance: f32, sample: [f32; 4]) -> Vec3 {
        let frame = &self.glass.frame;
        let [lens_x, lens_y, dx, dy] = sample;
        let ray = self.glass_picture_ray(x + dx, y + dy);
        let (right, up) = (Vec3::from(frame.right), Vec3::from(frame.up));
        let (right, up) = (right / right.dot(right).sqrt(), up / up.dot(up).sqrt());
        let from_eye = (right * lens_x + up * lens_y) * frame.lens;
        // What is behind is looked up for the pixel's middle: it is sampled already.
        let shift = Vec2::new(0.5 - dx, 0.5 - dy);
        let (corner, outward) = (Vec3::from(frame.corner), Vec3::from(frame.outward));
        let plane = corner.dot(outward);
        let towards = ray.dot(outward);
        let far = distance.min(GLASS_PICTURE_FAR);
        let pane = plane / towards.max(1.0e-6);
        if towards < 1.0e-3 || pane > far {
            return self.glass_picture_seen(Vec3::ZERO, ray, shift, frame.pixel_angle);
        }
        let depth = if frame.focus == GLASS_PICTURE_GLASS { pane } else { far };
        let aim = ray * depth - from_eye;
        let direction = aim / aim.dot(aim).sqrt();
        let (across, down) = (Vec3::from(frame.across), Vec3::from(frame.down));
        let d = Vec3::new(direction.dot(across), direction.dot(down), direction.dot(outward).max(1.0e-4));
        let way = (plane - from_eye.dot(outward)) / d.z;
        let met = from_eye + direction * way;
        let on = met - corner;
        let place = Vec2::new(on.dot(across), on.dot(down));
        let among = (1.0 / frame.samples as f32).sqrt();
        let apart = frame.lens * GLASS_PICTURE_APART * among;
        let pixel = frame.pixel_angle;
        let [width, height] = frame.size;
        if place.x < 0.0 || place.y < 0.0 || place.x > width || place.y > height {
            let angle = pixel + apart * (1.0 / depth - 1.0 / far).abs();
            return self.glass_picture_seen(from_eye, direction, shift, angle);
        }
        self.glass_picture_through(&Ray {
            place,
            d,
            from_eye: met,
            shift,
            angle: pixel * among + apart * (1.0 / depth - 1.0 / far).abs(),
            apart: pixel * pane * among + apart * (1.0 - pane / depth).abs(),
        })
    }

    /// A pixel.
    fn glass_picture_pixel(&self, x: u32, y: u32) -> Vec3 {
        let distance = self.glass_picture_texel(0, x as i32, y as i32).w;
        let mut sum = Vec3::ZERO;
        for &sample in &self.glass.lens {
            sum += self.glass_picture_sample(x as f32, y as f32, distance, sample);
        }
        sum / self.glass.lens.len() as f32
    }
}

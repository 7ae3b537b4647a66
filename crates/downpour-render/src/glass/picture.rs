//! A picture through a pane of glass with water on it, ray by ray through the lens. Twin of
//! `shaders/wgsl/render/glass_picture.wgsl`.

use std::f32::consts::FRAC_1_SQRT_2;

use downpour_drop::optics::{optics_fresnel, optics_fresnel_tatarchuk, optics_reflect, optics_refract};
use downpour_shaders::render::glass::{
    GLASS_PICTURE_APART, GLASS_PICTURE_DIFFUSE, GLASS_PICTURE_FAR, GLASS_PICTURE_GLASS, GLASS_PICTURE_INDEX,
    GLASS_PICTURE_MIRROR, GLASS_PICTURE_MOMENT, GLASS_PICTURE_TATARCHUK,
};
use glam::{Vec2, Vec3, Vec4};
use rayon::prelude::*;

use super::GlassPicture;
use super::blade::{glass_picture_blade_at, glass_picture_blade_part};
use super::light::glass_picture_light_seen;
use super::meet::PaneHit;

/// A ray that meets the pane.
#[derive(Clone, Copy, Debug)]
struct Ray {
    /// Position on the pane.
    position: Vec2,
    /// Its direction, in the pane's axes.
    d: Vec3,
    /// Position relative to the eye.
    from_eye: Vec3,
    /// From the sample's position in its pixel to the middle, pixels.
    shift: Vec2,
    /// The angle between neighboring rays.
    angle: f32,
    /// Their distance on the pane.
    apart: f32,
}

/// All that a pixel is made of.
#[derive(Clone, Copy, Debug)]
pub(super) struct PaneTracer<'a> {
    pub(super) glass: &'a GlassPicture,
    /// The picture behind the pane with its distances, all levels.
    pub(super) behind: &'a [[f32; 4]],
    /// Environment map around the eye, all levels.
    pub(super) capture: &'a [[f32; 4]],
}

fn refract(incident: Vec3, normal: Vec3, eta: f32) -> Vec4 {
    let (direction, squared) = optics_refract(incident.to_array(), normal.to_array(), eta);
    Vec3::from(direction).extend(squared)
}

impl PaneTracer<'_> {
    /// The whole picture, rows from the top.
    pub(super) fn picture(&self) -> Vec<[f32; 3]> {
        let frame = &self.glass.frame;
        let pixel = |y| (0..frame.camera.width).map(move |x| self.glass_picture_pixel(x, y).to_array());
        (0..frame.camera.height).into_par_iter().flat_map_iter(pixel).collect()
    }

    /// Radiance of the lamps and the sun in a drop: they are points, and in no picture of the scene behind the pane.
    fn glass_picture_lights(&self, from_eye: Vec3, direction: Vec3, footprint: f32) -> Vec3 {
        let mut sum = Vec3::ZERO;
        for light in self.glass.lights.iter().take(self.glass.frame.lights as usize) {
            sum += glass_picture_light_seen(light, from_eye, direction, footprint);
        }
        sum
    }

    /// A direction of the pane in the world.
    fn glass_picture_world(&self, v: Vec3) -> Vec3 {
        let frame = &self.glass.frame;
        let [across, down, outward] = [frame.across, frame.down, frame.outward].map(Vec3::from);
        across * v.x + down * v.y + outward * v.z
    }

    /// Radiance of the interior ambient along a ray that leaves water toward the eye's side, in a direction of the pane.
    fn glass_picture_inside(&self, v: Vec3) -> Vec3 {
        let aside = v.truncate() * self.glass.frame.water;
        let out = aside.extend(-(1.0 - aside.dot(aside)).max(1.0e-4).sqrt());
        self.glass_picture_environment(self.glass_picture_world(out), GLASS_PICTURE_MIRROR)
            * self.glass.frame.room
    }

    /// Fraction of the light that the outer surface reflects: that of water under a normal, or that of dry glass.
    fn glass_picture_outer(&self, cosine: f32, met: &PaneHit, within: f32) -> f32 {
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

    /// Radiance along a ray that meets the pane.
    fn glass_picture_through(&self, ray: &Ray) -> Vec3 {
        let (water, room) = (self.glass.frame.water, self.glass.frame.room);
        let (d, shift) = (ray.d, ray.shift);
        let aside = d.truncate() / water;
        let w = aside.extend((1.0 - aside.dot(aside)).max(0.0).sqrt());
        let met = self.glass_picture_meet(ray.position, w.truncate() / w.z);
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
            if met.lit {
                sum += self.glass_picture_lights(ray.from_eye, seen, footprint) * through;
            }
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
            sum += self.glass_picture_environment(mirror, GLASS_PICTURE_MIRROR) * (room * first);
            let away = if back.z > 0.0 { Vec3::new(back.x, back.y, -back.z) } else { back };
            sum += self.glass_picture_inside(away) * (rest - first).max(0.0);
        }
        sum
    }

    /// Radiance of a diffuse surface of the eye's side of a blade. `aside` is where its rounded face is turned, of length 1; `across` is
    /// how far it is turned there, -1 to 1. What it sees of the room and of the scene is as much as a face of that slope sees.
    fn glass_picture_diffuse(&self, aside: Vec2, across: f32) -> Vec3 {
        let turned = 0.8 * across;
        let upright = (1.0 - turned * turned).sqrt();
        let outside = 0.5 - 0.5 * upright;
        let to_room = self.glass_picture_world((aside * turned).extend(-upright));
        let room = self.glass_picture_environment(to_room, GLASS_PICTURE_DIFFUSE) * self.glass.frame.room;
        let side = if turned > 0.0 { 1.0 } else { -1.0 };
        let to_scene = self.glass_picture_world((aside * (side * FRAC_1_SQRT_2)).extend(FRAC_1_SQRT_2));
        room * (1.0 - outside) + self.glass_picture_environment(to_scene, GLASS_PICTURE_DIFFUSE) * outside
    }

    /// Radiance of the wipers along a ray that meets the pane at a position, in a direction of the pane, at a fraction of the exposure;
    /// `None` where there is none.
    fn glass_picture_wiper(&self, position: Vec2, d: Vec3, fraction: f32) -> Option<Vec3> {
        let frame = &self.glass.frame;
        for blade in frame.blades.iter().take(frame.blade_count as usize) {
            let direction = glass_picture_blade_at(blade, fraction);
            let part = glass_picture_blade_part(blade, direction, position);
            if part.y > 0.0 {
                let first = optics_fresnel(d.z, GLASS_PICTURE_INDEX);
                let aside = Vec2::new(-direction.y, direction.x);
                let mut sum = self.glass_picture_diffuse(aside, part.x) * (part.y * (1.0 - first));
                if frame.room > 0.0 {
                    let mirror = self.glass_picture_world(Vec3::new(d.x, d.y, -d.z));
                    sum +=
                        self.glass_picture_environment(mirror, GLASS_PICTURE_MIRROR) * (frame.room * first);
                }
                return Some(sum);
            }
        }
        None
    }

    /// A sample of a pixel: a position of the lens (in its radius) and of the pixel, and a fraction of the exposure.
    fn glass_picture_sample(&self, x: f32, y: f32, distance: f32, sample: [f32; 4], moment: f32) -> Vec3 {
        let frame = &self.glass.frame;
        let [lens_x, lens_y, dx, dy] = sample;
        let ray = frame.camera.camera_direction(x + dx, y + dy);
        let (right, up) = (frame.camera.right, frame.camera.up);
        let (right, up) = (right / right.dot(right).sqrt(), up / up.dot(up).sqrt());
        let from_eye = (right * lens_x + up * lens_y) * frame.lens;
        // The scene behind is looked up at the pixel's center: it is sampled already.
        let shift = Vec2::new(0.5 - dx, 0.5 - dy);
        let (corner, outward) = (Vec3::from(frame.corner), Vec3::from(frame.outward));
        let plane = corner.dot(outward);
        let towards = ray.dot(outward);
        let far = distance.min(GLASS_PICTURE_FAR);
        let pane = plane / towards.max(1.0e-6);
        if towards < 1.0e-3 || pane > far {
            return self.glass_picture_seen(Vec3::ZERO, ray, shift, frame.camera.pixel_angle);
        }
        let depth = if frame.focus == GLASS_PICTURE_GLASS { pane } else { far };
        let aim = ray * depth - from_eye;
        let direction = aim / aim.dot(aim).sqrt();
        let (across, down) = (Vec3::from(frame.across), Vec3::from(frame.down));
        let d = Vec3::new(direction.dot(across), direction.dot(down), direction.dot(outward).max(1.0e-4));
        let way = (plane - from_eye.dot(outward)) / d.z;
        let met = from_eye + direction * way;
        let on = met - corner;
        let position = Vec2::new(on.dot(across), on.dot(down));
        let among = (1.0 / frame.samples as f32).sqrt();
        let apart = frame.lens * GLASS_PICTURE_APART * among;
        let pixel = frame.camera.pixel_angle;
        let [width, height] = frame.size;
        if position.x < 0.0 || position.y < 0.0 || position.x > width || position.y > height {
            let angle = pixel + apart * (1.0 / depth - 1.0 / far).abs();
            return self.glass_picture_seen(from_eye, direction, shift, angle);
        }
        if let Some(seen) = self.glass_picture_wiper(position, d, moment) {
            return seen;
        }
        self.glass_picture_through(&Ray {
            position,
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
        for (k, &sample) in self.glass.lens.iter().enumerate() {
            let moment = ((k as f32 + 0.5) * GLASS_PICTURE_MOMENT).fract();
            sum += self.glass_picture_sample(x as f32, y as f32, distance, sample, moment);
        }
        sum / self.glass.lens.len() as f32
    }
}

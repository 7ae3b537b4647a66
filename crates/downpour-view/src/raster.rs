//! The window as a picture, without a window and without a GPU: triangles of egui, filled on the CPU, the same bits everywhere.

use std::collections::HashMap;
use std::sync::Arc;

use egui::epaint::{ClippedPrimitive, Primitive, Vertex};
use egui::{Color32, ColorImage, ImageData, Pos2, TextureId, TexturesDelta};

/// Textures, as egui has sent them.
#[derive(Debug, Default)]
pub struct Raster {
    textures: HashMap<TextureId, Arc<ColorImage>>,
}

impl Raster {
    /// Takes new textures, and parts of them.
    pub fn update(&mut self, delta: &mut TexturesDelta) {
        for (&id, changes) in &delta.set {
            for change in changes {
                let ImageData::Color(image) = &change.image;
                match (change.pos, self.textures.get_mut(&id)) {
                    (Some([left, top]), Some(texture)) => patch(Arc::make_mut(texture), image, left, top),
                    _ => {
                        self.textures.insert(id, Arc::clone(image));
                    }
                }
            }
        }
        for id in &delta.free {
            self.textures.remove(id);
        }
        // egui wants to know that they were taken.
        delta.clear();
    }

    /// Fills the triangles of a pass: a picture of `size` pixels, premultiplied sRGB over a background.
    #[must_use]
    pub fn draw(
        &self,
        primitives: &[ClippedPrimitive],
        size: [usize; 2],
        pixels_per_point: f32,
        background: Color32,
    ) -> Vec<[u8; 3]> {
        let start = [background.r(), background.g(), background.b()].map(f32::from);
        let mut target = vec![start; size[0] * size[1]];
        for ClippedPrimitive { clip_rect, primitive } in primitives {
            let Primitive::Mesh(mesh) = primitive else { continue };
            let Some(texture) = self.textures.get(&mesh.texture_id) else { continue };
            let edge =
                |value: f32, most: usize| (value * pixels_per_point).round().clamp(0.0, most as f32) as usize;
            let clip = [
                edge(clip_rect.min.x, size[0]),
                edge(clip_rect.min.y, size[1]),
                edge(clip_rect.max.x, size[0]),
                edge(clip_rect.max.y, size[1]),
            ];
            for corners in mesh.indices.chunks_exact(3) {
                let corner = |k: usize| mesh.vertices.get(corners[k] as usize).copied();
                if let (Some(a), Some(b), Some(c)) = (corner(0), corner(1), corner(2)) {
                    fill(&mut target, size, clip, [a, b, c], texture, pixels_per_point);
                }
            }
        }
        target.into_iter().map(|pixel| pixel.map(|part| part.round().clamp(0.0, 255.0) as u8)).collect()
    }
}

fn patch(texture: &mut ColorImage, part: &ColorImage, left: usize, top: usize) {
    let [width, height] = part.size;
    let columns = texture.size[0];
    for row in 0..height {
        let to = (top + row) * columns + left;
        if let (Some(target), Some(source)) =
            (texture.pixels.get_mut(to..to + width), part.pixels.get(row * width..(row + 1) * width))
        {
            target.copy_from_slice(source);
        }
    }
}

/// Twice the area of a triangle, with its sense.
fn cross(a: Pos2, b: Pos2, c: Pos2) -> f32 {
    (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x)
}

/// Fills a triangle, whose edges are taken by the rule of the top left, so that no pixel is drawn twice.
fn fill(
    target: &mut [[f32; 3]],
    size: [usize; 2],
    clip: [usize; 4],
    mut corners: [Vertex; 3],
    texture: &ColorImage,
    pixels_per_point: f32,
) {
    for corner in &mut corners {
        corner.pos = Pos2::new(corner.pos.x * pixels_per_point, corner.pos.y * pixels_per_point);
    }
    let mut area = cross(corners[0].pos, corners[1].pos, corners[2].pos);
    if area < 0.0 {
        corners.swap(1, 2);
        area = -area;
    }
    if area < 1.0e-6 {
        return;
    }
    let [a, b, c] = corners.map(|corner| corner.pos);
    let least = |x: f32, low: usize, high: usize| (x.floor().max(0.0) as usize).clamp(low, high);
    let low_x = least(a.x.min(b.x).min(c.x), clip[0], clip[2]);
    let low_y = least(a.y.min(b.y).min(c.y), clip[1], clip[3]);
    let high_x = least(a.x.max(b.x).max(c.x) + 1.0, clip[0], clip[2]);
    let high_y = least(a.y.max(b.y).max(c.y) + 1.0, clip[1], clip[3]);
    // An edge that goes up, or level to the right, has its own pixels.
    let owns = |from: Pos2, to: Pos2| (to.y < from.y) || (to.y == from.y && to.x > from.x);
    let own = [owns(b, c), owns(c, a), owns(a, b)];
    for y in low_y..high_y {
        for x in low_x..high_x {
            let point = Pos2::new(x as f32 + 0.5, y as f32 + 0.5);
            let parts = [cross(b, c, point), cross(c, a, point), cross(a, b, point)];
            if parts.iter().zip(own).any(|(&part, own)| part < 0.0 || (part == 0.0 && !own)) {
                continue;
            }
            let weight = parts.map(|part| part / area);
            let mix = |value: &dyn Fn(&Vertex) -> f32| -> f32 {
                corners.iter().zip(weight).map(|(corner, weight)| value(corner) * weight).sum()
            };
            let texel = sample(texture, mix(&|v| v.uv.x), mix(&|v| v.uv.y));
            let color = [
                mix(&|v| f32::from(v.color.r())),
                mix(&|v| f32::from(v.color.g())),
                mix(&|v| f32::from(v.color.b())),
                mix(&|v| f32::from(v.color.a())),
            ];
            let source: [f32; 4] = std::array::from_fn(|k| color[k] * texel[k] / 255.0);
            if let Some(pixel) = target.get_mut(y * size[0] + x) {
                let left = 1.0 - source[3] / 255.0;
                for (channel, part) in pixel.iter_mut().zip(source) {
                    *channel = part + *channel * left;
                }
            }
        }
    }
}

/// A texture between its texels, 0 to 255.
fn sample(texture: &ColorImage, u: f32, v: f32) -> [f32; 4] {
    let [width, height] = texture.size;
    let (x, y) = (u * width as f32 - 0.5, v * height as f32 - 0.5);
    let (x0, y0) = (x.floor(), y.floor());
    let (fx, fy) = (x - x0, y - y0);
    let texel = |x: f32, y: f32| -> [f32; 4] {
        let column = (x.max(0.0) as usize).min(width.saturating_sub(1));
        let row = (y.max(0.0) as usize).min(height.saturating_sub(1));
        texture.pixels.get(row * width + column).map_or([0.0; 4], |color| color.to_array().map(f32::from))
    };
    let [a, b, c, d] = [texel(x0, y0), texel(x0 + 1.0, y0), texel(x0, y0 + 1.0), texel(x0 + 1.0, y0 + 1.0)];
    std::array::from_fn(|k| {
        let top = a[k] + (b[k] - a[k]) * fx;
        let bottom = c[k] + (d[k] - c[k]) * fx;
        top + (bottom - top) * fy
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of two triangles, half transparent, is drawn once everywhere: on the diagonal too.
    #[test]
    fn no_pixel_of_a_square_is_drawn_twice() {
        let context = egui::Context::default();
        let mut raster = Raster::default();
        let input = egui::RawInput {
            screen_rect: Some(egui::Rect::from_min_size(Pos2::ZERO, egui::vec2(40.0, 30.0))),
            ..Default::default()
        };
        let mut output = context.run_ui(input, |ui| {
            let mut mesh = egui::Mesh::default();
            let half = Color32::from_rgba_premultiplied(100, 0, 0, 128);
            mesh.add_colored_rect(egui::Rect::from_min_max(Pos2::new(3.0, 4.0), Pos2::new(33.0, 24.0)), half);
            ui.painter().add(egui::Shape::mesh(mesh));
        });
        raster.update(&mut output.textures_delta);
        let primitives = context.tessellate(output.shapes, 1.0);
        let pixels = raster.draw(&primitives, [40, 30], 1.0, Color32::from_rgb(0, 0, 80));
        let inside = |x: usize, y: usize| (3..33).contains(&x) && (4..24).contains(&y);
        for y in 0..30 {
            for x in 0..40 {
                let expected = if inside(x, y) { [100, 0, 40] } else { [0, 0, 80] };
                assert_eq!(pixels[y * 40 + x], expected, "{x}, {y}");
            }
        }
    }
}

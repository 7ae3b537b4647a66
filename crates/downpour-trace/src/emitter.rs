//! Surfaces that shine, as lights. Twin of `shaders/wgsl/render/emitter.wgsl`.
//!
//! A place on one of the triangles that shine is drawn for all of them. A tree of spheres around the triangles says what each
//! half may give: its power over the square of the distance, times the cosine at the surface as far as it is known
//! (A. Conty Estevez, C. Kulla, Proc. ACM Comput. Graph. Interact. Tech. 1(2), 2018). The place is uniform over the triangle; its
//! light is the triangle's mean emission over the density with which it was drawn. So the mean is the light of all that shine, each
//! counted once, however many there are.
//!
//! Limits: within an eighth of a triangle's width its light does not grow; both sides shine, as both are seen; the pattern of a texture
//! on one triangle is not thrown on what it lights.

mod tree;

use downpour_render::light::Light;
use downpour_shaders::render::scene::{
    EMITTER_DEPTH, EMITTER_GRAZING, EMITTER_NEAR, EMITTER_NEAREST, EMITTER_WORDS, SCENE_LIGHT_AREA,
};
use glam::Vec3;

use crate::data::SceneData;
pub(crate) use tree::{mean_emission, words};

/// Node of the tree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EmitterNode {
    /// Center of the sphere.
    pub center: Vec3,
    /// Square of its radius.
    pub square: f32,
    /// Sum of emission times area.
    pub power: f32,
    /// First of the two children, or the triangle.
    pub next: u32,
    /// Of a triangle: fractions of its emission that are red and green, 12 bits each, and bit 31. 0 for a pair of nodes.
    pub color: u32,
    /// Area of the triangle times its mean opacity.
    pub area: f32,
}

/// Light that emitters within a sphere may give to a surface: 0 if all of them are below its horizon. `offset`: of the sphere's
/// center from the surface.
#[must_use]
pub fn emitter_weight(offset: Vec3, square: f32, power: f32, normal: Vec3) -> f32 {
    let from_center = offset.dot(offset);
    let radius = square.sqrt();
    let height = normal.dot(offset) + radius;
    if height <= 0.0 {
        return 0.0;
    }
    let cosine = (height / (from_center.sqrt() + radius)).clamp(EMITTER_GRAZING, 1.0);
    power * cosine / from_center.max(square.max(EMITTER_NEAREST))
}

/// Fractions of the emission of a triangle that are red, green and blue.
#[must_use]
pub fn emitter_color(color: u32) -> Vec3 {
    let red = (color & 4095) as f32 / 4095.0;
    let green = (color >> 12 & 4095) as f32 / 4095.0;
    Vec3::new(red, green, (1.0 - red - green).max(0.0))
}

impl SceneData {
    /// Reads a node.
    fn emitter_load(&self, index: u32) -> EmitterNode {
        let first = (self.emitters + index * EMITTER_WORDS) as usize;
        let words = &self.texels[first..first + EMITTER_WORDS as usize];
        let number = |k: usize| f32::from_bits(words[k]);
        EmitterNode {
            center: Vec3::new(number(0), number(1), number(2)),
            square: number(3),
            power: number(4),
            next: words[5],
            color: words[6],
            area: number(7),
        }
    }

    /// The triangles that shine, as leaves of the tree.
    pub(crate) fn shining_leaves(&self) -> Vec<EmitterNode> {
        let (mut leaves, mut open) = (Vec::new(), vec![0]);
        while let Some(index) = open.pop().filter(|_| self.emitters > 0) {
            let node = self.emitter_load(index);
            if node.color == 0 {
                open.extend([node.next + 1, node.next]);
            } else {
                leaves.push(node);
            }
        }
        leaves
    }

    /// A place of one of the surfaces that shine, drawn for all of them, as a light: of color 0 if none shines on the surface.
    /// `numbers` are uniform in [0, 1).
    pub(crate) fn emitter_draw(&self, position: Vec3, normal: Vec3, numbers: [f32; 3]) -> Light {
        let mut light = Light { kind: SCENE_LIGHT_AREA, cone: [0.0, 1.0], axis: normal, ..Light::default() };
        let mut node = self.emitter_load(0);
        let (mut probability, mut rest) = (1.0, numbers[2]);
        for _ in 0..EMITTER_DEPTH {
            if node.color != 0 {
                break;
            }
            let [left, right] = [node.next, node.next + 1].map(|index| self.emitter_load(index));
            let [of_left, of_right] = [&left, &right]
                .map(|child| emitter_weight(child.center - position, child.square, child.power, normal));
            let sum = of_left + of_right;
            if sum <= 0.0 {
                return light;
            }
            let part = of_left / sum;
            // Rounding may bring the rest to 1: a part that gives nothing is never drawn.
            if rest < part || part >= 1.0 || of_right <= 0.0 {
                rest /= part;
                probability *= part;
                node = left;
            } else {
                rest = (rest - part) / (1.0 - part);
                probability *= 1.0 - part;
                node = right;
            }
        }
        if node.color == 0 {
            return light;
        }
        let triangle = &self.triangles[node.next as usize];
        let edge = numbers[0].sqrt();
        let (u, v) = (edge * (1.0 - numbers[1]), edge * numbers[1]);
        let (edge_1, edge_2) = (Vec3::from(triangle.edge_1), Vec3::from(triangle.edge_2));
        let geometric = edge_1.cross(edge_2);
        light.position = Vec3::from(triangle.corner) + edge_1 * u + edge_2 * v;
        light.axis = geometric / geometric.dot(geometric).sqrt().max(1.0e-20);
        light.color = emitter_color(node.color) * (node.power / (probability * std::f32::consts::PI));
        light.radius = (node.area * EMITTER_NEAR).sqrt();
        light
    }
}

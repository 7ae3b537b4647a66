//! Windows that many openings share: surround, sill, frame, panes, shutters, railing.

use glam::{Vec2, Vec3};

use super::style::{JOINERY, SHUTTERS, STONES};
use super::{REVEAL_M, balcony};
use crate::material::Material;
use crate::mesh::{ABOVE, BEHIND, BELOW, LEFT, Mesh, Paint, RIGHT, plain, tinted};
use crate::noise::hash;

/// Sorts of frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Frame {
    /// Two leaves with glazing bars.
    Casement,
    /// Two sashes, one above the other.
    Sash,
    /// Two leaves without bars, low.
    Dormer,
}

/// Stone around an opening.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Surround {
    /// A sill alone.
    None,
    /// A sill and a beam above.
    Lintel,
    /// A flat band.
    Band,
    /// A molded band with a keystone.
    Molded,
    /// A molded band and a ledge on brackets.
    Ledge,
    /// A molded band and a gable.
    Pediment,
    /// Blocks of two lengths in turn, and a flat arch.
    Toothed,
}

/// Railings before a window.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Balcony {
    /// None.
    None,
    /// A railing in the opening.
    Rail,
    /// Bars before a window of the ground floor.
    Grille,
    /// A small balcony of stone with balusters.
    Stone,
}

/// Shutters of a window.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Shutters {
    /// Index of their paint.
    pub(crate) paint: u8,
    /// 0 open; 1 one leaf half open; 2 closed.
    pub(crate) state: u8,
}

/// Parameters of windows that share a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct WindowDesign {
    pub(super) size_cm: [u16; 2],
    pub(super) frame: Frame,
    pub(super) joinery: u8,
    pub(super) surround: Surround,
    pub(super) stone: u8,
    pub(super) shutters: Option<Shutters>,
    pub(super) balcony: Balcony,
    pub(super) has_flowers: bool,
}

impl WindowDesign {
    /// Width and height of the opening.
    pub(super) fn size_m(&self) -> [f32; 2] {
        self.size_cm.map(|v| f32::from(v) / 100.0)
    }

    /// The design with shutters as somebody left them, and perhaps flowers.
    pub(super) fn with_state(mut self, seed: u32, corner: Vec3) -> Self {
        let id = [(corner.x * 100.0) as i32 + 977 * seed as i32, (corner.y * 100.0) as i32];
        if let Some(shutters) = &mut self.shutters {
            let thrown = hash(id[0], id[1], 325);
            shutters.state = if thrown < 0.72 {
                0
            } else if thrown < 0.88 {
                1
            } else {
                2
            };
        }
        let can_stand = matches!(self.balcony, Balcony::None | Balcony::Rail) && self.frame != Frame::Dormer;
        self.has_flowers = can_stand && hash(id[0], id[1], 326) < 0.12;
        self
    }
}

/// A window, its lower left corner on the front at the origin.
pub(crate) fn window(design: WindowDesign) -> Mesh {
    let mut mesh = Mesh::default();
    surround(&design, &mut mesh);
    frame(&design, &mut mesh);
    shutters(&design, &mut mesh);
    let size = design.size_m();
    match design.balcony {
        Balcony::None => {}
        Balcony::Rail => balcony::rail(size, &mut mesh),
        Balcony::Grille => balcony::grille(size, &mut mesh),
        Balcony::Stone => balcony::stone(size, stone(&design), &mut mesh),
    }
    if design.has_flowers {
        balcony::flowers(size[0], &mut mesh);
    }
    mesh
}

fn stone(design: &WindowDesign) -> Paint {
    tinted(Material::Stone, STONES[usize::from(design.stone) % STONES.len()])
}

fn surround(design: &WindowDesign, mesh: &mut Mesh) {
    if design.frame == Frame::Dormer {
        return;
    }
    let paint = stone(design);
    let [w, h] = design.size_m();
    let block = |mesh: &mut Mesh, x: [f32; 2], y: [f32; 2], out: f32| {
        mesh.beveled(paint, Vec3::new(x[0], y[0], 0.0), Vec3::new(x[1], y[1], out), (0.35 * out).min(0.008));
    };
    // The sill slopes, and throws its drip off the wall.
    let sill = [
        [0.0, -0.10],
        [0.055, -0.10],
        [0.055, -0.085],
        [0.085, -0.08],
        [0.09, -0.015],
        [0.08, -0.006],
        [-REVEAL_M, 0.012],
    ];
    mesh.molding(paint, [-0.09, w + 0.09], 0.0, &sill);
    // Moldings are drawn along x; uprights as blocks of two steps.
    let molded = |mesh: &mut Mesh| {
        for x in [[-0.17, 0.0], [w, w + 0.17]] {
            block(mesh, x, [0.0, h], 0.035);
            let outer = if x[0] < 0.0 { [x[0], x[0] + 0.05] } else { [x[1] - 0.05, x[1]] };
            block(mesh, outer, [0.0, h + 0.17], 0.06);
        }
        let head =
            [[0.0, h], [0.035, h], [0.035, h + 0.12], [0.06, h + 0.125], [0.065, h + 0.17], [0.0, h + 0.175]];
        mesh.molding(paint, [-0.17, w + 0.17], 0.0, &head);
    };
    let ledge = |mesh: &mut Mesh, y: f32| {
        let profile = [
            [0.0, y],
            [0.05, y],
            [0.06, y + 0.03],
            [0.10, y + 0.045],
            [0.17, y + 0.06],
            [0.18, y + 0.10],
            [0.20, y + 0.105],
            [0.20, y + 0.13],
            [0.0, y + 0.145],
        ];
        mesh.molding(paint, [-0.27, w + 0.27], 0.0, &profile);
        for x in [-0.17, w + 0.05] {
            block(mesh, [x, x + 0.12], [y - 0.26, y], 0.12);
        }
    };
    match design.surround {
        Surround::None => {}
        Surround::Lintel => block(mesh, [-0.16, w + 0.16], [h, h + 0.20], 0.02),
        Surround::Band => {
            for x in [[-0.14, 0.0], [w, w + 0.14]] {
                block(mesh, x, [0.0, h], 0.03);
            }
            block(mesh, [-0.14, w + 0.14], [h, h + 0.15], 0.034);
        }
        Surround::Molded => {
            molded(mesh);
            block(mesh, [w / 2.0 - 0.11, w / 2.0 + 0.11], [h - 0.01, h + 0.26], 0.10);
        }
        Surround::Ledge => {
            molded(mesh);
            ledge(mesh, h + 0.30);
        }
        Surround::Pediment => {
            molded(mesh);
            ledge(mesh, h + 0.30);
            gable(mesh, paint, [-0.27, w + 0.27], h + 0.44);
        }
        Surround::Toothed => {
            let course = 0.225;
            let count = (h / course).floor() as i32;
            for k in 0..count {
                let long = if k % 2 == 0 { 0.26 } else { 0.15 };
                let y = [k as f32 * course, if k + 1 == count { h } else { (k + 1) as f32 * course }];
                block(mesh, [-long, 0.0], y, 0.022);
                block(mesh, [w, w + long], y, 0.022);
            }
            // The flat arch: seven stones that widen upwards.
            for k in -3..=3 {
                let at = |edge: f32, spread: f32| w / 2.0 + (edge / 7.0) * (w + 0.3 + spread);
                let (a, b) = (k as f32 - 0.5, k as f32 + 0.5);
                let out = if k == 0 { 0.07 } else { 0.026 };
                let top = if k == 0 { h + 0.36 } else { h + 0.30 };
                let p = |x: f32, y: f32| Vec3::new(x, y, out);
                let q = [p(at(a, 0.0), h), p(at(b, 0.0), h), p(at(b, 0.28), top), p(at(a, 0.28), top)];
                mesh.quad(paint, q);
                for side in 0..4 {
                    let (from, to) = (q[side], q[(side + 1) % 4]);
                    mesh.quad(paint, [from.with_z(0.0), to.with_z(0.0), to, from]);
                }
            }
        }
    }
}

/// A low gable over a ledge.
fn gable(mesh: &mut Mesh, paint: Paint, [a, b]: [f32; 2], y: f32) {
    let middle = (a + b) / 2.0;
    let rise = 0.26;
    let p = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    mesh.polygon(paint, &[p(a + 0.1, y, 0.06), p(b - 0.1, y, 0.06), p(middle, y + rise - 0.05, 0.06)]);
    for (from, to) in [(a, middle), (middle, b)] {
        let (y0, y1) = if from < middle { (y, y + rise) } else { (y + rise, y) };
        let t = 0.085;
        mesh.quad(paint, [p(from, y0, 0.19), p(to, y1, 0.19), p(to, y1 + t, 0.19), p(from, y0 + t, 0.19)]);
        mesh.quad(
            paint,
            [p(from, y0 + t, 0.19), p(to, y1 + t, 0.19), p(to, y1 + t, 0.0), p(from, y0 + t, 0.0)],
        );
        mesh.quad(paint, [p(from, y0, 0.0), p(to, y1, 0.0), p(to, y1, 0.19), p(from, y0, 0.19)]);
    }
    mesh.quad(paint, [p(a, y, 0.0), p(a, y, 0.19), p(a, y + 0.085, 0.19), p(a, y + 0.085, 0.0)]);
    mesh.quad(paint, [p(b, y, 0.19), p(b, y, 0.0), p(b, y + 0.085, 0.0), p(b, y + 0.085, 0.19)]);
}

fn frame(design: &WindowDesign, mesh: &mut Mesh) {
    let paint = tinted(Material::Joinery, JOINERY[usize::from(design.joinery) % JOINERY.len()]);
    let [w, h] = design.size_m();
    let back = -REVEAL_M - 0.055;
    let mut bar = |x: [f32; 2], y: [f32; 2], front: f32, left_out: u8| {
        mesh.cuboid(paint, Vec3::new(x[0], y[0], back), Vec3::new(x[1], y[1], front), BEHIND | left_out);
    };
    let (outer, near, leaf, thin) = (0.055, -REVEAL_M + 0.015, -REVEAL_M - 0.005, -REVEAL_M - 0.022);
    bar([0.0, outer], [0.0, h], near, LEFT | BELOW | ABOVE);
    bar([w - outer, w], [0.0, h], near, RIGHT | BELOW | ABOVE);
    bar([outer, w - outer], [h - outer, h], near, LEFT | RIGHT | ABOVE);
    bar([outer, w - outer], [0.0, outer + 0.02], near, LEFT | RIGHT | BELOW);
    let (l, r, low, high, middle) = (outer, w - outer, outer + 0.02, h - outer, w * 0.5);
    if design.frame == Frame::Sash {
        let half = h * 0.52;
        for (y, front) in [([half - 0.022, high], near - 0.008), ([low, half + 0.022], leaf)] {
            bar([l, l + 0.045], y, front, LEFT | BELOW | ABOVE);
            bar([r - 0.045, r], y, front, RIGHT | BELOW | ABOVE);
            bar([l + 0.045, r - 0.045], [y[0], y[0] + 0.045], front, LEFT | RIGHT);
            bar([l + 0.045, r - 0.045], [y[1] - 0.045, y[1]], front, LEFT | RIGHT);
            bar([middle - 0.012, middle + 0.012], [y[0] + 0.045, y[1] - 0.045], front - 0.012, BELOW | ABOVE);
        }
    } else {
        bar([middle - 0.05, middle + 0.05], [low, high], leaf + 0.012, BELOW | ABOVE);
        for [a, b] in [[l, l + 0.042], [r - 0.042, r]] {
            bar([a, b], [low, high], leaf, BELOW | ABOVE);
        }
        for [a, b] in [[l + 0.042, middle - 0.05], [middle + 0.05, r - 0.042]] {
            bar([a, b], [low, low + if h > 1.9 { 0.30 } else { 0.055 }], leaf, LEFT | RIGHT);
            bar([a, b], [high - 0.045, high], leaf, LEFT | RIGHT);
            let count = if design.frame == Frame::Dormer { 0 } else { (h / 0.62).round() as i32 - 1 };
            for k in 1..=count {
                let from = if h > 1.9 { low + 0.30 } else { low };
                let y = from + (high - from) * k as f32 / (count + 1) as f32;
                bar([a, b], [y - 0.013, y + 0.013], thin, LEFT | RIGHT);
            }
        }
    }
    let z = -REVEAL_M - 0.04;
    let p = |x: f32, y: f32| Vec3::new(x, y, z);
    mesh.quad_uv(
        plain(Material::Glass),
        [p(l, low), p(r, low), p(r, high), p(l, high)],
        [Vec2::ZERO, Vec2::X, Vec2::ONE, Vec2::Y],
    );
}

/// A leaf of louvers from the origin along x, 3.5 cm thick, its front along +z.
fn leaf(paint: Paint, width: f32, height: f32) -> Mesh {
    let mut mesh = Mesh::default();
    let p = |x: f32, y: f32, z: f32| Vec3::new(x, y, z);
    for [a, b] in [[0.0, 0.055], [width - 0.055, width]] {
        mesh.cuboid(paint, p(a, 0.0, 0.0), p(b, height, 0.035), 0);
    }
    for y in [0.0, height * 0.46, height - 0.07] {
        mesh.cuboid(paint, p(0.055, y, 0.0), p(width - 0.055, y + 0.07, 0.033), LEFT | RIGHT);
    }
    let dark = Paint { tint: paint.tint * 0.80, ..paint };
    for [from, to] in [[0.07, height * 0.46], [height * 0.46 + 0.07, height - 0.07]] {
        let count = ((to - from) / 0.075).round().max(1.0) as i32;
        for k in 0..count {
            let y = from + (to - from) * k as f32 / count as f32;
            let top = y + (to - from) / count as f32;
            let (a, b) = (0.055, width - 0.055);
            mesh.quad(dark, [p(a, y, 0.030), p(b, y, 0.030), p(b, top, 0.006), p(a, top, 0.006)]);
        }
    }
    mesh
}

fn shutters(design: &WindowDesign, mesh: &mut Mesh) {
    let Some(shutters) = design.shutters else { return };
    let paint = tinted(Material::Joinery, SHUTTERS[usize::from(shutters.paint) % SHUTTERS.len()]);
    let [w, h] = design.size_m();
    let width = w / 2.0 - 0.005;
    let one = leaf(paint, width, h - 0.02);
    let y = 0.01;
    match shutters.state {
        0 => {
            mesh.add(&one, [-width - 0.015, y, 0.045], 2.5);
            mesh.add(&one, [w + 0.015, y, 0.042], -2.0);
        }
        1 => {
            mesh.add(&one, [-width - 0.015, y, 0.045], 3.0);
            // The right leaf stands off the wall.
            mesh.add(&one, [w + 0.01, y, 0.02], -62.0);
        }
        _ => {
            mesh.add(&one, [0.0, y, -0.055], 0.0);
            mesh.add(&one, [w / 2.0 + 0.005, y, -0.055], 0.0);
        }
    }
}

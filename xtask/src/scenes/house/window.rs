//! Windows: frames that many openings share, and the panes in them.

use glam::{Vec2, Vec3};

use super::front::REVEAL_M;
use super::{House, Opening, StoneColor};
use crate::scenes::material::Material;
use crate::scenes::mesh::{ABOVE, BEHIND, BELOW, LEFT, Mesh, Paint, RIGHT, plain, tinted};
use crate::scenes::noise::hash;
use crate::scenes::textures::PANE_VIEWS;

/// Sorts of windows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::scenes) enum WindowKind {
    /// Two sashes, one above the other, each with two panes.
    Sash,
    /// Two leaves under a transom.
    Casement,
    /// Two leaves, low.
    Small,
}

/// Paints of frames.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::scenes) enum Joinery {
    White,
    Cream,
    Green,
}

impl Joinery {
    fn paint(self) -> Paint {
        tinted(
            Material::Joinery,
            match self {
                Self::White => [0.66, 0.66, 0.64],
                Self::Cream => [0.58, 0.53, 0.42],
                Self::Green => [0.035, 0.065, 0.05],
            },
        )
    }
}

impl WindowKind {
    /// Width and height.
    pub(in crate::scenes) fn size_m(self) -> [f32; 2] {
        match self {
            Self::Sash | Self::Casement => [1.1, 1.6],
            Self::Small => [0.95, 1.2],
        }
    }
}

/// Stone around an opening.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::scenes) enum Dressing {
    None,
    /// Sill and lintel, flush with brick.
    Lintel,
    /// Sill, frame and ledge, raised from plaster.
    Surround,
}

/// Parameters of windows that share a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::scenes) struct WindowDesign {
    pub(in crate::scenes) kind: WindowKind,
    pub(in crate::scenes) joinery: Joinery,
    pub(in crate::scenes) dressing: Dressing,
    pub(in crate::scenes) stone: StoneColor,
}

impl WindowDesign {
    fn dressings(&self, mesh: &mut Mesh) {
        let paint = self.stone.paint();
        let [w, h] = self.kind.size_m();
        let mut slab = |x: [f32; 2], y: [f32; 2], out: f32| {
            mesh.cuboid(paint, Vec3::new(x[0], y[0], 0.0), Vec3::new(x[1], y[1], out), BEHIND);
        };
        match self.dressing {
            Dressing::None => return,
            Dressing::Lintel => slab([-0.12, w + 0.12], [h, h + 0.21], 0.012),
            Dressing::Surround => {
                slab([-0.13, 0.0], [0.0, h], 0.025);
                slab([w, w + 0.13], [0.0, h], 0.025);
                slab([-0.13, w + 0.13], [h, h + 0.15], 0.03);
                slab([-0.17, w + 0.17], [h + 0.15, h + 0.2], 0.07);
            }
        }
        mesh.block(paint, [-0.08, -0.075, -0.09], [w + 0.16, 0.075, 0.155]);
    }
}

/// A window with its frame and its stone, its lower left corner on the front at the origin.
pub(in crate::scenes) fn window(design: WindowDesign) -> Mesh {
    let mut mesh = Mesh::default();
    let WindowDesign { kind, joinery, .. } = design;
    design.dressings(&mut mesh);
    let paint = joinery.paint();
    let [w, h] = kind.size_m();
    let back = -REVEAL_M - 0.04;
    let mut bar = |x: [f32; 2], y: [f32; 2], front: f32, left_out: u8| {
        mesh.cuboid(paint, Vec3::new(x[0], y[0], back), Vec3::new(x[1], y[1], front), BEHIND | left_out);
    };
    let (outer, near, far) = (0.05, -REVEAL_M + 0.02, -REVEAL_M - 0.005);
    // The frame: two posts, head and foot.
    bar([0.0, outer], [0.0, h], near, LEFT | BELOW | ABOVE);
    bar([w - outer, w], [0.0, h], near, RIGHT | BELOW | ABOVE);
    bar([outer, w - outer], [h - outer, h], near, LEFT | RIGHT | ABOVE);
    bar([outer, w - outer], [0.0, outer + 0.015], near, LEFT | RIGHT | BELOW);
    let (l, r) = (outer, w - outer);
    match kind {
        WindowKind::Sash => {
            let middle = h * 0.5;
            for (y, front) in [([middle - 0.02, h - outer], -REVEAL_M + 0.008), ([outer, middle + 0.02], far)]
            {
                bar([l, l + 0.045], y, front, LEFT | BELOW | ABOVE);
                bar([r - 0.045, r], y, front, RIGHT | BELOW | ABOVE);
                bar([l + 0.045, r - 0.045], [y[0], y[0] + 0.045], front, LEFT | RIGHT);
                bar([l + 0.045, r - 0.045], [y[1] - 0.045, y[1]], front, LEFT | RIGHT);
                bar(
                    [w * 0.5 - 0.012, w * 0.5 + 0.012],
                    [y[0] + 0.045, y[1] - 0.045],
                    front - 0.008,
                    BELOW | ABOVE,
                );
            }
        }
        WindowKind::Casement | WindowKind::Small => {
            let transom = if kind == WindowKind::Small { h - outer } else { h * 0.70 };
            let middle = w * 0.5;
            if kind == WindowKind::Casement {
                bar([l, r], [transom - 0.03, transom + 0.035], near - 0.006, LEFT | RIGHT);
                bar([middle - 0.02, middle + 0.02], [transom + 0.035, h - outer], far, BELOW | ABOVE);
            }
            let low = outer + 0.015;
            let high = if kind == WindowKind::Casement { transom - 0.03 } else { transom };
            bar([middle - 0.045, middle + 0.045], [low, high], far + 0.01, BELOW | ABOVE);
            for [a, b] in [[l, l + 0.04], [r - 0.04, r]] {
                bar([a, b], [low, high], far, BELOW | ABOVE);
            }
            for [a, b] in [[l + 0.04, middle - 0.045], [middle + 0.045, r - 0.04]] {
                bar([a, b], [low, low + 0.045], far, LEFT | RIGHT);
                bar([a, b], [high - 0.04, high], far, LEFT | RIGHT);
            }
        }
    }
    mesh
}

/// A pane with a view into a room, on the plane behind the frame; some rooms are lit at night.
pub(super) fn pane(house: &House, opening: &Opening, mesh: &mut Mesh) {
    let id = [(opening.x[0] * 100.0) as i32 + 977 * house.seed as i32, (opening.y[0] * 100.0) as i32];
    let view = (hash(id[0], id[1], 321) * (PANE_VIEWS[0] * PANE_VIEWS[1]) as f32) as u32;
    // Later in the evening a third of the rooms are lit.
    let is_lit = hash(id[0], id[1], 322) < 0.34;
    glaze(mesh, is_lit, view, opening, -REVEAL_M - 0.022);
}

/// A quad with one view of the picture of rooms.
pub(super) fn glaze(mesh: &mut Mesh, is_lit: bool, view: u32, opening: &Opening, z: f32) {
    let (u, v) = (view % PANE_VIEWS[0], view / PANE_VIEWS[0]);
    let scale = Vec2::new(1.0 / PANE_VIEWS[0] as f32, 1.0 / PANE_VIEWS[1] as f32);
    let at = |x: f32, y: f32| (Vec2::new(u as f32 + x, v as f32 + y)) * scale;
    let (lo, hi) = (0.02, 0.98);
    let ([x0, x1], [y0, y1]) = (opening.x, opening.y);
    let p = |x: f32, y: f32| Vec3::new(x, y, z);
    mesh.quad_uv(
        plain(if is_lit { Material::PaneLit } else { Material::Pane }),
        [p(x0, y0), p(x1, y0), p(x1, y1), p(x0, y1)],
        [at(lo, hi), at(hi, hi), at(hi, lo), at(lo, lo)],
    );
}

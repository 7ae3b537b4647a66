//! Houses: a front with openings, a roof, and attached parts.
//!
//! A house stands on x from 0 to its width, its front in the plane z = 0 looking along +z. Stories are 3 m high, windows 1.1 x 1.6 m,
//! doors 1 x 2.1 m under a fanlight.

mod door;
mod front;
mod roof;
mod shop;
mod window;

use glam::Vec3;

use super::ground::pavement_height;
use super::material::Material;
use super::mesh::{Mesh, Paint, tinted};
use super::model::Lamp;

pub(super) use roof::Roof;
pub(super) use shop::Shop;
pub(super) use window::{Dressing, Joinery, WindowDesign, WindowKind, window};

/// Height of the pavement at the front.
pub(super) fn ground_m() -> f32 {
    pavement_height(super::ground::HALF_STREET_M)
}

/// Height of stories above the first.
const STORY_M: f32 = 3.0;
/// Depth of a house.
pub(super) const DEPTH_M: f32 = 9.0;

/// Colors of stone parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum StoneColor {
    Limestone,
    Sandstone,
    Painted,
}

impl StoneColor {
    fn paint(self) -> Paint {
        tinted(
            Material::Stone,
            match self {
                Self::Limestone => [0.55, 0.52, 0.45],
                Self::Sandstone => [0.44, 0.36, 0.26],
                Self::Painted => [0.66, 0.64, 0.60],
            },
        )
    }
}

/// Parameters of a house.
#[derive(Clone, Copy, Debug)]
pub(super) struct House {
    pub(super) width_m: f32,
    /// Stories, with the ground floor.
    pub(super) stories: u32,
    pub(super) wall: Material,
    /// Paint of plaster, weathering of brick.
    pub(super) tint: [f32; 3],
    /// Color of stone parts.
    pub(super) stone: StoneColor,
    pub(super) joinery: Joinery,
    pub(super) windows: WindowKind,
    /// Windows of a story.
    pub(super) bays: u32,
    pub(super) door: [f32; 3],
    /// The bay of the door.
    pub(super) door_bay: u32,
    pub(super) shop: Option<Shop>,
    pub(super) roof: Roof,
    pub(super) seed: u32,
}

/// A window of a house: its design, and its lower left corner on the front.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlacedWindow {
    pub(super) design: WindowDesign,
    pub(super) corner: Vec3,
}

/// A finished house: mesh, windows, lamps.
pub(super) struct Built {
    pub(super) mesh: Mesh,
    pub(super) windows: Vec<PlacedWindow>,
    pub(super) lamps: Vec<Lamp>,
}

/// An opening in the front.
#[derive(Clone, Copy, Debug)]
struct Opening {
    x: [f32; 2],
    y: [f32; 2],
    is_window: bool,
}

impl House {
    /// Height of the ground floor.
    fn ground_floor_m(&self) -> f32 {
        if self.shop.is_some() { 3.6 } else { 3.2 }
    }

    /// Height of the front, to the top of its cornice.
    fn height_m(&self) -> f32 {
        ground_m() + self.ground_floor_m() + STORY_M * (self.stories - 1) as f32 + 0.25
    }

    fn wall_paint(&self) -> Paint {
        tinted(self.wall, self.tint)
    }

    fn stone_paint(&self) -> Paint {
        self.stone.paint()
    }

    /// Middle of a bay.
    fn bay_m(&self, bay: u32) -> f32 {
        let margin = 0.35;
        margin + (self.width_m - 2.0 * margin) * (bay as f32 + 0.5) / self.bays as f32
    }

    /// Makes the house.
    pub(super) fn build(&self) -> Built {
        let mut mesh = Mesh::default();
        let mut windows = Vec::new();
        let mut lamps = Vec::new();
        let openings = self.openings();
        front::front(self, &openings, &mut mesh);
        for opening in openings.iter().filter(|opening| opening.is_window) {
            let design = self.design(
                self.windows,
                if self.wall == Material::Plaster { Dressing::Surround } else { Dressing::Lintel },
            );
            windows.push(PlacedWindow { design, corner: Vec3::new(opening.x[0], opening.y[0], 0.0) });
            window::pane(self, opening, &mut mesh);
        }
        match &self.shop {
            Some(shop) => shop.build(self, &mut mesh, &mut lamps),
            None => door::door(self, self.bay_m(self.door_bay), &mut mesh),
        }
        roof::roof(self, &mut mesh, &mut windows);
        Built { mesh, windows, lamps }
    }

    fn design(&self, kind: WindowKind, dressing: Dressing) -> WindowDesign {
        WindowDesign { kind, joinery: self.joinery, dressing, stone: self.stone }
    }

    fn openings(&self) -> Vec<Opening> {
        let [w, h] = self.windows.size_m();
        let mut all = Vec::new();
        for story in 0..self.stories {
            let floor = match story {
                0 => ground_m(),
                _ => ground_m() + self.ground_floor_m() + STORY_M * (story - 1) as f32,
            };
            for bay in 0..self.bays {
                let x = self.bay_m(bay);
                if story == 0 {
                    if self.shop.is_some() {
                        continue;
                    }
                    if bay == self.door_bay {
                        all.push(door::opening(x));
                        continue;
                    }
                }
                let sill = floor + if story == 0 { 1.0 } else { 0.85 };
                all.push(Opening { x: [x - w / 2.0, x + w / 2.0], y: [sill, sill + h], is_window: true });
            }
        }
        if self.shop.is_some() {
            all.push(shop::opening(self));
        }
        all
    }
}

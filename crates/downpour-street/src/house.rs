//! Houses: a front with openings, a roof, and attached parts.
//!
//! A house stands on x from 0 to its width, its front in the plane z = 0 looking along +z.

mod balcony;
mod door;
mod front;
mod roof;
mod room;
mod shop;
mod style;
mod window;

use glam::Vec3;

use crate::material::Material;
use crate::mesh::{Mesh, Paint, tinted};

pub(crate) use style::draw;
pub(crate) use window::{WindowDesign, window};

/// Depth of a house.
pub(crate) const DEPTH_M: f32 = 9.0;
/// Depth of the reveals of windows and doors.
const REVEAL_M: f32 = 0.20;

/// Sorts of houses.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum HouseKind {
    /// Five stories of limestone, balconies along the second and the last, zinc above.
    Boulevard,
    /// Painted plaster with shutters.
    Plaster,
    /// Brick with dressings of stone.
    Brick,
    /// Low and old, rough plaster, small windows, tiles.
    Old,
    /// Rusticated below, window pediments, balustrade.
    Classical,
}

/// Sorts of roofs, with the color of their tiles.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Roof {
    /// Two slopes of a pitch in degrees.
    Pitched { pitch_deg: f32, tiles: [f32; 3] },
    /// A steep slope with dormers, of slate or of zinc, and a shallow one above.
    Mansard { paint: Material, tiles: [f32; 3] },
    /// A balustrade before a flat roof.
    Balustrade,
}

/// A story above the ground floor.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Story {
    height_m: f32,
    /// Height of the sills over the floor.
    sill_m: f32,
    design: WindowDesign,
    /// A balcony along all windows.
    has_long_balcony: bool,
    /// A string course under the story.
    has_course: bool,
}

/// A shop's parameters.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Shop {
    /// Number of its board.
    sign: u32,
    /// Paint of the front.
    paint: [f32; 3],
    /// Stripes of the awning; without it there is none.
    awning: Option<[[f32; 3]; 2]>,
}

/// Parameters of a house.
#[derive(Clone, Debug)]
pub(crate) struct House {
    pub(crate) width_m: f32,
    kind: HouseKind,
    wall: Material,
    /// Paint of plaster, weathering of brick.
    tint: [f32; 3],
    /// Material and tint of the ground floor.
    base: (Material, [f32; 3]),
    stone: [f32; 3],
    ground_m: f32,
    stories: Vec<Story>,
    /// Windows of a story.
    bays: u32,
    door: [f32; 3],
    door_bay: u32,
    ground_design: WindowDesign,
    shop: Option<Shop>,
    has_quoins: bool,
    has_pilasters: bool,
    roof: Roof,
    pub(crate) seed: u32,
    lit: f32,
    age: f32,
    /// Height of the pavement at the front.
    foot: f32,
}

/// A window of a house: its design, and its lower left corner on the front.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PlacedWindow {
    pub(crate) design: WindowDesign,
    pub(crate) corner: Vec3,
}

/// A finished house: mesh, windows, and ends of its doors along the front.
#[derive(Default)]
pub(crate) struct Built {
    pub(crate) mesh: Mesh,
    pub(crate) doors: Vec<[f32; 2]>,
    pub(crate) windows: Vec<PlacedWindow>,
}

/// An opening in the front.
#[derive(Clone, Copy, Debug)]
struct Opening {
    x: [f32; 2],
    y: [f32; 2],
    is_window: bool,
}

impl House {
    /// Height of the front, to the top of its cornice.
    pub(crate) fn height_m(&self) -> f32 {
        self.foot + self.ground_m + self.stories.iter().map(|story| story.height_m).sum::<f32>() + 0.35
    }

    /// Height of the floor of a story above the ground floor.
    fn floor(&self, story: usize) -> f32 {
        let below: f32 = self.stories[..story].iter().map(|story| story.height_m).sum();
        self.foot + self.ground_m + below
    }

    fn wall_paint(&self) -> Paint {
        tinted(self.wall, self.tint)
    }

    fn stone_paint(&self) -> Paint {
        tinted(Material::Stone, self.stone)
    }

    /// Middle of a bay.
    fn bay(&self, bay: u32) -> f32 {
        let margin = 0.45;
        margin + (self.width_m - 2.0 * margin) * (bay as f32 + 0.5) / self.bays as f32
    }

    /// Makes the house.
    pub(crate) fn build(&self) -> Built {
        let mut built = Built::default();
        let openings = self.openings();
        front::front(self, &openings, &mut built.mesh);
        for (story, opening, design) in self.window_list() {
            let corner = Vec3::new(opening.x[0], opening.y[0], 0.0);
            let design = design.with_state(self.seed, corner);
            built.windows.push(PlacedWindow { design, corner });
            room::room(self, &opening, story, &mut built.mesh);
        }
        for (k, story) in self.stories.iter().enumerate().filter(|(_, story)| story.has_long_balcony) {
            balcony::long(self, self.floor(k), story, &mut built.mesh);
        }
        match &self.shop {
            Some(shop) => shop.build(self, &mut built),
            None => {
                let x = self.bay(self.door_bay);
                door::door(self, x, &mut built.mesh);
                built.doors.push(door::opening(self, x).x);
            }
        }
        roof::roof(self, &mut built);
        built
    }

    /// Windows of all stories: number of the story, opening, design.
    fn window_list(&self) -> Vec<(usize, Opening, WindowDesign)> {
        let mut all = Vec::new();
        let opening = |x: f32, sill: f32, [w, h]: [f32; 2]| Opening {
            x: [x - w / 2.0, x + w / 2.0],
            y: [sill, sill + h],
            is_window: true,
        };
        if self.shop.is_none() {
            for bay in (0..self.bays).filter(|&bay| bay != self.door_bay) {
                let size = self.ground_design.size_m();
                all.push((0, opening(self.bay(bay), self.foot + 1.05, size), self.ground_design));
            }
        }
        for (k, story) in self.stories.iter().enumerate() {
            for bay in 0..self.bays {
                let sill = self.floor(k) + story.sill_m;
                all.push((k + 1, opening(self.bay(bay), sill, story.design.size_m()), story.design));
            }
        }
        all
    }

    fn openings(&self) -> Vec<Opening> {
        let mut all: Vec<Opening> = self.window_list().into_iter().map(|(_, opening, _)| opening).collect();
        match self.shop {
            Some(_) => all.push(shop::opening(self)),
            None => all.push(door::opening(self, self.bay(self.door_bay))),
        }
        all
    }
}

//! Plan of the street: positions of houses, lamps, cars and furniture.

mod furnish;
mod occupancy;

use std::collections::BTreeMap;

use glam::Vec3;

use crate::car;
use crate::dice::Dice;
use crate::error::StreetError;
use crate::furniture;
use crate::ground::{Ground, Hollow, LANE_M, LANE_REACH_M};
use crate::house::{DEPTH_M, House, HouseKind, WindowDesign, draw, window};
use crate::material::Material;
use crate::mesh::{Mesh, tinted, turn};
use crate::model::{Lamp, Piece, Placement};
use crate::settings::StreetSettings;
use furnish::furnish;
use occupancy::{Footprint, Occupancy, Use};

/// Distance of the lamps from the face of the curb, meters.
const LAMP_M: f32 = 0.42;
/// Distance along the street that a lamp may be moved to where there is room, meters.
const LAMP_REACH_M: f32 = 2.0;
/// Width of the way to a door beside its opening, on each side, meters.
const DOOR_MARGIN_M: f32 = 0.1;

/// A parked car: x and z of its middle, meters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParkedCar {
    /// x and z of its middle, meters.
    pub center_m: [f32; 2],
    /// Half its width and length, meters.
    pub half_size_m: [f32; 2],
}

/// The way from a door to the curb.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Doorway {
    /// x and z of its middle, meters.
    pub center_m: [f32; 2],
    /// Half its edges across and along the street, meters.
    pub half_size_m: [f32; 2],
}

/// Triangles that shine at night, as one number for each material.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct EmissiveSurface {
    /// The material.
    pub material: Material,
    /// Area of all its copies, m^2.
    pub area_m2: f32,
}

/// A street.
#[derive(Clone, Debug)]
pub struct Street {
    settings: StreetSettings,
    pieces: Vec<Piece>,
    lamps: Vec<Lamp>,
    hollows: Vec<Hollow>,
    cars: Vec<ParkedCar>,
    doorways: Vec<Doorway>,
}

impl Street {
    /// Makes the street of some settings: the same bytes for the same settings on every machine.
    ///
    /// # Errors
    /// [`StreetError::Setting`] for a number out of its range.
    pub fn generate(settings: &StreetSettings) -> Result<Self, StreetError> {
        settings.check("settings")?;
        let ground = Ground::new(settings);
        let mut plan = Plan::default();
        plan.copies.insert("ground".to_owned(), (ground.mesh(), vec![Placement::default()]));
        let doorways = houses(settings, &ground, &mut plan);
        let mut taken = Occupancy::new(ground.straight_curb());
        for way in &doorways {
            taken.take(Footprint::new(Use::Doorway, way.center_m, way.half_size_m));
        }
        lamps(settings, &ground, &mut taken, &mut plan);
        let cars = cars(settings, &ground, &mut taken, &mut plan);
        furnish(settings, &ground, &mut taken, &mut plan);
        wires(settings, &ground, &mut plan);
        let mut pieces: Vec<Piece> = plan
            .copies
            .into_iter()
            .map(|(name, (mesh, copies))| Piece { name, mesh, copies, rolls_on_m: None })
            .collect();
        for piece in &mut pieces {
            piece.mesh.clean();
        }
        pieces.retain(|piece| !piece.mesh.parts.is_empty());
        Ok(Self {
            settings: settings.clone(),
            pieces,
            lamps: plan.lamps,
            hollows: ground.hollows,
            cars,
            doorways,
        })
    }

    /// The opening of a window as a room sees it, 1.1 x 1.14 m: jambs, head, sill and the wall around; its pane would be at z = 0, the
    /// room at z > 0.
    #[must_use]
    pub fn window_opening() -> Self {
        let mut mesh = furniture::window_opening();
        mesh.clean();
        Self {
            settings: StreetSettings::default(),
            pieces: vec![Piece::single("window", mesh)],
            lamps: Vec::new(),
            hollows: Vec::new(),
            cars: Vec::new(),
            doorways: Vec::new(),
        }
    }

    /// The settings that it was made with.
    #[must_use]
    pub fn settings(&self) -> &StreetSettings {
        &self.settings
    }

    /// Meshes with their copies.
    #[must_use]
    pub fn pieces(&self) -> &[Piece] {
        &self.pieces
    }

    /// Lamps that burn at night.
    #[must_use]
    pub fn lamps(&self) -> &[Lamp] {
        &self.lamps
    }

    /// Hollows of the carriageway, where water would stand.
    #[must_use]
    pub fn hollows(&self) -> &[Hollow] {
        &self.hollows
    }

    /// Height of the carriageway at x and z, meters.
    #[must_use]
    pub fn road_height_m(&self, x_m: f32, z_m: f32) -> f32 {
        Ground::new(&self.settings).road_height(x_m, z_m)
    }

    /// Parked cars.
    #[must_use]
    pub fn cars(&self) -> &[ParkedCar] {
        &self.cars
    }

    /// Ways to the doors along both pavements: nothing stands on them.
    #[must_use]
    pub fn doorways(&self) -> &[Doorway] {
        &self.doorways
    }

    /// Triangles of all copies.
    #[must_use]
    pub fn triangle_count(&self) -> usize {
        self.pieces.iter().map(Piece::triangle_count).sum()
    }

    /// Surfaces that shine at night.
    #[must_use]
    pub fn emissive_surfaces(&self) -> Vec<EmissiveSurface> {
        let mut areas: BTreeMap<Material, f32> = BTreeMap::new();
        for piece in &self.pieces {
            for (&material, part) in piece.mesh.parts.iter().filter(|(material, _)| material.is_emissive()) {
                let corner = |k: u32| part.vertices[k as usize].position;
                let area: f32 = part
                    .indices
                    .chunks_exact(3)
                    .map(|t| (corner(t[1]) - corner(t[0])).cross(corner(t[2]) - corner(t[0])).length() / 2.0)
                    .sum();
                *areas.entry(material).or_default() += area * piece.copies.len() as f32;
            }
        }
        areas.into_iter().map(|(material, area_m2)| EmissiveSurface { material, area_m2 }).collect()
    }
}

/// Meshes by name with their copies, and lamps.
#[derive(Default)]
struct Plan {
    copies: BTreeMap<String, (Mesh, Vec<Placement>)>,
    lamps: Vec<Lamp>,
}

impl Plan {
    /// Places a copy of a mesh that is made when it is first needed.
    fn place(&mut self, name: &str, make: impl FnOnce() -> Mesh, at: Placement) {
        self.copies.entry(name.to_owned()).or_insert_with(|| (make(), Vec::new())).1.push(at);
    }

    /// Adds a lamp of a copy.
    fn light(&mut self, lamp: &Lamp, at: Placement) {
        let direction = lamp.direction.map(|d| at.turned(d.into()).to_array());
        let position = (at.turned(lamp.position.into()) + Vec3::from(at.position)).to_array();
        self.lamps.push(Lamp { position, direction, ..*lamp });
    }
}

impl Placement {
    fn turned(self, v: Vec3) -> Vec3 {
        let (c, s) = turn(self.turn_deg);
        Vec3::new(c * v.x + s * v.z, v.y, -s * v.x + c * v.z)
    }
}

/// Widths that fill a length.
fn widths(dice: &mut Dice, length: f32) -> Vec<f32> {
    let count = (length / 7.6).round().max(1.0) as usize;
    let drawn: Vec<f32> = (0..count).map(|_| dice.range(5.6, 9.6)).collect();
    let sum: f32 = drawn.iter().sum();
    drawn.into_iter().map(|width| width * length / sum).collect()
}

/// Places the houses. Returns the ways to the doors of those along the street.
fn houses(settings: &StreetSettings, ground: &Ground, plan: &mut Plan) -> Vec<Doorway> {
    let (half, length, reach) = (ground.half_street(), ground.length, ground.reach());
    let near = 2.0 * ground.pavement + LANE_M;
    let far = ground.far_front();
    // Corner of the left end of each row, its turn, its length.
    let rows: [(f32, f32, f32, f32); 4] = [
        (-half, 0.0, 90.0, length),
        (half, -length, -90.0, length),
        (-half - 2.5, far, 0.0, 2.0 * half + 5.0),
        (half + 2.5, near, 180.0, 2.0 * half + 5.0),
    ];
    // Plain walls close the lanes: no view from the street reaches them.
    let mut walls = Mesh::default();
    for side in [-1.0f32, 1.0] {
        for [from, to] in [[far, -length], [0.0, near]] {
            let x = side * (reach + 0.3);
            let (low, high) = (Vec3::new(x - 0.3, -0.2, from - 0.5), Vec3::new(x + 0.3, 13.0, to + 0.5));
            let paint = tinted(Material::Plaster, [0.5, 0.46, 0.40]);
            walls.cuboid(paint, low, high, 0);
            let z = if from < -length { far } else { near };
            let (a, b) = (side * (half + 2.5), side * (reach + 0.5));
            walls.cuboid(paint, Vec3::new(a.min(b), -0.2, z - 0.3), Vec3::new(a.max(b), 12.0, z + 0.3), 0);
        }
    }
    plan.copies.insert("walls".to_owned(), (walls, vec![Placement::default()]));
    let mut doorways = Vec::new();
    let mut stream = 0;
    for (row, (x, z, turn_deg, length)) in rows.into_iter().enumerate() {
        let mut dice = Dice::new(settings.seed, 300 + row as u32);
        let mut along = 0.0;
        let mut neighbor: Option<HouseKind> = None;
        for width in widths(&mut dice, length) {
            stream += 1;
            let (house, kind): (House, HouseKind) =
                draw(settings, stream, width, ground.front_height(), neighbor);
            neighbor = Some(kind);
            let built = house.build();
            let origin = Placement::new(x, 0.0, z, turn_deg);
            let at = |p: Vec3| {
                let p = origin.turned(p + Vec3::X * along) + Vec3::from(origin.position);
                Placement::new(p.x, p.y, p.z, turn_deg)
            };
            let place = at(Vec3::ZERO);
            plan.place(&format!("house {stream}"), || built.mesh, place);
            for placed in &built.windows {
                let design: WindowDesign = placed.design;
                plan.place(&format!("window {design:?}"), || window(design), at(placed.corner));
            }
            // The first two rows are those along the street.
            for [from, to] in built.doors.into_iter().filter(|_| row < 2) {
                let middle = at(Vec3::X * ((from + to) / 2.0)).position;
                doorways.push(Doorway {
                    center_m: [middle[0].signum() * (half - ground.pavement / 2.0), middle[2]],
                    half_size_m: [ground.pavement / 2.0, (to - from) / 2.0 + DOOR_MARGIN_M],
                });
            }
            along += width;
        }
    }
    const { assert!(DEPTH_M <= LANE_REACH_M) };
    doorways
}

fn lamps(settings: &StreetSettings, ground: &Ground, taken: &mut Occupancy, plan: &mut Plan) {
    let mut dice = Dice::new(settings.seed, 201);
    let x = ground.half_road + LAMP_M;
    let y = ground.pavement_height(x) - 0.02;
    let mut side = if dice.chance(0.5) { 1.0 } else { -1.0 };
    let mut z = -dice.range(3.0, 6.0);
    let era = settings.lamps;
    while z > -ground.length + 1.0 {
        // Not before a door.
        let foot = Footprint::new(Use::Lamp, [side * x, z], [furniture::LAMP_FOOT_M; 2]);
        if let Some(z) = taken.settle(foot, LAMP_REACH_M) {
            let at = Placement::new(side * x, y, z, if side > 0.0 { 180.0 } else { 0.0 });
            plan.place("lamp", || furniture::lamp(era).0, at);
            plan.light(&furniture::lamp(era).1, at);
        }
        side = -side;
        z -= settings.lamp_spacing_m * dice.range(0.92, 1.08);
    }
    // A lantern on a wall at each corner.
    for (side, z) in [(1.0, -1.2), (-1.0, -ground.length + 1.2), (-1.0, -1.6), (1.0, -ground.length + 1.6)] {
        let at = Placement::new(side * ground.half_street(), 3.1, z, if side > 0.0 { 180.0 } else { 0.0 });
        plan.place("wall lamp", || furniture::wall_lamp().0, at);
        plan.light(&furniture::wall_lamp().1, at);
    }
}

fn cars(
    settings: &StreetSettings,
    ground: &Ground,
    taken: &mut Occupancy,
    plan: &mut Plan,
) -> Vec<ParkedCar> {
    let mut dice = Dice::new(settings.seed, 202);
    let half = [car::HALF_WIDTH_M + 0.14, car::HALF_LENGTH_M];
    let mut cars = Vec::new();
    let mut last = None;
    let x = ground.half_road - half[0] - 0.12;
    for side in [1.0f32, -1.0] {
        // Narrow streets have cars on one side.
        if side < 0.0 && ground.half_road < 3.3 {
            continue;
        }
        let mut z = -dice.range(3.2, 7.0);
        while z > -ground.length + 3.0 {
            if dice.chance(settings.cars) {
                let drawn = dice.below(car::PAINTS.len());
                // No two neighbors have the same color.
                let paint = if last == Some(drawn) { (drawn + 1) % car::PAINTS.len() } else { drawn };
                last = Some(paint);
                let slant = dice.range(-0.9, 0.9);
                let turn_deg = if (side > 0.0) == dice.chance(0.85) { 180.0 } else { 0.0 };
                let at =
                    Placement::new(side * x, ground.road_height(x * side, z) - 0.004, z, turn_deg + slant);
                plan.place(&format!("car {paint}"), || car::car(paint), at);
                taken.take(Footprint::new(Use::Car, [side * x, z], half));
                cars.push(ParkedCar { center_m: [side * x, z], half_size_m: half });
                z -= 2.0 * half[1] + dice.range(0.7, 1.5);
            } else {
                z -= dice.range(3.0, 6.0);
            }
        }
    }
    cars
}

/// Wires across the street, from house to house.
fn wires(settings: &StreetSettings, ground: &Ground, plan: &mut Plan) {
    let mut dice = Dice::new(settings.seed, 204);
    let mut wires = Mesh::default();
    let mut z = -dice.range(6.0, 12.0);
    while z > -ground.length {
        let half = ground.half_street();
        let (a, b) = (
            Vec3::new(-half, dice.range(6.8, 7.8), z),
            Vec3::new(half, dice.range(6.8, 7.8), z + dice.range(-2.0, 2.0)),
        );
        furniture::wire(&mut wires, a, b, dice.range(0.2, 0.45));
        z -= dice.range(9.0, 18.0);
    }
    if !wires.parts.is_empty() {
        plan.copies.insert("wires".to_owned(), (wires, vec![Placement::default()]));
    }
}

//! The five sorts of houses, drawn at random.

use super::window::{Balcony, Frame, Shutters, Surround, WindowDesign};
use super::{House, HouseKind, Roof, Shop, Story};
use crate::dice::Dice;
use crate::material::Material;
use crate::settings::StreetSettings;
use crate::textures::SIGNS;

const CLAY: [f32; 3] = [0.34, 0.165, 0.105];
const BROWN: [f32; 3] = [0.235, 0.145, 0.105];
const SLATE: [f32; 3] = [0.135, 0.145, 0.16];

/// Colors of stone, as the index of [`WindowDesign::stone`].
pub(super) const STONES: [[f32; 3]; 5] =
    [[0.64, 0.59, 0.49], [0.57, 0.51, 0.42], [0.60, 0.585, 0.55], [0.50, 0.43, 0.34], [0.54, 0.535, 0.52]];
/// Paints of frames, as the index of [`WindowDesign::joinery`].
pub(super) const JOINERY: [[f32; 3]; 5] = [
    [0.66, 0.655, 0.62],
    [0.56, 0.52, 0.43],
    [0.34, 0.355, 0.355],
    [0.075, 0.115, 0.085],
    [0.16, 0.095, 0.06],
];
/// Paints of shutters, as the index of [`WindowDesign::shutters`].
pub(super) const SHUTTERS: [[f32; 3]; 6] = [
    [0.36, 0.41, 0.41],
    [0.11, 0.16, 0.125],
    [0.47, 0.46, 0.42],
    [0.20, 0.125, 0.085],
    [0.19, 0.25, 0.30],
    [0.27, 0.075, 0.06],
];
const PLASTERS: [[f32; 3]; 9] = [
    [0.62, 0.57, 0.47],
    [0.66, 0.63, 0.56],
    [0.58, 0.47, 0.33],
    [0.55, 0.42, 0.35],
    [0.52, 0.53, 0.50],
    [0.62, 0.55, 0.38],
    [0.60, 0.60, 0.58],
    [0.50, 0.40, 0.30],
    [0.47, 0.50, 0.50],
];
const DOORS: [[f32; 3]; 6] = [
    [0.035, 0.065, 0.05],
    [0.12, 0.022, 0.02],
    [0.03, 0.045, 0.075],
    [0.13, 0.075, 0.04],
    [0.05, 0.05, 0.052],
    [0.10, 0.13, 0.14],
];
const SHOP_PAINTS: [[f32; 3]; 7] = [
    [0.022, 0.05, 0.038],
    [0.11, 0.026, 0.022],
    [0.02, 0.028, 0.05],
    [0.11, 0.06, 0.032],
    [0.33, 0.32, 0.28],
    [0.04, 0.04, 0.04],
    [0.10, 0.15, 0.15],
];
const AWNINGS: [[[f32; 3]; 2]; 5] = [
    [[0.56, 0.52, 0.44], [0.26, 0.04, 0.032]],
    [[0.24, 0.035, 0.03], [0.24, 0.035, 0.03]],
    [[0.50, 0.47, 0.40], [0.06, 0.13, 0.09]],
    [[0.55, 0.52, 0.45], [0.55, 0.52, 0.45]],
    [[0.05, 0.09, 0.15], [0.50, 0.49, 0.44]],
];

/// Draws a house of a width; `stream` tells it from its neighbors, whose sort it does not have.
pub(crate) fn draw(
    settings: &StreetSettings,
    stream: u32,
    width_m: f32,
    foot: f32,
    neighbor: Option<HouseKind>,
) -> (House, HouseKind) {
    let mut dice = Dice::new(settings.seed, 1000 + stream);
    let kinds: Vec<HouseKind> = [
        HouseKind::Plaster,
        HouseKind::Boulevard,
        HouseKind::Brick,
        HouseKind::Plaster,
        HouseKind::Old,
        HouseKind::Classical,
    ]
    .into_iter()
    .filter(|&kind| Some(kind) != neighbor)
    .filter(|&kind| width_m < 7.4 || kind != HouseKind::Old)
    .collect();
    let kind = dice.pick(&kinds);
    let mut house = base(&mut dice, kind, width_m);
    match kind {
        HouseKind::Boulevard => boulevard(&mut dice, &mut house),
        HouseKind::Plaster => plaster(&mut dice, &mut house),
        HouseKind::Brick => brick(&mut dice, &mut house),
        HouseKind::Old => old(&mut dice, &mut house),
        HouseKind::Classical => classical(&mut dice, &mut house),
    }
    house.door_bay = dice.below(house.bays as usize) as u32;
    if dice.chance(settings.shops) {
        let awning = dice.chance(0.62).then(|| dice.pick(&AWNINGS));
        house.shop =
            Some(Shop { sign: dice.below(SIGNS as usize) as u32, paint: dice.pick(&SHOP_PAINTS), awning });
        house.ground_m = house.ground_m.max(3.7);
    }
    house.lit = settings.lit_windows;
    house.age = settings.age;
    house.foot = foot;
    house.seed = dice.below(1 << 20) as u32;
    (house, kind)
}

fn design(joinery: usize, stone: usize, size: [f32; 2]) -> WindowDesign {
    WindowDesign {
        size_cm: size.map(|v| (v * 100.0).round() as u16),
        frame: Frame::Casement,
        joinery: joinery as u8,
        surround: Surround::Band,
        stone: stone as u8,
        shutters: None,
        balcony: Balcony::None,
        has_flowers: false,
    }
}

fn base(dice: &mut Dice, kind: HouseKind, width_m: f32) -> House {
    let stone = dice.below(STONES.len());
    House {
        width_m,
        kind,
        wall: Material::Plaster,
        tint: [0.6; 3],
        base: (Material::Plaster, [0.6; 3]),
        stone: STONES[stone],
        ground_m: dice.range(3.3, 3.6),
        stories: Vec::new(),
        bays: ((width_m - 0.6) / dice.range(1.95, 2.35)).round().max(2.0) as u32,
        door: dice.pick(&DOORS),
        door_bay: 0,
        ground_design: design(0, stone, [1.1, 1.5]),
        shop: None,
        has_quoins: false,
        has_pilasters: false,
        roof: Roof::Balustrade,
        seed: 0,
        lit: 0.4,
        age: 0.5,
        foot: 0.0,
    }
}

/// Stories of heights, each a little lower than the last.
fn stack(house: &mut House, count: usize, first_m: f32, sill_m: f32, design: WindowDesign) {
    for k in 0..count {
        let height_m = first_m - 0.14 * k as f32;
        let [w, h] = design.size_cm;
        let size_cm = [w, h.saturating_sub(14 * k as u16)];
        let design = WindowDesign { size_cm, ..design };
        house.stories.push(Story { height_m, sill_m, design, has_long_balcony: false, has_course: k == 0 });
    }
}

fn boulevard(dice: &mut Dice, house: &mut House) {
    let stone = dice.below(2);
    house.stone = STONES[stone];
    house.wall = Material::Ashlar;
    house.tint = dice.vary(STONES[stone], 0.05).map(|c| (c * 1.03).min(1.0));
    house.base = (Material::Ashlar, house.tint.map(|c| c * 0.92));
    let window = WindowDesign {
        surround: Surround::Molded,
        balcony: Balcony::Rail,
        ..design(dice.pick(&[0, 0, 1, 2]), stone, [1.15, 2.15])
    };
    house.ground_design = WindowDesign { balcony: Balcony::None, ..design(0, stone, [1.15, 1.8]) };
    house.ground_m = dice.range(3.9, 4.2);
    let count = if dice.chance(0.5) { 4 } else { 3 };
    stack(house, count, 3.35, 0.22, window);
    for k in [0, count - 1] {
        house.stories[k].has_long_balcony = k > 0 || dice.chance(0.5);
        if house.stories[k].has_long_balcony {
            house.stories[k].design.balcony = Balcony::None;
        }
    }
    house.stories[0].design.surround = Surround::Pediment;
    house.stories[count - 1].has_course = true;
    house.roof = Roof::Mansard { paint: Material::Zinc, tiles: [0.86, 0.88, 0.92] };
}

fn plaster(dice: &mut Dice, house: &mut House) {
    let stone = dice.below(STONES.len());
    house.stone = STONES[stone];
    let color = dice.pick(&PLASTERS);
    house.tint = dice.vary(color, 0.10);
    house.base = if dice.chance(0.35) {
        (Material::Ashlar, house.stone)
    } else {
        (Material::Plaster, house.tint.map(|c| c * 0.86))
    };
    let shutters = dice.chance(0.75).then(|| Shutters { paint: dice.below(SHUTTERS.len()) as u8, state: 0 });
    let window = WindowDesign {
        shutters,
        surround: if dice.chance(0.6) { Surround::Band } else { Surround::None },
        balcony: if dice.chance(0.35) { Balcony::Rail } else { Balcony::None },
        ..design(dice.below(5), stone, [dice.range(0.98, 1.12), 1.72])
    };
    house.ground_design =
        WindowDesign { balcony: Balcony::Grille, shutters: None, size_cm: [105, 145], ..window };
    let count = 2 + dice.below(3);
    let first = dice.range(3.0, 3.25);
    let sill = if window.balcony == Balcony::Rail { 0.45 } else { 0.75 };
    stack(house, count, first, sill, window);
    house.has_quoins = dice.chance(0.3);
    let tiles = dice.pick(&[CLAY, BROWN, SLATE]);
    house.roof = if dice.chance(0.6) {
        Roof::Pitched { pitch_deg: dice.range(32.0, 42.0), tiles: dice.vary(tiles, 0.12) }
    } else {
        Roof::Mansard { paint: Material::Roof, tiles: dice.vary(SLATE, 0.1) }
    };
}

fn brick(dice: &mut Dice, house: &mut House) {
    let stone = dice.pick(&[0, 1, 2, 4]);
    house.stone = STONES[stone];
    house.wall = dice.pick(&[Material::Brick, Material::Brick, Material::BrickPale]);
    house.tint = dice.vary([0.90, 0.88, 0.86], 0.08);
    house.base = (Material::Ashlar, house.stone.map(|c| c * 0.95));
    let window = WindowDesign {
        frame: if dice.chance(0.5) { Frame::Sash } else { Frame::Casement },
        surround: Surround::Toothed,
        balcony: if dice.chance(0.5) { Balcony::Rail } else { Balcony::None },
        ..design(dice.pick(&[0, 1, 3]), stone, [1.1, 1.85])
    };
    house.ground_design =
        WindowDesign { surround: Surround::Band, balcony: Balcony::Grille, ..design(0, stone, [1.1, 1.6]) };
    house.ground_m = dice.range(3.5, 3.8);
    let count = 3 + dice.below(2);
    stack(house, count, 3.2, 0.55, window);
    for story in &mut house.stories {
        story.has_course = true;
    }
    house.has_quoins = dice.chance(0.7);
    house.roof = if dice.chance(0.55) {
        Roof::Mansard { paint: Material::Roof, tiles: dice.vary(SLATE, 0.12) }
    } else {
        Roof::Pitched { pitch_deg: dice.range(36.0, 44.0), tiles: dice.vary(BROWN, 0.12) }
    };
}

fn old(dice: &mut Dice, house: &mut House) {
    let stone = dice.pick(&[1, 3, 3, 2]);
    house.stone = STONES[stone];
    let color = dice.pick(&PLASTERS);
    house.tint = dice.vary(color, 0.16).map(|c| c * 0.92);
    house.base = (Material::Plaster, house.tint.map(|c| c * 0.80));
    let window = WindowDesign {
        shutters: Some(Shutters { paint: dice.below(SHUTTERS.len()) as u8, state: 0 }),
        surround: Surround::Lintel,
        ..design(dice.pick(&[0, 3, 4]), stone, [0.92, 1.32])
    };
    house.ground_design = WindowDesign { shutters: None, balcony: Balcony::Grille, ..window };
    house.ground_m = dice.range(2.9, 3.2);
    let count = 2 + usize::from(dice.chance(0.45));
    stack(house, count, 2.75, 0.85, window);
    house.stories[0].has_course = false;
    house.roof = Roof::Pitched {
        pitch_deg: dice.range(38.0, 50.0),
        tiles: dice.vary(dice.clone().pick(&[CLAY, BROWN]), 0.15),
    };
}

fn classical(dice: &mut Dice, house: &mut House) {
    let stone = dice.pick(&[0, 2, 4]);
    house.stone = STONES[stone];
    house.wall = if dice.chance(0.5) { Material::Ashlar } else { Material::Plaster };
    house.tint = if house.wall == Material::Ashlar {
        dice.vary(STONES[stone], 0.05)
    } else {
        let color = dice.pick(&PLASTERS);
        dice.vary(color, 0.08)
    };
    house.base = (Material::Ashlar, house.stone.map(|c| c * 0.94));
    let window =
        WindowDesign { surround: Surround::Molded, ..design(dice.pick(&[0, 1, 2]), stone, [1.15, 2.0]) };
    house.ground_design =
        WindowDesign { surround: Surround::Band, balcony: Balcony::Grille, ..design(0, stone, [1.1, 1.7]) };
    house.ground_m = dice.range(3.8, 4.1);
    let count = 2 + usize::from(dice.chance(0.6));
    stack(house, count, 3.45, 0.5, window);
    let head = if dice.chance(0.5) { Surround::Pediment } else { Surround::Ledge };
    house.stories[0].design = WindowDesign { surround: head, balcony: Balcony::Stone, ..window };
    house.has_pilasters = dice.chance(0.5);
    house.roof = if dice.chance(0.6) {
        Roof::Balustrade
    } else {
        Roof::Mansard { paint: Material::Zinc, tiles: [0.9; 3] }
    };
}

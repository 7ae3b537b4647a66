//! Materials of the street, by day and by night. All surfaces are dry: the renderer wets them.

use serde_json::{Value, json};

use crate::textures::{
    ASHLAR_M, ASPHALT_M, BRICK_M, CLOTH_M, COVER_M, CURB_M, IRON_M, JOINERY_M, PLASTER_M, ROOF_M, SETTS_M,
    SLABS_M, ZINC_M,
};

/// Sorts of light in rooms.
pub(crate) const ROOM_LIGHTS: u8 = 8;

/// All materials.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Material {
    /// Worn asphalt.
    Asphalt,
    /// Granite setts in rows.
    Setts,
    /// Granite of curb stones.
    Curb,
    /// Slabs of the pavement.
    Slabs,
    /// Cast iron of manhole covers.
    Cover,
    /// Earth and dark gaps.
    Soil,
    /// Red bricks.
    Brick,
    /// Buff bricks.
    BrickPale,
    /// Painted plaster with stains.
    Plaster,
    /// Blocks of limestone with joints.
    Ashlar,
    /// Dressed stone without joints.
    Stone,
    /// Plain tiles and slates.
    Roof,
    /// Sheets of zinc with standing seams.
    Zinc,
    /// Painted wood.
    Joinery,
    /// Painted or rusty iron.
    Iron,
    /// Bare wood.
    Wood,
    /// Cloth of awnings.
    Cloth,
    /// Things in shops, paper, ceramics.
    Goods,
    /// Bark of trees.
    Bark,
    /// Leaves on cards with holes.
    Leaf,
    /// Panes of windows.
    Glass,
    /// Walls and things in a room, with one of the lights of rooms; 0 is dark.
    Room(u8),
    /// A curtain before a room, with one of the lights of rooms; 0 is dark.
    Curtain(u8),
    /// Luminous panels of a shop.
    ShopLight,
    /// Boards with names of shops.
    Sign,
    /// Glass of a street lamp.
    LampGlass,
    /// Car paint; its color comes with the vertices.
    CarPaint,
    /// Windows of cars.
    CarGlass,
    /// Black plastic.
    Trim,
    /// Tires.
    Rubber,
    /// Wheels and bright parts.
    Alloy,
    /// Headlamps.
    Headlight,
    /// Headlamps of a car that drives.
    HeadlightLit,
    /// Tail lamps.
    TailLight,
    /// Tail lamps of a car that drives.
    TailLightLit,
    /// Number plates.
    Plate,
}

/// Light of a room: color of its brightest part, and its radiance, cd/m^2: walls at 10 to 80 lux, curtains before them;
/// lamps of 2400 to 5000 K as the camera at about 4000 K shows them, and a television.
const ROOM_LIGHT: [([f64; 3], f64); ROOM_LIGHTS as usize] = [
    ([0.0; 3], 0.0),
    ([1.0, 0.66, 0.36], 9.0),
    ([1.0, 0.58, 0.27], 4.5),
    ([1.0, 0.76, 0.50], 13.0),
    ([1.0, 0.52, 0.22], 2.4),
    ([1.0, 0.88, 0.72], 7.0),
    ([0.42, 0.62, 1.0], 1.4),
    ([0.88, 0.94, 1.0], 5.5),
];
/// A shop's luminous ceiling panels.
const SHOP_CD_M2: f64 = 220.0;
/// The glass of a street lamp.
const LAMP_CD_M2: f64 = 2_600.0;
/// The glass of a dipped headlight beside its beam.
const HEADLIGHT_CD_M2: f64 = 3_000.0;
/// A tail light: 6 cd from 0.012 m^2.
const TAIL_LIGHT_CD_M2: f64 = 500.0;

/// The textures of a material, by file name.
#[derive(Default)]
struct Maps {
    color: Option<&'static str>,
    normal: Option<(&'static str, f64)>,
    roughness: Option<&'static str>,
    emission: Option<&'static str>,
}

/// Appearance of a material.
struct Look {
    color: [f64; 3],
    roughness: f64,
    metallic: f64,
    maps: Maps,
    emission: Option<([f64; 3], f64)>,
    transmission: f64,
    /// Fraction of the scattered light that leaves on the other side, and the factor of its color.
    diffuse_transmission: Option<(f64, [f64; 3])>,
    /// Alpha mode and sides.
    more: Value,
}

fn look(color: [f64; 3], roughness: f64) -> Look {
    Look {
        color,
        roughness,
        metallic: 0.0,
        maps: Maps::default(),
        emission: None,
        transmission: 0.0,
        diffuse_transmission: None,
        more: json!({}),
    }
}

fn textured(color: &'static str, normal: Option<(&'static str, f64)>, roughness: f64) -> Look {
    let maps = Maps { color: Some(color), normal, ..Maps::default() };
    Look { maps, ..look([1.0; 3], roughness) }
}

/// A look of which a map says how rough it is, too.
fn tiled(color: &'static str, normal: Option<&'static str>, roughness: &'static str) -> Look {
    let mut look = textured(color, normal.map(|name| (name, 1.0)), 1.0);
    look.maps.roughness = Some(roughness);
    look
}

impl Material {
    /// Edge of the tile of its texture, meters; 1 without one.
    #[must_use]
    pub fn tile_m(self) -> f32 {
        match self {
            Self::Asphalt => ASPHALT_M,
            Self::Slabs => SLABS_M,
            Self::Setts => SETTS_M,
            Self::Curb => CURB_M,
            Self::Cover => COVER_M,
            Self::Brick | Self::BrickPale => BRICK_M,
            Self::Plaster => PLASTER_M,
            Self::Ashlar => ASHLAR_M,
            Self::Roof => ROOF_M,
            Self::Zinc => ZINC_M,
            Self::Iron => IRON_M,
            Self::Joinery => JOINERY_M,
            Self::Cloth => CLOTH_M,
            Self::Stone => 0.8,
            Self::Wood => 0.9,
            Self::Bark => 0.4,
            _ => 1.0,
        }
    }

    /// Its name in files.
    #[must_use]
    pub fn name(self) -> String {
        let words = format!("{self:?}");
        let mut name = String::new();
        for (k, c) in words.chars().enumerate() {
            match c {
                '(' => name.push('_'),
                ')' => {}
                _ => {
                    if c.is_uppercase() && k > 0 {
                        name.push('_');
                    }
                    name.extend(c.to_lowercase());
                }
            }
        }
        name
    }

    /// True if it shines at night.
    #[must_use]
    pub fn is_emissive(self) -> bool {
        self.look(true).emission.is_some()
    }

    fn look(self, is_night: bool) -> Look {
        let glow = |look: Look, color: [f64; 3], cd_m2: f64| {
            if is_night && cd_m2 > 0.0 { Look { emission: Some((color, cd_m2)), ..look } } else { look }
        };
        // 2700 to 3000 K as the camera at about 4000 K shows it.
        const WARM: [f64; 3] = [1.0, 0.84, 0.63];
        match self {
            Self::Asphalt => tiled("asphalt_color.jpg", Some("asphalt_normal.jpg"), "asphalt_roughness.jpg"),
            Self::Setts => tiled("setts_color.jpg", Some("setts_normal.jpg"), "setts_roughness.jpg"),
            Self::Curb => textured("curb_color.jpg", Some(("curb_normal.jpg", 1.0)), 0.75),
            Self::Slabs => tiled("slabs_color.jpg", Some("slabs_normal.jpg"), "slabs_roughness.jpg"),
            Self::Cover => {
                let mut look = Look { metallic: 0.6, ..look([0.16, 0.145, 0.13], 0.5) };
                look.maps.normal = Some(("cover_normal.jpg", 1.0));
                look
            }
            Self::Soil => look([0.05, 0.042, 0.034], 0.95),
            Self::Brick => tiled("brick_color.jpg", Some("brick_normal.jpg"), "brick_roughness.jpg"),
            Self::BrickPale => tiled("brick_pale_color.jpg", Some("brick_normal.jpg"), "brick_roughness.jpg"),
            Self::Plaster => tiled("plaster_color.jpg", Some("plaster_normal.jpg"), "plaster_roughness.jpg"),
            Self::Ashlar => tiled("ashlar_color.jpg", Some("ashlar_normal.jpg"), "ashlar_roughness.jpg"),
            Self::Stone => tiled("stone_color.jpg", Some("stone_normal.jpg"), "stone_roughness.jpg"),
            Self::Roof => tiled("roof_color.jpg", Some("roof_normal.jpg"), "roof_roughness.jpg"),
            Self::Zinc => {
                let look = tiled("zinc_color.jpg", Some("zinc_normal.jpg"), "zinc_roughness.jpg");
                Look { metallic: 0.85, ..look }
            }
            Self::Joinery => tiled("joinery_color.jpg", Some("joinery_normal.jpg"), "joinery_roughness.jpg"),
            Self::Iron => tiled("iron_color.jpg", None, "iron_roughness.jpg"),
            Self::Wood => tiled("wood_color.jpg", None, "wood_roughness.jpg"),
            Self::Cloth => Look {
                more: json!({"doubleSided": true}),
                ..textured("cloth_color.jpg", Some(("cloth_normal.jpg", 1.0)), 0.95)
            },
            Self::Goods => look([1.0; 3], 0.8),
            Self::Bark => Look { color: [0.24, 0.20, 0.16], ..textured("bark_color.jpg", None, 0.95) },
            Self::Leaf => Look {
                more: json!({"alphaMode": "MASK", "alphaCutoff": 0.5, "doubleSided": true}),
                // Of what a lime's leaf scatters more passes than is thrown back, and less of the blue (S. Jacquemoud and F. Baret, Remote
                // Sens. Environ. 34, 1990).
                diffuse_transmission: Some((0.6, [1.0, 1.0, 0.6])),
                ..textured("leaves.png", None, 0.55)
            },
            Self::Glass => Look {
                transmission: 1.0,
                more: json!({"doubleSided": true}),
                ..look([0.93, 0.95, 0.94], 0.03)
            },
            Self::Room(light) => {
                let mut look = textured("room_color.jpg", None, 0.9);
                let (color, cd_m2) = ROOM_LIGHT[usize::from(light.min(ROOM_LIGHTS - 1))];
                look.maps.emission = (is_night && light > 0).then_some("room_lit.jpg");
                glow(look, color, cd_m2)
            }
            Self::Curtain(light) => {
                let mut look = textured("curtain_color.jpg", None, 0.95);
                let (color, cd_m2) = ROOM_LIGHT[usize::from(light.min(ROOM_LIGHTS - 1))];
                look.maps.emission = (is_night && light > 0).then_some("curtain_color.jpg");
                look.more = json!({"doubleSided": true});
                glow(look, color, 0.55 * cd_m2)
            }
            Self::ShopLight => glow(look([0.85; 3], 0.6), WARM, SHOP_CD_M2),
            Self::Sign => textured("signs_color.jpg", None, 0.55),
            Self::LampGlass => glow(look([0.72, 0.71, 0.66], 0.3), WARM, LAMP_CD_M2),
            // The clear coat's gloss over the base.
            Self::CarPaint => look([1.0; 3], 0.10),
            // Laminated and tinted: with both of its sides it lets 70 % pass.
            Self::CarGlass => Look {
                transmission: 1.0,
                more: json!({"doubleSided": true}),
                ..look([0.72, 0.77, 0.74], 0.03)
            },
            Self::Trim => look([0.022, 0.022, 0.024], 0.55),
            Self::Rubber => look([0.032, 0.032, 0.033], 0.88),
            Self::Alloy => Look { metallic: 1.0, ..look([0.50, 0.50, 0.51], 0.35) },
            Self::Headlight => look([0.05, 0.052, 0.055], 0.06),
            Self::HeadlightLit => glow(look([0.50, 0.52, 0.53], 0.08), [1.0, 0.93, 0.82], HEADLIGHT_CD_M2),
            Self::TailLight => look([0.10, 0.007, 0.007], 0.10),
            Self::TailLightLit => glow(look([0.22, 0.012, 0.010], 0.12), [1.0, 0.03, 0.02], TAIL_LIGHT_CD_M2),
            Self::Plate => look([0.62, 0.62, 0.58], 0.45),
        }
    }

    /// True if it needs texture coordinates.
    #[must_use]
    pub fn has_texture(self) -> bool {
        let maps = self.look(true).maps;
        maps.color.is_some() || maps.normal.is_some()
    }

    /// The material in glTF; `texture` returns the index of a file.
    pub(crate) fn gltf(self, is_night: bool, mut texture: impl FnMut(&'static str) -> usize) -> Value {
        let look = self.look(is_night);
        let mut index = |name| json!({"index": texture(name)});
        let [r, g, b] = look.color;
        let mut pbr = json!({
            "baseColorFactor": [r, g, b, 1.0],
            "roughnessFactor": look.roughness,
            "metallicFactor": look.metallic,
        });
        let mut material = json!({"name": self.name()});
        if let Some(name) = look.maps.color {
            pbr["baseColorTexture"] = index(name);
        }
        if let Some(name) = look.maps.roughness {
            pbr["metallicRoughnessTexture"] = index(name);
        }
        material["pbrMetallicRoughness"] = pbr;
        if let Some((name, scale)) = look.maps.normal {
            let mut map = index(name);
            map["scale"] = json!(scale);
            material["normalTexture"] = map;
        }
        if let Some(name) = look.maps.emission {
            material["emissiveTexture"] = index(name);
        }
        if let Value::Object(more) = look.more {
            for (key, value) in more {
                material[key] = value;
            }
        }
        if look.transmission > 0.0 {
            material["extensions"]["KHR_materials_transmission"] =
                json!({"transmissionFactor": look.transmission});
        }
        if let Some((fraction, color)) = look.diffuse_transmission {
            let extension = &mut material["extensions"]["KHR_materials_diffuse_transmission"];
            *extension =
                json!({"diffuseTransmissionFactor": fraction, "diffuseTransmissionColorFactor": color});
            if let Some(name) = look.maps.color {
                extension["diffuseTransmissionColorTexture"] = index(name);
            }
        }
        if let Some((color, cd_m2)) = look.emission {
            material["emissiveFactor"] = json!(color);
            material["extensions"]["KHR_materials_emissive_strength"] = json!({"emissiveStrength": cd_m2});
        }
        material
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_those_of_files() {
        assert_eq!(Material::CarPaint.name(), "car_paint");
        assert_eq!(Material::Room(3).name(), "room_3");
    }

    #[test]
    fn only_the_night_shines() {
        for material in [Material::Room(2), Material::LampGlass, Material::HeadlightLit, Material::ShopLight]
        {
            assert!(material.gltf(false, |_| 0).get("emissiveFactor").is_none());
            assert!(material.gltf(true, |_| 0).get("emissiveFactor").is_some());
        }
        assert!(!Material::Room(0).is_emissive() && Material::Curtain(1).is_emissive());
    }
}

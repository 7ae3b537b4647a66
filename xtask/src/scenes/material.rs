//! Materials of the street, by day and by night.
//!
//! Road and pavement are darker and smoother than dry ones, as long as the renderer does not wet them itself; everything else is dry.

use serde_json::{Value, json};

use super::textures::{ASPHALT_M, BRICK_M, COVER_M, CURB_M, PLASTER_M, ROOF_M, SETTS_M, SLABS_M};

/// All materials.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Material {
    Asphalt,
    RoadPaint,
    Setts,
    Kerb,
    Slabs,
    Cover,
    Soil,
    Brick,
    BrickPale,
    Plaster,
    Stone,
    Roof,
    Joinery,
    Iron,
    Zinc,
    Wood,
    Fabric,
    Goods,
    Bark,
    Leaf,
    Pane,
    PaneLit,
    ShopLight,
    SignBooks,
    SignCafe,
    LampGlass,
    CarPaint,
    CarGlass,
    Trim,
    Rubber,
    Alloy,
    Headlight,
    TailLight,
    Plate,
}

/// Radiance of a lit window's brightest part, cd/m^2: a wall or curtain at 120 lux.
const WINDOW_CD_M2: f64 = 26.0;
/// A shop's luminous ceiling panels.
const SHOP_CD_M2: f64 = 900.0;
/// The bowl of a street lamp, to the side: most of its light goes down, as the lamp below it.
const LAMP_CD_M2: f64 = 3_000.0;
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
    extra: Value,
}

fn look(color: [f64; 3], roughness: f64) -> Look {
    Look { color, roughness, metallic: 0.0, maps: Maps::default(), emission: None, extra: json!({}) }
}

fn textured(color: &'static str, normal: Option<(&'static str, f64)>, roughness: f64) -> Look {
    let maps = Maps { color: Some(color), normal, ..Maps::default() };
    Look { maps, ..look([1.0; 3], roughness) }
}

impl Material {
    /// Edge of the tile of its texture, meters; 1 without one.
    pub(super) fn tile_m(self) -> f32 {
        match self {
            Self::Asphalt => ASPHALT_M,
            Self::Slabs => SLABS_M,
            Self::Setts => SETTS_M,
            Self::Kerb => CURB_M,
            Self::Cover => COVER_M,
            Self::Brick | Self::BrickPale => BRICK_M,
            Self::Plaster => PLASTER_M,
            Self::Roof => ROOF_M,
            Self::Stone => 0.8,
            Self::Wood => 0.9,
            Self::Bark => 0.4,
            _ => 1.0,
        }
    }

    /// Its name in files.
    pub(super) fn name(self) -> String {
        let words = format!("{self:?}");
        let mut name = String::new();
        for (k, c) in words.chars().enumerate() {
            if c.is_uppercase() && k > 0 {
                name.push('_');
            }
            name.extend(c.to_lowercase());
        }
        name
    }

    fn look(self, is_night: bool) -> Look {
        let glow = |look: Look, color: [f64; 3], cd_m2: f64| {
            if is_night { Look { emission: Some((color, cd_m2)), ..look } } else { look }
        };
        // 2700 to 3000 K as the camera at about 4000 K shows it.
        const WARM: [f64; 3] = [1.0, 0.76, 0.47];
        match self {
            // Wet: 0.6 of the dry albedo, and a film that is smooth between the stones.
            Self::Asphalt => {
                let mut look = textured("asphalt_color.jpg", Some(("asphalt_normal.jpg", 1.0)), 0.5);
                look.color = [0.60, 0.60, 0.615];
                look.maps.roughness = Some("asphalt_roughness.jpg");
                look
            }
            Self::RoadPaint => {
                let mut look = textured("asphalt_color.jpg", Some(("asphalt_normal.jpg", 0.5)), 0.45);
                look.maps.color = Some("stone_color.jpg");
                look.color = [0.52, 0.52, 0.50];
                look
            }
            Self::Setts => {
                Look { color: [0.7; 3], ..textured("setts_color.jpg", Some(("setts_normal.jpg", 1.0)), 0.38) }
            }
            Self::Kerb => Look { color: [0.72; 3], ..textured("kerb_color.jpg", None, 0.45) },
            Self::Slabs => {
                let mut look = textured("slabs_color.jpg", Some(("slabs_normal.jpg", 1.0)), 0.55);
                look.color = [0.66, 0.66, 0.67];
                look.maps.roughness = Some("slabs_roughness.jpg");
                look
            }
            Self::Cover => {
                let mut look = look([0.085, 0.08, 0.075], 0.35);
                look.maps.normal = Some(("cover_normal.jpg", 1.0));
                look
            }
            Self::Soil => look([0.05, 0.036, 0.024], 0.9),
            Self::Brick => textured("brick_color.jpg", Some(("brick_normal.jpg", 1.0)), 0.9),
            Self::BrickPale => textured("brick_pale_color.jpg", Some(("brick_normal.jpg", 1.0)), 0.9),
            Self::Plaster => textured("plaster_color.jpg", Some(("plaster_normal.jpg", 1.0)), 0.92),
            Self::Stone => textured("stone_color.jpg", None, 0.8),
            Self::Roof => textured("roof_color.jpg", Some(("roof_normal.jpg", 1.0)), 0.7),
            Self::Joinery => look([1.0; 3], 0.38),
            Self::Iron => look([1.0; 3], 0.42),
            Self::Zinc => Look { metallic: 1.0, ..look([0.52, 0.53, 0.55], 0.5) },
            Self::Wood => textured("wood_color.jpg", None, 0.6),
            Self::Fabric => look([1.0; 3], 0.95),
            Self::Goods => look([1.0; 3], 0.8),
            Self::Bark => Look { color: [0.20, 0.165, 0.125], ..textured("bark_color.jpg", None, 0.95) },
            Self::Leaf => {
                let mut look = textured("leaves.png", None, 0.55);
                look.extra = json!({"alphaMode": "MASK", "alphaCutoff": 0.5, "doubleSided": true});
                look
            }
            Self::Pane => textured("panes_color.jpg", None, 0.06),
            Self::PaneLit => {
                let mut look = textured("panes_color.jpg", None, 0.06);
                look.maps.emission = is_night.then_some("panes_lit.jpg");
                glow(look, [1.0; 3], WINDOW_CD_M2)
            }
            Self::ShopLight => glow(look([0.85; 3], 0.6), WARM, SHOP_CD_M2),
            Self::SignBooks => textured("sign_books.jpg", None, 0.5),
            Self::SignCafe => textured("sign_cafe.jpg", None, 0.5),
            Self::LampGlass => glow(look([0.75, 0.75, 0.72], 0.25), WARM, LAMP_CD_M2),
            Self::CarPaint => look([1.0; 3], 0.16),
            Self::CarGlass => look([0.012, 0.014, 0.015], 0.04),
            Self::Trim => look([0.022, 0.022, 0.024], 0.5),
            Self::Rubber => look([0.03, 0.03, 0.031], 0.85),
            Self::Alloy => Look { metallic: 1.0, ..look([0.55, 0.55, 0.56], 0.32) },
            Self::Headlight => glow(look([0.55, 0.57, 0.58], 0.08), [1.0, 0.93, 0.82], HEADLIGHT_CD_M2),
            Self::TailLight => glow(look([0.28, 0.012, 0.010], 0.12), [1.0, 0.03, 0.02], TAIL_LIGHT_CD_M2),
            Self::Plate => look([0.62, 0.62, 0.58], 0.45),
        }
    }

    /// True if it needs texture coordinates.
    pub(super) fn has_texture(self) -> bool {
        let maps = self.look(true).maps;
        maps.color.is_some() || maps.normal.is_some()
    }

    /// The material in glTF; `texture` returns the index of a file.
    pub(super) fn gltf(self, is_night: bool, mut texture: impl FnMut(&'static str) -> usize) -> Value {
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
        if let Value::Object(extra) = look.extra {
            for (key, value) in extra {
                material[key] = value;
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
        assert_eq!(Material::PaneLit.name(), "pane_lit");
    }

    #[test]
    fn only_the_night_shines() {
        for material in [Material::PaneLit, Material::LampGlass, Material::Headlight, Material::ShopLight] {
            assert!(material.gltf(false, |_| 0).get("emissiveFactor").is_none());
            assert!(material.gltf(true, |_| 0).get("emissiveFactor").is_some());
        }
    }
}

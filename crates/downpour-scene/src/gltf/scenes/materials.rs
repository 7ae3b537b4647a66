//! Materials: glTF 2.0, section 5.19, and the extensions that Downpour draws.

use super::fields;
use super::textures::Textures;
use crate::error::SceneError;
use crate::gltf::guard::Spot;
use crate::scene::{AlphaMode, Encoding, Material, TextureRef};
use crate::warning::{WarningKind, Warnings};
use downpour_math::ops::{cos, sin};
use glam::{Affine2, Mat2, Vec2, Vec3};

/// All materials. The textures that they use are noted down.
pub(super) fn read(
    document: &Spot<'_>,
    textures: &mut Textures,
    warnings: &mut Warnings,
) -> Result<Vec<Material>, SceneError> {
    let mut all = Vec::new();
    document.each(&["materials", "[]"], &mut |material| {
        all.push(one(material, textures, warnings)?);
        Ok(())
    })?;
    Ok(all)
}

fn one(spot: &Spot<'_>, textures: &mut Textures, warnings: &mut Warnings) -> Result<Material, SceneError> {
    let mut material = Material { name: fields::name(spot)?, ..Material::default() };
    if let Some(surface) = spot.get("pbrMetallicRoughness")? {
        material.base_color = fields::fractions(&surface, "baseColorFactor", [1.0; 4], warnings)?.into();
        material.metallic = fields::fraction(&surface, "metallicFactor", 1.0, warnings)?;
        material.roughness = fields::fraction(&surface, "roughnessFactor", 1.0, warnings)?;
        material.base_color_texture =
            texture(&surface, "baseColorTexture", Encoding::Srgb, textures, warnings)?;
        material.metallic_roughness_texture =
            texture(&surface, "metallicRoughnessTexture", Encoding::Linear, textures, warnings)?;
    }
    material.normal_texture = texture(spot, "normalTexture", Encoding::Linear, textures, warnings)?;
    if let Some(normal) = spot.get("normalTexture")? {
        material.normal_scale = fields::number(&normal, "scale", 1.0)?;
    }
    material.occlusion_texture = texture(spot, "occlusionTexture", Encoding::Linear, textures, warnings)?;
    if let Some(occlusion) = spot.get("occlusionTexture")? {
        material.occlusion_strength = fields::fraction(&occlusion, "strength", 1.0, warnings)?;
    }
    material.emissive_texture = texture(spot, "emissiveTexture", Encoding::Srgb, textures, warnings)?;
    material.emissive = fields::fractions(spot, "emissiveFactor", [0.0; 3], warnings)?.into();
    material.alpha_mode = alpha_mode(spot)?;
    material.double_sided = fields::flag(spot, "doubleSided")?;
    if let Some(extras) = spot.get("extras")?
        && extras.get("porosity")?.is_some()
    {
        material.porosity = Some(fields::fraction(&extras, "porosity", 0.0, warnings)?);
    }
    if let Some(extensions) = spot.get("extensions")? {
        self::extensions(&mut material, &extensions, textures, warnings)?;
    }
    Ok(material)
}

fn alpha_mode(spot: &Spot<'_>) -> Result<AlphaMode, SceneError> {
    let cutoff = fields::from(spot, "alphaCutoff", 0.0, 0.5)?;
    let Some(mode) = spot.get("alphaMode")? else { return Ok(AlphaMode::Opaque) };
    Ok(match mode.text()? {
        "OPAQUE" => AlphaMode::Opaque,
        "MASK" => AlphaMode::Mask { cutoff },
        "BLEND" => AlphaMode::Blend,
        _ => return Err(mode.not("\"OPAQUE\", \"MASK\" or \"BLEND\"")),
    })
}

fn extensions(
    material: &mut Material,
    extensions: &Spot<'_>,
    textures: &mut Textures,
    warnings: &mut Warnings,
) -> Result<(), SceneError> {
    if let Some(strength) = extensions.get("KHR_materials_emissive_strength")? {
        let factor = fields::from(&strength, "emissiveStrength", 0.0, 1.0)?;
        let [r, g, b] = material.emissive.to_array().map(|part| part * factor);
        material.emissive = Vec3::new(r, g, b);
    }
    if let Some(ior) = extensions.get("KHR_materials_ior")? {
        material.ior = fields::number(&ior, "ior", 1.5)?;
        if material.ior < 1.0 && material.ior != 0.0 {
            return Err(ior.need("ior")?.not("a number from 1 on, or 0"));
        }
    }
    if let Some(glass) = extensions.get("KHR_materials_transmission")? {
        material.transmission = fields::fraction(&glass, "transmissionFactor", 0.0, warnings)?;
        material.transmission_texture =
            texture(&glass, "transmissionTexture", Encoding::Linear, textures, warnings)?;
    }
    if let Some(leaf) = extensions.get("KHR_materials_diffuse_transmission")? {
        material.diffuse_transmission = fields::fraction(&leaf, "diffuseTransmissionFactor", 0.0, warnings)?;
        material.diffuse_transmission_texture =
            texture(&leaf, "diffuseTransmissionTexture", Encoding::Linear, textures, warnings)?;
        material.diffuse_transmission_color =
            fields::fractions(&leaf, "diffuseTransmissionColorFactor", [1.0; 3], warnings)?.into();
        material.diffuse_transmission_color_texture =
            texture(&leaf, "diffuseTransmissionColorTexture", Encoding::Srgb, textures, warnings)?;
    }
    material.unlit = extensions.get("KHR_materials_unlit")?.is_some();
    Ok(())
}

/// Use of a texture; `None` if there is none, or none that is supported.
fn texture(
    owner: &Spot<'_>,
    key: &str,
    encoding: Encoding,
    textures: &mut Textures,
    warnings: &mut Warnings,
) -> Result<Option<TextureRef>, SceneError> {
    let Some(info) = owner.get(key)? else { return Ok(None) };
    let index = info.need("index")?.whole()?;
    let mut set = info.whole_or_zero("texCoord")?;
    let mut transform = Affine2::IDENTITY;
    if let Some(extensions) = info.get("extensions")?
        && let Some(map) = extensions.get("KHR_texture_transform")?
    {
        transform = self::transform(&map)?;
        if let Some(other) = map.get("texCoord")? {
            set = other.whole()?;
        }
    }
    let Some(uv_set) = usize::try_from(set).ok().filter(|&set| set < 2) else {
        warnings.add(WarningKind::Ignored, info.trail, || {
            format!("left out: texture coordinates of set {set} are not read, only 0 and 1")
        });
        return Ok(None);
    };
    let texture = usize::try_from(index).ok().and_then(|index| textures.used(index, encoding, warnings));
    Ok(texture.map(|texture| TextureRef { texture, uv_set, transform }))
}

/// `KHR_texture_transform`: offset x rotation x scale.
///
/// The rotation is counter-clockwise as seen in the picture, whose second coordinate points down: `u' = u cos a +
/// v sin a`, `v' = v cos a - u sin a`. The matrix printed in the extension's text turns the other way; its
/// sample models and other readers do not (KhronosGroup/glTF issue 1563).
fn transform(map: &Spot<'_>) -> Result<Affine2, SceneError> {
    let [x, y] = fields::numbers(map, "offset", [0.0; 2])?;
    let [sx, sy] = fields::numbers(map, "scale", [1.0; 2])?;
    let angle = fields::number(map, "rotation", 0.0)?;
    let (s, c) = (sin(angle), cos(angle));
    let linear = Mat2::from_cols(Vec2::new(c * sx, -s * sx), Vec2::new(s * sy, c * sy));
    Ok(Affine2 { matrix2: linear, translation: Vec2::new(x, y) })
}

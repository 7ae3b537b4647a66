//! Cameras. The guard has checked the members that their type requires.

use super::fields;
use crate::error::SceneError;
use crate::gltf::guard::Spot;
use crate::scene::{Camera, Lens};
use std::f32::consts::PI;

/// All cameras.
pub(super) fn read(document: &Spot<'_>) -> Result<Vec<Camera>, SceneError> {
    let mut all = Vec::new();
    document.each(&["cameras", "[]"], &mut |camera| {
        let lens = match camera.need("type")?.text()? {
            "perspective" => perspective(&camera.need("perspective")?)?,
            _ => orthographic(&camera.need("orthographic")?)?,
        };
        all.push(Camera { name: fields::name(camera)?, lens });
        Ok(())
    })?;
    Ok(all)
}

fn perspective(lens: &Spot<'_>) -> Result<Lens, SceneError> {
    let yfov = fields::number(lens, "yfov", 1.0)?;
    // A number above 0 may be 0 in single precision.
    if yfov <= 0.0 || yfov >= PI {
        return Err(lens.need("yfov")?.not("an angle in radians above 0 and below pi (3.1416)"));
    }
    Ok(Lens::Perspective {
        yfov,
        aspect: above_zero(lens, "aspectRatio")?,
        near: above_zero(lens, "znear")?.unwrap_or(0.1),
        far: fields::maybe(lens, "zfar")?,
    })
}

fn orthographic(lens: &Spot<'_>) -> Result<Lens, SceneError> {
    Ok(Lens::Orthographic {
        xmag: fields::number(lens, "xmag", 1.0)?,
        ymag: fields::number(lens, "ymag", 1.0)?,
        near: fields::number(lens, "znear", 0.0)?,
        far: fields::number(lens, "zfar", 1.0)?,
    })
}

fn above_zero(lens: &Spot<'_>, key: &str) -> Result<Option<f32>, SceneError> {
    match fields::maybe(lens, key)? {
        Some(number) if number <= 0.0 => Err(lens.need(key)?.not("a positive number")),
        number => Ok(number),
    }
}

//! Members of objects as numbers, with defaults for missing ones.

use crate::error::SceneError;
use crate::gltf::guard::Spot;
use crate::gltf::irregular;
use crate::warning::Warnings;

/// A number.
pub(super) fn number(owner: &Spot<'_>, key: &str, missing: f32) -> Result<f32, SceneError> {
    owner.get(key)?.map_or(Ok(missing), |member| Ok(single(member.number()?)))
}

/// A number that may be missing.
pub(super) fn maybe(owner: &Spot<'_>, key: &str) -> Result<Option<f32>, SceneError> {
    owner.get(key)?.map(|member| Ok(single(member.number()?))).transpose()
}

/// A number from `least` on.
pub(super) fn from(owner: &Spot<'_>, key: &str, least: f32, missing: f32) -> Result<f32, SceneError> {
    let Some(member) = owner.get(key)? else { return Ok(missing) };
    let number = single(member.number()?);
    if number >= least { Ok(number) } else { Err(member.not(format!("a number from {least} on"))) }
}

/// A fraction from 0 to 1. One outside is clamped, with a warning.
pub(super) fn fraction(
    owner: &Spot<'_>,
    key: &str,
    missing: f32,
    warnings: &mut Warnings,
) -> Result<f32, SceneError> {
    owner.get(key)?.map_or(Ok(missing), |member| clamped(&member, warnings))
}

/// Fractions from 0 to 1, as many as `missing` has.
pub(super) fn fractions<const N: usize>(
    owner: &Spot<'_>,
    key: &str,
    missing: [f32; N],
    warnings: &mut Warnings,
) -> Result<[f32; N], SceneError> {
    each(owner, key, missing, |member| clamped(member, warnings))
}

/// Numbers, as many as `missing` has.
pub(super) fn numbers<const N: usize>(
    owner: &Spot<'_>,
    key: &str,
    missing: [f32; N],
) -> Result<[f32; N], SceneError> {
    each(owner, key, missing, |member| Ok(single(member.number()?)))
}

fn each<const N: usize>(
    owner: &Spot<'_>,
    key: &str,
    missing: [f32; N],
    mut read: impl FnMut(&Spot<'_>) -> Result<f32, SceneError>,
) -> Result<[f32; N], SceneError> {
    let Some(member) = owner.get(key)? else { return Ok(missing) };
    if member.items()?.count() != N {
        return Err(member.not(format!("{N} numbers")));
    }
    let mut all = missing;
    for (part, item) in all.iter_mut().zip(member.items()?) {
        *part = read(&item)?;
    }
    Ok(all)
}

fn clamped(member: &Spot<'_>, warnings: &mut Warnings) -> Result<f32, SceneError> {
    let found = single(member.number()?);
    let fraction = found.clamp(0.0, 1.0);
    if fraction != found {
        irregular(warnings, member.trail, || format!("{found}, not from 0 to 1: taken as {fraction}"));
    }
    Ok(fraction)
}

/// Value of a flag.
pub(super) fn flag(owner: &Spot<'_>, key: &str) -> Result<bool, SceneError> {
    let Some(member) = owner.get(key)? else { return Ok(false) };
    member.value.as_bool().ok_or_else(|| member.not("true or false"))
}

/// The name of an object; empty if it has none.
pub(super) fn name(owner: &Spot<'_>) -> Result<String, SceneError> {
    Ok(owner.get("name")?.map_or(Ok(""), |name| name.text())?.to_owned())
}

/// A number in single precision; its range has been checked.
#[expect(clippy::cast_possible_truncation, reason = "rounding is meant")]
pub(super) fn single(value: f64) -> f32 {
    value as f32
}

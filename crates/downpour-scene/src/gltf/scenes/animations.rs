//! Animations: glTF 2.0, section 3.11. The guard has checked the indices.

use super::fields::{name, single};
use super::primitives::Reading;
use crate::error::SceneError;
use crate::gltf::growth::GrowthBudget;
use crate::gltf::guard::Spot;
use crate::gltf::irregular;
use crate::scene::{Animation, Channel, Interpolation, Local, Node, Property, Track};
use crate::warning::{WarningKind, Warnings};
use gltf::json::Index;
use gltf::json::accessor::{ComponentType, GenericComponentType, Type};
use gltf::json::validation::Checked;

/// All animations. Channels without a supported target are skipped, with a warning.
pub(super) fn read(
    document: &Spot<'_>,
    reading: &Reading<'_>,
    nodes: &[Node],
    remaining: &mut GrowthBudget<'_>,
    warnings: &mut Warnings,
) -> Result<Vec<Animation>, SceneError> {
    let mut all = Vec::new();
    document.each(&["animations", "[]"], &mut |animation| {
        let samplers = animation.need("samplers")?;
        let mut channels = Vec::new();
        for spot in animation.need("channels")?.items()? {
            let Some((node, property, width)) = target(&spot, reading, nodes, warnings)? else { continue };
            let sampler = usize::try_from(spot.need("sampler")?.whole()?).unwrap_or(usize::MAX);
            if let Some(sampler) = samplers.item(sampler) {
                let track = track(&sampler, property, width, reading, remaining, warnings)?;
                channels.push(Channel { node, property, track });
            }
        }
        all.push(Animation { name: name(animation)?, channels });
        Ok(())
    })?;
    Ok(all)
}

/// Target of a channel: the node, its property, and the number of components of that.
fn target(
    channel: &Spot<'_>,
    reading: &Reading<'_>,
    nodes: &[Node],
    warnings: &mut Warnings,
) -> Result<Option<(usize, Property, usize)>, SceneError> {
    let target = channel.need("target")?;
    let path = target.need("path")?;
    let mut ignored =
        |why: &str| warnings.add(WarningKind::Ignored, channel.trail, || format!("ignored: {why}"));
    let (property, width) = match path.text()? {
        "translation" => (Property::Translation, 3),
        "rotation" => (Property::Rotation, 4),
        "scale" => (Property::Scale, 3),
        "weights" => (Property::Weights, 0),
        _ if target.value.get("extensions").is_some() => {
            ignored("the target of an extension is not read");
            return Ok(None);
        }
        _ => return Err(path.not("\"translation\", \"rotation\", \"scale\" or \"weights\"")),
    };
    let Some(index) = target.get("node")? else {
        ignored("it names no node");
        return Ok(None);
    };
    let index = usize::try_from(index.whole()?).unwrap_or(usize::MAX);
    let Some(node) = nodes.get(index) else { return Ok(None) };
    if property != Property::Weights {
        if matches!(node.local, Local::Matrix(_)) {
            ignored("its node has a matrix, which is not animated");
            return Ok(None);
        }
        return Ok(Some((index, property, width)));
    }
    let parts = node.mesh.and_then(|mesh| reading.root.meshes.get(mesh)).map(|mesh| &mesh.primitives);
    let targets = parts.into_iter().flatten().map(|part| part.targets.as_ref().map_or(0, Vec::len)).max();
    match targets.unwrap_or(0) {
        0 => {
            ignored("its node has no mesh with morph targets");
            Ok(None)
        }
        targets => Ok(Some((index, property, targets))),
    }
}

fn track(
    sampler: &Spot<'_>,
    property: Property,
    width: usize,
    reading: &Reading<'_>,
    remaining: &mut GrowthBudget<'_>,
    warnings: &mut Warnings,
) -> Result<Track, SceneError> {
    let interpolation = match sampler.get("interpolation")? {
        None => Interpolation::Linear,
        Some(way) => match way.text()? {
            "STEP" => Interpolation::Step,
            "LINEAR" => Interpolation::Linear,
            "CUBICSPLINE" => Interpolation::CubicSpline,
            _ => return Err(way.not("\"STEP\", \"LINEAR\" or \"CUBICSPLINE\"")),
        },
    };
    let (input, output) = (sampler.need("input")?, sampler.need("output")?);
    let keys = count(&input, Type::Scalar, true, reading)?;
    let kind = match property {
        Property::Translation | Property::Scale => Type::Vec3,
        Property::Rotation => Type::Vec4,
        Property::Weights => Type::Scalar,
    };
    let float = matches!(property, Property::Translation | Property::Scale);
    let found = count(&output, kind, float, reading)?;
    let parts: u64 = if interpolation == Interpolation::CubicSpline { 3 } else { 1 };
    // Weights are scalars one after the other; all else has one element for a value.
    let each = parts.saturating_mul(if property == Property::Weights { width as u64 } else { 1 });
    let wanted = keys.saturating_mul(each);
    if found != wanted {
        let why = format!("{wanted}, {each} for each of {keys} keys");
        return Err(output.wrong(format!("an accessor of {found} elements"), why));
    }
    remaining
        .take(keys.saturating_add(found.saturating_mul(width as u64)).saturating_mul(4), sampler.trail)?;
    let times = times(&input, reading, warnings)?;
    let values = values(&output, property, reading)?;
    let turns = property == Property::Rotation;
    let track = Track { times, values, width, interpolation, turns };
    if turns {
        check_turns(&track, &output)?;
    }
    Ok(track)
}

/// The number of elements of an accessor of the right format.
fn count(link: &Spot<'_>, kind: Type, float: bool, reading: &Reading<'_>) -> Result<u64, SceneError> {
    let Some(accessor) = reading.root.get(index(link)?) else { return Err(link.not("an accessor")) };
    let component = match accessor.component_type {
        Checked::Valid(GenericComponentType(component)) => component,
        Checked::Invalid => return Err(link.not("an accessor of a known type")),
    };
    let fits = match component {
        ComponentType::F32 => true,
        ComponentType::U32 => false,
        _ => !float && accessor.normalized,
    };
    if !fits || accessor.type_ != Checked::Valid(kind) {
        let kind = match kind {
            Type::Vec3 => "VEC3",
            Type::Vec4 => "VEC4",
            _ => "SCALAR",
        };
        let integers = if float { "" } else { ", or of normalized integers of 8 or 16 bits" };
        return Err(link.wrong("an accessor of another format", format!("{kind} of 5126 (float){integers}")));
    }
    Ok(accessor.count.0)
}

fn index(link: &Spot<'_>) -> Result<Index<gltf::json::Accessor>, SceneError> {
    Ok(Index::new(u32::try_from(link.whole()?).unwrap_or(u32::MAX)))
}

/// The times of keys: finite, from 0 on, never falling.
fn times(input: &Spot<'_>, reading: &Reading<'_>, warnings: &mut Warnings) -> Result<Vec<f32>, SceneError> {
    let mut elements = reading.open(index(input)?)?;
    let mut times = crate::Budget::vec_with_capacity(elements.count(), input.trail)?;
    let mut last = 0.0f64;
    let mut twice = 0usize;
    while let Some([time]) = elements.numbers::<1>(0.0)? {
        // NaN and infinity fail the comparison.
        if !(last..=f64::from(f32::MAX)).contains(&time) {
            let found = format!("{time} at element {}", times.len());
            return Err(input.wrong(found, format!("rising times in seconds, from {last} on")));
        }
        twice = twice.saturating_add(usize::from(time == last && !times.is_empty()));
        last = time;
        times.push(single(time));
    }
    if twice > 0 {
        irregular(warnings, input.trail, || format!("{twice} keys at the time of the one before"));
    }
    Ok(times)
}

/// The numbers of keys, one after the other.
fn values(output: &Spot<'_>, property: Property, reading: &Reading<'_>) -> Result<Vec<f32>, SceneError> {
    let width = match property {
        Property::Translation | Property::Scale => 3,
        Property::Rotation => 4,
        Property::Weights => 1,
    };
    let mut elements = reading.open(index(output)?)?;
    let mut values = crate::Budget::vec_with_capacity(elements.count().saturating_mul(width), output.trail)?;
    let mut element = 0usize;
    while let Some(parts) = elements.numbers::<4>(0.0)? {
        for &part in parts.iter().take(width) {
            if !part.is_finite() {
                return Err(output.wrong(format!("{part} at element {element}"), "finite numbers"));
            }
            values.push(single(part));
        }
        element = element.saturating_add(1);
    }
    Ok(values)
}

/// Checks that rotations have a length: those of length 0 are undefined.
fn check_turns(track: &Track, output: &Spot<'_>) -> Result<(), SceneError> {
    let (step, first) = if track.interpolation == Interpolation::CubicSpline { (3, 1) } else { (1, 0) };
    let keys = track.values.chunks_exact(4).skip(first).step_by(step);
    match keys.enumerate().find(|(_, turn)| turn.iter().all(|&part| part == 0.0)) {
        Some((key, _)) => {
            Err(output.wrong(format!("a rotation of length 0 at key {key}"), "unit quaternions"))
        }
        None => Ok(()),
    }
}

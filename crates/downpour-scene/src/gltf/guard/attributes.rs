//! Attributes and indices of primitives: each semantic in a format that the specification gives it.
//!
//! Source: glTF 2.0, section 3.7.2.1, and the table of `KHR_mesh_quantization`.

use super::Facts;
use super::accessors::AccessorFacts;
use super::extensions::{QUANTIZATION, used};
use super::spot::Spot;
use crate::error::SceneError;
use gltf::json::accessor::ComponentType::{F32, I8, I16, U8, U16, U32};
use gltf::json::accessor::{ComponentType, Type};

/// Allowed formats of a semantic.
struct Formats {
    kinds: &'static [Type],
    /// Component types, and whether they are normalized.
    plain: &'static [(ComponentType, bool)],
    /// Those that quantization adds.
    quantized: &'static [(ComponentType, bool)],
    words: &'static str,
}

const FLOAT: (ComponentType, bool) = (F32, false);
const SMALL: [(ComponentType, bool); 2] = [(U8, false), (U16, false)];
const UNIT: [(ComponentType, bool); 3] = [FLOAT, (U8, true), (U16, true)];

const POSITION: Formats = Formats {
    kinds: &[Type::Vec3],
    plain: &[FLOAT],
    quantized: &[
        (I8, false),
        (I8, true),
        (U8, false),
        (U8, true),
        (I16, false),
        (I16, true),
        (U16, false),
        (U16, true),
    ],
    words: "VEC3 of 5126 (float), or of integers of 8 or 16 bits with KHR_mesh_quantization",
};
const DIRECTION: Formats = Formats {
    kinds: &[Type::Vec3],
    plain: &[FLOAT],
    quantized: &[(I8, true), (I16, true)],
    words: "VEC3 of 5126 (float), or of normalized 5120 or 5122 with KHR_mesh_quantization",
};
const TANGENT: Formats = Formats {
    kinds: &[Type::Vec4],
    plain: &[FLOAT],
    quantized: &[(I8, true), (I16, true)],
    words: "VEC4 of 5126 (float), or of normalized 5120 or 5122 with KHR_mesh_quantization",
};
const TEXCOORD: Formats = Formats {
    kinds: &[Type::Vec2],
    plain: &UNIT,
    quantized: &[(I8, false), (I8, true), (U8, false), (I16, false), (I16, true), (U16, false)],
    words: "VEC2 of 5126 (float), or of normalized 5121 or 5123",
};
const COLOR: Formats = Formats {
    kinds: &[Type::Vec3, Type::Vec4],
    plain: &UNIT,
    quantized: &[],
    words: "VEC3 or VEC4 of 5126 (float), or of normalized 5121 or 5123",
};
const JOINTS: Formats =
    Formats { kinds: &[Type::Vec4], plain: &SMALL, quantized: &[], words: "VEC4 of 5121 or 5123" };
const WEIGHTS: Formats = Formats {
    kinds: &[Type::Vec4],
    plain: &UNIT,
    quantized: &[],
    words: "VEC4 of 5126 (float), or of normalized 5121 or 5123",
};
const INDICES: Formats = Formats {
    kinds: &[Type::Scalar],
    plain: &[(U8, false), (U16, false), (U32, false)],
    quantized: &[],
    words: "SCALAR of 5121, 5123 or 5125 (unsigned integers)",
};

/// The formats of a vertex attribute, or of a morph target's; `None` for a name that the specification has not.
fn formats(semantic: &str, morph: bool) -> Option<&'static Formats> {
    Some(match semantic {
        "POSITION" => &POSITION,
        "NORMAL" => &DIRECTION,
        "TANGENT" if morph => &DIRECTION,
        "TANGENT" => &TANGENT,
        _ => match numbered(semantic)? {
            "TEXCOORD" => &TEXCOORD,
            "COLOR" => &COLOR,
            "JOINTS" if !morph => &JOINTS,
            "WEIGHTS" if !morph => &WEIGHTS,
            _ => return None,
        },
    })
}

/// The name before `_0`, `_1`, …
fn numbered(semantic: &str) -> Option<&str> {
    let (name, number) = semantic.split_once('_')?;
    let digits = !number.is_empty() && number.bytes().all(|b| b.is_ascii_digit());
    (digits && (number == "0" || !number.starts_with('0'))).then_some(name)
}

/// True if the specification has an attribute of this name.
pub(super) fn is_known(semantic: &str, morph: bool) -> bool {
    semantic.starts_with('_') || formats(semantic, morph).is_some()
}

/// Checks the formats and counts of all primitives.
pub(super) fn check(facts: &Facts<'_>) -> Result<(), SceneError> {
    let quantized = used(&facts.document, QUANTIZATION);
    facts.document.each(&["meshes", "[]", "primitives", "[]"], &mut |primitive| {
        primitive.each(&["mode"], &mut |mode| match mode.value.as_u64() {
            Some(0..=6) => Ok(()),
            _ => Err(mode.not("0 to 6")),
        })?;
        primitive
            .each(&["indices"], &mut |indices| fits(indices, accessor(facts, indices)?, &INDICES, false))?;
        let attributes = primitive.need("attributes")?;
        let vertices = match attributes.get("POSITION")? {
            Some(position) => Some(accessor(facts, &position)?.count),
            None => None,
        };
        semantics(facts, &attributes, vertices, quantized, false)?;
        primitive.each(&["targets", "[]"], &mut |target| semantics(facts, target, vertices, quantized, true))
    })
}

fn semantics(
    facts: &Facts<'_>,
    attributes: &Spot<'_>,
    vertices: Option<u64>,
    quantized: bool,
    morph: bool,
) -> Result<(), SceneError> {
    attributes.members()?.try_for_each(|(semantic, attribute)| {
        let accessor = accessor(facts, &attribute)?;
        if let Some(formats) = formats(semantic, morph) {
            fits(&attribute, accessor, formats, quantized)?;
        }
        match vertices {
            Some(vertices) if accessor.count != vertices => Err(attribute.wrong(
                format!("an accessor of {} elements", accessor.count),
                format!("{vertices}, as POSITION has"),
            )),
            _ => Ok(()),
        }
    })
}

fn accessor(facts: &Facts<'_>, link: &Spot<'_>) -> Result<AccessorFacts, SceneError> {
    let index = link.index_into("accessors", facts.accessors.len())?;
    facts.accessors.get(index).copied().ok_or_else(|| link.not("an accessor"))
}

fn fits(link: &Spot<'_>, found: AccessorFacts, formats: &Formats, quantized: bool) -> Result<(), SceneError> {
    // Some exporters flag floats as normalized, which has no meaning: the flag is read for integers only.
    let component = (found.component, found.normalized && found.component != F32);
    let known = formats.plain.contains(&component) || (quantized && formats.quantized.contains(&component));
    if known && formats.kinds.contains(&found.kind) {
        return Ok(());
    }
    let normalized = if component.1 { "normalized " } else { "" };
    let code = component.0.as_gl_enum();
    Err(link.wrong(format!("an accessor of {} of {normalized}{code}", kind_name(found.kind)), formats.words))
}

fn kind_name(kind: Type) -> &'static str {
    match kind {
        Type::Scalar => "SCALAR",
        Type::Vec2 => "VEC2",
        Type::Vec3 => "VEC3",
        Type::Vec4 => "VEC4",
        Type::Mat2 => "MAT2",
        Type::Mat3 => "MAT3",
        Type::Mat4 => "MAT4",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_of_attributes() {
        for name in
            ["POSITION", "NORMAL", "TANGENT", "TEXCOORD_0", "COLOR_12", "JOINTS_0", "WEIGHTS_1", "_HEAT"]
        {
            assert!(is_known(name, false), "{name}");
        }
        for name in ["position", "TEXCOORD", "TEXCOORD_00", "TEXCOORD_01", "COLOR_", "COLOR_1_1", "UNKNOWN_0"]
        {
            assert!(!is_known(name, false), "{name}");
        }
        assert!(!is_known("JOINTS_0", true));
    }
}

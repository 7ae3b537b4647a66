//! Each number of the document fits what it will be read as.
//!
//! JSON knows no kinds of number. The typed reader takes `1.0` for no index although the specification does,
//! and makes an infinity of 1e39 without a word. Here whole numbers become integers, and a number beyond the
//! range of `f32` is an error. `extras` may hold anything and are taken out, but for the `porosity` of a
//! material's and the `radius_m` of a lamp's, which are read.

use super::spot::{Trail, shown};
use crate::error::SceneError;
use serde_json::{Number, Value};

/// Members of extras that are read.
const READ: [&str; 2] = ["porosity", "radius_m"];

/// Whole numbers up to here are exact in `f64`: 2^53.
const EXACT: f64 = 9_007_199_254_740_992.0;

/// Makes integers of whole numbers and refuses what `f32` does not hold.
pub(super) fn settle(value: &mut Value) -> Result<(), SceneError> {
    settle_at(value, &Trail::DOCUMENT)
}

fn settle_at(value: &mut Value, trail: &Trail<'_>) -> Result<(), SceneError> {
    match value {
        Value::Number(number) => {
            let Some(float) = number.as_f64().filter(|_| number.is_f64()) else { return Ok(()) };
            if float.abs() > f64::from(f32::MAX) {
                let allowed = "numbers from -3.4e38 to 3.4e38, what a 32-bit float holds";
                return Err(SceneError::bad(
                    trail,
                    format!("{}, not finite as a 32-bit float", shown(value)),
                    allowed,
                ));
            }
            if let Some(whole) = whole(float) {
                *number = whole;
            }
            Ok(())
        }
        Value::Array(items) => {
            items.iter_mut().enumerate().try_for_each(|(index, item)| settle_at(item, &trail.index(index)))
        }
        // The parser has bounded the depth of this recursion.
        Value::Object(members) => {
            members.retain(|key, member| {
                // All else in extras means nothing to us.
                if key == "extras"
                    && let Value::Object(own) = member
                {
                    own.retain(|key, _| READ.contains(&key.as_str()));
                }
                key != "extras" || READ.iter().any(|read| member.get(read).is_some())
            });
            members.iter_mut().try_for_each(|(key, member)| settle_at(member, &trail.key(key)))
        }
        Value::Null | Value::Bool(_) | Value::String(_) => Ok(()),
    }
}

/// The integer that a float is, if it is one.
fn whole(float: f64) -> Option<Number> {
    if float.fract() != 0.0 || float.abs() > EXACT {
        return None;
    }
    #[expect(clippy::cast_possible_truncation, reason = "whole, and within 2^53")]
    let integer = float as i64;
    Some(match u64::try_from(integer) {
        Ok(positive) => positive.into(),
        Err(_) => integer.into(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whole_numbers_become_integers() {
        let mut value: Value = serde_json::from_str(r#"[1.0, 2e0, 30e-1, -4.0, 0.5, -0.0, 1e300]"#).unwrap();
        let error = settle(&mut value).unwrap_err();
        assert_eq!(error.fault().location, "[6]");
        value.as_array_mut().unwrap().pop();
        settle(&mut value).unwrap();
        assert_eq!(value.to_string(), "[1,2,3,-4,0.5,0]");
    }

    #[test]
    fn extras_are_taken_out() {
        let mut value: Value = serde_json::from_str(r#"{"extras": {"a": 1e300}, "b": 3.5e38}"#).unwrap();
        assert_eq!(settle(&mut value).unwrap_err().fault().location, "b");
        value["b"] = 3.4e38.into();
        settle(&mut value).unwrap();
        assert_eq!(value.to_string(), r#"{"b":3.4e+38}"#);
        let mut value: Value =
            serde_json::from_str(r#"{"extras": {"a": 1e300, "porosity": 0.5}, "b": {"extras": [1e300]}}"#)
                .unwrap();
        settle(&mut value).unwrap();
        assert_eq!(value.to_string(), r#"{"extras":{"porosity":0.5},"b":{}}"#);
    }
}

//! Values that may move: a number or a vector, or an array of keys `[time, value]`.

use crate::fault::Positions;
use crate::quantity::{ALLOWED, Exactly, In, KeyTimeS, Range};
use downpour_scene::error::SceneError;
use downpour_wind::timeline::Blend;
use downpour_wind::{Keyed, WindError};
use glam::DVec3;
use serde::de::{Deserialize, Deserializer, Error, SeqAccess, Visitor};
use std::fmt;
use std::marker::PhantomData;

/// A number, or keys of it.
#[derive(Debug)]
pub(crate) struct NumberKeys<R>(Moving<f64>, PhantomData<R>);

/// Three numbers, or keys of them.
#[derive(Debug)]
pub(crate) struct VectorKeys<R>(Moving<DVec3>, PhantomData<R>);

/// Keys as in the file, each value in its range; only their times are not checked yet.
#[derive(Debug)]
enum Moving<T> {
    Still(T),
    Keys(Vec<(f64, T)>),
}

impl<T: Blend> Moving<T> {
    fn keyed(&self, path: &str, positions: &Positions<'_>) -> Result<Keyed<T>, SceneError> {
        match self {
            Self::Still(value) => Ok((*value).into()),
            Self::Keys(keys) => keyed(keys.clone(), path, positions),
        }
    }
}

/// Keys with increasing times.
pub(super) fn keyed<T: Blend>(
    keys: Vec<(f64, T)>,
    path: &str,
    positions: &Positions<'_>,
) -> Result<Keyed<T>, SceneError> {
    Keyed::new(keys).map_err(|error| match error {
        WindError::KeyCount { found: 0, .. } => {
            positions.bad(path, "no keys", "a number, or [[time, value], ...]")
        }
        WindError::KeyCount { found, allowed } => {
            positions.limit(path, format!("{found} keys"), format!("at most {allowed}"))
        }
        WindError::KeyTime { index, found, before } => {
            let at = format!("{path}[{index}]");
            let found = format!("a key at {found} s, after one at {before} s");
            positions.bad(&at, found, "times that rise by a microsecond at least")
        }
        error => positions.bad(path, error.to_string(), "keys of finite numbers"),
    })
}

impl<R> NumberKeys<R> {
    /// The number over time.
    pub(crate) fn keyed(&self, path: &str, positions: &Positions<'_>) -> Result<Keyed<f64>, SceneError> {
        self.0.keyed(path, positions)
    }

    /// Keys as in the file; one at time 0 for a number.
    pub(crate) fn raw(&self) -> Vec<(f64, f64)> {
        match &self.0 {
            Moving::Still(value) => vec![(0.0, *value)],
            Moving::Keys(keys) => keys.clone(),
        }
    }
}

impl<R> VectorKeys<R> {
    /// The vector over time.
    pub(crate) fn keyed(&self, path: &str, positions: &Positions<'_>) -> Result<Keyed<DVec3>, SceneError> {
        self.0.keyed(path, positions)
    }
}

/// The number over time, or a constant default.
pub(crate) fn number_or<R>(
    given: Option<&NumberKeys<R>>,
    default: f64,
    path: &str,
    positions: &Positions<'_>,
) -> Result<Keyed<f64>, SceneError> {
    given.map_or_else(|| Ok(default.into()), |given| given.keyed(path, positions))
}

/// A number over time, if the file gives it.
pub(crate) type Given = Option<Keyed<f64>>;

/// The number over time, if it is given.
pub(crate) fn number_given<R>(
    given: Option<&NumberKeys<R>>,
    path: &str,
    positions: &Positions<'_>,
) -> Result<Given, SceneError> {
    given.map(|given| given.keyed(path, positions)).transpose()
}

/// Values over time that change.
pub(crate) fn moving<T: Blend>(keyed: Option<Keyed<T>>) -> Option<Keyed<T>> {
    keyed.filter(|keyed| keyed.keys().len() > 1)
}

/// The vector over time, or a constant default.
pub(crate) fn vector_or<R>(
    given: Option<&VectorKeys<R>>,
    default: DVec3,
    path: &str,
    positions: &Positions<'_>,
) -> Result<Keyed<DVec3>, SceneError> {
    given.map_or_else(|| Ok(default.into()), |given| given.keyed(path, positions))
}

/// `[time, value]`.
struct Key<T>(f64, T);

impl<'de, T: Deserialize<'de>> Deserialize<'de> for Key<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(KeyOf(PhantomData))
    }
}

struct KeyOf<T>(PhantomData<T>);

impl<'de, T: Deserialize<'de>> Visitor<'de> for KeyOf<T> {
    type Value = Key<T>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a key, [time in s, value]")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Key<T>, A::Error> {
        let wrong = |found| A::Error::custom(format_args!("{found}{ALLOWED}a key, [time in s, value]"));
        let time: In<KeyTimeS> = seq.next_element()?.ok_or_else(|| wrong("an empty key"))?;
        let value = seq.next_element()?.ok_or_else(|| wrong("a key without a value"))?;
        match seq.next_element::<serde::de::IgnoredAny>()? {
            None => Ok(Key(time.0, value)),
            Some(_) => Err(wrong("a key of more than two")),
        }
    }
}

impl<'de, R: Range> Deserialize<'de> for NumberKeys<R> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(NumberOrKeys::<R>(PhantomData)).map(|moving| Self(moving, PhantomData))
    }
}

struct NumberOrKeys<R>(PhantomData<R>);

impl<'de, R: Range> Visitor<'de> for NumberOrKeys<R> {
    type Value = Moving<f64>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a number, {}, or keys [[time in s, value], ...]", R::WORDS)
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Moving<f64>, E> {
        In::<R>::checked(value).map(|number| Moving::Still(number.0))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Moving<f64>, E> {
        self.visit_f64(value as f64)
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<Moving<f64>, E> {
        self.visit_f64(value as f64)
    }

    fn visit_i128<E: Error>(self, value: i128) -> Result<Moving<f64>, E> {
        self.visit_f64(value as f64)
    }

    fn visit_u128<E: Error>(self, value: u128) -> Result<Moving<f64>, E> {
        self.visit_f64(value as f64)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Moving<f64>, A::Error> {
        let mut keys = Vec::new();
        while let Some(Key(time, value)) = seq.next_element::<Key<In<R>>>()? {
            keys.push((time, value.0));
        }
        Ok(Moving::Keys(keys))
    }
}

impl<'de, R: Range> Deserialize<'de> for VectorKeys<R> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(VectorOrKeys::<R>(PhantomData)).map(|moving| Self(moving, PhantomData))
    }
}

/// A component of a vector, or a key of one.
enum Element<R> {
    Component(f64),
    Key(f64, DVec3, PhantomData<R>),
}

impl<'de, R: Range> Deserialize<'de> for Element<R> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(ComponentOrKey(PhantomData))
    }
}

struct ComponentOrKey<R>(PhantomData<R>);

impl<'de, R: Range> Visitor<'de> for ComponentOrKey<R> {
    type Value = Element<R>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a number, {}, or a key, [time in s, [x, y, z]]", R::WORDS)
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<Element<R>, E> {
        In::<R>::checked(value).map(|number| Element::Component(number.0))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<Element<R>, E> {
        self.visit_f64(value as f64)
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<Element<R>, E> {
        self.visit_f64(value as f64)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<Element<R>, A::Error> {
        let Key(time, vector) = KeyOf::<Exactly<In<R>, 3>>(PhantomData).visit_seq(seq)?;
        Ok(Element::Key(time, vector.numbers().into(), PhantomData))
    }
}

struct VectorOrKeys<R>(PhantomData<R>);

impl<'de, R: Range> Visitor<'de> for VectorOrKeys<R> {
    type Value = Moving<DVec3>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "three numbers, {}, or keys [[time in s, [x, y, z]], ...]", R::WORDS)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Moving<DVec3>, A::Error> {
        let (mut components, mut keys) = (Vec::new(), Vec::new());
        while let Some(element) = seq.next_element::<Element<R>>()? {
            match element {
                Element::Component(value) => components.push(value),
                Element::Key(time, vector, _) => keys.push((time, vector)),
            }
        }
        let wrong = |found: String| A::Error::custom(format_args!("{found}{ALLOWED}3 numbers, or keys"));
        match (<[f64; 3]>::try_from(components), keys.is_empty()) {
            (Ok(vector), true) => Ok(Moving::Still(vector.into())),
            (Err(components), true) => Err(wrong(format!("{} numbers", components.len()))),
            (Err(components), false) if components.is_empty() => Ok(Moving::Keys(keys)),
            _ => Err(wrong("numbers among keys".to_owned())),
        }
    }
}

//! Numbers that are checked as they are read: finite and in range.

use serde::de::{Deserialize, Deserializer, Error, SeqAccess, Visitor};
use std::fmt;
use std::marker::PhantomData;

/// Separator between the value found and the values allowed, in errors that pass through serde.
pub(super) const ALLOWED: &str = "; allowed: ";

/// A range of numbers.
pub(super) trait Range {
    const LOW: f64;
    const HIGH: f64;
    /// True if 0 is allowed although it is below `LOW`.
    const OR_ZERO: bool = false;
    /// Range as text, for messages.
    const WORDS: &'static str;
}

macro_rules! ranges {
    ($($name:ident: $low:expr, $high:expr, $words:expr $(, $zero:ident)?;)*) => {$(
        #[derive(Clone, Copy, Debug)]
        pub(super) struct $name;
        impl Range for $name {
            const LOW: f64 = $low;
            const HIGH: f64 = $high;
            $(const OR_ZERO: bool = stringify!($zero).len() > 0;)?
            const WORDS: &'static str = $words;
        }
    )*};
}

ranges! {
    RateMmH: 1e-3, 500.0, "0, or 0.001 to 500 mm/h", or_zero;
    RateHeightM: -1e4, 1e5, "-1e4 to 1e5 m";
    GammaShape: -3.0, 8.0, "-3 to 8";
    MedianMm: 0.2, 5.0, "0.2 to 5 mm";
    TemperatureC: -20.0, 40.0, "-20 to 40 Celsius";
    PressureHpa: 300.0, 1100.0, "300 to 1100 hPa";
    OneMm: 0.2, 7.5, "0.2 to 7.5 mm";
    BoxM: 1.0, 1000.0, "1 to 1000 m";
    RadiusM: 0.5, 1000.0, "0.5 to 1000 m";
    PuddleM: 0.1, 1000.0, "0.1 to 1000 m";
    PuddleReachM: 0.01, 100.0, "0.01 to 100 m";
    PuddleDepthMm: 0.1, 10_000.0, "0.1 to 10000 mm";
    ReliefMm: 0.0, 100.0, "0 to 100 mm";
    FieldCellMm: 2.0, 1000.0, "2 to 1000 mm";
    RippleScale: 0.1, 10.0, "0.1 to 10";
    Influence: 0.0, 10.0, "0 to 10";
    AttenuationM: 0.001, 1000.0, "0.001 to 1000 m";
    Fraction: 0.0, 1.0, "0 to 1";
    Fill: 0.0, 1.0, "\"rain\", or 0 to 1";
    VisibilityM: 1.0, 1e6, "1 to 1e6 m";
    ExtinctionPerM: 1e-6, 10.0, "1e-6 to 10 per m";
    FogHeightM: 0.1, 1e5, "0.1 to 1e5 m";
    FogAsymmetry: 0.0, 0.95, "0 to 0.95";
    GlowWidth: 0.1, 10.0, "0.1 to 10";
    WaveMS: 0.05, 2.0, "0.05 to 2 m/s";
    Parallax: 1.1, 50.0, "1.1 to 50";
    Visibility: 0.0, 20.0, "0 to 20";
    StreakLength: 0.0, 20.0, "0 to 20";
    DropSize: 0.05, 1.0, "0.05 to 1";
    ShortS: 0.01, 10.0, "0.01 to 10 s";
    Brightness: 0.0, 1e9, "0 to 1e9";
    Tint: 0.0, 1.0, "0 to 1";
    TurnDeg: -360.0, 360.0, "-360 to 360 degrees";
    ElevationDeg: -90.0, 90.0, "-90 to 90 degrees";
    PitchDeg: -89.9, 89.9, "-89.9 to 89.9 degrees";
    Stops: -30.0, 30.0, "-30 to 30 stops";
    Lux: 0.0, 1e9, "0 to 1e9 lux";
    Candela: 0.0, 1e9, "0 to 1e9 cd";
    DiskDeg: 0.0, 20.0, "0 to 20 degrees";
    PositionM: -1e7, 1e7, "-1e7 to 1e7 m";
    FovDeg: 1.0, 170.0, "1 to 170 degrees";
    DepthM: 1e-4, 1e7, "1e-4 to 1e7 m";
    ShutterS: 0.0, 1.0, "0 to 1 s";
    PersistenceS: 0.06, 0.09, "0.06 to 0.09 s";
    ApertureMm: 0.0, 500.0, "0 to 500 mm";
    FocusM: 0.01, 1e7, "0.01 to 1e7 m";
    Amplitude: 0.0, 0.3, "0 to 0.3";
    Scale: 1e-6, 1e6, "1e-6 to 1e6";
    AnimationSpeed: -1000.0, 1000.0, "-1000 to 1000";
    Part: -1e9, 1e9, "-1e9 to 1e9";
    ConeDeg: 0.0, 89.9, "0 to 89.9 degrees";
    SeepageMmH: 0.0, 1000.0, "0 to 1000 mm/h";
    LampM: 0.0, 100.0, "0 to 100 m";
    RangeM: 1e-3, 1e7, "0.001 to 1e7 m";
    KeyTimeS: -1e6, 1e6, "-1e6 to 1e6 s";
    WindMS: 0.0, 200.0, "0 to 200 m/s";
    Outflow: 0.0, 1e6, "0 to 1e6";
    Turning: -1e6, 1e6, "-1e6 to 1e6";
    WindPositionM: -1e6, 1e6, "-1e6 to 1e6 m";
    CoreM: 0.01, 1e4, "0.01 to 1e4 m";
    HeightM: 0.02, 1e5, "0.02 to 1e5 m";
    Intensity: 0.0, 1.0, "0 to 1";
    GustM: 1.0, 1e4, "1 to 1e4 m";
    EddyMS: 0.0, 50.0, "0 to 50 m/s";
    EddyM: 0.1, 1e4, "0.1 to 1e4 m";
    WindBoxM: 0.01, 1e6, "0.01 to 1e6 m";
    ReachM: 0.02, 10.0, "0.02 to 10 m";
    PaneTiltDeg: 10.0, 90.0, "10 to 90 degrees";
    PaneM: 0.01, 10.0, "0.01 to 10 m";
    SheetM: 0.02, 100.0, "0.02 to 100 m";
    SheetHeightM: 0.1, 100.0, "0.1 to 100 m";
    SheetDropMm: 0.5, 10.0, "0.5 to 10 mm";
    AboveM: 0.0, 1.0, "0 to 1 m";
    CellMm: 0.25, 5.0, "0.25 to 5 mm";
    PaneMS: 0.0, 100.0, "0 to 100 m/s";
    BeforeS: 0.0, 3600.0, "0 to 3600 s";
    PaneApertureMm: 0.0, 100.0, "0 to 100 mm";
    AdvancingDeg: 5.0, 120.0, "5 to 120 degrees";
    RecedingDeg: 0.0, 120.0, "0 to 120 degrees";
    HighlightMm: 0.0, 10.0, "0 to 10 mm";
    FilmUm: 0.0, 200.0, "0 to 200 um";
    BladeFilmUm: 0.0, 20.0, "0 to 20 um";
    Pull: 0.0, 4.0, "0 to 4";
    GlassWetS: 0.1, 3600.0, "0.1 to 3600 s";
    TrailMm: 0.1, 1000.0, "0.1 to 1000 mm";
    BeadMm: 0.0, 2.0, "0 to 2 mm";
    DryingMmH: 0.0, 100.0, "0 to 100 mm/h";
    PivotM: -20.0, 20.0, "-20 to 20 m";
    BladeM: 0.0, 20.0, "0 to 20 m";
    WetS: 0.0, 1e6, "0 to 1e6 s";
    RainedMm: 0.0, 1000.0, "0 to 1000 mm";
    StorageMm: 0.01, 10.0, "0.01 to 10 mm";
    FilmMm: 0.05, 10.0, "0.05 to 10 mm";
    SplashSize: 0.1, 10.0, "0.1 to 10";
    SprayM: 0.005, 1.0, "0.005 to 1 m";
    SprayDropletMm: 0.05, 1.0, "0.05 to 1 mm";
    DryingS: 1.0, 1e7, "1 to 1e7 s";
    ReflectionEdge: 0.0, 10.0, "0 to 10";
    DripsPerS: 0.001, 1000.0, "0.001 to 1000 drops per second";
    DripMm: 0.5, 6.4, "0.5 to 6.4 mm";
    PeriodS: 0.1, 1e6, "0.1 to 1e6 s";
    RiseMs: 0.0, 100.0, "0 to 100 ms";
    FlashMs: 0.1, 1000.0, "0.1 to 1000 ms";
    StrokeKey: 0.0, 10_000.0, "0 to 10000 ms, and a factor of 0 to 1";
    FlashesPerMinute: 0.0, 600.0, "0 to 600 flashes per minute";
    FlashM: 100.0, 1e5, "100 to 1e5 m";
    Clouds: 0.0, 10.0, "0 to 10";
}

/// A number within a range.
#[derive(Debug)]
pub(super) struct In<R>(pub(super) f64, PhantomData<R>);

impl<R> Clone for In<R> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<R> Copy for In<R> {}

impl<R: Range> In<R> {
    pub(super) fn checked<E: Error>(value: f64) -> Result<Self, E> {
        if (R::LOW..=R::HIGH).contains(&value) || (R::OR_ZERO && value == 0.0) {
            // Zero has no sign.
            return Ok(Self(value + 0.0, PhantomData));
        }
        Err(E::custom(format_args!("{}{ALLOWED}{}", shown(value), R::WORDS)))
    }
}

/// Number formatted close to the text of the file.
fn shown(value: f64) -> String {
    if value.fract() == 0.0 && value.abs() < 1e15 { format!("{value:.0}") } else { format!("{value:?}") }
}

impl<'de, R: Range> Deserialize<'de> for In<R> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Number(PhantomData))
    }
}

struct Number<R>(PhantomData<R>);

impl<'de, R: Range> Visitor<'de> for Number<R> {
    type Value = In<R>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a number, {}", R::WORDS)
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<In<R>, E> {
        In::checked(value)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, _: A) -> Result<In<R>, A::Error> {
        Err(A::Error::custom(format_args!(
            "an array: this key has no keyframes{ALLOWED}a number, {}",
            R::WORDS
        )))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<In<R>, E> {
        In::checked(value as f64)
    }

    fn visit_u64<E: Error>(self, value: u64) -> Result<In<R>, E> {
        In::checked(value as f64)
    }

    fn visit_i128<E: Error>(self, value: i128) -> Result<In<R>, E> {
        In::checked(value as f64)
    }

    fn visit_u128<E: Error>(self, value: u128) -> Result<In<R>, E> {
        In::checked(value as f64)
    }
}

/// Exactly `N` values in an array.
#[derive(Clone, Copy, Debug)]
pub(super) struct Exactly<T, const N: usize>(pub(super) [T; N]);

impl<R, const N: usize> Exactly<In<R>, N> {
    /// The plain numbers.
    pub(super) fn numbers(self) -> [f64; N] {
        self.0.map(|In(value, _)| value)
    }
}

impl<'de, T: Deserialize<'de>, const N: usize> Deserialize<'de> for Exactly<T, N> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(Row::<T, N>(PhantomData))
    }
}

struct Row<T, const N: usize>(PhantomData<T>);

impl<'de, T: Deserialize<'de>, const N: usize> Visitor<'de> for Row<T, N> {
    type Value = Exactly<T, N>;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "an array of {N} numbers")
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut seq: A) -> Result<Exactly<T, N>, A::Error> {
        let mut values = Vec::with_capacity(N);
        while let Some(value) = seq.next_element()? {
            if values.len() == N {
                return Err(A::Error::custom(format_args!("more than {N} numbers{ALLOWED}{N} numbers")));
            }
            values.push(value);
        }
        <[T; N]>::try_from(values).map(Exactly).map_err(|values: Vec<T>| {
            A::Error::custom(format_args!("{} numbers{ALLOWED}{N} numbers", values.len()))
        })
    }
}

/// One scale, or one for each axis.
#[derive(Clone, Copy, Debug)]
pub(super) struct ScaleXyz(pub(super) [f64; 3]);

impl<'de> Deserialize<'de> for ScaleXyz {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_any(OneOrThree)
    }
}

struct OneOrThree;

impl<'de> Visitor<'de> for OneOrThree {
    type Value = ScaleXyz;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "a number or three, {}", Scale::WORDS)
    }

    fn visit_f64<E: Error>(self, value: f64) -> Result<ScaleXyz, E> {
        In::<Scale>::checked(value).map(|In(value, _)| ScaleXyz([value; 3]))
    }

    fn visit_i64<E: Error>(self, value: i64) -> Result<ScaleXyz, E> {
        self.visit_f64(value as f64)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, seq: A) -> Result<ScaleXyz, A::Error> {
        Row::<In<Scale>, 3>(PhantomData).visit_seq(seq).map(|row| ScaleXyz(row.numbers()))
    }
}

/// An integer from `LOW` to `HIGH`.
#[derive(Clone, Copy, Debug)]
pub(super) struct Whole<const LOW: u32, const HIGH: u32>(pub(super) u32);

impl<'de, const LOW: u32, const HIGH: u32> Deserialize<'de> for Whole<LOW, HIGH> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Count<const LOW: u32, const HIGH: u32>;
        impl<const LOW: u32, const HIGH: u32> Visitor<'_> for Count<LOW, HIGH> {
            type Value = u32;

            fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                write!(f, "a whole number, {LOW} to {HIGH}")
            }

            fn visit_i64<E: Error>(self, value: i64) -> Result<u32, E> {
                let fits = u32::try_from(value).ok().filter(|value| (LOW..=HIGH).contains(value));
                fits.ok_or_else(|| E::custom(format_args!("{value}{ALLOWED}{LOW} to {HIGH}")))
            }

            fn visit_u64<E: Error>(self, value: u64) -> Result<u32, E> {
                Err(E::custom(format_args!("{value}{ALLOWED}{LOW} to {HIGH}")))
            }
        }
        deserializer.deserialize_any(Count::<LOW, HIGH>).map(Self)
    }
}

//! `[rain]`.

use super::fault::Positions;
use super::file::path;
use super::layers::{LayersForm, LayersTable, RainLayers};
use super::quantity::{
    BoxM, DropSize, Exactly, Fraction, GammaShape, In, MedianMm, OneMm, PositionM, PressureHpa, RadiusM,
    RateHeightM, RateMmH, ShortS, TemperatureC, Whole,
};
use super::streaks::Streaks;
use super::wind::keys::{NumberKeys, number_or};
use downpour_drop::DropError;
use downpour_drop::air::Air;
use downpour_drop::distribution::{DistributionOptions, DropSizeDistribution, DropSizeLaw};
use downpour_drop::fall_speed::FallSpeedModel;
use downpour_drop::shape::ShapeTable;
use downpour_scene::error::SceneError;
use downpour_scene::uri::RelativePath;
use downpour_wind::Keyed;
use serde::Deserialize;

/// Default shape of the gamma law.
const GAMMA_SHAPE: f64 = 3.0;

/// Rain rate below which drop sizes no longer vary, in mm/h.
const MIN_SHAPE_MM_H: f64 = downpour_drop::distribution::MIN_SHAPE_RATE_MM_H;

/// Range of diameters of drops of one size, relative to the diameter and at least in m.
const ONE_FRACTION: f64 = 1.0e-3;
const ONE_MIN_M: f64 = 1.0e-6;

/// Maximum rain rate, mm/h.
const MAX_MM_H: f64 = 500.0;

/// Default side of a box of rain, m.
pub const RAIN_BOX_M: f64 = 10.0;

/// Default maximum number of simulated drops.
const MAX_DROPS: u32 = 2_000_000;

/// Volume in which drops are simulated, and method.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum RainVolume {
    /// In closed form if the wind is uniform, else in view.
    #[default]
    Auto,
    /// In closed form: the same drops for every camera and every time.
    ClosedForm,
    /// Step by step in the view volume.
    View,
    /// Step by step in a box that follows the eye (Rousseau 2006).
    Box,
    /// The rain area of Im & Sung 2022 with their sampling.
    #[serde(rename = "im-sung-2022")]
    ImSung2022,
    /// A box with drops falling into it, after Tariq 2007.
    #[serde(rename = "tariq-2007")]
    Tariq2007,
    /// A cylinder fixed in the world, after Creus and Patow 2013.
    #[serde(rename = "creus-patow-2013")]
    CreusPatow2013,
}

/// Names of the laws of terminal speed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
enum FallSpeed {
    #[serde(rename = "beard-1976")]
    Beard1976,
    #[serde(rename = "gunn-kinzer-1949")]
    GunnKinzer1949,
    #[serde(rename = "rousseau-2006")]
    Rousseau2006,
    #[serde(rename = "atlas-1973")]
    Atlas1973,
    #[serde(rename = "atlas-ulbrich-1977")]
    AtlasUlbrich1977,
    #[serde(rename = "brandes-2002")]
    Brandes2002,
    #[serde(rename = "van-dijk-2002")]
    VanDijk2002,
    #[serde(rename = "lhermitte-1988")]
    Lhermitte1988,
}

impl From<FallSpeed> for FallSpeedModel {
    fn from(law: FallSpeed) -> Self {
        match law {
            FallSpeed::Beard1976 => Self::Beard1976,
            FallSpeed::GunnKinzer1949 => Self::GunnKinzer1949,
            FallSpeed::Rousseau2006 => Self::Rousseau2006,
            FallSpeed::Atlas1973 => Self::Atlas1973,
            FallSpeed::AtlasUlbrich1977 => Self::AtlasUlbrich1977,
            FallSpeed::Brandes2002 => Self::Brandes2002,
            FallSpeed::VanDijk2002 => Self::VanDijk2002,
            FallSpeed::Lhermitte1988 => Self::Lhermitte1988,
        }
    }
}

/// Shapes of the drops in masks and streaks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum RainDropShape {
    /// The model of Beard & Chuang 1987, by the table of Chuang & Beard 1990.
    #[default]
    BeardChuang,
    /// The four rows of Rousseau 2006, table 1, as printed.
    #[serde(rename = "rousseau-2006")]
    Rousseau2006,
}

impl RainDropShape {
    /// Name in weather files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::BeardChuang => "beard-chuang",
            Self::Rousseau2006 => "rousseau-2006",
        }
    }

    /// Coefficients of the shapes.
    #[must_use]
    pub fn table(self) -> ShapeTable {
        match self {
            Self::BeardChuang => ShapeTable::ChuangBeard1990,
            Self::Rousseau2006 => ShapeTable::Rousseau2006,
        }
    }
}

/// Lookup of the color of a drop's pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum RainRefraction {
    /// By the direction of the refracted light, in an environment map around the eye.
    #[default]
    Direction,
    /// By a shift in a perspective picture of 165 degrees and 512 x 512 texels (Rousseau 2006, 4.2.3).
    #[serde(rename = "rousseau-2006")]
    Rousseau2006,
}

/// Model of the drops' motion in the wind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum RainDrag {
    /// Relaxation by drag.
    #[default]
    Relaxation,
    /// Averages, once a step.
    #[serde(rename = "rousseau-2008")]
    Rousseau2008,
}

/// Light of lamps and sun on drops.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum RainDropLight {
    /// Geometric optics: a sphere's rays of orders 0 to 3, bows included.
    #[default]
    Traced,
    /// The formula of Rousseau 2006, section 6.
    #[serde(rename = "rousseau-2006")]
    Rousseau2006,
    /// Its term of external reflection alone: `A_1 A_2` of the paper.
    #[serde(rename = "rousseau-2006-external")]
    Rousseau2006External,
    /// Its term of internal reflection alone: `A_1 A_3` of the paper.
    #[serde(rename = "rousseau-2006-internal")]
    Rousseau2006Internal,
    /// Spots only: the cone of Im & Sung 2022, section III.C.
    #[serde(rename = "im-sung-2022")]
    ImSung2022,
    /// None: drops show the scene behind and around them only.
    None,
}

/// Extinction by a drop of the light behind it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum RainExtinction {
    /// The area of its outline: a camera keeps diffracted light.
    #[default]
    Camera,
    /// Twice that area: diffracted light is lost as well.
    Total,
}

/// Look of the drops that are not drawn one by one.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
#[non_exhaustive]
pub enum RainUnresolved {
    /// Streaks by chance, with the mean and the variance of these drops.
    #[default]
    Streaks,
    /// Their mean everywhere.
    Even,
}

/// Bounce of drops off surfaces, in step-by-step simulation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RainBounce {
    /// Fraction of impacts that eject a droplet, 0 to 1.
    pub fraction: f64,
    /// Fraction of the normal speed after the bounce, 0 to 1.
    pub restitution: f64,
    /// Fraction of the tangential speed that is lost, 0 to 1.
    pub grip: f64,
    /// Ratio of the diameters of droplet and drop, 0.05 to 1.
    pub size: f64,
    /// Maximum time of flight of a droplet, s, 0.01 to 10.
    pub max_time_s: f64,
}

impl Default for RainBounce {
    /// A droplet of a quarter of the drop's diameter after a tenth of the impacts.
    fn default() -> Self {
        Self { fraction: 0.1, restitution: 0.25, grip: 0.7, size: 0.25, max_time_s: 1.0 }
    }
}

/// An upright cylinder.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RainCylinder {
    /// Center of the base, m; `None`: below the eye of the first picture, by half the height.
    pub base_m: Option<[f64; 3]>,
    /// Radius, 0.5 to 1000 m.
    pub radius_m: f64,
    /// Height, 1 to 1000 m.
    pub height_m: f64,
}

impl Default for RainCylinder {
    fn default() -> Self {
        Self { base_m: None, radius_m: 12.0, height_m: 12.0 }
    }
}

/// Rain of a weather.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rain {
    /// Rain rate in mm/h: 0 (dry), or 0.001 to 500. Keys give it over time ([`WeatherKeys::rate`](crate::WeatherKeys::rate)).
    pub rate_mm_h: f64,
    /// Height, m, at which a rate that changes is that of its time; elsewhere it is that of the time at which drops pass this height.
    pub rate_height_m: f64,
    /// Law of the drop sizes.
    pub law: DropSizeLaw,
    /// Same seed, same drops.
    pub seed: u64,
    /// Temperature and pressure of the air.
    pub air: Air,
    /// Law of terminal speed.
    pub fall_speed: FallSpeedModel,
    /// Shapes of the drops.
    pub drop_shape: RainDropShape,
    /// Lookup of the color of a drop's pixel.
    pub refraction: RainRefraction,
    /// Diameter of all drops, m, 0.2e-3 to 7.5e-3, if they are of one size.
    pub one_diameter: Option<f64>,
    /// Volume in which drops are simulated, and method.
    pub volume: RainVolume,
    /// Side of a box of rain, in meters, 1 to 1000; `None` leaves it to the renderer.
    pub box_m: Option<f64>,
    /// Cylinder of rain.
    pub cylinder: RainCylinder,
    /// Maximum number of simulated drops.
    pub max_drops: u32,
    /// Model of the drops' motion in the wind.
    pub drag: RainDrag,
    /// Bounce of drops off surfaces.
    pub bounce: RainBounce,
    /// Light of lamps and sun on drops.
    pub drop_light: RainDropLight,
    /// Extinction by a drop of the light behind it.
    pub extinction: RainExtinction,
    /// Look of the drops that are not drawn one by one.
    pub unresolved: RainUnresolved,
    /// Layers of a texture in place of drops.
    pub layers: Option<RainLayers>,
}

impl Default for Rain {
    /// 10 mm/h by Marshall & Palmer's law in standard air, seed 0.
    fn default() -> Self {
        Self {
            rate_mm_h: 10.0,
            rate_height_m: 0.0,
            law: DropSizeLaw::default(),
            seed: 0,
            air: Air::standard(),
            fall_speed: FallSpeedModel::default(),
            drop_shape: RainDropShape::default(),
            refraction: RainRefraction::default(),
            one_diameter: None,
            volume: RainVolume::default(),
            box_m: None,
            cylinder: RainCylinder::default(),
            max_drops: MAX_DROPS,
            drag: RainDrag::default(),
            bounce: RainBounce::default(),
            drop_light: RainDropLight::default(),
            extinction: RainExtinction::default(),
            unresolved: RainUnresolved::default(),
            layers: None,
        }
    }
}

#[derive(Debug, Default, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub(super) struct RainTable {
    rate_mm_h: Option<NumberKeys<RateMmH>>,
    rate_height_m: Option<In<RateHeightM>>,
    distribution: Option<Distribution>,
    gamma_shape: Option<In<GammaShape>>,
    median_diameter_mm: Option<In<MedianMm>>,
    seed: Option<u64>,
    temperature_c: Option<In<TemperatureC>>,
    pressure_hpa: Option<In<PressureHpa>>,
    fall_speed: Option<FallSpeed>,
    drop_shape: Option<RainDropShape>,
    pub(super) mask_model: Option<String>,
    refraction: Option<RainRefraction>,
    drops: Option<DropsTable>,
    volume: Option<RainVolume>,
    box_m: Option<In<BoxM>>,
    cylinder: Option<CylinderTable>,
    max_drops: Option<Whole<1, { 1 << 30 }>>,
    drag: Option<RainDrag>,
    bounce: Option<BounceTable>,
    drop_light: Option<RainDropLight>,
    extinction: Option<RainExtinction>,
    unresolved: Option<RainUnresolved>,
    layers: Option<LayersForm>,
}

/// A number of drops of one size.
#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
struct DropsTable {
    count: Whole<1, { 1 << 30 }>,
    diameter_mm: In<OneMm>,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
struct CylinderTable {
    base_m: Option<Exactly<In<PositionM>, 3>>,
    radius_m: Option<In<RadiusM>>,
    height_m: Option<In<BoxM>>,
}

#[derive(Clone, Copy, Debug, Deserialize)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
struct BounceTable {
    fraction: Option<In<Fraction>>,
    restitution: Option<In<Fraction>>,
    grip: Option<In<Fraction>>,
    size: Option<In<DropSize>>,
    max_time_s: Option<In<ShortS>>,
}

impl BounceTable {
    fn checked(&self) -> RainBounce {
        let usual = RainBounce::default();
        RainBounce {
            fraction: self.fraction.map_or(usual.fraction, |x| x.0),
            restitution: self.restitution.map_or(usual.restitution, |x| x.0),
            grip: self.grip.map_or(usual.grip, |x| x.0),
            size: self.size.map_or(usual.size, |x| x.0),
            max_time_s: self.max_time_s.map_or(usual.max_time_s, |x| x.0),
        }
    }
}

impl CylinderTable {
    fn checked(&self) -> RainCylinder {
        let usual = RainCylinder::default();
        RainCylinder {
            base_m: self.base_m.map(Exactly::numbers),
            radius_m: self.radius_m.map_or(usual.radius_m, |x| x.0),
            height_m: self.height_m.map_or(usual.height_m, |x| x.0),
        }
    }
}

#[derive(Clone, Copy, Debug, Deserialize, PartialEq, Eq)]
#[cfg_attr(feature = "schema", derive(schemars::JsonSchema))]
#[serde(rename_all = "kebab-case")]
enum Distribution {
    MarshallPalmer,
    Best,
    Gamma,
    #[serde(alias = "lognormal")]
    FeingoldLevin,
    JossDrizzle,
    JossWidespread,
    JossThunderstorm,
}

impl Rain {
    /// Diameters and fall speeds of the drops.
    #[must_use]
    pub fn options(&self) -> DistributionOptions {
        let usual = DistributionOptions { fall_speed: self.fall_speed, air: self.air, ..Default::default() };
        match self.one_diameter {
            None => usual,
            Some(diameter) => {
                let half = (diameter * ONE_FRACTION).max(ONE_MIN_M);
                DistributionOptions {
                    min_diameter_m: diameter - half,
                    max_diameter_m: diameter + half,
                    ..usual
                }
            }
        }
    }

    /// Drop size distribution.
    ///
    /// # Errors
    /// [`DropError`] for an invalid rain.
    pub fn sizes(&self) -> Result<DropSizeDistribution, DropError> {
        DropSizeDistribution::with_options(self.law, self.rate_mm_h, &self.options())
    }

    /// The rain at time 0, and its rate over time if that changes.
    pub(super) fn checked(
        table: &RainTable,
        layers: &LayersTable,
        positions: &Positions<'_>,
    ) -> Result<(Self, Option<Keyed<f64>>), SceneError> {
        let default = Self::default();
        let rates = number_or(table.rate_mm_h.as_ref(), default.rate_mm_h, "rain.rate_mm_h", positions)?;
        let (rate_mm_h, most_mm_h) = (rates.at(0.0), most(&rates));
        let rates = Some(rates).filter(|rates| rates.keys().len() > 1);
        if rates.is_none() && table.rate_height_m.is_some() {
            let found = "the height of a rate that does not change";
            return Err(positions.bad("rain.rate_height_m", found, "with keys of rain.rate_mm_h"));
        }
        let temperature_c = table.temperature_c.map_or(default.air.temperature_c(), |t| t.0);
        let pressure_pa = table.pressure_hpa.map_or(default.air.pressure_pa(), |p| p.0 * 100.0);
        let air = Air::new(temperature_c, pressure_pa);
        let air =
            air.map_err(|error| positions.bad("rain", error.to_string(), "the air of the laws of fall"))?;
        let law = match table.distribution {
            None => default.law,
            Some(Distribution::MarshallPalmer) => DropSizeLaw::MarshallPalmer1948,
            Some(Distribution::Best) => DropSizeLaw::Best1950,
            Some(Distribution::Gamma) => table.gamma(most_mm_h, positions)?,
            Some(Distribution::FeingoldLevin) => DropSizeLaw::FeingoldLevin1986,
            Some(Distribution::JossDrizzle) => DropSizeLaw::Joss1968Drizzle,
            Some(Distribution::JossWidespread) => DropSizeLaw::Joss1968Widespread,
            Some(Distribution::JossThunderstorm) => DropSizeLaw::Joss1968Thunderstorm,
        };
        if table.distribution != Some(Distribution::Gamma) {
            for (key, given) in [
                ("rain.gamma_shape", table.gamma_shape.is_some()),
                ("rain.median_diameter_mm", table.median_diameter_mm.is_some()),
            ] {
                if given {
                    let found = format!("a parameter of the gamma law, with {}", law.name());
                    return Err(positions.bad(key, found, "distribution = \"gamma\""));
                }
            }
        }
        // Drops with a count are in a box.
        let usual = if table.drops.is_some() { RainVolume::Box } else { RainVolume::default() };
        let volume = table.volume.unwrap_or(usual);
        let steps = !matches!(volume, RainVolume::Auto | RainVolume::ClosedForm);
        if rates.is_some() && table.drops.is_none() && steps {
            let found = "keys of a rain that goes step by step";
            return Err(positions.bad("rain.rate_mm_h", found, "a number, or volume = \"closed-form\""));
        }
        let boxed = matches!(volume, RainVolume::Box | RainVolume::Tariq2007);
        for (key, given, of, allowed) in [
            ("rain.box_m", table.box_m.is_some(), boxed, "volume = \"box\" or \"tariq-2007\""),
            (
                "rain.cylinder",
                table.cylinder.is_some(),
                volume == RainVolume::CreusPatow2013,
                "volume = \"creus-patow-2013\"",
            ),
        ] {
            if given && !of {
                return Err(positions.bad(key, "a part of another volume", allowed));
            }
        }
        let rain = Self {
            rate_mm_h,
            rate_height_m: table.rate_height_m.map_or(default.rate_height_m, |height| height.0),
            law,
            seed: table.seed.unwrap_or(default.seed),
            air,
            fall_speed: table.fall_speed.map_or(default.fall_speed, FallSpeedModel::from),
            drop_shape: table.drop_shape.unwrap_or_default(),
            refraction: table.refraction.unwrap_or_default(),
            one_diameter: table.drops.map(|drops| drops.diameter_mm.0 * 1.0e-3),
            volume,
            box_m: table.box_m.map(|side| side.0),
            cylinder: table.cylinder.map_or(default.cylinder, |cylinder| cylinder.checked()),
            max_drops: table.max_drops.map_or(default.max_drops, |Whole(drops)| drops),
            drag: table.drag.unwrap_or_default(),
            bounce: table.bounce.map_or(default.bounce, |bounce| bounce.checked()),
            drop_light: table.drop_light.unwrap_or_default(),
            extinction: table.extinction.unwrap_or_default(),
            unresolved: table.unresolved.unwrap_or_default(),
            layers: layers.checked(table.layers, (volume, table.unresolved), positions)?,
        };
        match table.drops {
            None => Ok((rain, rates)),
            Some(drops) => Ok((rain.counted(table, drops.count.0, positions)?, None)),
        }
    }

    /// The rain with the rate at which, on average, `count` drops of its one size are in its volume.
    fn counted(self, table: &RainTable, count: u32, positions: &Positions<'_>) -> Result<Self, SceneError> {
        let allowed = "one or the other";
        for (key, given) in [
            ("rain.rate_mm_h", table.rate_mm_h.is_some()),
            ("rain.distribution", table.distribution.is_some()),
        ] {
            if given {
                return Err(positions.bad(key, "a rain that is counted by rain.drops", allowed));
            }
        }
        let side = self.box_m.unwrap_or(RAIN_BOX_M);
        let volume = match self.volume {
            RainVolume::Box | RainVolume::Tariq2007 => side * side * side,
            RainVolume::CreusPatow2013 => {
                std::f64::consts::PI
                    * self.cylinder.radius_m
                    * self.cylinder.radius_m
                    * self.cylinder.height_m
            }
            _ => {
                let allowed = "volume = \"box\", \"tariq-2007\" or \"creus-patow-2013\"";
                return Err(positions.bad("rain.drops", "drops that are counted in no volume", allowed));
            }
        };
        if count > self.max_drops {
            let found = format!("{count} drops, more than rain.max_drops = {}", self.max_drops);
            return Err(positions.bad("rain.drops.count", found, "1 to rain.max_drops"));
        }
        // The number is proportional to the rate.
        let bad =
            |error: DropError| positions.bad("rain.drops", error.to_string(), "drops of the laws of fall");
        let of_one = Self { rate_mm_h: 1.0, ..self }.sizes().map_err(bad)?;
        let rate_mm_h = f64::from(count) / (of_one.number_density() * volume);
        if !(MIN_SHAPE_MM_H..=MAX_MM_H).contains(&rate_mm_h) {
            let found = format!("{count} drops in {volume:.4} m^3 are {rate_mm_h:.4} mm/h");
            return Err(positions.bad("rain.drops.count", found, "drops of 0.001 to 500 mm/h"));
        }
        Ok(Self { rate_mm_h, ..self })
    }
}

/// The largest rate over time, mm/h.
pub(super) fn most(rates: &Keyed<f64>) -> f64 {
    rates.keys().iter().fold(0.0, |most: f64, &(_, rate)| most.max(rate))
}

impl RainTable {
    /// Model that drops are drawn as.
    pub(super) fn drop_model(
        &self,
        streaks: &Streaks,
        positions: &Positions<'_>,
    ) -> Result<Option<RelativePath>, SceneError> {
        let Some(file) = &self.mask_model else { return Ok(None) };
        let key = "rain.mask_model";
        if self.drop_shape.is_some() {
            return Err(positions.bad(
                key,
                "a model for drops that have rain.drop_shape",
                "one or the other",
            ));
        }
        // The table of streaks is traced through the drops' shapes.
        if streaks.samples.is_none() {
            let found = "a mask for streaks that need none, with streaks.samples = \"table\"";
            return Err(positions.bad(key, found, "with streaks.samples = 1 to 4096"));
        }
        path(file, key, positions).map(Some)
    }

    fn gamma(&self, rate_mm_h: f64, positions: &Positions<'_>) -> Result<DropSizeLaw, SceneError> {
        let median_volume_diameter_m = match self.median_diameter_mm {
            Some(median) => median.0 * 1e-3,
            None => DropSizeDistribution::new(DropSizeLaw::MarshallPalmer1948, rate_mm_h.max(MIN_SHAPE_MM_H))
                .map_err(|error| positions.bad("rain.rate_mm_h", error.to_string(), "a rate of the laws"))?
                .median_volume_diameter(),
        };
        let mu = self.gamma_shape.map_or(GAMMA_SHAPE, |mu| mu.0);
        Ok(DropSizeLaw::GammaByMedian { mu, median_volume_diameter_m })
    }
}

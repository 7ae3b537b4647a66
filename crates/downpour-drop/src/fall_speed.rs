//! Terminal fall speed of water drops, and relaxation toward it.
//!
//! Law: K. V. Beard, J. Atmos. Sci. 33, 851 (1976): three regimes, by temperature and pressure, for diameters
//! up to 7 mm; the speed is held constant beyond. The two tables and the five fits of other authors hold for
//! 20 C and 1013.25 hPa; in other air they are multiplied by (rho0/rho)^0.4 (Foote & du Toit 1969).
//! Relaxation toward the terminal speed v with quadratic drag: v/(2g) vertically, v/g across.
//! Units: diameters in meters, speeds in m/s, times in seconds. Diameters above 9 mm are not drops: an error.
//!
//! | model | form | range | against Gunn & Kinzer, 0.5 to 5.8 mm |
//! |---|---|---|---|
//! | [`Beard1976`](FallSpeedModel::Beard1976) | three regimes | to 7 mm | 2.1 % at 0.5 mm, rms 0.6 % |
//! | [`GunnKinzer1949`](FallSpeedModel::GunnKinzer1949) | table 2 | 0.078 to 5.8 mm | the measurement itself |
//! | [`Rousseau2006`](FallSpeedModel::Rousseau2006) | table 2 | 0.2 to 8 mm | 1.6 % at 2 mm |
//! | [`Atlas1973`](FallSpeedModel::Atlas1973) | 9.65 - 10.3 exp(-0.6 d) | from 0.109 mm | 2.0 %, rms 1.1 % |
//! | [`AtlasUlbrich1977`](FallSpeedModel::AtlasUlbrich1977) | 3.78 d^0.67 | 0.5 to 5 mm, rough | 34 % |
//! | [`Brandes2002`](FallSpeedModel::Brandes2002) | quartic | | 3.6 %, rms 1.0 % |
//! | [`VanDijk2002`](FallSpeedModel::VanDijk2002) | cubic | to 6 mm | 2.7 %, rms 1.1 % |
//! | [`Lhermitte1988`](FallSpeedModel::Lhermitte1988) | 9.25 (1 - exp(-(0.068 d^2 + 0.488 d))) | | 3.2 %, rms 1.0 % |
//!
//! Functions whose names begin with `fall_speed_` are the twins of `shaders/wgsl/drop/fall_speed.wgsl`, in f32;
//! [`terminal_speed`] and [`TerminalSpeed`] are the reference, in f64.

mod beard;
mod fits;
mod motion;
mod tables;

use downpour_shaders::drop::fall_speed as shared;

use crate::DropError;
use crate::air::Air;
use crate::error::in_rounded_range;

pub use beard::{FallSpeedAir, fall_speed_beard_1976, fall_speed_beard_flattened, fall_speed_beard_sphere};
pub use fits::{
    fall_speed_atlas_1973, fall_speed_atlas_ulbrich_1977, fall_speed_brandes_2002, fall_speed_lhermitte_1988,
    fall_speed_van_dijk_2002,
};
pub use motion::{
    FallNumbers, Relaxation, distance_to_fraction, fall_from_rest, fall_numbers, fall_speed_relaxation,
    relaxation, speed_after_fall, time_of_fall, time_to_fraction,
};
pub use tables::{fall_speed_gunn_kinzer_1949, fall_speed_rousseau_2006};

/// Largest diameter of a drop, in meters. Larger drops break up.
pub const MAX_DIAMETER_M: f64 = 9.0e-3;

/// A published model of terminal speed. The number of a variant is the one that shaders use.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum FallSpeedModel {
    /// K. V. Beard, J. Atmos. Sci. 33, 851 (1976): physical, with temperature and pressure.
    ///
    /// The three regimes do not meet exactly: at 20 C and 1013.25 hPa the speed falls by 0.19 % at 19 um and rises
    /// by 0.02 % at 1.07 mm. From 0 to 40 C and 700 to 1050 hPa the steps stay within 0.8 %, in all air that is
    /// accepted within 2.1 %.
    #[default]
    Beard1976 = shared::FALL_SPEED_MODEL_BEARD_1976,
    /// R. Gunn, G. D. Kinzer, J. Meteor. 6, 243 (1949), table 2: measured; straight lines between its points. As
    /// d^2 below 0.078 mm, constant above 5.8 mm.
    GunnKinzer1949 = shared::FALL_SPEED_MODEL_GUNN_KINZER_1949,
    /// P. Rousseau, V. Jolivet, D. Ghazanfarpour, Computers & Graphics 30, 507 (2006), table 2, which is in radii:
    /// its spherical column up to a diameter of 0.9 mm (the same numbers as Gunn & Kinzer's), its ellipsoidal column
    /// from 1 mm. Straight lines between its points; as d^2 below 0.2 mm, constant above 8 mm.
    Rousseau2006 = shared::FALL_SPEED_MODEL_ROUSSEAU_2006,
    /// D. Atlas, R. C. Srivastava, R. S. Sekhon, Rev. Geophys. 11, 1 (1973). The fit is negative below 0.109 mm,
    /// where the speed is 0.
    Atlas1973 = shared::FALL_SPEED_MODEL_ATLAS_1973,
    /// D. Atlas, C. W. Ulbrich, J. Appl. Meteor. 16, 1322 (1977): a power law, for integrals in closed form. It
    /// does not saturate: 66 % too fast at 8 mm.
    AtlasUlbrich1977 = shared::FALL_SPEED_MODEL_ATLAS_ULBRICH_1977,
    /// E. A. Brandes, G. Zhang, J. Vivekanandan, J. Appl. Meteor. 41, 674 (2002). 0 below 0.021 mm.
    Brandes2002 = shared::FALL_SPEED_MODEL_BRANDES_2002,
    /// A. I. J. M. van Dijk, L. A. Bruijnzeel, C. J. Rosewell, J. Hydrology 261, 1 (2002). 0 below 0.051 mm. The
    /// cubic diverges above 6 mm: held constant.
    VanDijk2002 = shared::FALL_SPEED_MODEL_VAN_DIJK_2002,
    /// R. Lhermitte, Geophys. Res. Lett. 15, 1125 (1988), as later corrected: the paper's printed form is wrong.
    Lhermitte1988 = shared::FALL_SPEED_MODEL_LHERMITTE_1988,
}

impl FallSpeedModel {
    /// All models, in the order of their numbers.
    pub const ALL: [Self; 8] = [
        Self::Beard1976,
        Self::GunnKinzer1949,
        Self::Rousseau2006,
        Self::Atlas1973,
        Self::AtlasUlbrich1977,
        Self::Brandes2002,
        Self::VanDijk2002,
        Self::Lhermitte1988,
    ];

    /// Name in files and arguments.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Beard1976 => "beard-1976",
            Self::GunnKinzer1949 => "gunn-kinzer-1949",
            Self::Rousseau2006 => "rousseau-2006",
            Self::Atlas1973 => "atlas-1973",
            Self::AtlasUlbrich1977 => "atlas-ulbrich-1977",
            Self::Brandes2002 => "brandes-2002",
            Self::VanDijk2002 => "van-dijk-2002",
            Self::Lhermitte1988 => "lhermitte-1988",
        }
    }

    /// Returns the model of a name; `None` for an unknown name.
    #[must_use]
    pub fn from_name(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|model| model.name() == name)
    }

    /// Number of the model in shaders.
    #[must_use]
    pub const fn number(self) -> u32 {
        self as u32
    }
}

/// Terminal speed in m/s of a drop of `diameter_m` meters (of the sphere of equal volume) in `air`.
///
/// ```
/// use downpour_drop::air::Air;
/// use downpour_drop::fall_speed::{FallSpeedModel, terminal_speed};
/// let v = terminal_speed(FallSpeedModel::Beard1976, 2.0e-3, &Air::standard())?;
/// assert!((v - 6.506).abs() < 0.001);
/// # Ok::<(), downpour_drop::DropError>(())
/// ```
///
/// # Errors
/// [`DropError::OutOfRange`] if the diameter is not above 0 and at most 9 mm.
pub fn terminal_speed(model: FallSpeedModel, diameter_m: f64, air: &Air) -> Result<f64, DropError> {
    TerminalSpeed::new(model, air).at(diameter_m)
}

/// A model of terminal speed in one kind of air, with all terms that do not depend on the drop precomputed.
///
/// ```
/// use downpour_drop::air::Air;
/// use downpour_drop::fall_speed::{FallSpeedModel, TerminalSpeed};
/// let law = TerminalSpeed::new(FallSpeedModel::GunnKinzer1949, &Air::standard());
/// assert_eq!(law.at(4.0e-3)?, 8.83);
/// assert!(law.at(12.0e-3).is_err());
/// # Ok::<(), downpour_drop::DropError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct TerminalSpeed {
    model: FallSpeedModel,
    beard: beard::Beard,
    density_factor: f64,
}

impl TerminalSpeed {
    /// Creates the model `model` in `air`.
    #[must_use]
    pub fn new(model: FallSpeedModel, air: &Air) -> Self {
        Self { model, beard: beard::Beard::new(air), density_factor: air.speed_factor() }
    }

    /// Speed in m/s of a drop of `diameter_m` meters.
    ///
    /// # Errors
    /// [`DropError::OutOfRange`] if the diameter is not above 0 and at most 9 mm.
    pub fn at(&self, diameter_m: f64) -> Result<f64, DropError> {
        Ok(self.unchecked(drop_diameter(diameter_m)?))
    }

    /// Speed for a diameter that was checked before; 0 for the diameter 0.
    pub(crate) fn unchecked(&self, diameter_m: f64) -> f64 {
        let d = diameter_m * 1.0e3;
        let standard = match self.model {
            FallSpeedModel::Beard1976 => return self.beard.speed(d),
            FallSpeedModel::GunnKinzer1949 => tables::gunn_kinzer(d),
            FallSpeedModel::Rousseau2006 => tables::rousseau(d),
            FallSpeedModel::Atlas1973 => fits::atlas(d),
            FallSpeedModel::AtlasUlbrich1977 => fits::atlas_ulbrich(d),
            FallSpeedModel::Brandes2002 => fits::brandes(d),
            FallSpeedModel::VanDijk2002 => fits::van_dijk(d),
            FallSpeedModel::Lhermitte1988 => fits::lhermitte(d),
        };
        standard * self.density_factor
    }

    /// Diameters, in meters and ascending, of the steps and kinks of the law, which no integral should cross.
    pub(crate) fn kinks(&self) -> Vec<f64> {
        let mm: Vec<f64> = match self.model {
            FallSpeedModel::Beard1976 => beard::JOINTS_MM.to_vec(),
            FallSpeedModel::GunnKinzer1949 => tables::gunn_kinzer_diameters(),
            FallSpeedModel::Rousseau2006 => tables::rousseau_diameters(),
            FallSpeedModel::VanDijk2002 => vec![fits::VAN_DIJK_MAX_MM],
            FallSpeedModel::Atlas1973 => vec![fits::atlas_zero()],
            FallSpeedModel::AtlasUlbrich1977
            | FallSpeedModel::Brandes2002
            | FallSpeedModel::Lhermitte1988 => Vec::new(),
        };
        mm.into_iter().map(|d| d * 1.0e-3).collect()
    }
}

/// Returns `diameter_m` if it is in the range of drops.
pub(crate) fn drop_diameter(diameter_m: f64) -> Result<f64, DropError> {
    let range = f64::MIN_POSITIVE..=MAX_DIAMETER_M;
    in_rounded_range("diameter", diameter_m, "mm", &range, 1.0e3, "above 0, at most 9 mm")
}

/// Terminal speed in m/s by the number of a model; an unknown number selects Beard 1976. Diameter in meters, 0 to 9e-3.
#[must_use]
pub fn fall_speed_terminal(model: u32, diameter_m: f32, air: FallSpeedAir) -> f32 {
    match model {
        shared::FALL_SPEED_MODEL_GUNN_KINZER_1949 => fall_speed_gunn_kinzer_1949(diameter_m, air),
        shared::FALL_SPEED_MODEL_ROUSSEAU_2006 => fall_speed_rousseau_2006(diameter_m, air),
        shared::FALL_SPEED_MODEL_ATLAS_1973 => fall_speed_atlas_1973(diameter_m, air),
        shared::FALL_SPEED_MODEL_ATLAS_ULBRICH_1977 => fall_speed_atlas_ulbrich_1977(diameter_m, air),
        shared::FALL_SPEED_MODEL_BRANDES_2002 => fall_speed_brandes_2002(diameter_m, air),
        shared::FALL_SPEED_MODEL_VAN_DIJK_2002 => fall_speed_van_dijk_2002(diameter_m, air),
        shared::FALL_SPEED_MODEL_LHERMITTE_1988 => fall_speed_lhermitte_1988(diameter_m, air),
        _ => fall_speed_beard_1976(diameter_m, air),
    }
}

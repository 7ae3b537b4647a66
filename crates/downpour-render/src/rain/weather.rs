//! Masks of the drops of a weather.

use downpour_drop::air::Air;
use downpour_drop::optics::water_index_in_air;
use downpour_mask::{ClosedMesh, MaskError};
use downpour_weather::{Loaded, Weather};

use super::DropMasks;

/// The line of sodium, in meters: the wavelength at which water's index is taken.
const SODIUM_M: f64 = 589.3e-9;

/// The coldest air, in Celsius, in which water's index is known.
const COLDEST_INDEX_C: f64 = -12.0;

impl DropMasks {
    /// Traces the masks of a weather's drops, of the shape or the model that it names.
    ///
    /// # Errors
    /// [`MaskError`] if the air is outside what the laws know, or as [`drop_model`].
    pub fn of_weather(weather: &Weather, loaded: &Loaded) -> Result<Self, MaskError> {
        let index = index_of_water(&weather.rain.air)?;
        match drop_model(weather, loaded)? {
            Some(model) => Self::trace_model(index, &model),
            None => Self::trace_shapes(index, weather.rain.drop_shape.table()),
        }
    }

    /// Returns the masks with those of the splashes of a weather behind them.
    ///
    /// # Errors
    /// As [`DropMasks::of_weather`].
    pub fn with_splashes_of(self, weather: &Weather) -> Result<Self, MaskError> {
        self.with_splashes_in_air(&weather.rain.air)
    }

    /// Adds those of splashes in an air ([`DropMasks::with_splashes`]).
    ///
    /// # Errors
    /// As [`DropMasks::in_air`].
    pub fn with_splashes_in_air(self, air: &Air) -> Result<Self, MaskError> {
        self.with_splashes(index_of_water(air)?)
    }

    /// Traces the masks of drops in an air: of its temperature, but of no colder one than the refractive index is known for.
    ///
    /// # Errors
    /// [`MaskError`] if the air is outside what the laws know.
    pub fn in_air(air: &Air) -> Result<Self, MaskError> {
        Self::trace(index_of_water(air)?)
    }
}

/// Refractive index of the drops in an air, against it.
fn index_of_water(air: &Air) -> Result<f64, MaskError> {
    let air = Air::new(air.temperature_c().max(COLDEST_INDEX_C), air.pressure_pa())?;
    Ok(water_index_in_air(SODIUM_M, &air)?)
}

/// The model that the drops of a weather are drawn as, if it has one.
///
/// # Errors
/// [`MaskError::InFile`] with the file and the key for a model that is no closed surface.
pub fn drop_model(weather: &Weather, loaded: &Loaded) -> Result<Option<ClosedMesh>, MaskError> {
    let Some(model) = &loaded.drop_model else { return Ok(None) };
    let mesh = ClosedMesh::new(&model.positions, model.normals.as_deref(), &model.indices);
    let in_file = |error| MaskError::InFile {
        path: format!("{}: rain.mask_model: {}", weather.name, model.name),
        error: Box::new(error),
    };
    Ok(Some(mesh.map_err(in_file)?))
}

//! `downpour drop`: the physical properties of one drop.

use clap::Args;
use downpour::drop::DropShape;
use downpour::drop::air::Air;
use downpour::drop::fall_speed::{FallSpeedModel, distance_to_fraction, fall_numbers, relaxation};
use downpour::drop::optics::{field_of_view, water_index_in_air};
use downpour::drop::oscillation::{Fluids, FrequencyLaw, lamb_damping_time};

use super::FallSpeedArgument;
use crate::failure::Failure;
use crate::listing::{Datum, Entry};
use crate::{listing, quantity, stream};

/// Wavelength, in meters, of the refractive index that is printed: sodium light.
const SODIUM_M: f64 = 589.3e-9;

/// Print the physical properties of one drop.
#[derive(Debug, Args)]
pub(crate) struct DropArguments {
    /// Diameter of the sphere of equal volume, 0.001 to 9 mm.
    #[arg(long, value_name = "MM", value_parser = quantity::diameter_mm, allow_hyphen_values = true)]
    diameter: f64,
    /// Temperature of air and water, -12 to 40 C.
    #[arg(long, value_name = "C", default_value = "20", value_parser = quantity::temperature_of_index_c)]
    #[arg(allow_hyphen_values = true)]
    temperature: f64,
    /// Pressure of the air, 300 to 1100 hPa.
    #[arg(long, value_name = "HPA", default_value = "1013.25", value_parser = quantity::pressure_hpa)]
    #[arg(allow_hyphen_values = true)]
    pressure: f64,
    #[command(flatten)]
    fall_speed: FallSpeedArgument,
    /// Write JSON.
    #[arg(long)]
    json: bool,
}

impl DropArguments {
    pub(crate) fn run(&self) -> Result<(), Failure> {
        let entries = self.entries()?;
        stream::print(&if self.json { listing::json(&entries) } else { listing::text(&entries) })
    }

    fn entries(&self) -> Result<Vec<Entry>, Failure> {
        use Datum::{Computed, Given};
        let diameter = self.diameter * 1.0e-3;
        let model: FallSpeedModel = self.fall_speed.model;
        let air = Air::new(self.temperature, self.pressure * 100.0)?;
        let shape = DropShape::new(diameter)?;
        let fall = fall_numbers(model, diameter, &air)?;
        let times = relaxation(fall.speed_m_s);
        let fluids = Fluids::in_air(&air);
        let law = FrequencyLaw::default();
        let index = water_index_in_air(SODIUM_M, &air)?;
        let entry = Entry::new;
        Ok(vec![
            entry("diameter_mm", "diameter", Given(self.diameter), "mm"),
            entry("temperature_c", "temperature", Given(self.temperature), "C"),
            entry("pressure_hpa", "pressure", Given(self.pressure), "hPa"),
            entry("fall_speed_model", "law of fall speed", Datum::Word(model.name().to_owned()), ""),
            entry("terminal_speed_m_s", "terminal speed", Computed(fall.speed_m_s, 4), "m/s"),
            entry("relaxation_vertical_s", "relaxation along the fall", Computed(times.vertical_s, 3), "s"),
            entry("relaxation_horizontal_s", "relaxation across it", Computed(times.horizontal_s, 3), "s"),
            entry(
                "fall_to_99_percent_m",
                "fall to 99 % of the speed",
                Computed(distance_to_fraction(fall.speed_m_s, 0.99)?, 3),
                "m",
            ),
            entry("reynolds", "Reynolds number", Computed(fall.reynolds, 4), ""),
            entry("weber", "Weber number", Computed(fall.weber, 4), ""),
            entry("bond", "Bond number", Computed(fall.bond, 4), ""),
            entry(
                "drag_coefficient",
                "drag coefficient",
                Datum::bounded(fall.drag_coefficient, 3, "unbounded"),
                "",
            ),
            entry("axis_ratio", "height over width", Computed(shape.axis_ratio(), 3), ""),
            entry("width_mm", "width", Computed(2.0e3 * shape.max_half_width(), 4), "mm"),
            entry(
                "height_mm",
                "height",
                Computed(1.0e3 * (shape.extent_up() + shape.extent_down()), 4),
                "mm",
            ),
            entry("volume_mm3", "volume", Computed(1.0e9 * shape.volume(), 4), "mm^3"),
            entry(
                "centroid_mm",
                "centroid above the origin",
                Computed(1.0e3 * shape.centroid_height(), 2),
                "mm",
            ),
            entry(
                "f2_hz",
                "oscillation of degree 2",
                Computed(law.frequency(2, diameter, &fluids)?, 4),
                "Hz",
            ),
            entry(
                "f3_hz",
                "oscillation of degree 3",
                Computed(law.frequency(3, diameter, &fluids)?, 4),
                "Hz",
            ),
            entry(
                "tau2_s",
                "its damping, degree 2",
                Computed(lamb_damping_time(2, diameter, &fluids)?, 3),
                "s",
            ),
            entry(
                "tau3_s",
                "its damping, degree 3",
                Computed(lamb_damping_time(3, diameter, &fluids)?, 3),
                "s",
            ),
            entry("refractive_index", "refractive index, 589 nm", Computed(index, 4), ""),
            entry(
                "field_of_view_deg",
                "field of view of the sphere",
                Computed(field_of_view(index)?.to_degrees(), 4),
                "degrees",
            ),
        ])
    }
}

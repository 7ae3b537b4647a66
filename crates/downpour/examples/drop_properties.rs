//! The physical properties of raindrops, as a table.
//!
//! `cargo run -p downpour --example drop_properties`

use downpour::drop::air::Air;
use downpour::drop::fall_speed::{FallSpeedModel, TerminalSpeed, relaxation};
use downpour::drop::oscillation::{Fluids, FrequencyLaw};
use downpour::drop::{DropError, DropShape};

fn main() -> Result<(), DropError> {
    print!("{}", table()?);
    Ok(())
}

/// One line for each drop.
pub(crate) fn table() -> Result<String, DropError> {
    let law = TerminalSpeed::new(FallSpeedModel::Beard1976, &Air::standard());
    let mut table = "diameter   speed   height/width   oscillates at   takes a gust in\n".to_owned();
    for diameter_mm in [0.5, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0] {
        let diameter = diameter_mm * 1.0e-3;
        let ratio = DropShape::new(diameter)?.axis_ratio();
        let speed = law.at(diameter)?;
        let frequency = FrequencyLaw::default().frequency(2, diameter, &Fluids::AT_20_C)?;
        let gust = relaxation(speed).horizontal_s;
        table +=
            &format!("{diameter_mm:5.1} mm {speed:6.2} m/s {ratio:9.3} {frequency:14.1} Hz {gust:12.2} s\n");
    }
    Ok(table)
}

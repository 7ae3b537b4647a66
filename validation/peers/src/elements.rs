//! Rain of `bevy_elements`.

use bevy::camera::Exposure;
use bevy::prelude::*;
use bevy_elements::{
    ElementsCamera, ElementsQuality, PrecipitationPlugin, PrecipitationState, Weather, WindPlugin,
};

use crate::bevy_app::BevyApp;
use crate::contender::{Contender as _, Entry};
use crate::device::Device;

/// Rain rate, mm/h, at which all particles of a quality are rain.
const FULL_MM_H: f32 = 20.0;

/// Qualities by their numbers of particles.
const QUALITIES: [ElementsQuality; 4] =
    [ElementsQuality::Low, ElementsQuality::Medium, ElementsQuality::High, ElementsQuality::Ultra];

/// Returns frames without rain, and with as many drops as are wanted, or as there can be.
///
/// # Errors
/// An app that cannot be created.
pub(crate) fn entries(device: &Device, drops: u32) -> Result<Vec<Entry>, String> {
    let fits = |quality: &&ElementsQuality| quality.precipitation_particles() >= drops;
    let quality = QUALITIES.iter().find(fits).copied().unwrap_or(ElementsQuality::Ultra);
    let most = quality.precipitation_particles();
    let rate = FULL_MM_H * drops.min(most) as f32 / most as f32;
    let mut raining = with(device, quality, rate)?;
    raining.frame()?;
    let state = raining.app().world().get_resource::<PrecipitationState>();
    let count = state.ok_or("bevy_elements: there is no precipitation")?.rain;
    let entry = |name: &str, drops, empty, app| Entry {
        name: name.to_owned(),
        drops,
        empty,
        contender: Box::new(app),
    };
    Ok(vec![
        entry("bevy_elements, no rain", 0, None, with(device, quality, 0.0)?),
        entry("bevy_elements, rain", u64::from(count), Some(0), raining),
    ])
}

/// Creates an app with wind and a rain rate, mm/h, and nothing else of the crate.
fn with(device: &Device, quality: ElementsQuality, rate: f32) -> Result<BevyApp, String> {
    let add = |app: &mut App| {
        app.insert_resource(quality);
        app.insert_resource(Weather { precipitation_mm_h: rate, ..default() });
        app.add_plugins((WindPlugin, PrecipitationPlugin));
    };
    BevyApp::new(device, add, |camera| {
        camera.insert((ElementsCamera::bare(), Exposure::SUNLIGHT));
    })
}

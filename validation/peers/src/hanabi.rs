//! Falling particles of `bevy_hanabi`.

use bevy::prelude::*;
use bevy_hanabi::{
    Attribute, EffectAsset, ExprWriter, HanabiPlugin, OrientMode, OrientModifier, ParticleEffect,
    SetAttributeModifier, SetColorModifier, SetSizeModifier, SimulationCondition, SpawnerSettings,
    VectorType,
};

use crate::bevy_app::BevyApp;
use crate::contender::Entry;
use crate::device::Device;
use crate::{BOX_M, EYE_M};

/// Length and width of a streak, m.
const STREAK_M: [f32; 2] = [0.12, 0.01];

/// Color and opacity of a streak.
const COLOR: Vec4 = Vec4::new(0.7, 0.75, 0.8, 0.3);

/// Least and largest speed of a particle, m/s, each constant.
const SPEEDS: [f32; 2] = [4.0, 9.0];

/// Returns frames without particles, with particles that move but are not drawn, and with particles.
///
/// # Errors
/// An app that cannot be created.
pub(crate) fn entries(device: &Device, drops: u32) -> Result<Vec<Entry>, String> {
    let add = |app: &mut App| {
        app.add_plugins(HanabiPlugin);
    };
    let none = BevyApp::new(device, add, |_| ())?;
    let entry = |name: &str, drops, app| Entry {
        name: name.to_owned(),
        drops,
        empty: Some(0),
        contender: Box::new(app),
    };
    Ok(vec![
        Entry { empty: None, ..entry("bevy_hanabi, no particles", 0, none) },
        entry(
            "bevy_hanabi, particles in a box, not drawn",
            u64::from(drops),
            with(device, drops)?.when_settled(hide),
        ),
        entry("bevy_hanabi, particles in a box, drawn", u64::from(drops), with(device, drops)?),
    ])
}

/// Creates an app with particles.
fn with(device: &Device, drops: u32) -> Result<BevyApp, String> {
    let add = |app: &mut App| {
        app.add_plugins(HanabiPlugin);
        let effect = app.world_mut().resource_mut::<Assets<EffectAsset>>().add(falling(drops));
        app.world_mut().spawn(ParticleEffect::new(effect));
    };
    BevyApp::new(device, add, |_| ())
}

/// Stops drawing the particles; they move on.
fn hide(app: &mut App) {
    let mut effects = app.world_mut().query_filtered::<&mut Visibility, With<ParticleEffect>>();
    for mut visibility in effects.iter_mut(app.world_mut()) {
        *visibility = Visibility::Hidden;
    }
}

/// Particles in a box around the camera: all at once, each with a constant speed, and again at the top when it passes the bottom.
fn falling(drops: u32) -> EffectAsset {
    let edge = BOX_M as f32;
    let low = Vec3::new(0.0, EYE_M, 0.0) - Vec3::splat(0.5 * edge);
    let writer = ExprWriter::new();
    let position = writer.rand(VectorType::VEC3F) * writer.lit(edge) + writer.lit(low);
    let position = SetAttributeModifier::new(Attribute::POSITION, position.expr());
    let speed = writer.lit(SPEEDS[0]).uniform(writer.lit(SPEEDS[1]));
    let velocity = writer.lit(Vec3::NEG_Y) * speed;
    let velocity = SetAttributeModifier::new(Attribute::VELOCITY, velocity.expr());
    let moved = writer.attr(Attribute::POSITION);
    let inside = moved.clone().y().step(writer.lit(low.y));
    let lift = writer.lit(Vec3::Y) * (writer.lit(1.0) - inside) * writer.lit(edge);
    let wrapped = SetAttributeModifier::new(Attribute::POSITION, (moved + lift).expr());
    let [length, width] = STREAK_M;
    EffectAsset::new(drops, SpawnerSettings::once((drops as f32).into()), writer.finish())
        .with_name("rain")
        .with_simulation_condition(SimulationCondition::Always)
        .init(position)
        .init(velocity)
        .update(wrapped)
        .render(OrientModifier::new(OrientMode::AlongVelocity))
        .render(SetSizeModifier { size: Vec3::new(length, width, 1.0).into() })
        .render(SetColorModifier::new(COLOR))
}

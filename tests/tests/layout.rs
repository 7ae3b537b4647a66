//! Host structs have the layout that naga gives their WGSL counterparts.

use std::mem::offset_of;

use downpour_atlas::gpu::AtlasQuery;
use downpour_atlas::lookup::{AtlasFrame, AtlasSlot, AtlasTriangle};
use downpour_bvh::{BvhNode, BvhTriangle};
use downpour_drop::fall_speed::FallSpeedAir;
use downpour_drop::oscillation::{DropOscillation, DropOscillationTime};
use downpour_drop::shape::DropShapeCoefficients;
use downpour_lattice::glass::blade::GlassBlade;
use downpour_lattice::glass::frame::GlassFrame;
use downpour_lattice::glass::size::{GlassSizeRow, GlassTable};
use downpour_lattice::puddle::PuddleSeed;
use downpour_lattice::puddle::lattice::PuddleGrid;
use downpour_mask::MaskTexel;
use downpour_mask::gpu::{DropUniform, ModelUniform};
use downpour_math::pyramid::PyramidLevel;
use downpour_render::camera::Camera;
use downpour_render::glass::{GlassPictureDrop, GlassPictureFrame, GlassPictureLight};
use downpour_render::glow::{GlowCoarse, GlowLevel};
use downpour_render::host::{HostBlendFrame, HostEnvironmentFrame, HostPlateFrame};
use downpour_render::rain::layers::{LayersFrame, LayersLamp};
use downpour_render::rain::light::DropLightFrame;
use downpour_render::rain::medium::{MediumFrame, MediumShell};
use downpour_render::rain::profiles::ProfilesFrame;
use downpour_render::rain::project::ProjectFrame;
use downpour_render::rain::spray::SprayFrame;
use downpour_render::rain::tiles::TilesFrame;
use downpour_render::rain::{DropsFrame, ScreenDrop, StreakPath, StreakRay};
use downpour_render::tone::ToneFrame;
use downpour_shaders::render::specimen;
use downpour_shaders::{
    Module, atlas, bvh, common, compose, drop, lattice, mask, modules, render, sim, wind,
};
use downpour_sim::collision::{CollisionFrame, CollisionTexel};
use downpour_sim::drips::row::{DripFrame, DripRow};
use downpour_sim::enter::EnterRegion;
use downpour_sim::field::EyeDrop;
use downpour_sim::field::frame::{FieldClass, FieldFrame, ShelterFrame};
use downpour_sim::impacts::bounce_frame::{BounceFrame, BounceParts};
use downpour_sim::impacts::splash_frame::SplashFrame;
use downpour_sim::step::{StepEvent, StepFrame};
use downpour_sim::step_list::StepListFrame;
use downpour_sim::step_splash::StepSplashFrame;
use downpour_sim::volume::{VolumeEye, VolumeFrustum};
use downpour_specimen::gpu::{CameraUniform, LampUniform, SpecimenUniform, StreakUniform};
use downpour_tests::signature::parse;
use downpour_trace::data::{RenderCorner, RenderFrame};
use downpour_trace::running_light::RunningMean;
use downpour_trace::temporal::TemporalFrame;
use downpour_trace::trace::{TraceAmbient, TraceSlot};
use downpour_wind::WindTurbulenceMode;
use downpour_wind::field::WindFieldGrid;
use downpour_wind::field_spread::WindFieldSpreadFrame;

/// A host struct: its WGSL name, the module that declares it, its size, and its fields by their WGSL names.
struct Host {
    wgsl: &'static str,
    module: &'static Module,
    size: usize,
    fields: Vec<(&'static str, usize)>,
}

macro_rules! host {
    ($type:ty as $wgsl:literal in $module:expr, $($field:ident),+ $(,)?) => {
        Host {
            wgsl: $wgsl,
            module: $module,
            size: size_of::<$type>(),
            fields: vec![$((stringify!($field), offset_of!($type, $field))),+],
        }
    };
}

fn hosts() -> Vec<Host> {
    vec![
        host!(DropShapeCoefficients as "DropShapeCoefficients" in &drop::shape::SHAPE, c0, c1, c2),
        host!(FallSpeedAir as "FallSpeedAir" in &drop::fall_speed::FALL_SPEED,
            stokes, slip_mm, davies_log, davies_speed, bond_log, bond_speed, density_factor, unused),
        host!(DropOscillation as "DropOscillation" in &drop::oscillation::OSCILLATION,
            amplitude, damping, phase, frequency),
        host!(DropOscillationTime as "DropOscillationTime" in &drop::oscillation::OSCILLATION, ticks, offset),
        host!(MaskTexel as "MaskTexel" in &mask::TEXEL, direction, coverage, reflected, transmittance, internal,
            internal_transmittance, reflections),
        host!(DropUniform as "MaskTracedDrop" in &mask::TRACE, size, pixel, inverse_wide, inverse_tall, shape, up,
            index),
        host!(ModelUniform as "MaskModelParameters" in &mask::MODEL, front, index, pixel, size, first_row),
        host!(AtlasFrame as "AtlasFrame" in &atlas::ATLAS,
            size, half_extent, pick, counts, seed, is_shared, unused, diameters, elevations, first),
        host!(AtlasTriangle as "AtlasTriangle" in &atlas::ATLAS,
            a, b, c, unused, directions, unused_1, next, unused_2),
        host!(AtlasSlot as "AtlasSlot" in &atlas::ATLAS, layers, side, weights, amount, parts, unused),
        host!(AtlasQuery as "AtlasQuery" in &atlas::ATLAS_QUERY,
            light, diameter, view, id, axis, across, turns, unused),
        host!(Camera as "RenderCamera" in &render::camera::CAMERA,
            eye, width, right, height, up, seed, forward, pixel_angle),
        host!(RenderFrame as "RenderFrame" in &render::scene::DATA, sky_levels, camera, grid, slots, lights,
            light_count, sky_rays, first_row, nearest, ray_fraction, projection, suns_out, puddles, puddle_count, pane,
            turn, wetness, emitters, ray_spacing, ray_column, ray_row, glazing, impostors, impostor_edge, translucent,
            unused, sky_irradiance),
        host!(RenderCorner as "RenderCorner" in &render::scene::DATA, normal, material, tangent, uv, color),
        host!(TraceSlot as "TraceSlot" in &render::scene::TRACE, position, normal, light, look, factor),
        host!(TraceAmbient as "TraceAmbient" in &render::scene::TRACE, base, mirror),
        host!(TemporalFrame as "TemporalFrame" in &render::scene::TEMPORAL, unread, turn, is_last, max_weight, camera,
            shift, max_gloss),
        host!(RunningMean as "RunningMean" in &render::scene::RUNNING_LIGHT, color, weight, recent, variance),
        host!(PyramidLevel as "PyramidLevel" in &common::PYRAMID, size, source_size, source, target_texel, unused),
        host!(HostPlateFrame as "HostPlateFrame" in &render::host::HOST_PLATE, inverse, clear, scale, camera),
        host!(HostEnvironmentFrame as "HostEnvironmentFrame" in &render::host::HOST_ENVIRONMENT, levels, camera, size,
            last, has_sky, sky_scale),
        host!(HostBlendFrame as "HostBlendFrame" in &render::host::HOST_BLEND, width, scale, unused),
        host!(DropsFrame as "DropsFrame" in &render::rain::DROPS_FRAME, unread, count, made_classes, visibility, camera,
            capture_right, capture_size, capture_up, capture_last, capture_forward, capture_texel, form, mask_size,
            known, light_terms, streak_samples, streak_color, glints, atlas),
        host!(LayersLamp as "LayersLamp" in &render::layers::LAYERS, place, is_parallel, color, unused),
        host!(LayersFrame as "LayersFrame" in &render::layers::LAYERS, strength, parallax, fall, moved, row_part, row,
            count, milk, stretch, distortion, unused, lamps),
        host!(SprayFrame as "SprayFrame" in &render::spray::SPRAY_FRAME,
            levels, lean, extinction, height, eye, top, rise, ray_spacing, ray_column, ray_row, unused_a, unused_b),
        host!(EyeDrop as "EyeDrop" in &sim::field::EYE_DROP,
            offset, diameter, velocity, id, present, speed, id_low),
        host!(FieldClass as "FieldClass" in &sim::field::FIELD,
            seed, edge, period, first_node, first_threshold, portions, first_column, columns, counts, eye_column,
            eye_in_column, eye_periods, heights, drift, reach, middle, gauge, first_kept, least_units, kept_inverse,
            farthest, margin, unused),
        host!(FieldFrame as "FieldFrame" in &sim::field::FIELD,
            sides, swept, velocity, half_shutter, turning, nearest, per_diameter, beyond, seconds, fraction,
            is_before, classes, columns, room, pane, first, begins, kept_row, radius),
        host!(DripRow as "DripRow" in &sim::drip::DRIP,
            position, terminal, end, longest, due, units, left, shift, key, diameter, below, until, hanging, leaving,
            drain, normal, unused),
        host!(DripFrame as "DripFrame" in &sim::drip::DRIP, unread, seconds, fraction, is_before, eye, points, wind,
            end, farthest, fastest, unused),
        host!(SplashFrame as "SplashFrame" in &sim::splash::SPLASH,
            sides, pane, eye, half_time, now, strength, radius, per_radius, farthest, drops, first, room),
        host!(BounceFrame as "BounceFrame" in &sim::bounce::BOUNCE,
            sides, pane, air, eye, half_shutter, velocity, nearest, turning, farthest, per_diameter, lowest, highest,
            first_time, slices, longest, chance, restitution, grip, size, model, slack, parts, first, room, unused),
        host!(BounceParts as "BounceParts" in &sim::bounce::BOUNCE, count, drops),
        host!(ShelterFrame as "ShelterFrame" in &sim::field::SHELTER, unread, room, first, stopped, eye, half_shutter,
            low, since_cut, high, cuts),
        host!(ProjectFrame as "ProjectFrame" in &render::rain::PROJECT, unread, has_axes, unused, camera, eye_velocity,
            shutter, turning, aperture, amplitudes, inverse_focus, streaks, seed, ticks, time_offset, count, room,
            is_fading, small_are_round),
        host!(ProfilesFrame as "ProfilesFrame" in &render::rain::PROFILES,
            count, max_rays, max_entries, first_entry, seed, amplitudes, medium, unused_1, unused_2, unused_3),
        host!(TilesFrame as "TilesFrame" in &render::rain::TILES, size, count, room),
        host!(ToneFrame as "ToneFrame" in &render::tone::TONE,
            width, height, curve, exposure, has_glow, has_edges, pad_a, pad_b),
        host!(GlowLevel as "GlowLevel" in &render::glow::GLOW,
            size, coarse, first, coarse_first, weight, coarse_weight, fraction, extinction, is_added, offset),
        host!(GlowCoarse as "GlowCoarse" in &render::glow::GLOW, count, unused_1, unused_2, unused_3, levels),
        host!(MediumFrame as "MediumFrame" in &render::medium::MEDIUM, columns, rows, lit, shape, depths, rise, all,
            center, region, size, flatness, eye, open, pane, fog, fog_phase, axis, seed, across, is_grainy, beside,
            unused, shells),
        host!(MediumShell as "MediumShell" in &render::medium::MEDIUM, count, pixels, row, part),
        host!(ScreenDrop as "ScreenDrop" in &render::rain::STREAK,
            towards, distance, position, slope, half_extent, mask_index, area, grid, start, along, first, screen_delta, oval, depth_ratio,
            mode_phase, cycles, fraction, spread, nearest, kind, shape, profile, weights, reach, id),
        host!(StreakPath as "StreakPath" in &render::rain::STREAK_PATH,
            shape, volume, volume_last, wide, tall, index, lobe, amplitudes, rows, columns, profile_rows, fine,
            first_ray, first_entry, drop, unused),
        host!(StreakRay as "StreakRay" in &render::rain::STREAK_RAY, exits, fractions, interfaces, unused),
        host!(DropLightFrame as "DropLightFrame" in &render::drop_light::DROP_LIGHT, form, count, glints, first_light,
            terms),
        host!(GlassPictureDrop as "GlassPictureDrop" in &render::glass::WATER,
            center, radius, sphere, along, behind, lean, droop, axis, lobes),
        host!(GlassPictureFrame as "GlassPictureFrame" in &render::glass::GLASS_PICTURE, unread, lights, lit_from,
            blade_count, camera, across, columns, down, rows, outward, bins, corner, cells, size, wet_size, lens, focus,
            fresnel, room, samples, last, capture_size, capture_last, capture_texel, film, water, first_row, levels,
            blades),
        host!(GlassPictureLight as "GlassPictureLight" in &render::glass::LIGHT, position, radius, color, distance),
        host!(PuddleGrid as "PuddleGrid" in &lattice::puddle::PUDDLE,
            size, quads, degree, coefficients, weights, dt, twice, kick, viscosity, keep, sponge_cells, sponge_drag,
            steps, halo, half_storage, slope, first_texel),
        host!(PuddleSeed as "PuddleSeed" in &lattice::puddle::PUDDLE_SEED,
            center, per_length, amplitude, lift, reach),
        host!(BvhNode as "BvhNode" in &bvh::BVH, low_x, low_y, low_z, high_x, high_y, high_z, child),
        host!(BvhTriangle as "BvhTriangle" in &bvh::BVH, corner, index, edge_1, lets_through, edge_2),
        host!(CameraUniform as "SpecimenCamera" in &specimen::SPECIMEN, right, step, up, distance, back, samples),
        host!(SpecimenUniform as "SpecimenView" in &specimen::SPECIMEN,
            traced, camera, size, sky, first_row, rows, channels),
        host!(LampUniform as "SpecimenLamp" in &specimen::SPECIMEN, direction, reach, radiance),
        host!(StreakUniform as "SpecimenStreak" in &specimen::SPECIMEN_STREAK,
            oscillation, volume, volume_last, inverse_wide, inverse_tall, speed, farthest, instants, first, count),
        host!(CollisionFrame as "CollisionMap" in &sim::collision::COLLISION,
            low, triangles, across, steep, along, merge, fall, edge, per_edge, anchor, size),
        host!(CollisionTexel as "CollisionTexel" in &sim::collision::COLLISION, depths, surfaces),
        host!(StepFrame as "StepFrame" in &sim::step::STEP, unread, kept_since, unused_2, unused_3, now, shift, count,
            size, first, center, volume, wind, time, seed, step, elsewhere, farthest, average, events, bounce,
            restitution, grip, bounced_size, bounced_time, gauge_height, gauge, boxes, kept_room, gauge_area, frustum,
            frustum_before, tangents, lags, oldest, candidates, regions, regions_first, sizes_first, pieces, piece,
            kept_span),
        host!(StepListFrame as "StepListFrame" in &sim::step_list::STEP_LIST, unread, room, unused_2, unused_3, eye,
            after, velocity, half_shutter, turning, nearest, center, farthest, size, volume, sides, pane, seed, range,
            bounce, restitution, grip, bounced_size, step, per_second, count, first, known),
        host!(StepEvent as "StepEvent" in &sim::step::STEP, position, diameter, velocity, drop, normal, time, last),
        host!(StepSplashFrame as "StepSplashFrame" in &sim::step_list::STEP_SPLASH,
            spans, first, room, unused_1, unused_2),
        host!(EnterRegion as "EnterRegion" in &sim::enter::ENTER,
            face, bin, first, first_of_bin, low, high, begin, end, slope, width, middle, unused),
        host!(VolumeFrustum as "VolumeFrustum" in &sim::step::VOLUME,
            planes, eye, air, half_horizon, half_wait, spread, spread_slope, spread_max, range, farthest, unused),
        host!(VolumeEye as "VolumeEye" in &sim::step::VOLUME,
            position, half_width, right, half_height, up, unused_1, forward, unused_2),
        host!(WindFieldGrid as "WindFieldGrid" in &wind::FIELD, cell, modes, low, primitives, per_cell, size),
        host!(WindFieldSpreadFrame as "WindFieldSpreadFrame" in &wind::FIELD_SPREAD, grid, at, reach),
        host!(WindTurbulenceMode as "WindTurbulenceMode" in &wind::TURBULENCE, wave, phase, amplitude),
        host!(GlassSizeRow as "GlassSizeRow" in &lattice::glass::SIZE,
            radius, hold, slow, air, sphere, loss, ridge, ahead),
        host!(GlassTable as "GlassTable" in &lattice::glass::TABLE, rows, landing),
        host!(GlassBlade as "GlassBlade" in &lattice::glass::BLADE,
            before, after, pivot, reach, turn, leaves, film, unused),
        host!(GlassFrame as "GlassFrame" in &lattice::glass::FRAME,
            size, seed, first_step, first_clock, clock_step, blades, gravity, air, kinetic, trail_chance,
            trail_mass, wet_life, wet_ease, affinity_pull, wet_pull, ridge_drain, ridge_hold, ridge_fresh, unused_1,
            unused_2, rain_few, rain_many),
    ]
}

/// Layout of a struct according to naga: its span and the offsets of its members.
fn layout(module: &'static Module, name: &str) -> (usize, Vec<(String, usize)>) {
    let parsed = parse(&compose(&[module]));
    let found = parsed.types.iter().find(|(_, t)| t.name.as_deref() == Some(name));
    let (_, ty) = found.unwrap_or_else(|| panic!("{name} is not in {}", module.path));
    let naga::TypeInner::Struct { members, span } = &ty.inner else { panic!("{name} is no struct") };
    let members = members.iter().map(|m| (m.name.clone().unwrap_or_default(), m.offset as usize)).collect();
    (*span as usize, members)
}

#[test]
fn host_structs_have_the_layout_of_their_wgsl() {
    for host in hosts() {
        let (span, members) = layout(host.module, host.wgsl);
        assert_eq!(host.size, span, "size of {}", host.wgsl);
        let fields: Vec<_> = host.fields.iter().map(|&(name, at)| (name.to_owned(), at)).collect();
        assert_eq!(fields, members, "{}", host.wgsl);
    }
}

/// Structs that the device alone writes and reads, with their modules and the sizes by which the host makes room for them.
const DEVICE_ONLY: [(&str, &Module, u64); 1] =
    [("TraceState", &render::scene::TRACE, render::scene::TRACE_STATE_BYTES)];

#[test]
fn there_is_room_for_structs_of_the_device_alone() {
    for (name, module, bytes) in DEVICE_ONLY {
        assert_eq!(layout(module, name).0 as u64, bytes, "size of {name}");
    }
}

/// A struct that a buffer holds has a host counterpart, if it is not the device's alone; others are the shader's own.
#[test]
fn every_struct_in_a_buffer_has_a_host() {
    let hosts: Vec<_> = hosts().iter().map(|h| h.wgsl).chain(DEVICE_ONLY.map(|(name, ..)| name)).collect();
    for module in modules() {
        let parsed = parse(&compose(&[module]));
        for (_, variable) in parsed.global_variables.iter() {
            let mut ty = variable.ty;
            while let naga::TypeInner::Array { base, .. } = parsed.types[ty].inner {
                ty = base;
            }
            if let (Some(name), naga::TypeInner::Struct { .. }) =
                (&parsed.types[ty].name, &parsed.types[ty].inner)
            {
                assert!(
                    hosts.contains(&name.as_str()),
                    "{}: {name} has no host struct in this test",
                    module.path
                );
            }
        }
    }
}

/// The check itself can fail: a struct with its fields in another order is seen.
#[test]
fn a_wrong_layout_is_seen() {
    let (_, members) = layout(&bvh::BVH, "BvhNode");
    let swapped = [("low_x", offset_of!(BvhNode, high_x)), ("high_x", offset_of!(BvhNode, low_x))];
    for (name, at) in swapped {
        assert!(members.iter().any(|(n, offset)| n == name && *offset != at), "{name}");
    }
}

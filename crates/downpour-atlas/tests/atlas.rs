//! Atlases: round trip and rejection of files, triangles, and choice of a particle's streak.

#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::sync::LazyLock;

use downpour_atlas::AtlasError;
use downpour_atlas::lookup::{AtlasSlot, atlas_light, atlas_map};
use downpour_atlas::{
    StreakAtlas, StreakOptions, StreakOscillation, StreakParticle, StreakPick, StreakSet, light_directions,
    read_streaks, write_streaks,
};
use downpour_math::rng::{rng_draw, rng_unit};
use half::f16;

const OPTIONS: StreakOptions = StreakOptions {
    columns: 8,
    rows: 4,
    rays: 1,
    half_extent: 1.4,
    light_radius: 0.2,
    refractive_index: 1.333,
};
const ELEVATIONS: [f64; 3] = [-0.7, 0.0, 0.7];

fn set(diameter: f64, oscillation: usize) -> StreakSet {
    let kind = &StreakOscillation::COMMITTED[oscillation];
    StreakSet::trace(diameter, kind, &ELEVATIONS, &light_directions(), &OPTIONS).unwrap()
}

static ATLAS: LazyLock<StreakAtlas> = LazyLock::new(|| {
    StreakAtlas::trace(
        &[1.0e-3, 2.0e-3, 4.0e-3],
        &StreakOscillation::COMMITTED[..2],
        &ELEVATIONS,
        &light_directions(),
        &OPTIONS,
    )
    .unwrap()
});

/// A small set whose texels encode their layer, row and column.
fn counted() -> StreakSet {
    let directions = light_directions();
    let texels = (0..3 * directions.len() * 32).map(|k| f16::from_f32(k as f32)).collect();
    StreakSet { texels, ..set(2.0e-3, 0) }
}

fn drop(diameter: f32, id: u32) -> StreakParticle {
    StreakParticle { diameter, axis: [0.0, 1.0, 0.0], id }
}

/// A direction at random.
fn direction(k: u32) -> [f32; 3] {
    let [a, b, ..] = rng_draw([3, 3], k, 0, 0).map(rng_unit);
    let (z, phi) = (2.0 * a - 1.0, std::f32::consts::TAU * b);
    let r = (1.0 - z * z).max(0.0).sqrt();
    [r * downpour_math::ops::cos(phi), r * downpour_math::ops::sin(phi), z]
}

#[test]
fn a_file_is_read_again_and_by_the_ktx2_crate() {
    let before = set(2.0e-3, 1);
    let bytes = write_streaks(&before).unwrap();
    let after = read_streaks(&bytes).unwrap();
    assert_eq!(before.texels, after.texels);
    assert_eq!((before.amounts.len(), &before.amounts), (25 * 41 * 41, &after.amounts));
    assert!((before.diameter - after.diameter).abs() < 1.0e-15);
    assert_eq!(before.oscillation.amplitudes, after.oscillation.amplitudes);
    assert!((before.oscillation.azimuth - after.oscillation.azimuth).abs() < 1.0e-12);
    for (a, b) in before.directions.iter().flatten().zip(after.directions.iter().flatten()) {
        assert!(a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1.0e-6), "{a:?} {b:?}");
    }
    // A set that was read is written as the same bytes.
    assert_eq!(write_streaks(&after).unwrap(), bytes);
    let reader = ktx2::Reader::new(&bytes[..]).unwrap();
    assert_eq!(reader.header().layer_count, 123);
    assert_eq!(reader.header().format, Some(ktx2::Format::R16_SFLOAT));
    let keys: Vec<_> = reader.key_value_data().map(|(k, _)| k.to_owned()).collect();
    assert_eq!(keys, ["DownpourStreakAmounts", "DownpourStreaks", "KTXorientation", "KTXwriter"]);
}

#[test]
fn lists_of_directions_may_differ_between_elevations() {
    let mut before = counted();
    before.directions[2].swap(0, 5);
    let after = read_streaks(&write_streaks(&before).unwrap()).unwrap();
    assert_ne!(after.directions[2], after.directions[0]);
    assert_eq!(after.directions[1], after.directions[0]);
}

/// A truncated file is an error that names the missing part; flipped bits and bytes are errors or harmless.
#[test]
fn damaged_files_are_refused() {
    let bytes = write_streaks(&counted()).unwrap();
    for length in (0..bytes.len()).step_by(7).chain([bytes.len() - 1]) {
        let error = read_streaks(&bytes[..length]).unwrap_err();
        assert!(!matches!(error, AtlasError::Unreadable { .. }), "{error}");
    }
    for i in 0..3000 {
        let [a, b, c, d] = rng_draw([9, 8], i, 0, 0);
        let mut damaged = bytes.clone();
        let reach = if d & 1 == 0 { damaged.len() } else { 300 };
        damaged[a as usize % reach] = b as u8;
        damaged[c as usize % reach] ^= 1 << (d >> 29);
        let _ = read_streaks(&damaged);
    }
    for at in [20, 24, 32, 36, 40] {
        let mut hostile = bytes.clone();
        hostile[at..at + 4].fill(0xff);
        read_streaks(&hostile).unwrap_err();
    }
}

/// Replaces text of the key in the file; the same length keeps all offsets.
fn with_text(bytes: &[u8], from: &str, to: &str) -> Vec<u8> {
    assert_eq!(from.len(), to.len());
    let at = bytes.windows(from.len()).position(|w| w == from.as_bytes()).unwrap();
    let mut changed = bytes.to_vec();
    changed[at..at + to.len()].copy_from_slice(to.as_bytes());
    changed
}

#[test]
fn another_version_or_digest_is_refused() {
    let bytes = write_streaks(&counted()).unwrap();
    let message = |bytes: &[u8]| read_streaks(bytes).unwrap_err().to_string();
    let version = message(&with_text(&bytes, "version=1", "version=2"));
    assert!(
        version.contains("version") && version.contains("\"2\"") && version.contains("\"1\""),
        "{version}"
    );
    // An edited number no longer has the digest.
    let digest = message(&with_text(&bytes, "diameter_mm=2", "diameter_mm=3"));
    assert!(digest.contains("digest"), "{digest}");
}

#[test]
fn texels_that_are_no_radiances_are_refused() {
    for bad in [f16::NAN, f16::INFINITY, f16::from_f32(-1.0)] {
        let mut set = counted();
        set.amounts = Vec::new();
        set.texels[777] = bad;
        let error = write_streaks(&set).unwrap_err().to_string();
        assert!(error.contains("texel 777") && error.contains("finite"), "{error}");
        // In a file, with the right digest: written by hand, as the writer refuses it.
        let bytes = write_unchecked(&set);
        let error = read_streaks(&bytes).unwrap_err().to_string();
        assert!(error.contains("texel 777"), "{error}");
    }
}

/// A file without amounts is read; its amounts are interpolated between those of its layers.
#[test]
fn a_set_without_amounts_has_those_of_its_layers() {
    let mut set = counted();
    set.amounts = Vec::new();
    let after = read_streaks(&write_streaks(&set).unwrap()).unwrap();
    assert!(after.amounts.is_empty());
    let atlas = StreakAtlas::from_sets(vec![after]).unwrap();
    // Straight ahead, above and aslant: nodes of the grid, and directions of the list.
    for (k, d) in light_directions().iter().enumerate() {
        let [y, z] = atlas_map(d.map(|c| c as f32)).map(|c| (c + 1.0) * 20.0);
        let slot = atlas.slot(&drop(2.0e-3, 0), d.map(|c| c as f32), [0.0, 0.0, 1.0]);
        let layer = 41 + k;
        let wanted = (32.0 * layer as f32 + 15.5) * 4.0 * 1.4 / std::f32::consts::PI;
        if (y - y.round()).abs() < 1.0e-4 && (z - z.round()).abs() < 1.0e-4 {
            // Half floats of the texels are integers up to 2048.
            assert!((slot.amount / wanted - 1.0).abs() < 1.0e-3, "{d:?}: {} for {wanted}", slot.amount);
        }
        // Between the smallest and the largest of its elevation everywhere.
        assert!((32.0 * 41.0 * 1.7..32.0 * 82.0 * 1.8).contains(&slot.amount), "{}", slot.amount);
    }
}

#[test]
fn amounts_that_are_none_are_refused() {
    let message = |change: fn(&mut StreakSet)| {
        let mut set = counted();
        change(&mut set);
        write_streaks(&set).unwrap_err().to_string()
    };
    for bad in [
        message(|set| set.amounts[777] = f16::NAN),
        message(|set| set.amounts[777] = f16::INFINITY),
        message(|set| set.amounts[777] = f16::from_f32(-1.0)),
    ] {
        assert!(bad.contains("DownpourStreakAmounts") && bad.contains("node 777"), "{bad}");
    }
    let short = message(|set| set.amounts.truncate(41));
    assert!(short.contains("DownpourStreakAmounts") && short.contains("25 x 41 x 41"), "{short}");
    // In a file: an amount that is not the digest's, and a key that is gone.
    let bytes = write_streaks(&counted()).unwrap();
    let at = bytes.windows(21).position(|w| w == b"DownpourStreakAmounts").unwrap();
    let mut changed = bytes.clone();
    changed[at + 22 + 100] ^= 1;
    let error = read_streaks(&changed).unwrap_err().to_string();
    assert!(error.contains("digest"), "{error}");
    let mut gone = bytes;
    gone[at] = b'd';
    let error = read_streaks(&gone).unwrap_err().to_string();
    assert!(error.contains("digest"), "{error}");
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("streak.ktx2"), &gone).unwrap();
    let error = StreakAtlas::load(folder.path()).unwrap_err();
    assert!(error.to_string().contains("streak.ktx2") && error.to_string().contains("digest"), "{error}");
}

/// A file of a set whose texels are not checked: a good file whose level and digest are exchanged.
fn write_unchecked(set: &StreakSet) -> Vec<u8> {
    let good = write_streaks(&StreakSet { texels: counted().texels, ..set.clone() }).unwrap();
    let header = ktx2::Header::from_bytes(good.first_chunk().unwrap()).unwrap();
    let level_at = 80;
    let offset = u64::from_le_bytes(good[level_at..level_at + 8].try_into().unwrap()) as usize;
    let texels: Vec<u8> = set.texels.iter().flat_map(|v| v.to_le_bytes()).collect();
    let packed = miniz_oxide::deflate::compress_to_vec_zlib(&texels, 1);
    let mut bytes = good[..offset].to_vec();
    bytes.extend(&packed);
    bytes[level_at + 8..level_at + 16].copy_from_slice(&(packed.len() as u64).to_le_bytes());
    let keys = header.index.kvd_byte_offset as usize;
    let text_at = keys + 4 + "DownpourStreaks".len() + 1;
    let end = text_at + bytes[text_at..].iter().position(|&b| b == 0).unwrap();
    let text = String::from_utf8(bytes[text_at..end].to_vec()).unwrap();
    let (rest, _) = text.rsplit_once(";digest=").unwrap();
    let hash = rest.bytes().chain(texels).fold(0xcbf2_9ce4_8422_2325u64, |hash, byte| {
        (hash ^ u64::from(byte)).wrapping_mul(0x0000_0100_0000_01b3)
    });
    bytes[end - 16..end].copy_from_slice(format!("{hash:016x}").as_bytes());
    bytes
}

#[test]
fn a_folder_is_loaded_or_the_file_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let missing = StreakAtlas::load(&folder.path().join("nowhere")).unwrap_err();
    assert!(matches!(missing, AtlasError::Unreadable { .. }));
    assert!(missing.to_string().contains("nowhere"), "{missing}");
    let empty = StreakAtlas::load(folder.path()).unwrap_err();
    assert!(matches!(empty, AtlasError::Unreadable { .. }));
    assert!(empty.to_string().contains("no .ktx2"), "{empty}");
    for (name, diameter) in [("a.ktx2", 1.0e-3), ("b.ktx2", 2.0e-3)] {
        let set = StreakSet { diameter, ..counted() };
        std::fs::write(folder.path().join(name), write_streaks(&set).unwrap()).unwrap();
    }
    std::fs::write(folder.path().join("SOURCE.md"), "not a texture").unwrap();
    let atlas = StreakAtlas::load(folder.path()).unwrap();
    assert_eq!((atlas.sets().len(), atlas.layers()), (2, 246));
    let cut = std::fs::read(folder.path().join("b.ktx2")).unwrap();
    std::fs::write(folder.path().join("b.ktx2"), &cut[..cut.len() / 2]).unwrap();
    let error = StreakAtlas::load(folder.path()).unwrap_err();
    assert!(error.to_string().contains("b.ktx2") && error.to_string().contains("complete"), "{error}");
}

#[test]
fn sets_that_do_not_belong_together_are_refused() {
    let message = |sets: Vec<StreakSet>| StreakAtlas::from_sets(sets).unwrap_err().to_string();
    let (a, b) = (counted(), StreakSet { diameter: 3.0e-3, ..counted() });
    assert!(message(vec![]).contains("no set"));
    // 2 mm has two oscillations, 3 mm has one.
    let short = message(vec![a.clone(), a.clone(), b.clone()]);
    assert!(short.contains("1 at 3 mm"), "{short}");
    let mut other = b.clone();
    other.options.half_extent = 1.5;
    assert!(message(vec![a.clone(), other]).contains("differs"));
    let twice = StreakSet { directions: vec![vec![[0.0, 0.0, 1.0]; 41]; 3], ..a };
    assert!(message(vec![twice]).contains("twice"));
}

/// The triangles fill the disk but for slivers, none is crossed by a corner's circle (Delaunay), neighbors agree.
#[test]
fn triangles_are_those_of_delaunay() {
    let atlas = &*ATLAS;
    let data = atlas.data();
    let count = data.frame.first[0][1] as usize;
    let triangles = &data.triangles[..count];
    let map: Vec<_> = light_directions().iter().map(|d| atlas_map(d.map(|c| c as f32))).collect();
    let mut area = 0.0;
    for (k, t) in triangles.iter().enumerate() {
        let [a, b, c] = [t.a, t.b, t.c].map(|p| p.map(f64::from));
        let (bx, by) = (b[0] - a[0], b[1] - a[1]);
        let (cx, cy) = (c[0] - a[0], c[1] - a[1]);
        let double = bx * cy - by * cx;
        assert!(double > 0.0, "triangle {k} turns the wrong way");
        area += 0.5 * double;
        // The circle through the three corners, relative to a.
        let (b2, c2) = (bx * bx + by * by, cx * cx + cy * cy);
        let (ux, uy) = ((cy * b2 - by * c2) / (2.0 * double), (bx * c2 - cx * b2) / (2.0 * double));
        let radius = ux * ux + uy * uy;
        for p in &map {
            let (dx, dy) = (f64::from(p[0]) - a[0] - ux, f64::from(p[1]) - a[1] - uy);
            assert!(dx * dx + dy * dy > radius * (1.0 - 1.0e-5), "{p:?} is within the circle of {k}");
        }
        for (corner, &next) in t.next.iter().enumerate() {
            if next != u32::MAX {
                let other = &triangles[next as usize];
                assert!(other.next.contains(&(k as u32)));
                assert!(!other.directions.contains(&t.directions[corner]));
            }
        }
    }
    assert!((0.95..1.0).contains(&(area / std::f64::consts::PI)), "{area}");
}

/// A light exactly at a direction uses that layer alone; in between, weights are fractions of 1.
#[test]
fn places_are_barycentric() {
    let atlas = &*ATLAS;
    let data = atlas.data();
    for (k, d) in light_directions().iter().enumerate() {
        let slot = atlas.slot(&drop(2.0e-3, 1), d.map(|c| c as f32), [0.0, 0.0, 1.0]);
        let weight: f32 =
            (0..3).filter(|&j| (slot.layers[j] as usize % 123) % 41 == k).map(|j| slot.weights[j]).sum();
        assert!(weight > 0.999, "{k}: {slot:?}");
    }
    let mut mirrored = 0;
    for k in 0..4000 {
        let light = direction(k);
        let slot = atlas.slot(&drop(2.0e-3, k), light, [0.0, 0.0, 1.0]);
        assert!(slot.weights.iter().all(|w| (0.0..=1.0).contains(w)), "{slot:?}");
        assert!((slot.weights.iter().sum::<f32>() - 1.0).abs() < 1.0e-6);
        assert_eq!(slot.side, if light[0] < 0.0 { -1.0 } else { 1.0 });
        mirrored += u32::from(slot.side < 0.0);
        // The mean of the corners is the position of the light, but for the slivers at the rim.
        let corners =
            slot.layers.map(|layer| atlas_map(light_directions()[layer as usize % 41].map(|c| c as f32)));
        let at = atlas_map(light);
        for axis in 0..2 {
            let mean: f32 = (0..3).map(|j| slot.weights[j] * corners[j][axis]).sum();
            assert!((mean - at[axis]).abs() < 0.05, "{light:?}: {mean} {}", at[axis]);
        }
    }
    assert!((1600..2400).contains(&mirrored));
    assert_eq!(data.frame.counts, [3, 2, 3, 41]);
}

/// A small move of the light changes the radiance by little: no jump between triangles.
#[test]
fn radiance_is_continuous_over_triangles() {
    let atlas = &*ATLAS;
    for k in 0..2000 {
        let light = direction(k);
        if light[0].abs() < 0.01 {
            continue;
        }
        let shifted = {
            let [x, y, z] = light;
            let (y, z) = (y + 1.0e-4, z - 1.0e-4);
            let length = (x * x + y * y + z * z).sqrt();
            [x / length, y / length, z / length]
        };
        let of = |light| {
            let slot = atlas.slot(&drop(2.0e-3, 5), light, [0.0, 0.0, 1.0]);
            atlas.radiance(&slot, 0.3, 0.4)
        };
        let (a, b) = (of(light), of(shifted));
        assert!((a - b).abs() < 0.02, "{light:?}: {a} {b}");
    }
}

/// Two diameters, and two elevations, around a drop, and the position between them: by the logarithm and by the sine.
#[test]
fn diameter_and_elevation_are_between_those_of_the_sets() {
    let atlas = StreakAtlas::clone(&ATLAS).with_seed(11);
    let light = [0.6, 0.0, -0.8];
    let level = [0.0, 0.0, 1.0];
    let slot = |diameter, view: [f32; 3], id| atlas.slot(&drop(diameter, id), light, view);
    // Layers of 41 directions: three elevations in each of two oscillations of each diameter.
    let position = |diameter| {
        let slot = slot(diameter, level, 0);
        (slot.layers[0] / 41 / 6) as f32 + slot.parts[0]
    };
    let root = 2.0f32.sqrt();
    for (diameter, wanted) in [
        (0.5e-3, 0.0),
        (1.0e-3, 0.0),
        (1.0e-3 * root, 0.5),
        (2.0e-3, 1.0),
        (2.0e-3 * root, 1.5),
        (4.0e-3, 2.0),
        (7.0e-3, 2.0),
    ] {
        assert!((position(diameter) - wanted).abs() < 1.0e-5, "{diameter}: {}", position(diameter));
    }
    let high = downpour_math::ops::sin(0.7);
    for (sine, wanted) in [
        (-0.9f32, 0.0),
        (-high, 0.0),
        (-0.5 * high, 0.5),
        (0.0, 1.0),
        (0.25 * high, 1.25),
        (high, 2.0),
        (0.99, 2.0),
    ] {
        let slot = slot(2.0e-3, [0.0, sine, (1.0 - sine * sine).sqrt()], 0);
        let found = (slot.layers[0] / 41 % 3) as f32 + slot.parts[1];
        assert!((found - wanted).abs() < 1.0e-5, "{sine}: {found}");
    }
    let second = (0..1000).filter(|&id| (slot(2.0e-3, level, id).layers[0] / 41 / 3) % 2 == 1).count();
    assert!((430..570).contains(&second), "{second}");
}

/// If elevations have different directions, patterns are those of the nearest one; amounts are still between.
#[test]
fn other_directions_at_each_elevation_have_patterns_of_the_nearest() {
    let mut set = counted();
    set.amounts = Vec::new();
    set.directions[2].reverse();
    let atlas = StreakAtlas::from_sets(vec![set]).unwrap();
    let amount = |sine: f32| {
        let slot = atlas.slot(&drop(2.0e-3, 0), [0.6, 0.0, -0.8], [0.0, sine, (1.0 - sine * sine).sqrt()]);
        assert_eq!(slot.parts[1].to_bits(), 0.0f32.to_bits());
        (slot.layers[0] / 41, slot.amount)
    };
    let high = downpour_math::ops::sin(0.7);
    for (sine, elevation) in
        [(-0.9, 0), (-0.51 * high, 0), (-0.49 * high, 1), (0.49 * high, 1), (0.51 * high, 2)]
    {
        assert_eq!(amount(sine).0, elevation, "{sine}");
    }
    let [(_, below), (_, above)] = [0.499 * high, 0.501 * high].map(amount);
    assert!((below - above).abs() < 0.01 * above, "{below} {above}");
}

#[test]
fn chance_picks_any_layer() {
    let atlas = StreakAtlas::clone(&ATLAS).with_seed(11);
    let (light, level) = ([0.6, 0.0, -0.8], [0.0, 0.0, 1.0]);
    // At random, every layer is used by some particle, for any light.
    let random = atlas.with_pick(StreakPick::Random);
    let mut met = vec![0u32; random.layers()];
    for id in 0..40 * random.layers() as u32 {
        let AtlasSlot { layers, weights, parts, .. } = random.slot(&drop(2.0e-3, id), light, level);
        assert_eq!((weights, parts), ([1.0, 0.0, 0.0], [0.0, 0.0]));
        met[layers[0] as usize] += 1;
    }
    let chi2: f64 = met.iter().map(|&n| (f64::from(n) - 40.0) * (f64::from(n) - 40.0) / 40.0).sum();
    // 737 degrees of freedom: 5 standard deviations of 38.
    assert!((545.0..930.0).contains(&chi2), "{chi2}");
}

#[test]
fn the_frame_of_a_streak_is_right_handed() {
    let view = [0.0, 0.0, 1.0];
    let near = |a: [f32; 3], b: [f32; 3]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1.0e-6);
    assert!(near(atlas_light([1.0, 0.0, 0.0], view, [0.0, 1.0, 0.0]), [1.0, 0.0, 0.0]));
    assert!(near(atlas_light([0.0, 1.0, 0.0], view, [0.0, 1.0, 0.0]), [0.0, 1.0, 0.0]));
    assert!(near(atlas_light(view, view, [0.0, 0.8, 0.6]), [0.0, 0.0, 1.0]));
    // A drop that falls to the left: its axis is to the right, and a light above the viewer is on its left.
    assert!(near(atlas_light([0.0, 1.0, 0.0], view, [1.0, 0.0, 0.0]), [-1.0, 0.0, 0.0]));
    // Along the axis any frame does, but it is one.
    let [x, y, z] = atlas_light([0.6, 0.0, 0.8], [0.0, 1.0, 0.0], [0.0, 1.0, 0.0]);
    assert!((x * x + y * y + z * z - 1.0).abs() < 1.0e-5);
}

/// Texels are at the expected positions: middle of texel (column, row) of a layer.
#[test]
fn radiance_is_bilinear_and_goes_round() {
    let atlas = StreakAtlas::from_sets(vec![counted()]).unwrap();
    // The amount that makes a pattern of the layer: the mean of its texels, as a disk.
    let mean = |layer: u32| (32.0 * layer as f32 + 15.5) * 4.0 * 1.4 / std::f32::consts::PI;
    let slot = |layer: u32, side| AtlasSlot {
        layers: [layer; 3],
        side,
        weights: [1.0, 0.0, 0.0],
        amount: mean(layer),
        ..AtlasSlot::default()
    };
    let across = |column: f32| (column + 0.5) / 8.0 * 2.8 - 1.4;
    let at = |column, row: f32| atlas.radiance(&slot(2, 1.0), across(column), (row + 0.5) / 4.0);
    assert!((at(3.0, 1.0) - 75.0).abs() < 0.05);
    assert!((at(3.5, 1.0) - 75.5).abs() < 0.05);
    assert!((at(3.0, 1.25) - 77.0).abs() < 0.05);
    assert!((at(3.0, 3.5) - 0.5 * (91.0 + 67.0)).abs() < 0.05, "the last row is next to the first");
    assert!((at(3.0, 9.0) - 75.0).abs() < 0.05, "two turns on");
    assert!((at(7.5, 1.0) - 0.5 * 79.0).abs() < 0.05, "0 outside");
    assert_eq!(at(9.0, 1.0), 0.0);
    let mirrored = atlas.radiance(&slot(2, -1.0), across(3.0), 1.5 / 4.0);
    assert!((mirrored - 76.0).abs() < 0.05, "{mirrored}");
}

#[test]
fn errors_name_their_files() {
    let gone = AtlasError::Unreadable { path: "a".to_owned(), reason: "b".to_owned() };
    let within = AtlasError::InFile { path: "a".to_owned(), error: Box::new(gone) };
    assert_eq!(within.to_string(), "a: a: b");
}

//! Reports for scripts: `--stats` and `--dump-drops`.

use std::fmt::Write as _;

use downpour::weather::Weather;
use downpour::{Computer, Frame};
use serde_json::{Map, Value, json};

use super::frames::Frames;
use crate::listing::number;

/// Statistics of a picture of a rain.
pub(super) fn stats(frame: &Frame, computer: &Computer, weather: &Weather) -> Value {
    let rain = &weather.rain_at(frame.time_s);
    let look = weather.look_at(frame.time_s);
    let Frame { picture, drops, medium, .. } = frame;
    let mut passes = Map::new();
    for (name, ms) in &picture.passes {
        passes.insert((*name).to_owned(), number(*ms));
    }
    let mut stats = json!({
        "adapter": computer.adapter,
        "backend": computer.backend,
        "width": picture.size[0],
        "height": picture.size[1],
        "drops_simulated": drops.simulated,
        "drops_drawn": picture.drawn.len(),
        "drops_on_screen": picture.drops_on_screen,
        "asked_rate_mm_h": number(rain.rate_mm_h),
        "measured_rate_mm_h": frame.measured_rate_mm_h.map(number),
        "unresolved_rate_mm_h": number(medium.unresolved_rate_mm_h()),
        "unresolved_fraction": number(medium.unresolved_fraction()),
        "resolved_to_m": number(drops.resolved.far),
        "resolved_from_mm": number(1.0e3 * drops.resolved.min_diameter),
        "least_pixels": number(drops.resolved.least_pixels),
        "time_s": number(frame.time_s),
        "seed": rain.seed,
        "look": {
            "visibility": number(look.visibility),
            "streak_length": number(look.streak_length),
            "spray": number(look.spray),
            "splash_size": number(weather.splashes_at(frame.time_s).size),
            "milk": weather.rain.layers.map(|layers| number(layers.milk)),
        },
        "triangles": frame.triangles,
        "begin_ms": number(frame.begin_ms),
        "frame_ms": number(frame.frame_ms),
        "passes": Value::Object(passes),
    });
    if let Some(device) = picture.device {
        stats["bytes_uploaded"] = json!(device.bytes_uploaded);
        stats["buffers_made"] = json!(device.buffers_made);
    }
    stats
}

/// The text of `--stats`.
pub(super) fn text(stats: &Value) -> String {
    format!("{stats:#}\n")
}

/// Statistics of a clip in addition to its frames.
pub(super) struct ClipStats {
    pub(super) frames: Frames,
    pub(super) fps: f64,
    /// Frames that this run made; the others were there.
    pub(super) made: u32,
    /// Encoding time of the video, if there is one.
    pub(super) encode_ms: Option<f64>,
}

/// Keys whose value in a clip is the mean of its frames; `time_s` is that of the first.
const MEANS: [&str; 9] = [
    "asked_rate_mm_h",
    "drops_simulated",
    "drops_drawn",
    "drops_on_screen",
    "measured_rate_mm_h",
    "begin_ms",
    "frame_ms",
    "bytes_uploaded",
    "buffers_made",
];

/// Statistics of a clip: the keys of a picture, with counts, the measured rate and times as means of the
/// frames, and `frames` with the statistics of each.
pub(super) fn clip_stats(frames: &[(u32, &Value)], totals: &ClipStats) -> Value {
    let Some((_, Value::Object(first))) = frames.first() else { return Value::Null };
    let mut clip = first.clone();
    for key in MEANS.into_iter().filter(|key| first.contains_key(*key)) {
        clip.insert(key.to_owned(), mean(frames.iter().map(|(_, frame)| &frame[key])));
    }
    let passes = first.get("passes").and_then(Value::as_object).cloned().unwrap_or_default();
    let passes = passes.into_iter().map(|(name, _)| {
        let value = mean(frames.iter().map(|(_, frame)| &frame["passes"][&name]));
        (name, value)
    });
    clip.insert("passes".to_owned(), Value::Object(passes.collect()));
    clip.insert("fps".to_owned(), number(totals.fps));
    clip.insert("first_frame".to_owned(), json!(totals.frames.first));
    clip.insert("frame_count".to_owned(), json!(totals.frames.count()));
    clip.insert("frames_made".to_owned(), json!(totals.made));
    clip.insert("encode_ms".to_owned(), totals.encode_ms.map_or(Value::Null, number));
    let each = frames.iter().map(|(number, frame)| {
        let mut numbered = Map::new();
        numbered.insert("frame".to_owned(), json!(number));
        numbered.extend(frame.as_object().cloned().unwrap_or_default());
        Value::Object(numbered)
    });
    clip.insert("frames".to_owned(), each.collect());
    Value::Object(clip)
}

fn mean<'a>(values: impl Iterator<Item = &'a Value>) -> Value {
    let (sum, count) =
        values.filter_map(Value::as_f64).fold((0.0, 0u32), |(sum, count), v| (sum + v, count + 1));
    number(sum / f64::from(count))
}

/// The text of `--dump-drops`: each drop that was drawn, nearest first, in the world.
pub(super) fn drops(frame: &Frame) -> String {
    let (drawn, drops) = (&frame.picture.drawn, &frame.drops.drops);
    let mut text = String::from("id,x_m,y_m,z_m,vx_m_s,vy_m_s,vz_m_s,diameter_mm,kind\n");
    for drop in drawn.iter().filter_map(|&index| drops.get(index as usize)) {
        let [x, y, z] = drop.position.to_array();
        let [vx, vy, vz] = drop.velocity.map(|v| v + 0.0);
        let (mm, kind) = (drop.diameter * 1.0e3, drop.kind.name());
        let _ = writeln!(text, "{},{x},{y},{z},{vx},{vy},{vz},{mm},{kind}", drop.id);
    }
    text
}

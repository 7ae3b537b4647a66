//! Contents of `--stats` of a clip.

use serde_json::Value;

/// A frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Frame {
    pub(super) number: u32,
    pub(super) simulated: f64,
    pub(super) on_screen: f64,
    pub(super) drawn: f64,
    /// Time of the whole frame.
    pub(super) frame_ms: f64,
    /// Of the passes that draw drops.
    pub(super) drops_ms: f64,
    /// Time outside the passes: the simulation, collision data, and the scene's pose.
    pub(super) step_ms: f64,
}

impl Frame {
    /// Fraction of the simulated drops that are on screen; 0 without drops.
    pub(super) fn fraction(&self) -> f64 {
        if self.simulated > 0.0 { self.on_screen / self.simulated } else { 0.0 }
    }
}

/// The frames of a clip.
pub(super) fn read(text: &str) -> Result<Vec<Frame>, String> {
    let stats: Value = serde_json::from_str(text).map_err(|error| error.to_string())?;
    let frames = stats["frames"].as_array().filter(|frames| !frames.is_empty());
    frames.ok_or("it has no frames")?.iter().map(frame).collect()
}

fn frame(value: &Value) -> Result<Frame, String> {
    let number = |value: &Value, key: &str| {
        value[key].as_f64().ok_or_else(|| format!("a frame does not tell \"{key}\""))
    };
    let passes = value["passes"].as_object().ok_or("a frame does not tell \"passes\"")?;
    let all: f64 = passes.values().filter_map(Value::as_f64).sum();
    let frame_ms = number(value, "frame_ms")?;
    Ok(Frame {
        number: number(value, "frame")? as u32,
        simulated: number(value, "drops_simulated")?,
        on_screen: number(value, "drops_on_screen")?,
        drawn: number(value, "drops_drawn")?,
        frame_ms,
        drops_ms: ["binning", "drops"].iter().filter_map(|name| passes.get(*name)?.as_f64()).sum(),
        step_ms: frame_ms - all,
    })
}

#[cfg(test)]
pub(super) mod tests {
    use super::*;

    /// A clip of two frames.
    pub(in super::super) const CLIP: &str = r#"{ "drops_simulated": 10, "frames": [
        { "frame": 0, "drops_simulated": 1000, "drops_drawn": 900, "drops_on_screen": 960, "frame_ms": 90.0,
          "passes": { "scene": 40.0, "binning": 2.0, "capture": 10.0, "drops": 8.0 } },
        { "frame": 1, "drops_simulated": 1000, "drops_drawn": 700, "drops_on_screen": 950, "frame_ms": 70.0,
          "passes": { "scene": 30.0, "binning": 1.0, "capture": 10.0, "drops": 9.0 } } ] }"#;

    #[test]
    fn a_clip_is_read() {
        let frames = read(CLIP).expect("a clip");
        assert_eq!(frames.len(), 2);
        let first = frames[0];
        assert_eq!((first.number, first.drawn, first.drops_ms, first.step_ms), (0, 900.0, 10.0, 30.0));
        assert!((first.fraction() - 0.96).abs() < 1.0e-12);
    }

    #[test]
    fn what_is_missing_is_named() {
        assert_eq!(read("{}"), Err("it has no frames".to_owned()));
        let less = CLIP.replace("\"drops_on_screen\": 950,", "");
        assert_eq!(read(&less), Err("a frame does not tell \"drops_on_screen\"".to_owned()));
        assert!(read("no JSON").is_err());
    }
}

//! Frames of a clip and their times.

/// The most frames of a clip, and the last number that one may have.
const MAX_FRAMES: u32 = 1_000_000;

/// The frames of a clip by their numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Frames {
    /// The first one.
    pub(super) first: u32,
    /// The one after the last one.
    pub(super) end: u32,
}

impl Frames {
    pub(super) fn count(self) -> u32 {
        self.end - self.first
    }

    pub(super) fn numbers(self) -> std::ops::Range<u32> {
        self.first..self.end
    }

    pub(super) fn last(self) -> u32 {
        self.end - 1
    }
}

/// `A..B`: the frames from A to the one before B.
pub(super) fn frames(text: &str) -> Result<Frames, String> {
    let allowed = format!(
        "allowed: A..B, frames A to B - 1, for example 0..240, with B above A and at most {MAX_FRAMES}"
    );
    let number = |part: &str| {
        let digits = !part.is_empty() && part.bytes().all(|b| b.is_ascii_digit());
        part.parse::<u32>().ok().filter(|number| digits && *number <= MAX_FRAMES)
    };
    let ends = text.split_once("..").and_then(|(first, end)| Some((number(first)?, number(end)?)));
    match ends {
        Some((first, end)) if first < end => Ok(Frames { first, end }),
        _ => Err(allowed),
    }
}

/// Frames per second.
pub(super) fn fps(text: &str) -> Result<f64, String> {
    let found = text.parse::<f64>().ok().filter(|fps| (1.0e-3..=1.0e3).contains(fps));
    found.ok_or_else(|| "allowed: 0.001 to 1000 frames per second".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_have_a_beginning_and_an_end_after_it() {
        assert_eq!(frames("0..1"), Ok(Frames { first: 0, end: 1 }));
        assert_eq!(frames("007..24").map(Frames::count), Ok(17));
        assert!(frames("0..1000000").is_ok());
        for text in [
            "",
            "5",
            "0..0",
            "2..1",
            "-1..3",
            "0..-1",
            "0..=3",
            "0...3",
            "..3",
            "3..",
            "a..b",
            "+1..3",
            " 0..3",
            "0..1000001",
            "0..4294967296",
            "0..99999999999999999999",
            "0.5..3",
        ] {
            assert!(frames(text).is_err_and(|error| error.contains("A..B")), "{text}");
        }
    }

    #[test]
    fn rates_are_finite_and_in_range() {
        assert_eq!((fps("0.001"), fps("1000"), fps("23.976")), (Ok(0.001), Ok(1000.0), Ok(23.976)));
        for text in ["0", "-24", "nan", "inf", "0.0009", "1000.1", "1e39", "", "24fps"] {
            assert!(fps(text).is_err(), "{text}");
        }
    }
}

//! Rounds of timed frames, and the rows of the table.

use std::fmt::{Display, Formatter};
use std::thread::sleep;
use std::time::{Duration, Instant};

use crate::contender::Entry;
use crate::device::Device;
use crate::picture::Picture;
use crate::{SIZE, picture};

/// Time for the first drop to be on a picture: shaders are loaded and compiled until then.
const PATIENCE: Duration = Duration::from_secs(120);

/// Time that an entry without drops gets for its shaders.
const EMPTY_WAIT: Duration = Duration::from_secs(2);

/// Frames of a round that are not timed: the caches hold what was drawn before.
const RESUMED: u32 = 3;

/// How often and how long is timed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rounds {
    /// Timed frames of a round.
    pub(crate) frames: u32,
    /// Rounds.
    pub(crate) rounds: u32,
    /// Frames before the first round.
    pub(crate) warm_up: u32,
    /// Frames after which the CPU waits until the device is idle.
    pub(crate) wait_every: u32,
    /// Time after which a round ends with fewer frames.
    pub(crate) limit: Duration,
}

impl Rounds {
    /// Sentence above the table.
    pub(crate) fn caption(&self, device: &Device) -> String {
        let Self { frames, rounds, wait_every, limit, .. } = self;
        let wait = match wait_every {
            1 => "the device idle after every frame".to_owned(),
            _ => format!("the device idle after every {wait_every} frames"),
        };
        format!(
            "{}, {} x {} pixels: medians of {rounds} rounds of {frames} frames (fewer after {} s), {wait}.",
            device.name(),
            SIZE[0],
            SIZE[1],
            limit.as_secs()
        )
    }

    /// Times all entries, round by round.
    ///
    /// # Errors
    /// An entry that fails, or shows no drops.
    pub(crate) fn run(&self, device: &Device, entries: &mut [Entry]) -> Result<Vec<Row>, String> {
        for index in 0..entries.len() {
            // An entry without drops stands before those with drops: its frames are there.
            let plate = entries[index].empty.and_then(|empty| entries[empty].contender.picture());
            let plate = plate.map(|plate| picture::read(device, plate)).transpose()?;
            self.settle(device, &mut entries[index], plate.as_ref())?;
            self.frames(device, &mut entries[index], self.warm_up)?;
        }
        let mut times = vec![Vec::new(); entries.len()];
        for round in 0..self.rounds {
            for k in 0..entries.len() {
                let index = if round % 2 == 0 { k } else { entries.len() - 1 - k };
                self.frames(device, &mut entries[index], RESUMED)?;
                times[index].push(self.frames(device, &mut entries[index], self.frames)?);
            }
        }
        for times in &mut times {
            times.sort_by(f64::total_cmp);
        }
        let adapter = device.adapter.get_info().name;
        let row = |(entry, times): (&Entry, &Vec<f64>)| {
            let ms = median(times);
            Row {
                name: entry.name.clone(),
                drops: entry.drops,
                ms,
                range: [times.first().copied().unwrap_or(ms), times.last().copied().unwrap_or(ms)],
                of_drops_ms: None,
                adapter: adapter.clone(),
            }
        };
        let mut rows: Vec<Row> = entries.iter().zip(&times).map(row).collect();
        for (k, entry) in entries.iter().enumerate() {
            rows[k].of_drops_ms = entry.empty.map(|empty| rows[k].ms - rows[empty].ms);
        }
        Ok(rows)
    }

    /// Makes frames until their number or the time is reached, waits until the device is idle after every few and at the end, and
    /// returns their mean time, ms.
    fn frames(&self, device: &Device, entry: &mut Entry, count: u32) -> Result<f64, String> {
        let begin = Instant::now();
        let mut made = 0;
        while made < count && (made == 0 || begin.elapsed() < self.limit) {
            entry.contender.frame().map_err(|message| format!("{}: {message}", entry.name))?;
            made += 1;
            if made % self.wait_every == 0 {
                device.wait()?;
            }
        }
        device.wait()?;
        Ok(begin.elapsed().as_secs_f64() * 1.0e3 / f64::from(made.max(1)))
    }

    /// Makes frames until the picture differs from that of the frames without drops; a while where there are none.
    fn settle(&self, device: &Device, entry: &mut Entry, plate: Option<&Picture>) -> Result<(), String> {
        let begin = Instant::now();
        loop {
            self.frames(device, entry, RESUMED)?;
            let done = match (entry.contender.picture(), plate) {
                (Some(texture), Some(plate)) => picture::read(device, texture)? != *plate,
                (Some(_), None) => begin.elapsed() > EMPTY_WAIT,
                (None, _) => true,
            };
            if done {
                entry.contender.settled();
                return Ok(());
            }
            if begin.elapsed() > PATIENCE {
                let waited = PATIENCE.as_secs();
                return Err(format!("{}: no drop is on the picture after {waited} s", entry.name));
            }
            sleep(Duration::from_millis(10));
        }
    }
}

/// Median of sorted numbers.
fn median(sorted: &[f64]) -> f64 {
    let (low, high) = (sorted.len().saturating_sub(1) / 2, sorted.len() / 2);
    let at = |k: usize| sorted.get(k).copied().unwrap_or(f64::NAN);
    0.5 * (at(low) + at(high))
}

/// A row of the table.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    name: String,
    drops: u64,
    /// Median time of a frame, ms.
    ms: f64,
    /// Least and largest time of a frame in a round, ms.
    range: [f64; 2],
    /// Time above that of the empty frame, ms.
    of_drops_ms: Option<f64>,
    adapter: String,
}

impl Row {
    /// Head of the table.
    pub(crate) const HEAD: &str = "| what | drops | ms per frame | range of the rounds | ms above the empty frame | \
                                   drops per second | adapter |\n|---|--:|--:|--:|--:|--:|---|";
}

impl Display for Row {
    fn fmt(&self, f: &mut Formatter<'_>) -> std::fmt::Result {
        let Self { name, drops, ms, range: [low, high], of_drops_ms, adapter } = self;
        let above = of_drops_ms.map_or_else(|| "-".to_owned(), |above| format!("{above:.2}"));
        let rate = match drops {
            0 => "-".to_owned(),
            _ => format!("{:.2e}", *drops as f64 / ms * 1.0e3),
        };
        write!(f, "| {name} | {drops} | {ms:.2} | {low:.2} to {high:.2} | {above} | {rate} | {adapter} |")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_median_is_in_the_middle() {
        assert_eq!(median(&[1.0, 2.0, 9.0]).to_bits(), 2.0f64.to_bits());
        assert_eq!(median(&[1.0, 2.0, 4.0, 9.0]).to_bits(), 3.0f64.to_bits());
        assert!(median(&[]).is_nan());
    }

    #[test]
    fn a_row_says_drops_per_second_of_the_whole_frame() {
        let row = Row {
            name: "rain".to_owned(),
            drops: 1000,
            ms: 2.0,
            range: [1.0, 3.0],
            of_drops_ms: Some(1.5),
            adapter: "one".to_owned(),
        };
        assert_eq!(row.to_string(), "| rain | 1000 | 2.00 | 1.00 to 3.00 | 1.50 | 5.00e5 | one |");
    }
}

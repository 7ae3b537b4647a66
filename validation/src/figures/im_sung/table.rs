//! The numbers of all runs as Markdown and as CSV.

use super::stats::Frame;
use super::weather::Rain;

/// P8: minimum fraction of the simulated drops that our rain has on screen.
pub(super) const MIN_FRACTION: f64 = 0.95;

/// A run and its results.
#[derive(Clone, Debug)]
pub(super) struct Run {
    /// `path`, `number` or `zoom`.
    pub(super) set: &'static str,
    /// Of its folder.
    pub(super) name: String,
    pub(super) rain: Rain,
    /// At least one.
    pub(super) frames: Vec<Frame>,
}

/// Mean and least of a value over the frames.
fn over(frames: &[Frame], value: impl Fn(&Frame) -> f64) -> [f64; 2] {
    let values: Vec<f64> = frames.iter().map(value).collect();
    let mean = values.iter().sum::<f64>() / values.len().max(1) as f64;
    [mean, values.iter().copied().reduce(f64::min).unwrap_or(0.0)]
}

impl Run {
    /// Mean and minimum fraction of the drops on screen.
    pub(super) fn fraction(&self) -> [f64; 2] {
        over(&self.frames, Frame::fraction)
    }

    /// Error text of a run of ours below the aim.
    pub(super) fn miss(&self) -> Option<String> {
        let [mean, least] = self.fraction();
        let percent = |fraction: f64| 100.0 * fraction;
        (least.is_nan() || least < MIN_FRACTION).then(|| {
            format!(
                "{}: {:.1} % of the simulated drops on screen, least {:.1} %; aim {:.0} %",
                self.name,
                percent(mean),
                percent(least),
                percent(MIN_FRACTION)
            )
        })
    }
}

/// Fraction of drops on screen, of runs along a path or of single pictures.
pub(super) fn fractions(runs: &[Run], set: &str) -> String {
    let mut text = "| model | field of view | simulated | on screen: mean | least | fraction: mean | least | seen: mean |\n\
                    |---|--:|--:|--:|--:|--:|--:|--:|\n"
        .to_owned();
    for run in runs.iter().filter(|run| run.set == set) {
        let ([simulated, _], [mean, least]) =
            (over(&run.frames, |f| f.simulated), over(&run.frames, |f| f.on_screen));
        let ([drawn, _], [fraction, least_fraction]) = (over(&run.frames, |f| f.drawn), run.fraction());
        text += &format!(
            "| {} | {:.0}° | {simulated:.0} | {mean:.0} | {least:.0} | {:.2} % | {:.2} % | {drawn:.0} |\n",
            run.rain.model.title(),
            run.rain.fov_deg.unwrap_or(super::walk::FOV_DEG),
            100.0 * fraction,
            100.0 * least_fraction,
        );
    }
    text
}

/// Figure 7: time per frame against the number of drops.
pub(super) fn times(runs: &[Run]) -> String {
    let mut text =
        "| model | at most | simulated | on screen | frame, ms | drawing drops, ms | stepping, ms |\n\
                    |---|--:|--:|--:|--:|--:|--:|\n"
            .to_owned();
    for run in runs.iter().filter(|run| run.set == "number") {
        let mean = |value: fn(&Frame) -> f64| over(&run.frames, value)[0];
        // The minimum: other processes only add to a time.
        let least = |value: fn(&Frame) -> f64| over(&run.frames, value)[1];
        text += &format!(
            "| {} | {} | {:.0} | {:.0} | {:.0} | {:.1} | {:.0} |\n",
            run.rain.model.title(),
            run.rain.max_drops,
            mean(|f| f.simulated),
            mean(|f| f.on_screen),
            least(|f| f.frame_ms),
            least(|f| f.drops_ms),
            least(|f| f.step_ms),
        );
    }
    text
}

/// A row for each run.
pub(super) fn csv(runs: &[Run]) -> String {
    let mut text =
        "set,model,rate_mm_h,max_drops,fov_deg,frames,simulated,on_screen_mean,on_screen_least,drawn_mean,\
                    share_mean,share_least,frame_ms_mean,frame_ms_least,drops_ms_least,step_ms_least\n"
            .to_owned();
    for run in runs {
        let rain = &run.rain;
        let ([seen, least_seen], [fraction, least_fraction]) =
            (over(&run.frames, |f| f.on_screen), run.fraction());
        let [frame, least_frame] = over(&run.frames, |f| f.frame_ms);
        text += &format!(
            "{},{},{},{},{},{},{:.1},{seen:.1},{least_seen},{:.1},{fraction:.5},{least_fraction:.5},{frame:.2},{least_frame:.2},\
             {:.2},{:.2}\n",
            run.set,
            rain.model.key(),
            rain.rate_mm_h,
            rain.max_drops,
            rain.fov_deg.unwrap_or(super::walk::FOV_DEG),
            run.frames.len(),
            over(&run.frames, |f| f.simulated)[0],
            over(&run.frames, |f| f.drawn)[0],
            over(&run.frames, |f| f.drops_ms)[1],
            over(&run.frames, |f| f.step_ms)[1],
        );
    }
    text
}

/// A row for each frame of each run.
pub(super) fn frames_csv(runs: &[Run], fps: u32) -> String {
    let mut text = "set,model,max_drops,frame,time_s,simulated,on_screen,drawn,share,frame_ms\n".to_owned();
    for run in runs {
        for frame in &run.frames {
            text += &format!(
                "{},{},{},{},{:.4},{},{},{},{:.5},{:.2}\n",
                run.set,
                run.rain.model.key(),
                run.rain.max_drops,
                frame.number,
                f64::from(frame.number) / f64::from(fps),
                frame.simulated,
                frame.on_screen,
                frame.drawn,
                frame.fraction(),
                frame.frame_ms,
            );
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::super::stats::{read, tests::CLIP};
    use super::super::weather::Model;
    use super::*;

    fn run(set: &'static str, model: Model) -> Run {
        let rain = Rain { model, rate_mm_h: 60.0, max_drops: 1000, fov_deg: None };
        Run { set, name: format!("{set}-{}", model.key()), rain, frames: read(CLIP).expect("a clip") }
    }

    #[test]
    fn shares_are_means_and_the_least() {
        let text = fractions(&[run("path", Model::View), run("number", Model::Tariq)], "path");
        let rows: Vec<&str> = text.lines().skip(2).collect();
        assert_eq!(rows, ["| ours (view) | 18° | 1000 | 955 | 950 | 95.50 % | 95.00 % | 800 |"]);
    }

    #[test]
    fn times_are_the_least() {
        let text = times(&[run("path", Model::View), run("number", Model::Tariq)]);
        let rows: Vec<&str> = text.lines().skip(2).collect();
        assert_eq!(rows, ["| Tariq 2007 | 1000 | 1000 | 955 | 70 | 10.0 | 20 |"]);
    }

    #[test]
    fn all_rows_of_a_file_have_its_columns() {
        let runs = [run("path", Model::View), run("number", Model::Tariq)];
        for (text, rows) in [(csv(&runs), 3), (frames_csv(&runs, 12), 5)] {
            let columns: Vec<usize> = text.lines().map(|line| line.split(',').count()).collect();
            assert_eq!(columns.len(), rows);
            assert!(columns.iter().all(|&n| n == columns[0]), "{text}");
        }
        assert!(csv(&runs).contains(
            "path,view,60,1000,18,2,1000.0,955.0,950,800.0,0.95500,0.95000,80.00,70.00,10.00,20.00"
        ));
    }

    #[test]
    fn less_than_the_aim_is_told() {
        let mut ours = run("path", Model::View);
        assert_eq!(ours.miss(), None);
        ours.frames[1].on_screen = 949.0;
        let words = "path-view: 95.4 % of the simulated drops on screen, least 94.9 %; aim 95 %";
        assert_eq!(ours.miss().as_deref(), Some(words));
    }
}

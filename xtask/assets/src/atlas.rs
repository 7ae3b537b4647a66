//! assets/streaks: written by `cargo xtask atlas` and compared by `--check`, byte for byte; the Columbia database in the
//! same format.

mod columbia;
mod sheet;

use std::path::PathBuf;

use downpour_atlas::{StreakOptions, StreakOscillation, StreakSet, light_directions, write_streaks};

use xtask::run;

use crate::files::{self, Asset};

const USAGE: &str = "\
cargo xtask atlas [--check] [--quick]              write assets/streaks, or compare it; --quick: one set of it
cargo xtask atlas --columbia FOLDER WIDTH OUTPUT   the Columbia database's streaks of 4, 8, 16 or 32 columns as KTX2";

/// Diameters in millimeters. Between 1 and 4 mm a drop changes from a sphere to a bun, which moves its bows, most of all from 2 mm on;
/// larger ones are rare.
const DIAMETERS_MM: [f64; 4] = [1.0, 2.0, 2.8, 4.0];
/// Those that are shown.
const SHOWN_MM: [f64; 2] = [2.0, 4.0];
/// Elevations of the viewer in degrees: rain is seen horizontally, from below or from above.
const ELEVATIONS_DEG: [f64; 3] = [-40.0, 0.0, 40.0];
/// The most bytes that the folder may hold.
const BUDGET: usize = 4 << 20;

/// Runs the task with its arguments.
pub(crate) fn run(arguments: &[&str]) -> Result<(), String> {
    match arguments {
        [] => write(false),
        ["--quick"] => write(true),
        ["--check"] => check(false),
        ["--check", "--quick"] | ["--quick", "--check"] => check(true),
        ["--columbia", folder, width, output] => columbia::run(folder.as_ref(), width, output.as_ref()),
        _ => Err(format!("atlas {}: not understood; there is:\n{USAGE}", arguments.join(" "))),
    }
}

fn folder() -> PathBuf {
    run::root().join("assets/streaks")
}

fn set(diameter_mm: f64, oscillation: usize) -> Result<StreakSet, String> {
    let elevations = ELEVATIONS_DEG.map(f64::to_radians);
    let kind = &StreakOscillation::COMMITTED[oscillation];
    StreakSet::trace(diameter_mm * 1.0e-3, kind, &elevations, &light_directions(), &StreakOptions::default())
        .map_err(|error| error.to_string())
}

/// Every file of the folder that the code makes; `quick`: the first of 2 mm alone.
fn make(quick: bool) -> Result<Vec<Asset>, String> {
    let (mut assets, mut shown) = (Vec::new(), Vec::new());
    let diameters: &[f64] = if quick { &DIAMETERS_MM[1..2] } else { &DIAMETERS_MM };
    let oscillations = if quick { 1 } else { StreakOscillation::COMMITTED.len() };
    for &diameter in diameters {
        for oscillation in 0..oscillations {
            let set = set(diameter, oscillation)?;
            let bytes = write_streaks(&set).map_err(|error| error.to_string())?;
            assets.push((format!("streak_{diameter}mm_{}.ktx2", oscillation + 1), bytes));
            if oscillation < 2 && SHOWN_MM.contains(&diameter) {
                shown.push(set);
            }
        }
    }
    if !quick {
        assets.push(("preview.png".to_owned(), sheet::sheet(&shown)?));
    }
    let bytes = files::total(&assets);
    if bytes > BUDGET {
        return Err(format!("the streaks take {bytes} bytes, more than {BUDGET}"));
    }
    Ok(assets)
}

fn write(quick: bool) -> Result<(), String> {
    files::write(&folder(), &make(quick)?)
}

/// Compares the folder with generated files.
pub(crate) fn check(quick: bool) -> Result<(), String> {
    let which = if quick { "one of assets/streaks" } else { "assets/streaks" };
    files::verdict(which, "atlas", &files::differences(&folder(), &make(quick)?))
}

#[cfg(test)]
mod tests {
    use downpour_atlas::StreakAtlas;

    #[test]
    fn what_is_not_understood_is_answered_with_the_usage() {
        let message = super::run(&["--chekc"]).expect_err("no such option");
        assert!(
            message.contains("--chekc") && message.contains("--columbia FOLDER WIDTH OUTPUT"),
            "{message}"
        );
    }

    /// The committed files are an atlas, and each of them is a texture array on any device.
    #[test]
    fn the_committed_atlas_is_loaded() {
        let atlas = StreakAtlas::load(&super::folder()).expect("assets/streaks");
        assert_eq!(atlas.data().frame.counts, [4, 4, 3, 41]);
        assert!(atlas.sets().iter().all(|set| set.layers() <= 256));
    }
}

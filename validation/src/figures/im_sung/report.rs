//! Report of the runs, as Markdown.

use super::options::Options;
use super::table::{self, Run};
use super::weather::{self, Model};
use super::{MAX_DROPS, NUMBERS, NUMBERS_FRAMES, NUMBERS_RATE_MM_H, RATE_MM_H, ZOOM_DEG, walk};

/// Method, numbers, and contents of the sheets.
pub(super) fn text(runs: &[Run], options: &Options) -> String {
    let [width, height] = options.size;
    let moments: Vec<String> =
        walk::MOMENTS.iter().map(|(name, time)| format!("{name} ({time:.2} s)")).collect();
    let numbers = NUMBERS.map(|number| number.to_string()).join(", ");
    let (times, last) = if options.quick {
        (String::new(), String::new())
    } else {
        let times = format!(
            "## Time per frame against the number of drops (figure 7)\n\nThe least of {NUMBERS_FRAMES} frames. Stepping is all \
             that is outside the passes: the drops, the map of what stops them, and the scene's hierarchy, which is built \
             anew for each frame of a scene that moves.\n\n{}\n",
            table::times(runs)
        );
        (times, format!("| `fig11-numbers.png` | ours with {numbers} drops at most |\n"))
    };
    let columns = |moments: [usize; 3]| moments.map(|moment| walk::MOMENTS[moment].0).join(", ");
    format!(
        "# Im & Sung 2022, figures 6 to 11\n\n\
         `cargo xtask figures im-sung`: {width} x {height} pixels, {} frames per second, backend {}. The camera stands, moves \
         {way} m ahead within 1 s, turns about in 0.5 s, and stands; vertical field of view {fov}°.\n\n\
         Drops are as large as drops are: a gamma law (shape {shape}) with a median volume diameter of {median} mm, \
         {RATE_MM_H} mm/h along the path and {NUMBERS_RATE_MM_H} mm/h for figures 7 and 11, frozen (shutter 0), none farther \
         than {far} m. The papers' streaks have no such size, so that theirs may be 50 m away.\n\n\
         {MAX_DROPS} drops at most, for all four. Tariq's box of 10 m, Creus and Patow's cylinder of the same volume round the \
         first eye, and Im & Sung's sphere then leave out the smaller drops of the rain, a whole class of sizes at a time, so \
         that they have up to a fifth less than they may; ours shortens the distance up to which each size is simulated. None \
         of the four shows all of the rain.\n\n\
         On screen: the drop's outline touches the picture, it is at least 0.4 pixel wide (ours: more, where the distance is \
         shortened), and not under a roof. Seen: nothing hides it altogether. Aim (P8) for ours: {aim:.0} % of the simulated drops on \
         screen in every frame; a margin of 2 % along each edge of the picture is simulated and off screen.\n\n\
         ## Along the path (figures 6, 8, 9, 10)\n\n{}\n## Zoom (figure 10)\n\n{}\n\
         {times}## Sheets\n\n\
         Each has the pictures above and, below, the same drops as streaks of 1/60 s on the darkened picture.\n\n\
         | file | from left to right |\n|---|---|\n\
         | `fig06-same-number.png` | {}, all before the camera moves |\n\
         | `fig08-tariq.png` | Tariq: {three} |\n\
         | `fig09-creus-patow.png` | Creus & Patow: {three} |\n\
         | `fig10-im-sung.png`, `fig10-ours.png` | Im & Sung, ours: {three} |\n\
         | `fig10-zoom-im-sung-2022.png`, `fig10-zoom-view.png` | fields of view of {}° |\n\
         {last}| `path.png` | streaks alone; rows: {}; columns: {} |\n",
        options.fps,
        options.backend,
        table::fractions(runs, "path"),
        table::fractions(runs, "zoom"),
        Model::ALL.map(Model::title).join(", "),
        ZOOM_DEG.map(|fov| fov.to_string()).join(", "),
        Model::ALL.map(Model::title).join(", "),
        moments.join(", "),
        way = walk::PATH_M,
        fov = walk::FOV_DEG,
        shape = weather::SHAPE,
        median = weather::MEDIAN_MM,
        far = weather::FAR_M,
        aim = 100.0 * table::MIN_FRACTION,
        three = columns([0, 2, 4]),
    )
}

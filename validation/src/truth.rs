//! `cargo xtask truth`: the drop of `downpour specimen` compared with Mitsuba 3, which shares with us only the mesh,
//! the sky map and the camera.
//!
//! Aim: inside the silhouette, a mean FLIP of at most 0.03 and a mean luminance within 2 %. FLIP is LDR-FLIP
//! (Andersson et al. 2020) at 67 pixels per degree, both pictures with the same exposure: the one that puts the
//! logarithmic mean of Mitsuba's picture within the silhouette at 0.18, cut at 1, with the curve of sRGB.
//!
//! The mesh is fine enough: at 5 mm, mean FLIP is 0.019, 0.0071, 0.0034, 0.0027 and 0.0027 with 4 to 8 subdivisions of the
//! icosahedron. Each case has its negative control: our picture mirrored has to be above the aim.
//!
//! Streaks (`streaks`) are compared with the mean of Mitsuba's pictures of their instants, before the same maps and under lamps:
//! back-lit at 20 degrees from the axis, and from beside.
//!
//! Mitsuba and FLIP come from `PyPI` into `target/truth/venv` (pinned in `truth/requirements.txt`), so that the task needs
//! the network once, and is not one of the tests. All its output is under `target/truth`.

mod cases;
mod mesh;
mod mitsuba;
mod options;
mod report;
mod scenes;
mod sky;
mod streaks;

use std::path::Path;

use downpour_drop::DropShape;

use cases::Case;
use mitsuba::Mitsuba;
pub(crate) use options::Options;
use report::{Outcome, Report};
use xtask::run;

/// Renders every case twice, compares, writes the report, and lists the cases above the aim.
pub(crate) fn run(options: &Options) -> Result<(), String> {
    let folder = run::root().join("target/truth");
    create(&folder)?;
    let maps = cases::maps(options, &folder)?;
    let program = run::downpour(options.command.as_deref())?;
    let mitsuba = Mitsuba::ready(&folder)?;
    if options.scenes() {
        let (text, misses) = scenes::compare(options, &program, &folder, &mitsuba)?;
        println!("{text}");
        write(&folder.join("scenes.md"), text.as_bytes())?;
        return if misses.is_empty() || !options.check {
            Ok(())
        } else {
            Err(format!("above the aim:\n  {}", misses.join("\n  ")))
        };
    }
    let mut report = Report::new(options, &mitsuba);
    let diameters_mm = if options.streaks { &[][..] } else { &options.diameters_mm()[..] };
    for &diameter_mm in diameters_mm {
        let shape = DropShape::new(diameter_mm * 1.0e-3).map_err(|error| error.to_string())?;
        let mesh = folder.join("mesh.ply");
        write(&mesh, &mesh::ply(&shape, options.subdivisions)?)?;
        for case in cases::cases(&shape, diameter_mm, &maps, options) {
            let outcome = compare(&case, &program, &folder, &mesh, &mitsuba, options)?;
            eprintln!("{}", report.add(&case, outcome));
        }
    }
    let (of_streaks, above) = streaks::compare(options, &maps, &program, &folder, &mitsuba)?;
    let text = if options.streaks { of_streaks } else { format!("{}\n{of_streaks}", report.markdown()) };
    println!("{text}");
    write(&folder.join("report.md"), text.as_bytes())?;
    match [report.misses(), &above].concat().as_slice() {
        [] => Ok(()),
        misses if options.check => Err(format!("above the aim:\n  {}", misses.join("\n  "))),
        _ => Ok(()),
    }
}

/// One case: our picture, theirs, and the numbers.
fn compare(
    case: &Case<'_>,
    program: &Path,
    folder: &Path,
    mesh: &Path,
    mitsuba: &Mitsuba,
    options: &Options,
) -> Result<Outcome, String> {
    let name = case.name();
    let (ours, theirs) =
        (folder.join(format!("{name}.ours.exr")), folder.join(format!("{name}.mitsuba.exr")));
    specimen(case, program, &ours, options.size)?;
    let values = mitsuba.compare(&mitsuba::Job {
        case,
        ours: &ours,
        mesh,
        reference: &theirs,
        beside: &folder.join(format!("{name}.png")),
        options,
    })?;
    Outcome::read(&values).map_err(|message| format!("{name}: {message}"))
}

/// Draws the case with the command under test.
fn specimen(case: &Case<'_>, program: &Path, output: &Path, size: u32) -> Result<(), String> {
    let status = run::command(&program.display().to_string(), &["specimen", "--backend", "cpu", "--quiet"])
        .args(["--overwrite", "--diameter", &case.diameter_mm.to_string()])
        .args(["--distance", &case.view.distance_m.to_string(), "--fov", &case.fov_deg.to_string()])
        .args(["--yaw", &case.view.yaw_deg.to_string(), "--pitch", &case.view.pitch_deg.to_string()])
        .args(["--size", &format!("{size}x{size}"), "--environment"])
        .arg(&case.map.file)
        .arg("--output")
        .arg(output)
        .status()
        .map_err(|error| format!("{} did not start: {error}", program.display()))?;
    if status.success() {
        Ok(())
    } else {
        Err(format!("{}: downpour specimen failed ({status})", case.name()))
    }
}

fn create(folder: &Path) -> Result<(), String> {
    std::fs::create_dir_all(folder).map_err(|error| format!("{}: {error}", folder.display()))
}

fn write(file: &Path, bytes: &[u8]) -> Result<(), String> {
    std::fs::write(file, bytes).map_err(|error| format!("{}: {error}", file.display()))
}

//! Lattices and streaks on a GPU are those of the CPU.

use serde_json::Value;

use crate::child::{Downpour, Ended};

/// A float picture's numbers, all channels one after the other.
fn numbers(ended: &Ended, name: &str) -> Vec<f32> {
    use ::exr::prelude::*;
    let image = read().no_deep_data().largest_resolution_level().all_channels().first_valid_layer();
    let bytes = std::io::Cursor::new(ended.file(name));
    let image = image.all_attributes().from_buffered(bytes).expect("a picture");
    image.layer_data.channel_data.list.iter().flat_map(|c| c.sample_data.values_as_f32()).collect()
}

/// Root mean square of the difference of two lists over that of the second.
fn apart(a: &[f32], b: &[f32]) -> f64 {
    assert_eq!(a.len(), b.len());
    let square = |x: f32| f64::from(x) * f64::from(x);
    let squares: f64 = a.iter().zip(b).map(|(a, b)| square(a - b)).sum();
    (squares / b.iter().map(|&b| square(b)).sum::<f64>()).sqrt()
}

fn lattice(arguments: &[&str], backend: &[&str]) -> Ended {
    Downpour::new(&[&["lattice"], arguments, backend].concat()).run().succeeded()
}

const CPU: [&str; 2] = ["--backend", "cpu"];

/// The same list, to the nanoliter, and the same pictures. The control is another seed.
pub(crate) fn a_pane_is_that_of_the_cpu(on: &[&str]) {
    let fixed = ["glass", "--size", "96x64", "--rate", "300", "--speed", "12", "--steps", "1200", "--json"];
    for show in ["height", "normal", "mass"] {
        let more = ["--check", "mass", "--show", show, "--every", "600", "-o", "%d.exr"];
        let arguments = [&fixed[..], &more].concat();
        let (gpu, cpu) = (lattice(&arguments, on), lattice(&arguments, &CPU));
        assert_eq!(gpu.stdout, cpu.stdout);
        assert!(gpu.stderr.contains("backend: gpu, "), "{}", gpu.stderr);
        assert!(cpu.json()["drops"].as_u64().is_some_and(|drops| drops > 10), "{}", cpu.stdout);
        for picture in ["0.exr", "1.exr", "2.exr"] {
            assert!(gpu.file(picture) == cpu.file(picture), "{show}: {picture}");
        }
        assert!(cpu.file("1.exr") != cpu.file("2.exr"));
        let other = lattice(&[&arguments[..], &["--seed", "3"]].concat(), on);
        assert!(other.stdout != cpu.stdout && other.file("2.exr") != cpu.file("2.exr"), "{show}");
    }
}

/// The same list and pictures to rounding; integers are the same. The control is another seed.
pub(crate) fn a_puddle_is_that_of_the_cpu(on: &[&str]) {
    let fixed = ["puddle", "--size", "96x64", "--steps", "150", "--json", "-o", "h.exr"];
    for more in [&["--rate", "100"][..], &["--check", "energy"], &["--check", "mass"], &["--check", "rest"]] {
        let arguments = [&fixed[..], more].concat();
        let (gpu, cpu) = (lattice(&arguments, on), lattice(&arguments, &CPU));
        let (found, expected) = (gpu.json(), cpu.json());
        for key in ["steps", "degree", "drops", "reset_cells"] {
            assert!(found[key].is_u64() && found[key] == expected[key], "{key}: {found}, {expected}");
        }
        let number =
            |json: &Value, key: &str| json[key].as_f64().unwrap_or_else(|| panic!("{key} of {json}"));
        for key in ["highest_mm", "energy_m4_s2"] {
            let (a, b) = (number(&found, key), number(&expected, key));
            assert!((a - b).abs() <= 1.0e-3 * b.abs(), "{more:?}: {key}: {a} and {b}");
        }
        let (heights, wanted) = (numbers(&gpu, "h.exr"), numbers(&cpu, "h.exr"));
        if more == ["--check", "rest"] {
            assert!(heights == wanted && heights.iter().all(|&h| h == 0.0));
            continue;
        }
        let difference = apart(&heights, &wanted);
        assert!(difference < 1.0e-3, "{more:?}: heights differ by {difference}");
        if more[0] == "--rate" {
            let other = numbers(&lattice(&[&arguments[..], &["--seed", "3"]].concat(), on), "h.exr");
            assert!(apart(&other, &wanted) > 0.5, "another rain has other ripples");
        }
    }
}

/// A lost device ends a lattice, and leaves nothing.
pub(crate) fn a_lattice_of_a_lost_device_is_not_told_of(on: &[&str]) {
    for kind in [&["glass"][..], &["puddle", "--size", "64x64"]] {
        let arguments = [&["lattice"], kind, &["--steps", "100", "--rate", "50", "-o", "a.png"], on].concat();
        let ended = Downpour::new(&arguments).env("DOWNPOUR_INJECT", "lost@2").run().failed(4, &["lost"]);
        assert_eq!(ended.left(&[]).stdout, "");
    }
}

/// The streak by the table. The control is the exact one.
pub(crate) fn a_streak_by_the_table_is_that_of_the_cpu(on: &[&str]) {
    let pixels: Vec<[f32; 3]> =
        (0..64 * 32).map(|i| if (i / 4 + i / 256) % 2 == 0 { [2.0, 3.0, 4.0] } else { [0.1; 3] }).collect();
    let sky = downpour::render::file::write_exr(64, 32, &pixels).expect("a sky");
    let picture = |samples: &str, backend: &[&str]| {
        let fixed = ["specimen", "--environment", "sky.exr", "--diameter", "2", "--exposure", "0.001"];
        let more = ["--oscillation", "0.2,0.1", "--size", "33x99", "--light", "165,3,2,200", "-o", "d.exr"];
        let run = Downpour::new(&[&fixed[..], &more, &["--samples", samples], backend].concat());
        numbers(&run.with_file("sky.exr", &sky).run().succeeded(), "d.exr")
    };
    let cpu = picture("table", &CPU);
    let difference = apart(&picture("table", on), &cpu);
    let control = apart(&picture("1", &CPU), &cpu);
    assert!(difference < 2.0e-3 && control > 0.01, "{difference}, and the exact one {control}");
}

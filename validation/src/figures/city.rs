//! `cargo xtask figures city`: each effect of the wet city off and on, over the weather files of the project's street: the system of Tatarchuk &
//! Isidoro 2006, effect by effect.
//!
//! Everything is under `target/figures/city`: of each effect two weather files, two pictures, and `city.md`, which shows them beside each other.

mod effects;
mod merge;

use std::path::{Path, PathBuf};

use clap::Args;

use crate::quantity::{size, within};
use effects::{EFFECTS, Effect};
use merge::merged;
use xtask::run;

/// Folder of the street's weather files, and of the models that they name.
const STREET: &str = "assets/scenes/street";

/// Quality of the pictures, 1 to 100.
const JPEG_QUALITY: u8 = 72;

/// Each effect of the wet city off and on, over the project's street.
#[derive(Args, Clone, Debug, PartialEq)]
pub(crate) struct Options {
    /// A `downpour` that is built already.
    #[arg(long, value_name = "FILE")]
    command: Option<PathBuf>,
    /// Size of the pictures.
    #[arg(long, value_name = "WxH", default_value = "960x540", value_parser = size)]
    size: [u32; 2],
    /// Samples along an edge of a pixel.
    #[arg(long, value_name = "N", default_value = "4", value_parser = within(1..=8_u32))]
    samples: u32,
    /// Backend: cpu, gpu or auto.
    #[arg(long, value_name = "NAME", default_value = "auto")]
    backend: String,
    /// Write the weather files and the page, and no pictures.
    #[arg(long)]
    files_only: bool,
    /// Effects; all without a name.
    #[arg(value_name = "EFFECT", value_parser = clap::builder::PossibleValuesParser::new(EFFECTS.map(|effect| effect.name)))]
    names: Vec<String>,
}

/// Makes the files, the pictures and the page.
pub(crate) fn run(options: &Options) -> Result<(), String> {
    let folder = run::root().join("target/figures/city");
    std::fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let wanted =
        |effect: &&Effect| options.names.is_empty() || options.names.iter().any(|name| name == effect.name);
    let effects: Vec<&Effect> = EFFECTS.iter().filter(wanted).collect();
    for effect in &effects {
        for (state, text) in texts(effect)? {
            write(&folder.join(format!("{}_{state}.toml", effect.name)), text.as_bytes())?;
        }
    }
    write(&folder.join("city.md"), page(&effects).as_bytes())?;
    if options.files_only {
        return Ok(());
    }
    let command = run::downpour(options.command.as_deref())?;
    for effect in &effects {
        for state in ["off", "on"] {
            render(&command, &folder, effect, state, options)?;
        }
    }
    Ok(())
}

/// The weather files of an effect: without it, and with it.
fn texts(effect: &Effect) -> Result<[(&'static str, String); 2], String> {
    let base = run::root().join(STREET).join(effect.base);
    let text = std::fs::read_to_string(&base).map_err(|error| format!("{}: {error}", base.display()))?;
    let of = |state, changes: &str| {
        let changes = [effect.both, changes].concat();
        let made = merged(&text, &changes, effect.without)
            .map_err(|error| format!("{}, {state}: {error}", effect.name))?;
        Ok::<_, String>((state, made))
    };
    Ok([of("off", effect.off)?, of("on", effect.on)?])
}

/// Renders a state of an effect as a .png and as a .jpg.
fn render(
    command: &Path,
    folder: &Path,
    effect: &Effect,
    state: &str,
    options: &Options,
) -> Result<(), String> {
    let of = |ending: &str| folder.join(format!("{}_{state}.{ending}", effect.name));
    let [width, height] = options.size;
    let status = std::process::Command::new(command)
        .current_dir(run::root())
        .arg("render")
        .arg(of("toml"))
        .args(["--asset-root", STREET, "--backend", &options.backend, "--overwrite"])
        .args(["--time", effect.time_s, "--size", &format!("{width}x{height}")])
        .args(["--samples", &options.samples.to_string(), "--sky-rays", "2", "-o"])
        .arg(of("png"))
        .status()
        .map_err(|error| format!("{}: {error}", command.display()))?;
    if !status.success() {
        return Err(format!("{}_{state} was not rendered", effect.name));
    }
    let picture = image::open(of("png")).map_err(|error| format!("{}: {error}", of("png").display()))?;
    let mut bytes = Vec::new();
    let encoder = image::codecs::jpeg::JpegEncoder::new_with_quality(&mut bytes, JPEG_QUALITY);
    picture.to_rgb8().write_with_encoder(encoder).map_err(|error| error.to_string())?;
    write(&of("jpg"), &bytes)
}

/// A page with the pictures beside each other.
fn page(effects: &[&Effect]) -> String {
    let mut text = "# The wet city, effect by effect\n\nEach effect off and on, `cargo xtask figures city`: the changes over the weather file of the \
                    street that is named, and nothing else.\n"
        .to_owned();
    let keys = |keys: &str| {
        if keys.is_empty() { " nothing.\n\n".to_owned() } else { format!("\n\n```toml\n{keys}```\n\n") }
    };
    for Effect { name, title, base, without, both, off, on, time_s } in effects {
        text += &format!("\n## {title}\n\n`{base}` at {time_s} s");
        if !without.is_empty() {
            text += &format!(", without its `{}`", without.join("` and `"));
        }
        text += ".\n\n";
        if !both.is_empty() {
            text += &format!("Both:{}", keys(both));
        }
        text += &format!("Off:{}On:{}", keys(off), keys(on));
        text += &format!(
            "| off | on |\n|---|---|\n| ![{title}: off]({name}_off.jpg) | ![{title}: on]({name}_on.jpg) |\n"
        );
    }
    text
}

fn write(path: &Path, bytes: &[u8]) -> Result<(), String> {
    std::fs::write(path, bytes).map_err(|error| format!("{}: {error}", path.display()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use downpour_weather::Weather;

    #[test]
    fn every_effect_is_two_weathers() {
        for effect in &EFFECTS {
            let [off, on] = texts(effect).expect(effect.name).map(|(state, text)| {
                let name = format!("{}_{state}.toml", effect.name);
                Weather { name: String::new(), ..Weather::parse(&name, &text).expect(&name) }
            });
            assert!(off != on, "{}: off and on are alike", effect.name);
        }
        assert!(page(&EFFECTS.iter().collect::<Vec<_>>()).contains("spray_on.jpg"));
    }

    #[test]
    fn options_have_names_of_effects() {
        let options =
            crate::read::<Options>(&["spray", "--size", "480x270", "--files-only"]).expect("options");
        assert_eq!((options.names, options.size), (vec!["spray".to_owned()], [480, 270]));
        assert!(crate::read::<Options>(&["mud"]).is_err());
    }
}

//! The assets that the code makes: `cargo xtask masks`, `atlas` and `scenes`. The tests compare the committed files with them.

mod atlas;
mod files;
mod masks;
mod scenes;

use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let done = match words.as_slice() {
        ["masks"] => masks::write(),
        ["masks", "--check"] => masks::check(),
        ["atlas", rest @ ..] => atlas::run(rest),
        ["scenes"] => scenes::write(),
        ["scenes", "--check"] => scenes::check(),
        ["scenes", "skies", rest @ ..] => scenes::skies(rest),
        _ => Err(format!("no task \"{}\": cargo xtask lists them", words.join(" "))),
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(message) => {
            eprintln!("xtask: {message}");
            ExitCode::FAILURE
        }
    }
}

#[cfg(test)]
mod tests {
    use super::{atlas, masks, scenes};

    #[test]
    fn masks_are_what_the_code_makes() {
        assert_eq!(masks::check(), Ok(()));
    }

    #[test]
    fn one_of_the_streaks_is_what_the_code_makes() {
        assert_eq!(atlas::check(true), Ok(()));
    }

    /// And it keeps its limits of bytes, triangles and texels.
    #[test]
    fn the_street_is_what_the_code_makes() {
        assert_eq!(scenes::check(), Ok(()));
    }
}

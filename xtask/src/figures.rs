//! `cargo xtask figures`: figures of papers made again, with our rain beside theirs.

mod im_sung;
mod persistence;

/// What there is.
const NAMES: &str = "\
cargo xtask figures im-sung   figures 6 to 11 of Im & Sung 2022: three ways to keep rain before a camera, and ours
cargo xtask figures persistence [--quick] [WEATHER.toml]
                              tables 1 and 2 of Rousseau 2008: what streaks cost, and how far they are from the truth";

/// Makes the figures of a name; without one lists the names.
pub(crate) fn run(arguments: &[&str]) -> Result<(), String> {
    match arguments {
        [] => {
            println!("{NAMES}");
            Ok(())
        }
        ["im-sung", rest @ ..] => im_sung::run(rest),
        ["persistence", rest @ ..] => persistence::run(rest),
        [name, ..] => Err(format!("no figures \"{name}\"; there are:\n{NAMES}")),
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_wrong_name_is_answered_with_the_right_ones() {
        let message = super::run(&["im-sun"]).expect_err("no such figures");
        assert!(message.starts_with("no figures \"im-sun\""), "{message}");
        assert!(message.contains("figures im-sung"), "{message}");
    }
}

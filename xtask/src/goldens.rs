//! Golden images in `tests/goldens`: small masks of the CPU twins, and small pictures of every kind that the command makes.

use xtask::run;

/// The tests that hold them.
const TESTS: [[&str; 2]; 2] = [["downpour-tests", "golden"], ["downpour-cli", "goldens"]];

/// Compares them.
pub(crate) fn compare() -> Result<(), String> {
    TESTS.iter().try_for_each(|test| run::cargo(&arguments(test), &[]))
}

/// Writes them. The run then fails on purpose: a new picture counts once a person has reviewed it.
pub(crate) fn bless() -> Result<(), String> {
    let mut written = false;
    for test in &TESTS {
        // A GPU is compared with the committed files; its pictures are not written.
        let blessed = run::cargo(&arguments(test), &[("DOWNPOUR_BLESS", "1"), ("DOWNPOUR_GPU_TESTS", "no")]);
        written |= blessed.is_err();
    }
    if written {
        return Err("golden images were written to tests/goldens; look at them, then compare".to_owned());
    }
    Ok(())
}

fn arguments<'a>([package, test]: &[&'a str; 2]) -> [&'a str; 6] {
    ["test", "-p", package, "--locked", "--test", test]
}

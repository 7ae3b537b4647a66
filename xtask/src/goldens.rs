//! Golden images: small pictures of what the CPU twins make, kept in `tests/goldens`.

use crate::run;

/// Compares them.
pub(crate) fn compare() -> Result<(), String> {
    run::cargo(&["test", "-p", "downpour-tests", "--locked", "--test", "golden"], &[])
}

/// Writes them. The run then fails on purpose: a new picture counts once a person has looked at it.
pub(crate) fn bless() -> Result<(), String> {
    let blessed = run::cargo(
        &["test", "-p", "downpour-tests", "--locked", "--test", "golden"],
        &[("DOWNPOUR_BLESS", "1")],
    );
    match blessed {
        Ok(()) => Ok(()),
        Err(_) => Err("golden images were written to tests/goldens; look at them, then compare".to_owned()),
    }
}

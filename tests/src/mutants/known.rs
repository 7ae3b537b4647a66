//! Mutants that no case sees, each with the reason why: `tests/mutants.txt`.

use super::population::Mutant;

/// Mutants of one function that may survive for the same reason.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Known {
    /// The function.
    pub function: String,
    /// The changed lines, as [`Mutant::wrong`] has them.
    pub wrong: Vec<String>,
    /// Reason why nothing sees them.
    pub reason: String,
}

/// The list. A paragraph has the function, the changed lines and the reason, a line each; `#` begins a remark.
///
/// # Panics
/// If a paragraph has fewer than three lines.
#[must_use]
pub fn known() -> Vec<Known> {
    let text = include_str!("../../mutants.txt");
    let lines = |paragraph: &str| -> Vec<String> {
        paragraph.lines().filter(|line| !line.starts_with('#')).map(str::to_owned).collect()
    };
    let paragraphs = text.split("\n\n").map(lines).filter(|lines| !lines.is_empty());
    paragraphs
        .map(|lines| match lines.as_slice() {
            [function, wrong @ .., reason] if !wrong.is_empty() => {
                Known { function: function.clone(), wrong: wrong.to_vec(), reason: reason.clone() }
            }
            _ => panic!("tests/mutants.txt: at least three lines are wanted, not {lines:?}"),
        })
        .collect()
}

/// The reason why a mutant may survive, if it is listed.
#[must_use]
pub fn reason<'a>(list: &'a [Known], mutant: &Mutant) -> Option<&'a str> {
    let found = list.iter().find(|k| k.function == mutant.swap.function && k.wrong.contains(&mutant.wrong));
    found.map(|known| known.reason.as_str())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mutants::population::population;

    #[test]
    fn the_list_names_mutants_that_exist() {
        let all = population();
        for known in known() {
            for wrong in &known.wrong {
                let exists = all.iter().any(|m| m.swap.function == known.function && m.wrong == *wrong);
                assert!(exists, "{}: no mutant gives \"{wrong}\"", known.function);
            }
            assert!(known.reason.len() > 20, "{}: a reason is a sentence", known.function);
        }
    }
}

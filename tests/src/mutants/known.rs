//! Mutants that no case sees, each with the reason why: `tests/mutants.txt`.

use super::population::Mutant;

/// A mutant that may survive.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Known {
    /// The function.
    pub function: String,
    /// The changed line, as [`Mutant::wrong`] has it.
    pub wrong: String,
    /// Reason why nothing sees it.
    pub reason: String,
}

/// The list. A paragraph has the function, the changed line and the reason, a line each; `#` begins a remark.
///
/// # Panics
/// If a paragraph has another number of lines.
#[must_use]
pub fn known() -> Vec<Known> {
    let text = include_str!("../../mutants.txt");
    let lines = |paragraph: &str| -> Vec<String> {
        paragraph.lines().filter(|line| !line.starts_with('#')).map(str::to_owned).collect()
    };
    let paragraphs = text.split("\n\n").map(lines).filter(|lines| !lines.is_empty());
    paragraphs
        .map(|lines| match <[String; 3]>::try_from(lines) {
            Ok([function, wrong, reason]) => Known { function, wrong, reason },
            Err(lines) => panic!("tests/mutants.txt: three lines are wanted, not {lines:?}"),
        })
        .collect()
}

/// The reason why a mutant may survive, if it is listed.
#[must_use]
pub fn reason<'a>(list: &'a [Known], mutant: &Mutant) -> Option<&'a str> {
    let found = list.iter().find(|k| k.function == mutant.swap.function && k.wrong == mutant.wrong);
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
            let exists = all.iter().any(|m| m.swap.function == known.function && m.wrong == known.wrong);
            assert!(exists, "{}: no mutant gives \"{}\"", known.function, known.wrong);
            assert!(known.reason.len() > 20, "{}: a reason is a sentence", known.function);
        }
    }
}

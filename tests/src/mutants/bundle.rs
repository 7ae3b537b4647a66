//! Several mutants of a function in one text: a number that the shader reads says which of them runs.
//!
//! A software driver takes seconds to compile a large kernel and a fraction of one to run it.

use std::fmt::Write as _;

use super::population::Mutant;
use super::tokens::{Kind, tokens};
use crate::relay::{CHOSEN, Swap};

/// Largest number of mutants that share a text.
pub const MAX_MUTANTS: usize = 16;

/// The swap of all mutants of one function; number `k + 1` chooses the `k`-th, any other none. `None` for entry points,
/// which nothing can call: they are tried one by one.
#[must_use]
pub fn bundle(mutants: &[&Mutant]) -> Option<Swap> {
    let Swap { function, right, .. } = &mutants.first()?.swap;
    if function.starts_with("main_") {
        return None;
    }
    let body = right.find('{')?;
    let head = &right[..body];
    let call = format!("{function}_as_{{}}({})", parameters(head).join(", "));
    let gives = head.contains("->");
    let line = |number: usize| {
        let call = call.replace("{}", &number.to_string());
        if gives { format!("return {call};") } else { format!("{call};") }
    };
    let named = |text: &str, number: usize| {
        text.replacen(&format!("fn {function}("), &format!("fn {function}_as_{number}("), 1)
    };
    let mut text = named(right, 0);
    let mut cases = String::new();
    for (number, mutant) in (1..).zip(mutants) {
        let _ = write!(text, "\n{}", named(&mutant.swap.wrong, number));
        let _ = writeln!(cases, "        case {number}u: {{ {} }}", line(number));
    }
    let _ = write!(
        text,
        "\n{head}{{\n    switch {CHOSEN} {{\n{cases}        default: {{ {} }}\n    }}\n}}",
        line(0)
    );
    Some(Swap { function: function.clone(), right: right.clone(), wrong: text })
}

/// The names of the parameters in a function's head.
fn parameters(head: &str) -> Vec<String> {
    let tokens = tokens(head);
    let open = tokens.iter().position(|t| t.text(head) == "(").unwrap_or(0);
    let named =
        tokens.windows(2).skip(open).filter(|pair| pair[0].kind == Kind::Name && pair[1].text(head) == ":");
    named.map(|pair| pair[0].text(head).to_owned()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mutants::population::population;

    #[test]
    fn parameters_are_the_names_before_colons() {
        let head = "fn a(x: f32, b: ptr<function, vec2<f32>>, c: array<u32, 4>) -> vec3f ";
        assert_eq!(parameters(head), ["x", "b", "c"]);
    }

    #[test]
    fn a_bundle_holds_every_mutant_and_the_right_text() {
        let all = population();
        let few: Vec<&Mutant> = all.iter().filter(|m| m.swap.function == "rng_unit").take(2).collect();
        let swap = bundle(&few).expect("a function");
        assert!(swap.wrong.contains("case 2u: { return rng_unit_as_2(word); }"), "{}", swap.wrong);
        assert!(swap.wrong.contains("fn rng_unit_as_0("));
    }
}

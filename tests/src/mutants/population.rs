//! All mutants of all shaders, in one order that never changes.

use std::collections::BTreeSet;

use downpour_math::rng::rng_draw;
use downpour_shaders::{Module, compose, modules};

use super::changes::{Change, ChangeKind, changes};
use super::tokens::{functions, tokens};
use crate::relay::Swap;

/// One function with one change in it.
#[derive(Clone, Debug)]
pub struct Mutant {
    /// The module that holds the function.
    pub module: &'static Module,
    /// The line of the change in the module's file.
    pub line: usize,
    /// Kind of the change.
    pub kind: ChangeKind,
    /// The line as it is.
    pub right: String,
    /// The line with the change (the lines, if the change is over several).
    pub wrong: String,
    /// The function, right and wrong.
    pub swap: Swap,
}

impl Mutant {
    fn new(module: &'static Module, function: &super::tokens::FunctionSpan, change: &Change) -> Self {
        let text = module.wgsl;
        let right = text[function.at.clone()].to_owned();
        let mut wrong = right.clone();
        let inner = change.at.start - function.at.start..change.at.end - function.at.start;
        wrong.replace_range(inner, &change.to);
        let from = text[..change.at.start].rfind('\n').map_or(0, |at| at + 1);
        let to = text[change.at.end..].find('\n').map_or(text.len(), |at| change.at.end + at);
        let changed = format!("{}{}{}", &text[from..change.at.start], change.to, &text[change.at.end..to]);
        let one_line = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
        Self {
            module,
            line: text[..change.at.start].matches('\n').count() + 1,
            kind: change.kind,
            right: one_line(&text[from..to]),
            wrong: one_line(&changed),
            swap: Swap { function: function.name.clone(), right, wrong },
        }
    }

    /// Reason why naga refuses it, if it does: such a change could not stay in a shader.
    #[must_use]
    pub fn refused(&self) -> Option<String> {
        let text = compose(&[self.module]).replace(&self.swap.right, &self.swap.wrong);
        let module = match naga::front::wgsl::parse_str(&text) {
            Ok(module) => module,
            Err(error) => return Some(error.message().to_owned()),
        };
        let flags = naga::valid::ValidationFlags::all();
        let capabilities = naga::valid::Capabilities::SHADER_FLOAT16_IN_FLOAT32;
        let checked = naga::valid::Validator::new(flags, capabilities).validate(&module);
        checked.err().map(|error| error.as_inner().to_string())
    }

    /// Position, kind and change in one line.
    #[must_use]
    pub fn describe(&self) -> String {
        format!(
            "shaders/wgsl/{}:{} {} [{}] {} => {}",
            self.module.path, self.line, self.swap.function, self.kind, self.right, self.wrong
        )
    }
}

/// Every mutant.
#[must_use]
pub fn population() -> Vec<Mutant> {
    let mut seen = BTreeSet::new();
    let mut found = Vec::new();
    for module in modules() {
        if !seen.insert(module.path) {
            continue;
        }
        let tokens = tokens(module.wgsl);
        for function in functions(module.wgsl, &tokens) {
            for change in changes(module.wgsl, &tokens, &function) {
                found.push(Mutant::new(module, &function, &change));
            }
        }
    }
    found
}

/// `count` of the chosen mutants, drawn by the seed: the same for the same arguments. Each is drawn by its own text, so that a change
/// of one function leaves those of the others in the sample.
#[must_use]
pub fn sample(all: &[Mutant], chosen: &[usize], count: usize, seed: u32) -> Vec<usize> {
    let mut order: Vec<([u32; 4], usize)> = chosen.iter().map(|&at| (draw(&all[at], seed), at)).collect();
    order.sort_unstable();
    let mut drawn: Vec<usize> = order.into_iter().take(count).map(|(_, at)| at).collect();
    drawn.sort_unstable();
    drawn
}

/// Random words of a mutant.
fn draw(mutant: &Mutant, seed: u32) -> [u32; 4] {
    let text = format!("{} {} {}", mutant.swap.function, mutant.right, mutant.wrong);
    text.bytes().fold([seed, 0x6d75, 0, 0], |[a, b, c, _], byte| rng_draw([a, b], c, byte.into(), 0))
}

//! Functions that an entry point or a function really calls, as naga's module says.
//!
//! A branch on an `override` constant counts only where the constant's value takes it.

use std::collections::BTreeSet;

use naga::{Block, Expression, Function, Handle, Module, Statement};

/// The names of an entry point and of all functions that it calls, directly or not. `overrides` are the values that differ
/// from the text's own.
#[must_use]
pub fn from_entry(module: &Module, entry: &str, overrides: &[(&str, f64)]) -> BTreeSet<String> {
    let mut walk = Walk { module, overrides, found: BTreeSet::new() };
    if let Some(point) = module.entry_points.iter().find(|point| point.name == entry) {
        walk.found.insert(entry.to_owned());
        walk.block(&point.function, &point.function.body);
    }
    walk.found
}

/// The names of a function and of all functions that it calls, directly or not.
#[must_use]
pub fn from_function(module: &Module, name: &str) -> BTreeSet<String> {
    let mut walk = Walk { module, overrides: &[], found: BTreeSet::new() };
    if let Some((handle, _)) = module.functions.iter().find(|(_, f)| f.name.as_deref() == Some(name)) {
        walk.function(handle);
    }
    walk.found
}

struct Walk<'a> {
    module: &'a Module,
    overrides: &'a [(&'a str, f64)],
    found: BTreeSet<String>,
}

impl Walk<'_> {
    fn function(&mut self, handle: Handle<Function>) {
        let function = &self.module.functions[handle];
        if self.found.insert(function.name.clone().unwrap_or_default()) {
            self.block(function, &function.body);
        }
    }

    fn block(&mut self, within: &Function, block: &Block) {
        for statement in block {
            match statement {
                Statement::Call { function, .. } => self.function(*function),
                Statement::Block(inner) => self.block(within, inner),
                Statement::If { condition, accept, reject } => {
                    let known = self.known(within, *condition);
                    if known != Some(false) {
                        self.block(within, accept);
                    }
                    if known != Some(true) {
                        self.block(within, reject);
                    }
                }
                Statement::Switch { cases, .. } => cases.iter().for_each(|c| self.block(within, &c.body)),
                Statement::Loop { body, continuing, .. } => {
                    self.block(within, body);
                    self.block(within, continuing);
                }
                _ => {}
            }
        }
    }

    /// Value of a condition, if `override` constants alone decide it.
    fn known(&self, within: &Function, condition: Handle<Expression>) -> Option<bool> {
        match &within.expressions[condition] {
            Expression::Override(handle) => {
                let constant = &self.module.overrides[*handle];
                let given = self.overrides.iter().find(|(name, _)| constant.name.as_deref() == Some(*name));
                match (given, constant.init.map(|init| &self.module.global_expressions[init])) {
                    (Some((_, value)), _) => Some(*value != 0.0),
                    (None, Some(Expression::Literal(naga::Literal::Bool(value)))) => Some(*value),
                    _ => None,
                }
            }
            Expression::Unary { op: naga::UnaryOperator::LogicalNot, expr } => {
                self.known(within, *expr).map(|value| !value)
            }
            Expression::Binary { op: naga::BinaryOperator::LogicalAnd, left, right } => {
                match (self.known(within, *left), self.known(within, *right)) {
                    (Some(false), _) | (_, Some(false)) => Some(false),
                    (Some(true), Some(true)) => Some(true),
                    _ => None,
                }
            }
            _ => None,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "
        override DEEP: bool = true;
        fn a() -> f32 { return b(); }
        fn b() -> f32 { return 1.0; }
        fn c() -> f32 { return 2.0; }
        fn unused() -> f32 { return c(); }
        @group(0) @binding(0) var<storage, read_write> out: array<f32>;
        @compute @workgroup_size(1) fn main_text() {
            if DEEP { out[0] = a(); } else { out[0] = c(); }
        }";

    #[test]
    fn what_is_called_is_found_and_no_more() {
        let module = naga::front::wgsl::parse_str(TEXT).expect("valid");
        let names = |overrides: &[(&str, f64)]| -> Vec<String> {
            from_entry(&module, "main_text", overrides).into_iter().collect()
        };
        assert_eq!(names(&[]), ["a", "b", "main_text"]);
        assert_eq!(names(&[("DEEP", 0.0)]), ["c", "main_text"]);
        assert_eq!(from_function(&module, "unused").len(), 2);
        assert!(from_entry(&module, "nothing", &[]).is_empty());
    }
}

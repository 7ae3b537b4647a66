//! The changes that a slip of the hand could make in a function.

use std::fmt;
use std::ops::Range;

use super::tokens::{FunctionSpan, Kind, Token, closing};

/// A kind of change.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum ChangeKind {
    /// A number with a fraction, 1.5 % larger; 0.01 in the place of 0.
    Number,
    /// A whole number, one more or one less.
    Integer,
    /// `+` and `-`, `*` and `/`.
    Operator,
    /// A term of a sum left out.
    Term,
    /// `<` and `<=`, `>` and `>=`.
    Edge,
    /// `<` and `>`, `==` and `!=`.
    Comparison,
    /// `&&` and `||`.
    Logic,
    /// `min` and `max`.
    Extreme,
    /// Both values of a `select`.
    Select,
}

impl fmt::Display for ChangeKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Number => "number",
            Self::Integer => "integer",
            Self::Operator => "operator",
            Self::Term => "term",
            Self::Edge => "edge",
            Self::Comparison => "comparison",
            Self::Logic => "logic",
            Self::Extreme => "extreme",
            Self::Select => "select",
        })
    }
}

/// Bytes of a text, and what stands there instead.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Change {
    /// Kind of the change.
    pub kind: ChangeKind,
    /// The bytes.
    pub at: Range<usize>,
    /// The new text.
    pub to: String,
}

/// The words before a `<` that opens a list of types.
fn opens_types(name: &str) -> bool {
    let prefixes = ["vec", "mat", "array", "bitcast", "ptr", "atomic", "var"];
    prefixes.iter().any(|p| name == *p || (name.starts_with(p) && matches!(name.len(), 4 | 6)))
        && !name.contains('_')
}

/// All changes of a function, in the order of its text.
#[must_use]
pub fn changes(source: &str, tokens: &[Token], function: &FunctionSpan) -> Vec<Change> {
    let body = Body { source, tokens, range: function.body.clone() };
    let types = body.types();
    let mut found = Vec::new();
    let mut after = 0;
    for at in function.body.clone() {
        // Attributes say nothing of what is computed, and steps of loops only how long they run.
        if at < after || types.contains(&at) {
            continue;
        }
        if body.text(at) == "for" {
            after = body.step_of_loop(at, &mut found, &types);
            continue;
        }
        body.change(at, &mut found);
    }
    found.sort_by_key(|change: &Change| change.at.start);
    found
}

struct Body<'a> {
    source: &'a str,
    tokens: &'a [Token],
    range: Range<usize>,
}

impl Body<'_> {
    fn text(&self, at: usize) -> &str {
        self.tokens.get(at).map_or("", |token| token.text(self.source))
    }

    /// Tokens that belong to lists of types: `array<f32, 4>`.
    fn types(&self) -> Vec<usize> {
        let mut found = Vec::new();
        let mut at = self.range.start;
        while at + 1 < self.range.end {
            if self.text(at + 1) == "<" && opens_types(self.text(at)) {
                let mut depth = 0;
                for k in at + 1..self.range.end {
                    depth += match self.text(k) {
                        "<" => 1,
                        ">" => -1,
                        ">>" => -2,
                        _ => 0,
                    };
                    found.push(k);
                    if depth <= 0 {
                        at = k;
                        break;
                    }
                }
            }
            at += 1;
        }
        found
    }

    /// The changes of the head of a `for` but for its step; gives the index of the head's closing bracket.
    fn step_of_loop(&self, at: usize, found: &mut Vec<Change>, types: &[usize]) -> usize {
        let close = closing(self.source, self.tokens, at + 1);
        let mut semicolons = 0;
        for k in at + 2..close {
            semicolons += usize::from(self.text(k) == ";");
            if semicolons == 2 {
                break;
            }
            if !types.contains(&k) {
                self.change(k, found);
            }
        }
        close
    }

    /// True if the sign at `at` stands between two operands.
    fn between(&self, at: usize) -> bool {
        at > self.range.start
            && match self.tokens[at - 1].kind {
                Kind::Sign => matches!(self.text(at - 1), ")" | "]"),
                Kind::Name => !matches!(self.text(at - 1), "return" | "case" | "if" | "while"),
                Kind::Number => true,
            }
    }

    fn change(&self, at: usize, found: &mut Vec<Change>) {
        let token = &self.tokens[at];
        let text = self.text(at);
        let mut say = |kind, at: Range<usize>, to: &str| found.push(Change { kind, at, to: to.to_owned() });
        let here = token.at.clone();
        match (token.kind, text) {
            (Kind::Number, _) => {
                for (kind, to) in numbers(text) {
                    say(kind, here.clone(), &to);
                }
            }
            (Kind::Name, "min" | "max") if self.text(at + 1) == "(" => {
                say(ChangeKind::Extreme, here, if text == "min" { "max" } else { "min" });
            }
            (Kind::Name, "select") if self.text(at + 1) == "(" => {
                if let Some((whole, swapped)) = self.swapped(at + 1) {
                    say(ChangeKind::Select, whole, &swapped);
                }
            }
            (Kind::Sign, "+" | "-") if self.between(at) => {
                say(ChangeKind::Operator, here.clone(), if text == "+" { "-" } else { "+" });
                say(ChangeKind::Term, here.start..self.term_end(at), "");
            }
            (Kind::Sign, "*" | "/") if self.between(at) => {
                say(ChangeKind::Operator, here, if text == "*" { "/" } else { "*" });
            }
            (Kind::Sign, "+=" | "-=") => {
                say(ChangeKind::Operator, here.clone(), if text == "+=" { "-=" } else { "+=" });
                if let Some(whole) = self.statement(at) {
                    say(ChangeKind::Term, whole, "");
                }
            }
            (Kind::Sign, "*=" | "/=") => {
                say(ChangeKind::Operator, here, if text == "*=" { "/=" } else { "*=" });
            }
            (Kind::Sign, "<" | "<=" | ">" | ">=") if self.between(at) => {
                let [edge, turned] = match text {
                    "<" => ["<=", ">"],
                    "<=" => ["<", ">="],
                    ">" => [">=", "<"],
                    _ => [">", "<="],
                };
                say(ChangeKind::Edge, here.clone(), edge);
                say(ChangeKind::Comparison, here, turned);
            }
            (Kind::Sign, "==" | "!=") => {
                say(ChangeKind::Comparison, here, if text == "==" { "!=" } else { "==" });
            }
            (Kind::Sign, "&&" | "||") => {
                say(ChangeKind::Logic, here, if text == "&&" { "||" } else { "&&" });
            }
            _ => {}
        }
    }

    /// End of the term that follows the `+` or `-` at `at`.
    fn term_end(&self, at: usize) -> usize {
        let mut k = at + 1;
        let mut end = self.tokens[at].at.end;
        while k < self.range.end {
            match self.text(k) {
                "(" | "[" => k = closing(self.source, self.tokens, k),
                // A sign of a number.
                "-" | "+" if !self.between(k) => {}
                ")" | "]" | "}" | "{" | "," | ";" | "+" | "-" | "<" | ">" | "<=" | ">=" | "==" | "!="
                | "&&" | "||" | "<<" | ">>" | "&" | "|" | "^" => break,
                _ => {}
            }
            end = self.tokens[k].at.end;
            k += 1;
        }
        end
    }

    /// The statement round `at`, which ends with a semicolon.
    fn statement(&self, at: usize) -> Option<Range<usize>> {
        let first = (self.range.start..at).rev().find(|&k| matches!(self.text(k), ";" | "{" | "}"));
        let first = first.map_or(self.range.start, |k| k + 1);
        let last = (at..self.range.end).find(|&k| self.text(k) == ";")?;
        Some(self.tokens[first].at.start..self.tokens[last].at.end)
    }

    /// The arguments of a `select` whose bracket is at `open`, with the first two swapped.
    fn swapped(&self, open: usize) -> Option<(Range<usize>, String)> {
        let close = closing(self.source, self.tokens, open);
        let mut commas = Vec::new();
        let mut k = open + 1;
        while k < close {
            match self.text(k) {
                "(" | "[" => k = closing(self.source, self.tokens, k),
                "," => commas.push(k),
                _ => {}
            }
            k += 1;
        }
        let (&a, &b) = (commas.first()?, commas.get(1)?);
        let first = self.tokens[open + 1].at.start..self.tokens[a - 1].at.end;
        let second = self.tokens[a + 1].at.start..self.tokens[b - 1].at.end;
        let (one, two) = (&self.source[first.clone()], &self.source[second.clone()]);
        (one != two).then(|| (first.start..second.end, format!("{two}, {one}")))
    }
}

/// Other numbers in the place of this one.
fn numbers(text: &str) -> Vec<(ChangeKind, String)> {
    if let Some(hex) = text.strip_prefix("0x") {
        let digits = hex.trim_end_matches(['u', 'i']);
        let suffix = &hex[digits.len()..];
        let value = u64::from_str_radix(digits, 16).unwrap_or(0);
        return vec![(ChangeKind::Integer, format!("{:#x}{suffix}", value ^ 1))];
    }
    let is_float = text.contains(['.', 'e', 'f', 'h']);
    let digits = text.trim_end_matches(['u', 'i', 'f', 'h']);
    let suffix = &text[digits.len()..];
    if is_float {
        let value: f64 = digits.parse().unwrap_or(0.0);
        let changed = if value == 0.0 { 0.01 } else { value * 1.015 };
        return vec![(ChangeKind::Number, format!("{:?}{suffix}", changed as f32))];
    }
    let value: u64 = digits.parse().unwrap_or(0);
    let mut found = vec![(ChangeKind::Integer, format!("{}{suffix}", value + 1))];
    if value > 0 {
        found.push((ChangeKind::Integer, format!("{}{suffix}", value - 1)));
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mutants::tokens::{functions, tokens};

    /// The texts of all changed functions.
    fn changed(source: &str) -> Vec<String> {
        let tokens = tokens(source);
        let function = &functions(source, &tokens)[0];
        let apply = |change: &Change| {
            let mut text = source.to_owned();
            text.replace_range(change.at.clone(), &change.to);
            text
        };
        changes(source, &tokens, function).iter().map(apply).collect()
    }

    #[test]
    fn changes_are_those_of_a_slip_of_the_hand() {
        let body = |bodies: &[&str]| bodies.iter().map(|b| format!("fn a() {{ {b} }}")).collect::<Vec<_>>();
        assert_eq!(
            changed("fn a() { return x + y * -2.0; }"),
            body(&["return x - y * -2.0;", "return x ;", "return x + y / -2.0;", "return x + y * -2.03;"])
        );
        assert_eq!(
            changed("fn a() { return select(f(a, b), vec2<f32>(b), x < -y); }"),
            body(&[
                "return select(vec2<f32>(b), f(a, b), x < -y);",
                "return select(f(a, b), vec2<f32>(b), x <= -y);",
                "return select(f(a, b), vec2<f32>(b), x > -y);",
            ])
        );
        assert_eq!(
            changed("fn a() { for (var i = 0u; i < n; i += 1u) { s += max(i, j); } }"),
            body(&[
                "for (var i = 1u; i < n; i += 1u) { s += max(i, j); }",
                "for (var i = 0u; i <= n; i += 1u) { s += max(i, j); }",
                "for (var i = 0u; i > n; i += 1u) { s += max(i, j); }",
                "for (var i = 0u; i < n; i += 1u) {  }",
                "for (var i = 0u; i < n; i += 1u) { s -= max(i, j); }",
                "for (var i = 0u; i < n; i += 1u) { s += min(i, j); }",
            ])
        );
    }
}

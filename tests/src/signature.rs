//! Signature of a function, from naga, and the WGSL that calls it with words and takes its result as words.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use downpour_shaders::{compose, modules};
use naga::{Handle, Module, ScalarKind, Type, TypeInner, UniqueArena};

/// Kind of a word of a result: a number, compared with a tolerance, or a word that has to be equal.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum WordKind {
    /// f32.
    Float,
    /// u32, i32 or bool.
    Integer,
}

/// A function that takes and gives values (no pointers).
#[derive(Debug)]
pub struct Signature {
    /// The call, with `parity_in[base + k]` as arguments.
    pub call: String,
    /// Statements that write the result `r` to `parity_out[base + k]`.
    pub store: String,
    /// Number of words of the arguments.
    pub argument_words: usize,
    /// The kind of each word of the result.
    pub result: Vec<WordKind>,
}

/// Parses WGSL.
///
/// # Panics
/// If the text is not valid: the tests are about our own shaders.
#[must_use]
pub fn parse(source: &str) -> Module {
    naga::front::wgsl::parse_str(source).unwrap_or_else(|error| panic!("{}", error.emit_to_string(source)))
}

impl Signature {
    /// The signature of `function`; `None` if it takes a pointer, or returns nothing.
    ///
    /// # Panics
    /// If there is no such function.
    #[must_use]
    pub fn of(module: &Module, function: &str) -> Option<Self> {
        let (_, found) = module
            .functions
            .iter()
            .find(|(_, f)| f.name.as_deref() == Some(function))
            .unwrap_or_else(|| panic!("no function {function} in the module"));
        let mut words = 0;
        let mut arguments = Vec::new();
        for argument in &found.arguments {
            arguments.push(construct(&module.types, argument.ty, &mut words)?);
        }
        let mut result = Vec::new();
        let mut store = String::new();
        destruct(&module.types, found.result.as_ref()?.ty, "r", &mut result, &mut store)?;
        let call = format!("{function}({})", arguments.join(", "));
        Some(Self { call, store, argument_words: words, result })
    }
}

fn scalar_name(kind: ScalarKind) -> &'static str {
    match kind {
        ScalarKind::Float => "f32",
        ScalarKind::Uint => "u32",
        ScalarKind::Sint => "i32",
        _ => "bool",
    }
}

fn scalar_from_word(kind: ScalarKind, words: &mut usize) -> String {
    let word = format!("parity_in[base_in + {words}u]");
    *words += 1;
    match kind {
        ScalarKind::Float => format!("bitcast<f32>({word})"),
        ScalarKind::Sint => format!("bitcast<i32>({word})"),
        ScalarKind::Uint => word,
        _ => format!("({word} != 0u)"),
    }
}

/// The expression that makes a value of a type from the next words.
fn construct(types: &UniqueArena<Type>, ty: Handle<Type>, words: &mut usize) -> Option<String> {
    let mut several = |n: u32, kind: ScalarKind| -> String {
        (0..n).map(|_| scalar_from_word(kind, words)).collect::<Vec<_>>().join(", ")
    };
    Some(match &types[ty].inner {
        TypeInner::Scalar(s) => several(1, s.kind),
        TypeInner::Vector { size, scalar } => {
            let n = *size as u32;
            format!("vec{n}<{}>({})", scalar_name(scalar.kind), several(n, scalar.kind))
        }
        TypeInner::Matrix { columns, rows, scalar } => {
            let (c, r) = (*columns as u32, *rows as u32);
            format!("mat{c}x{r}<{}>({})", scalar_name(scalar.kind), several(c * r, scalar.kind))
        }
        TypeInner::Array { base, size: naga::ArraySize::Constant(n), .. } => {
            let items: Option<Vec<String>> = (0..n.get()).map(|_| construct(types, *base, words)).collect();
            format!("array({})", items?.join(", "))
        }
        TypeInner::Struct { members, .. } => {
            let items: Option<Vec<String>> = members.iter().map(|m| construct(types, m.ty, words)).collect();
            format!("{}({})", types[ty].name.as_deref()?, items?.join(", "))
        }
        _ => return None,
    })
}

/// The statements that write `value` of a type to the next words.
fn destruct(
    types: &UniqueArena<Type>,
    ty: Handle<Type>,
    value: &str,
    result: &mut Vec<WordKind>,
    text: &mut String,
) -> Option<()> {
    let mut scalar = |kind: ScalarKind, value: String| {
        let (word, of) = match kind {
            ScalarKind::Float => (format!("bitcast<u32>({value})"), WordKind::Float),
            ScalarKind::Uint => (value, WordKind::Integer),
            ScalarKind::Sint => (format!("bitcast<u32>({value})"), WordKind::Integer),
            _ => (format!("select(0u, 1u, {value})"), WordKind::Integer),
        };
        let _ = writeln!(text, "    parity_out[base_out + {}u] = {word};", result.len());
        result.push(of);
    };
    match &types[ty].inner {
        TypeInner::Scalar(s) => scalar(s.kind, value.to_owned()),
        TypeInner::Vector { size, scalar: s } => {
            for i in 0..*size as u32 {
                scalar(s.kind, format!("{value}[{i}]"));
            }
        }
        TypeInner::Matrix { columns, rows, scalar: s } => {
            for c in 0..*columns as u32 {
                for r in 0..*rows as u32 {
                    scalar(s.kind, format!("{value}[{c}][{r}]"));
                }
            }
        }
        TypeInner::Array { base, size: naga::ArraySize::Constant(n), .. } => {
            for i in 0..n.get() {
                destruct(types, *base, &format!("{value}[{i}]"), result, text)?;
            }
        }
        TypeInner::Struct { members, .. } => {
            for member in members {
                destruct(types, member.ty, &format!("{value}.{}", member.name.as_deref()?), result, text)?;
            }
        }
        _ => return None,
    }
    Some(())
}

/// The names of all functions and entry points.
#[must_use]
pub fn all_functions() -> BTreeSet<String> {
    modules()
        .flat_map(|module| {
            let parsed = parse(&compose(&[module]));
            let functions = parsed.functions.iter().filter_map(|(_, f)| f.name.clone());
            functions.chain(parsed.entry_points.iter().map(|e| e.name.clone())).collect::<Vec<_>>()
        })
        .collect()
}

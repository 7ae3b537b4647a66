//! WGSL as tokens, and where functions stand in it.

use std::ops::Range;

/// Kind of a token.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// A name or a keyword.
    Name,
    /// A number.
    Number,
    /// An operator, a bracket or another sign.
    Sign,
}

/// A token and its position in the text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Token {
    /// Kind of the token.
    pub kind: Kind,
    /// Its bytes.
    pub at: Range<usize>,
}

impl Token {
    /// Its text.
    #[must_use]
    pub fn text<'a>(&self, source: &'a str) -> &'a str {
        &source[self.at.clone()]
    }
}

/// Signs of more than one character, longer ones first.
const SIGNS: [&str; 21] = [
    "<<=", ">>=", "->", "&&", "||", "==", "!=", "<=", ">=", "<<", ">>", "+=", "-=", "*=", "/=", "%=", "&=",
    "|=", "^=", "++", "--",
];

/// The tokens of a text, without comments.
#[must_use]
pub fn tokens(source: &str) -> Vec<Token> {
    let bytes = source.as_bytes();
    let mut found = Vec::new();
    let mut at = 0;
    let run = |from: usize, fits: &dyn Fn(u8) -> bool| {
        from + bytes[from..].iter().take_while(|&&b| fits(b)).count()
    };
    let word = |b: u8| b.is_ascii_alphanumeric() || b == b'_';
    while at < bytes.len() {
        let (rest, byte) = (&source[at..], bytes[at]);
        if byte.is_ascii_whitespace() {
            at += 1;
            continue;
        }
        if rest.starts_with("//") {
            at = run(at, &|b| b != b'\n');
            continue;
        }
        if rest.starts_with("/*") {
            at += rest.find("*/").map_or(rest.len(), |end| end + 2);
            continue;
        }
        let dotted = byte == b'.' && bytes.get(at + 1).is_some_and(u8::is_ascii_digit);
        let (kind, end) = if byte.is_ascii_digit() || dotted {
            (Kind::Number, number_end(bytes, at))
        } else if word(byte) {
            (Kind::Name, run(at, &word))
        } else {
            let sign = SIGNS.iter().find(|sign| rest.starts_with(**sign));
            (Kind::Sign, at + sign.map_or_else(|| rest.chars().next().map_or(1, char::len_utf8), |s| s.len()))
        };
        found.push(Token { kind, at: at..end });
        at = end;
    }
    found
}

/// End of a number: `1.5e-3f`, `0x1fu`, `12i`.
fn number_end(bytes: &[u8], from: usize) -> usize {
    let hex = bytes[from..].starts_with(b"0x");
    let mut at = from;
    while at < bytes.len() {
        let b = bytes[at];
        let sign_of_exponent = (b == b'-' || b == b'+') && !hex && matches!(bytes[at - 1], b'e' | b'E');
        // `v.0` is no WGSL: a dot in a number is always its point.
        if b.is_ascii_alphanumeric() || b == b'.' || (sign_of_exponent && at > from) {
            at += 1;
        } else {
            break;
        }
    }
    at
}

/// A function of a text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FunctionSpan {
    /// Its name.
    pub name: String,
    /// From `fn` to the closing brace.
    pub at: Range<usize>,
    /// Indices of the tokens between the braces of its body.
    pub body: Range<usize>,
}

/// The functions of a text, in their order.
#[must_use]
pub fn functions(source: &str, tokens: &[Token]) -> Vec<FunctionSpan> {
    let mut found = Vec::new();
    let mut at = 0;
    while at + 1 < tokens.len() {
        if tokens[at].text(source) != "fn" {
            at += 1;
            continue;
        }
        let name = tokens[at + 1].text(source).to_owned();
        let Some(open) = (at..tokens.len()).find(|&i| tokens[i].text(source) == "{") else { break };
        let close = closing(source, tokens, open);
        found.push(FunctionSpan {
            name,
            at: tokens[at].at.start..tokens[close].at.end,
            body: open + 1..close,
        });
        at = close + 1;
    }
    found
}

/// The index of the bracket that closes the one at `open`, or of the last token.
#[must_use]
pub fn closing(source: &str, tokens: &[Token], open: usize) -> usize {
    let mut depth = 0;
    for (at, token) in tokens.iter().enumerate().skip(open) {
        match token.text(source) {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth -= 1,
            _ => {}
        }
        if depth == 0 {
            return at;
        }
    }
    tokens.len() - 1
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn text_is_cut_into_tokens() {
        let source = "a.x+=1.5e-3f*b>>2u; // not this\nc<=-0x1fu /* nor this */ && d";
        let texts: Vec<&str> = tokens(source).iter().map(|t| t.text(source)).collect();
        let wanted =
            ["a", ".", "x", "+=", "1.5e-3f", "*", "b", ">>", "2u", ";", "c", "<=", "-", "0x1fu", "&&", "d"];
        assert_eq!(texts, wanted);
    }

    #[test]
    fn functions_are_found() {
        let source =
            "const A = 1;\nfn a(x: f32) -> f32 { if x > 0.0 { return x; } return 1.0; }\nfn b() {}\n";
        let tokens = tokens(source);
        let found = functions(source, &tokens);
        assert_eq!(found.iter().map(|f| f.name.as_str()).collect::<Vec<_>>(), ["a", "b"]);
        assert!(source[found[0].at.clone()].ends_with("return 1.0; }"));
        assert!(found[1].body.is_empty());
    }
}

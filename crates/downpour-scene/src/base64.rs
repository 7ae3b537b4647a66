//! Base64 of RFC 4648, section 4, as `data:` addresses hold it.
//!
//! Padding may be missing. White space and the URL-safe alphabet are refused.

/// The six bits of a character.
fn six_bits(byte: u8) -> Option<u32> {
    let value = match byte {
        b'A'..=b'Z' => byte.wrapping_sub(b'A'),
        b'a'..=b'z' => byte.wrapping_sub(b'a').wrapping_add(26),
        b'0'..=b'9' => byte.wrapping_sub(b'0').wrapping_add(52),
        b'+' => 62,
        b'/' => 63,
        _ => return None,
    };
    Some(u32::from(value))
}

/// Text without its padding: at most two signs, and only to complete a group of four.
fn digits(text: &str) -> &[u8] {
    let bytes = text.as_bytes();
    if !bytes.len().is_multiple_of(4) {
        return bytes;
    }
    let once = bytes.strip_suffix(b"=").unwrap_or(bytes);
    once.strip_suffix(b"=").unwrap_or(once)
}

/// Number of decoded bytes of the text, before anything is allocated; `None` if it is not base64.
pub(crate) fn decoded_len(text: &str) -> Option<usize> {
    let digits = digits(text);
    let rest = match digits.len() % 4 {
        0 => 0,
        1 => return None,
        rest => rest.saturating_sub(1),
    };
    let whole = digits.len() / 4;
    if digits.iter().all(|&byte| six_bits(byte).is_some()) {
        whole.checked_mul(3)?.checked_add(rest)
    } else {
        None
    }
}

/// Appends the first `wanted` bytes of the text, or all of them if it is shorter, to `out`.
///
/// A character outside the alphabet ends the reading: [`decoded_len`] has refused such a text before.
pub(crate) fn decode(text: &str, wanted: usize, out: &mut Vec<u8>) {
    let end = out.len().saturating_add(wanted);
    for group in digits(text).chunks(4) {
        let mut word = 0u32;
        for index in 0..4 {
            let Some(bits) = group.get(index).map_or(Some(0), |&byte| six_bits(byte)) else { return };
            word = (word << 6) | bits;
        }
        let [_, bytes @ ..] = word.to_be_bytes();
        for &byte in bytes.iter().take(group.len().saturating_sub(1)) {
            if out.len() == end {
                return;
            }
            out.push(byte);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The test vectors of RFC 4648, section 10, with and without padding.
    #[test]
    fn rfc_4648_vectors() {
        let vectors = [
            ("", ""),
            ("Zg==", "f"),
            ("Zm8=", "fo"),
            ("Zm9v", "foo"),
            ("Zm9vYg==", "foob"),
            ("Zm9vYmE=", "fooba"),
            ("Zm9vYmFy", "foobar"),
        ];
        for (text, plain) in vectors {
            for text in [text, text.trim_end_matches('=')] {
                let mut out = Vec::new();
                assert_eq!(decoded_len(text), Some(plain.len()), "{text}");
                decode(text, usize::MAX, &mut out);
                assert_eq!(out, plain.as_bytes(), "{text}");
            }
        }
    }

    #[test]
    fn what_is_no_base64_is_refused() {
        for text in ["A", "AAAAA", "Zm9v\n", "Zm9-", "=", "Zg=", "Z===", "Zg==Zg==", "`"] {
            assert_eq!(decoded_len(text), None, "{text}");
        }
    }

    #[test]
    fn no_more_than_wanted() {
        let mut out = Vec::new();
        decode("Zm9vYmFy", 4, &mut out);
        assert_eq!(out, b"foob");
    }
}

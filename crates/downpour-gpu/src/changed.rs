//! What has changed since it was written.

use std::ops::Range;

/// Ranges of `now` that differ from what was there `before`, in whole blocks of so many items, at least 1; those with less than `min_gap` items
/// between are one.
#[must_use]
pub fn changed_ranges<T: PartialEq>(
    before: &[T],
    now: &[T],
    block: usize,
    min_gap: usize,
) -> Vec<Range<usize>> {
    let block = block.max(1);
    let mut changed: Vec<Range<usize>> = Vec::new();
    for (k, part) in now.chunks(block).enumerate() {
        let range = k * block..k * block + part.len();
        if before.get(range.clone()) == Some(part) {
            continue;
        }
        match changed.last_mut() {
            Some(last) if range.start - last.end < min_gap => last.end = range.end,
            _ => changed.push(range),
        }
    }
    changed
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changed_ranges_are_all_that_differs() {
        let mut known = vec![7u8; 1003];
        let mut bytes = vec![7u8; 1201];
        for at in [0, 63, 64, 400, 401, 999, 1002] {
            bytes[at] = 1;
        }
        let ranges = changed_ranges(&known, &bytes, 64, 256);
        assert!(ranges.windows(2).all(|pair| pair[1].start - pair[0].end >= 256), "{ranges:?}");
        assert!(ranges.iter().all(|range| range.start % 64 == 0));
        known.resize(bytes.len(), 0);
        for range in ranges {
            known[range.clone()].copy_from_slice(&bytes[range]);
        }
        assert_eq!(known, bytes);
    }
}

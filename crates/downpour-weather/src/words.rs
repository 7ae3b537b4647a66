//! Suggestions for misspelled words.

/// Maximum length of a wrong word that is compared, in bytes: longer ones are near no key, and the work grows with it.
const MAX_COMPARED: usize = 64;

/// Known word nearest to a wrong one: the same quantity in another unit, or a few typing errors away.
pub(super) fn nearest<'a>(wrong: &str, known: &[&'a str]) -> Option<&'a str> {
    if wrong.len() > MAX_COMPARED {
        return None;
    }
    let first = |word: &str| word.split(['_', '-']).next().unwrap_or_default().to_ascii_lowercase();
    let same_quantity = |word: &&&str| first(word) == first(wrong);
    let closest = |words: &mut dyn Iterator<Item = &&'a str>| {
        words.map(|word| (distance(wrong, word), *word)).min_by_key(|(distance, _)| *distance)
    };
    if let Some((_, word)) = closest(&mut known.iter().filter(same_quantity)) {
        return Some(word);
    }
    let (distance, word) = closest(&mut known.iter())?;
    (distance <= wrong.chars().count().max(4) / 3).then_some(word)
}

/// Sorts words by their distance from a wrong one; words as far away as each other, and all words where the wrong one is too long to
/// compare, keep their order.
pub(super) fn nearest_first(wrong: &str, known: &mut [&str]) {
    if wrong.len() <= MAX_COMPARED {
        known.sort_by_cached_key(|word| distance(wrong, word));
    }
}

/// Number of letters to insert, delete, change, or swap with the next (optimal string alignment).
fn distance(a: &str, b: &str) -> usize {
    let letters = |word: &str| word.to_ascii_lowercase().chars().collect::<Vec<char>>();
    let (a, b) = (letters(a), letters(b));
    let mut before: Vec<usize> = Vec::new();
    let mut last: Vec<usize> = (0..=b.len()).collect();
    let mut previous = None;
    for (i, &x) in a.iter().enumerate() {
        let mut row = vec![i.saturating_add(1)];
        for (j, &y) in b.iter().enumerate() {
            let at = |row: &[usize], j: usize| row.get(j).copied().unwrap_or(usize::MAX);
            let next = j.saturating_add(1);
            let changed = at(&last, j).saturating_add(usize::from(x != y));
            let mut best = changed.min(at(&last, next).saturating_add(1)).min(at(&row, j).saturating_add(1));
            if let Some(back) = j.checked_sub(1)
                && previous == Some(y)
                && b.get(back) == Some(&x)
            {
                best = best.min(at(&before, back).saturating_add(1));
            }
            row.push(best);
        }
        before = std::mem::replace(&mut last, row);
        previous = Some(x);
    }
    last.last().copied().unwrap_or(usize::MAX)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_are_those_of_the_definition() {
        for (a, b, expected) in [
            ("", "", 0),
            ("", "abc", 3),
            ("abc", "", 3),
            ("rain", "rain", 0),
            ("rian", "rain", 1),
            ("ran", "rain", 1),
            ("Rain", "rain", 0),
            ("kitten", "sitting", 3),
            ("ca", "abc", 3),
        ] {
            assert_eq!(distance(a, b), expected, "{a} {b}");
        }
    }

    #[test]
    fn slips_and_other_units_find_their_key() {
        let keys = ["rate_mm_h", "distribution", "seed", "temperature_c", "pressure_hpa", "box_m"];
        for (wrong, key) in [
            ("rate", "rate_mm_h"),
            ("rate_m_s", "rate_mm_h"),
            ("ratemm_h", "rate_mm_h"),
            ("temperature_k", "temperature_c"),
            ("sede", "seed"),
            ("Seed", "seed"),
            ("distirbution", "distribution"),
        ] {
            assert_eq!(nearest(wrong, &keys), Some(key), "{wrong}");
        }
        for wrong in ["wind", "", "xyzzy", &"seed".repeat(100_000)] {
            assert_eq!(nearest(wrong, &keys), None);
        }
    }

    #[test]
    fn the_nearest_words_come_first() {
        let words = ["bark", "brick", "brick_pale", "roof"];
        let sorted = |wrong: &str| {
            let mut words = words;
            nearest_first(wrong, &mut words);
            words
        };
        assert_eq!(sorted("bricks"), ["brick", "bark", "brick_pale", "roof"]);
        assert_eq!(sorted(&"roof".repeat(100_000)), words);
    }
}

//! Numbers of the command line, each in its range.

use std::fmt::Display;
use std::ops::RangeInclusive;
use std::str::FromStr;

/// A number in a range.
pub(crate) fn within<T>(range: RangeInclusive<T>) -> impl Fn(&str) -> Result<T, String> + Clone + Send + Sync
where
    T: FromStr + PartialOrd + Display + Clone + Send + Sync,
{
    move |text: &str| {
        let number = text.parse().ok().filter(|value| range.contains(value));
        number.ok_or_else(|| format!("allowed: {} to {}", range.start(), range.end()))
    }
}

/// Columns and rows of a picture.
pub(crate) fn size(text: &str) -> Result<[u32; 2], String> {
    let edge = within(64..=4096);
    let (columns, rows) = text.split_once('x').ok_or("allowed: WxH")?;
    Ok([edge(columns)?, edge(rows)?])
}

//! A weather file with changes.

use toml_edit::{DocumentMut, Item, Table};

/// The text of a file with the keys of another, table by table; tables of the names `without` are left out first.
pub(super) fn merged(text: &str, changes: &str, without: &[&str]) -> Result<String, String> {
    let parsed = |text: &str| text.parse::<DocumentMut>().map_err(|error| error.to_string());
    let (mut base, changes) = (parsed(text)?, parsed(changes)?);
    for name in without {
        base.remove(name).ok_or_else(|| format!("there is no {name} to leave out"))?;
    }
    merge(base.as_table_mut(), &changes);
    Ok(base.to_string())
}

fn merge(base: &mut Table, changes: &Table) {
    for (key, change) in changes {
        match (base.get_mut(key), change) {
            (Some(Item::Table(own)), Item::Table(change)) => merge(own, change),
            _ => {
                base.insert(key, change.clone());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn changes_are_merged_table_by_table() {
        let made = merged(
            "[rain]\nrate_mm_h = 5\nseed = 1\n[fog]\nbase_m = 1\n",
            "[rain]\nrate_mm_h = 9\n[glow]\nglare = 0\n",
            &["fog"],
        );
        let made = made.expect("a file");
        for kept in ["rate_mm_h = 9", "seed = 1", "[glow]\nglare = 0"] {
            assert!(made.contains(kept), "{kept}: {made}");
        }
        assert!(!made.contains("fog") && !made.contains("= 5"), "{made}");
        assert!(merged("", "", &["fog"]).is_err() && merged("[", "", &[]).is_err());
    }
}

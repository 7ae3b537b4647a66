//! Edits of the text of a weather file, which keep its comments, its order and the way in which it is written.

use toml_edit::{ArrayOfTables, DocumentMut, InlineTable, Item, RawString, Table, TableLike, Value};

use super::error::DocumentError;
use crate::key_path::{KeyPath, Step};
use crate::plain::Plain;

/// Mark of the comment that names an entry of a list.
const NAME_MARK: &str = "# name: ";

/// Sets the value of a key; tables on the way are added.
pub(super) fn set(document: &mut DocumentMut, path: &KeyPath, value: &Plain) -> Result<(), DocumentError> {
    set_in(document.as_table_mut(), path.steps(), value, true).ok_or_else(|| absent(path))
}

/// Removes a key, so that its default holds, and the table that is empty without it.
pub(super) fn remove(document: &mut DocumentMut, path: &KeyPath) -> Result<(), DocumentError> {
    remove_in(document.as_table_mut(), path.steps()).ok_or_else(|| absent(path))
}

/// Adds an entry at the end of a list. Returns its index.
pub(super) fn add_entry(
    document: &mut DocumentMut,
    list: &KeyPath,
    entry: &Plain,
) -> Result<usize, DocumentError> {
    with_list(document.as_table_mut(), list.steps(), &mut |list| match list {
        List::Tables(tables) => {
            let mut table = Table::new();
            for (key, value) in entry.entries() {
                table.insert(key, Item::Value(value.to_value()));
            }
            tables.push(table);
            Some(tables.len() - 1)
        }
        List::Inline(array) => {
            let mut value = entry.to_value();
            value.decor_mut().set_prefix(before_next(array));
            array.push_formatted(value);
            Some(array.len() - 1)
        }
    })
    .ok_or_else(|| absent(list))
}

/// The text before an entry that is added at the end of an array: the comment of the entry before, and a new line as it has.
fn before_next(array: &mut toml_edit::Array) -> String {
    let mut comment = String::new();
    if array.trailing_comma() {
        let trailing = text(Some(array.trailing()));
        if let Some(end) = trailing.find('\n') {
            comment = trailing[..end].trim_end().to_owned();
            array.set_trailing(trailing[end..].to_owned());
        }
    } else if let Some(last) = array.iter_mut().last() {
        comment = text(last.decor().suffix()).trim_end().to_owned();
        last.decor_mut().set_suffix("");
    }
    let prefix = array.iter().last().map(|last| text(last.decor().prefix())).unwrap_or_default();
    match prefix.rfind('\n') {
        Some(at) => format!("{comment}\n{}", &prefix[at + 1..]),
        None => prefix,
    }
}

/// Copies an entry of a list behind itself. Returns the index of the copy.
pub(super) fn duplicate_entry(
    document: &mut DocumentMut,
    list: &KeyPath,
    index: usize,
) -> Result<usize, DocumentError> {
    with_list(document.as_table_mut(), list.steps(), &mut |list| match list {
        List::Tables(tables) => {
            let mut copy = tables.get(index)?.clone();
            without_positions(&mut copy);
            // A comment is about the original.
            let blank = "\n".repeat(text(copy.decor().prefix()).matches('\n').count().min(1));
            copy.decor_mut().set_prefix(blank);
            tables.insert(index + 1, copy);
            // Tables behind it have their old positions: the copy follows the original.
            Some(index + 1)
        }
        List::Inline(array) => {
            let mut copy = array.get(index)?.clone();
            let prefix = text(copy.decor().prefix());
            let plain = prefix.rfind('\n').map_or(prefix.clone(), |at| format!("\n{}", &prefix[at + 1..]));
            copy.decor_mut().set_prefix(plain);
            array.insert_formatted(index + 1, copy);
            Some(index + 1)
        }
    })
    .ok_or_else(|| absent(&list.entry(index)))
}

/// Deletes an entry of a list; a list without entries is removed.
pub(super) fn remove_entry(
    document: &mut DocumentMut,
    list: &KeyPath,
    index: usize,
) -> Result<(), DocumentError> {
    let left = with_list(document.as_table_mut(), list.steps(), &mut |list| match list {
        List::Tables(tables) => {
            tables.get(index)?;
            tables.remove(index);
            Some(tables.len())
        }
        List::Inline(array) => {
            array.get(index)?;
            let removed = array.remove(index);
            // The comment behind the entry before stands before this one; that behind this one goes with it.
            let before = text(removed.decor().prefix());
            let kept = before.split('\n').next().unwrap_or_default().trim_end();
            let behind = |raw: String| raw.find('\n').map(|end| format!("{kept}{}", &raw[end..]));
            if let Some(next) = array.get_mut(index) {
                if let Some(prefix) = behind(text(next.decor().prefix())) {
                    next.decor_mut().set_prefix(prefix);
                }
            } else if let Some(trailing) = behind(text(Some(array.trailing()))) {
                array.set_trailing(trailing);
            }
            Some(array.len())
        }
    });
    match left.ok_or_else(|| absent(&list.entry(index)))? {
        0 => remove(document, list),
        _ => Ok(()),
    }
}

/// Name of an entry of a list, from the comment before it.
pub(super) fn entry_name(document: &DocumentMut, list: &str, index: usize) -> Option<String> {
    let prefix = match document.get(list)? {
        Item::ArrayOfTables(tables) => text(tables.get(index)?.decor().prefix()),
        Item::Value(Value::Array(array)) => text(array.get(index)?.decor().prefix()),
        _ => return None,
    };
    let line = prefix.lines().map(str::trim).rfind(|line| line.starts_with(NAME_MARK))?;
    Some(line[NAME_MARK.len()..].to_owned())
}

/// Names an entry of a list, by a comment before it; an empty name removes the comment.
pub(super) fn set_entry_name(
    document: &mut DocumentMut,
    list: &KeyPath,
    index: usize,
    name: &str,
) -> Result<(), DocumentError> {
    let name: String = name.chars().map(|c| if c.is_control() { ' ' } else { c }).take(80).collect();
    with_list(document.as_table_mut(), list.steps(), &mut |list| match list {
        List::Tables(tables) => {
            let decor = tables.get_mut(index)?.decor_mut();
            // A table that was added stands after an empty line.
            let before = decor.prefix().map_or_else(|| "\n".to_owned(), |raw| text(Some(raw)));
            decor.set_prefix(named(&before, false, name.trim()));
            Some(())
        }
        List::Inline(array) => {
            let decor = array.get_mut(index)?.decor_mut();
            decor.set_prefix(named(&text(decor.prefix()), true, name.trim()));
            Some(())
        }
    })
    .ok_or_else(|| absent(&list.entry(index)))
}

/// The text before an entry, with the comment that names it in place of an older one. An entry within an array begins a line.
fn named(prefix: &str, is_inline: bool, name: &str) -> String {
    let mut lines: Vec<&str> =
        prefix.split('\n').filter(|line| !line.trim().starts_with(NAME_MARK)).collect();
    if name.is_empty() {
        return lines.join("\n");
    }
    let mut indent = lines.pop().unwrap_or_default();
    if is_inline && lines.is_empty() {
        (lines, indent) = (vec![""], "    ");
    }
    let mark = format!("{indent}{NAME_MARK}{name}");
    lines.extend([mark.as_str(), indent]);
    lines.join("\n")
}

/// A list of entries, as it is written.
enum List<'a> {
    Tables(&'a mut ArrayOfTables),
    Inline(&'a mut toml_edit::Array),
}

/// Does something to a list, which is added if it is absent.
fn with_list<T>(
    table: &mut dyn TableLike,
    steps: &[Step],
    edit: &mut dyn FnMut(List<'_>) -> Option<T>,
) -> Option<T> {
    let (Step::Key(key), rest) = steps.split_first()? else { return None };
    if rest.is_empty() {
        if !table.contains_key(key) {
            table.insert(key, Item::ArrayOfTables(ArrayOfTables::new()));
        }
        return match table.get_mut(key)? {
            Item::ArrayOfTables(tables) => edit(List::Tables(tables)),
            Item::Value(Value::Array(array)) => edit(List::Inline(array)),
            _ => None,
        };
    }
    let (inner, rest) = inner(table.get_mut(key)?, rest)?;
    with_list(inner, rest, edit)
}

/// The table that an item is, or that an entry of it is, and the steps that are left.
fn inner<'a, 'b>(item: &'a mut Item, steps: &'b [Step]) -> Option<(&'a mut dyn TableLike, &'b [Step])> {
    let Some(Step::Entry(index)) = steps.first() else { return Some((item.as_table_like_mut()?, steps)) };
    let table: &mut dyn TableLike = match item {
        Item::ArrayOfTables(tables) => tables.get_mut(*index)?,
        Item::Value(Value::Array(array)) => array.get_mut(*index)?.as_inline_table_mut()?,
        _ => return None,
    };
    Some((table, &steps[1..]))
}

fn set_in(table: &mut dyn TableLike, steps: &[Step], value: &Plain, is_block: bool) -> Option<()> {
    let (Step::Key(key), rest) = steps.split_first()? else { return None };
    if let Some(Step::Entry(index)) = rest.first()
        && rest.len() == 1
    {
        // An element of a vector.
        let array = table.get_mut(key)?.as_array_mut()?;
        replace(array.get_mut(*index)?, value);
        return Some(());
    }
    if rest.is_empty() {
        match table.get_mut(key) {
            Some(Item::Value(old)) => replace(old, value),
            _ => {
                table.insert(key, Item::Value(value.to_value()));
            }
        }
        return Some(());
    }
    if !table.contains_key(key) {
        let added = if is_block { Item::Table(Table::new()) } else { Item::Value(InlineTable::new().into()) };
        table.insert(key, added);
    }
    let item = table.get_mut(key)?;
    let is_block = item.is_table();
    let (inner, rest) = inner(item, rest)?;
    set_in(inner, rest, value, is_block)
}

fn remove_in(table: &mut dyn TableLike, steps: &[Step]) -> Option<()> {
    let (Step::Key(key), rest) = steps.split_first()? else { return None };
    if rest.is_empty() {
        return table.remove(key).map(|_| ());
    }
    let (inner, after) = inner(table.get_mut(key)?, rest)?;
    remove_in(inner, after)
}

/// Replaces a value; what stays the same keeps its form, comments within arrays stay.
fn replace(old: &mut Value, new: &Plain) {
    match (&mut *old, new) {
        (Value::Integer(number), Plain::Number(found)) if *number.value() as f64 == *found => return,
        (Value::Float(number), Plain::Number(found)) if number.value() == found => return,
        (Value::String(text), Plain::Text(found)) if text.value() == found => return,
        (Value::Array(array), Plain::List(list)) => {
            while array.len() > list.len() {
                array.remove(array.len() - 1);
            }
            for (i, value) in list.iter().enumerate() {
                if let Some(element) = array.get_mut(i) {
                    replace(element, value);
                } else {
                    let mut value = value.to_value();
                    let prefix = array.iter().last().map(|last| text(last.decor().prefix()));
                    let prefix = prefix.map(|p| if i == 1 && !p.contains('\n') { " ".to_owned() } else { p });
                    value.decor_mut().set_prefix(prefix.unwrap_or_default());
                    array.push_formatted(value);
                }
            }
            return;
        }
        _ => {}
    }
    let decor = old.decor().clone();
    *old = new.to_value();
    *old.decor_mut() = decor;
}

/// Lets tables stand where they are added.
fn without_positions(table: &mut Table) {
    table.set_position(None);
    for (_, item) in table.iter_mut() {
        match item {
            Item::Table(inner) => without_positions(inner),
            Item::ArrayOfTables(tables) => tables.iter_mut().for_each(without_positions),
            _ => {}
        }
    }
}

fn text(raw: Option<&RawString>) -> String {
    raw.and_then(RawString::as_str).unwrap_or_default().to_owned()
}

fn absent(path: &KeyPath) -> DocumentError {
    DocumentError::Absent { path: path.to_string() }
}

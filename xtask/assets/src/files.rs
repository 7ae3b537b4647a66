//! Files of a folder that code makes: written so that none is ever there in part, and compared byte for byte.

use std::path::Path;

/// Name of a file, below its folder, and its bytes.
pub(crate) type Asset = (String, Vec<u8>);

/// Bytes of all files.
pub(crate) fn total<'a>(assets: impl IntoIterator<Item = &'a Asset>) -> usize {
    assets.into_iter().map(|(_, bytes)| bytes.len()).sum()
}

/// Writes files to a folder, and lists them.
pub(crate) fn write(folder: &Path, assets: &[Asset]) -> Result<(), String> {
    assets.iter().try_for_each(|(name, bytes)| publish(folder, name, bytes))
}

/// Writes one, and lists it.
pub(crate) fn publish(folder: &Path, name: &str, bytes: &[u8]) -> Result<(), String> {
    let path = folder.join(name);
    save(&path, bytes).map_err(|error| format!("{}: {error}", path.display()))?;
    println!("{:>9} bytes  {}", bytes.len(), path.display());
    Ok(())
}

fn save(path: &Path, bytes: &[u8]) -> std::io::Result<()> {
    if let Some(parent) = path.parent() {
        std::fs::create_dir_all(parent)?;
    }
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let part = path.with_file_name(format!(".{name}.part"));
    std::fs::write(&part, bytes)?;
    std::fs::rename(&part, path)
}

/// What differs between the files of a folder and those that were made, a line each.
pub(crate) fn differences(folder: &Path, assets: &[Asset]) -> Vec<String> {
    let mut wrong = Vec::new();
    for (name, made) in assets {
        match std::fs::read(folder.join(name)) {
            Ok(kept) if kept == *made => {}
            Ok(kept) => {
                let same = kept.iter().zip(made).take_while(|(a, b)| a == b).count();
                let (kept, made) = (kept.len(), made.len());
                wrong.push(format!("{name}: differs from byte {same} on ({kept} bytes kept, {made} made)"));
            }
            Err(error) => wrong.push(format!("{name}: {error}")),
        }
    }
    wrong
}

/// Says that the files are those that were made, or how they differ and which task makes them.
pub(crate) fn verdict(what: &str, task: &str, differences: &[String]) -> Result<(), String> {
    if differences.is_empty() {
        println!("{what}: equal to the generated files, byte for byte");
        return Ok(());
    }
    Err(format!("{what}: not the generated files (cargo xtask {task}):\n  {}", differences.join("\n  ")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_written_is_equal_and_what_was_changed_is_named() {
        let folder = tempfile::tempdir().expect("a folder");
        let assets = [("a".to_owned(), vec![1, 2, 3]), ("below/b".to_owned(), vec![4])];
        write(folder.path(), &assets).expect("written");
        assert_eq!(total(&assets), 4);
        assert_eq!(differences(folder.path(), &assets), [""; 0]);
        std::fs::write(folder.path().join("a"), [1, 2, 4, 5]).expect("written");
        std::fs::remove_file(folder.path().join("below/b")).expect("removed");
        let wrong = differences(folder.path(), &assets);
        assert_eq!(wrong[0], "a: differs from byte 2 on (4 bytes kept, 3 made)");
        assert!(wrong.len() == 2 && wrong[1].starts_with("below/b: "), "{wrong:?}");
        let message = verdict("both", "masks", &wrong).expect_err("they differ");
        assert!(message.contains("cargo xtask masks") && message.contains("from byte 2"), "{message}");
    }
}

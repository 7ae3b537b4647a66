//! The complete text of every kernel, for tools that take WGSL files.

use xtask::run;

/// Writes one file per kernel to `folder`, below the root if it is relative.
pub(crate) fn write(folder: &str) -> Result<(), String> {
    let folder = run::root().join(folder);
    std::fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    for kernel in downpour_shaders::kernels() {
        let path = folder.join(format!("{}.wgsl", kernel.entry));
        std::fs::write(&path, kernel.source()).map_err(|error| format!("{}: {error}", path.display()))?;
        println!("{}", path.display());
    }
    Ok(())
}

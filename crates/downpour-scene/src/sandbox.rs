//! Sandbox for files that a scene file names: only regular files inside one folder are opened.
//!
//! A scene file may name others. A checked [`RelativePath`] has no `..`, but a symbolic link in the folder can
//! still lead out of it, and a FIFO or a device never ends. On Linux the kernel itself rejects a path that
//! leaves the folder (`openat2` with `RESOLVE_BENEATH | RESOLVE_NO_MAGICLINKS`). Without that call, the
//! path is resolved first and its prefix compared with the folder's; a link that is exchanged between the
//! two steps is then not detected. Files are opened without blocking (`O_NONBLOCK`) and examined through the open
//! handle.

use crate::Budget;
use crate::error::{SceneError, quoted, shown_path, size, subject};
pub use crate::uri::RelativePath;
use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, Cursor, Read};
use std::path::{Path, PathBuf};

/// Maximum length of a file that is read as a whole, in bytes: 1 GiB.
pub const MAX_FILE: u64 = 1 << 30;

const REGULAR: &str = "a regular file";
const INSIDE: &str = "only files inside the scene folder";
const COPY_HERE: &str = "copy the file into the scene folder";

/// A file that is open for reading, with its length.
pub struct OpenFile {
    /// Its length in bytes, when it was opened.
    pub size: u64,
    /// Its bytes.
    pub bytes: Box<dyn Read>,
}

impl OpenFile {
    /// Reads all bytes of the file. Nothing is deducted from the budget, which limits the length.
    ///
    /// # Errors
    /// [`SceneError::OverLimit`] for a file of more than [`MAX_FILE`] bytes, or more than the budget has left;
    /// [`SceneError::Unreadable`] if the system fails to read it.
    pub fn read_all(self, budget: &Budget) -> Result<Vec<u8>, SceneError> {
        let most = MAX_FILE.min(budget.bytes);
        if self.size > most {
            let allowed = format!("at most {most} bytes ({})", size(most));
            return Err(SceneError::limit("", format!("a file of {} bytes", self.size), allowed));
        }
        let mut bytes = Budget::vec_with_capacity(usize::try_from(self.size).unwrap_or(usize::MAX), "")?;
        self.bytes.take(self.size).read_to_end(&mut bytes).map_err(|error| SceneError::io("", "", &error))?;
        Ok(bytes)
    }
}

/// Source of the files that a scene file names.
pub trait Files {
    /// Opens a file.
    ///
    /// # Errors
    /// [`SceneError::Unreadable`]: the file is missing or cannot be read; [`SceneError::BadInput`]: it is not a regular file beneath the
    /// folder.
    fn open(&self, path: &RelativePath) -> Result<OpenFile, SceneError>;
}

/// No files at all: for a GLB or a glTF that holds all its data itself.
#[derive(Clone, Copy, Debug, Default)]
pub struct NoFiles;

impl Files for NoFiles {
    fn open(&self, path: &RelativePath) -> Result<OpenFile, SceneError> {
        let found = format!("{} is another file", quoted(path.as_str()));
        Err(SceneError::bad("", found, "data in the file itself").with_advice("export as one .glb"))
    }
}

/// Files in memory by their relative path, for tests and for the web.
impl Files for BTreeMap<String, Vec<u8>> {
    fn open(&self, path: &RelativePath) -> Result<OpenFile, SceneError> {
        let Some(bytes) = self.get(path.as_str()) else {
            return Err(SceneError::io("", path.as_str(), &io::ErrorKind::NotFound.into()));
        };
        Ok(OpenFile { size: bytes.len() as u64, bytes: Box::new(Cursor::new(bytes.clone())) })
    }
}

/// A folder on disk with all its subfolders.
#[derive(Debug)]
pub struct Folder {
    path: PathBuf,
    #[cfg(target_os = "linux")]
    handle: std::os::fd::OwnedFd,
}

impl Folder {
    /// Opens a folder.
    ///
    /// # Errors
    /// The folder is missing, is no folder, or may not be opened.
    pub fn open(path: &Path) -> Result<Self, SceneError> {
        let path = if path.as_os_str().is_empty() { Path::new(".") } else { path };
        let named = |error: io::Error| SceneError::io("", "", &error).in_file(&shown_path(path));
        if !fs::metadata(path).map_err(named)?.is_dir() {
            return Err(SceneError::bad("", "no folder", "a folder").in_file(&shown_path(path)));
        }
        Ok(Self {
            path: path.to_owned(),
            #[cfg(target_os = "linux")]
            handle: {
                use rustix::fs::{Mode, OFlags, open};
                // A handle that only marks the folder, which need not be readable.
                let flags = OFlags::PATH | OFlags::DIRECTORY | OFlags::CLOEXEC;
                open(path, flags, Mode::empty()).map_err(|error| named(error.into()))?
            },
        })
    }

    /// Opens a path with the kernel's own test; `None` if the kernel lacks it.
    #[cfg(target_os = "linux")]
    fn open_resolved(&self, path: &RelativePath) -> Option<Result<File, Refusal>> {
        use rustix::fs::{Mode, ResolveFlags, openat2};
        use rustix::io::Errno;
        let resolve = ResolveFlags::BENEATH | ResolveFlags::NO_MAGICLINKS;
        // EAGAIN: a name was moved while the kernel walked the path.
        for _ in 0..16 {
            match openat2(&self.handle, path.as_str(), read_flags(), Mode::empty(), resolve) {
                Ok(handle) => return Some(Ok(File::from(handle))),
                // Old kernels do not have the call; some sandboxes answer EPERM to all calls that they do not recognize.
                Err(Errno::NOSYS | Errno::PERM) => return None,
                Err(Errno::AGAIN | Errno::INTR) => {}
                Err(Errno::XDEV | Errno::LOOP) => return Some(Err(Refusal::Leaves)),
                Err(error) => return Some(Err(Refusal::System(error.into()))),
            }
        }
        Some(Err(Refusal::System(io::ErrorKind::ResourceBusy.into())))
    }

    #[cfg(not(target_os = "linux"))]
    fn open_resolved(&self, _path: &RelativePath) -> Option<Result<File, Refusal>> {
        None
    }

    /// The portable test: resolve both, compare their beginnings.
    fn open_compared(&self, path: &RelativePath) -> Result<File, Refusal> {
        let folder = fs::canonicalize(&self.path).map_err(Refusal::System)?;
        let target = fs::canonicalize(folder.join(path.as_str())).map_err(Refusal::System)?;
        if !target.starts_with(&folder) {
            return Err(Refusal::Leaves);
        }
        // Opening may block: test first.
        let sort = fs::metadata(&target).map_err(Refusal::System)?.file_type();
        if !sort.is_file() {
            return Err(Refusal::NotRegular(sort_name(sort)));
        }
        open_for_reading(&target).map_err(Refusal::System)
    }
}

impl Files for Folder {
    fn open(&self, path: &RelativePath) -> Result<OpenFile, SceneError> {
        let file = self.open_resolved(path).unwrap_or_else(|| self.open_compared(path));
        let file = file.and_then(|file| regular(&file).map(|size| OpenFile { size, bytes: Box::new(file) }));
        file.map_err(|refusal| refusal.into_error(path.as_str()))
    }
}

/// Opens a regular file that the user has named, in any folder.
///
/// # Errors
/// The file is missing or cannot be opened, or is no regular file.
pub fn open_named(path: &Path) -> Result<OpenFile, SceneError> {
    let look = || -> Result<OpenFile, Refusal> {
        // Before opening: the mere opening of some devices does something.
        let sort = fs::metadata(path).map_err(Refusal::System)?.file_type();
        if !sort.is_file() {
            return Err(Refusal::NotRegular(sort_name(sort)));
        }
        let file = open_for_reading(path).map_err(Refusal::System)?;
        Ok(OpenFile { size: regular(&file)?, bytes: Box::new(file) })
    };
    look().map_err(|refusal| refusal.into_error("").in_file(&shown_path(path)))
}

/// Reason why a file was not opened.
enum Refusal {
    Leaves,
    NotRegular(&'static str),
    System(io::Error),
}

impl Refusal {
    /// Converts to the error; `name` is empty if the message already begins with the file.
    fn into_error(self, name: &str) -> SceneError {
        let file = subject(name);
        match self {
            Self::Leaves => {
                let found = format!("{file}leaves the scene folder through a link");
                SceneError::bad("", found, INSIDE).with_advice(COPY_HERE)
            }
            Self::NotRegular(sort) => {
                SceneError::bad("", format!("{file}is {sort}, not a regular file"), REGULAR)
            }
            Self::System(error) => SceneError::io("", name, &error),
        }
    }
}

/// The length of an open file, if it is one that ends.
fn regular(file: &File) -> Result<u64, Refusal> {
    let about = file.metadata().map_err(Refusal::System)?;
    if about.is_file() { Ok(about.len()) } else { Err(Refusal::NotRegular(sort_name(about.file_type()))) }
}

#[cfg(unix)]
fn read_flags() -> rustix::fs::OFlags {
    use rustix::fs::OFlags;
    OFlags::RDONLY | OFlags::CLOEXEC | OFlags::NONBLOCK | OFlags::NOCTTY
}

#[cfg(unix)]
fn open_for_reading(path: &Path) -> io::Result<File> {
    Ok(File::from(rustix::fs::open(path, read_flags(), rustix::fs::Mode::empty())?))
}

#[cfg(not(unix))]
fn open_for_reading(path: &Path) -> io::Result<File> {
    File::open(path)
}

#[cfg(unix)]
fn sort_name(sort: fs::FileType) -> &'static str {
    use std::os::unix::fs::FileTypeExt;
    match sort {
        _ if sort.is_dir() => "a folder",
        _ if sort.is_fifo() => "a FIFO",
        _ if sort.is_socket() => "a socket",
        _ => "a device",
    }
}

#[cfg(not(unix))]
fn sort_name(sort: fs::FileType) -> &'static str {
    if sort.is_dir() { "a folder" } else { "a device" }
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use crate::uri::{Address, check};
    use std::os::unix::fs::symlink;

    fn path(text: &str) -> RelativePath {
        match check(text) {
            Ok(Address::File(path)) => path,
            other => panic!("{text}: {other:?}"),
        }
    }

    /// Both methods of opening agree on the files that may be opened.
    #[test]
    fn the_kernel_and_the_comparison_agree() {
        let outside = tempfile::tempdir().unwrap();
        fs::write(outside.path().join("secret"), b"secret").unwrap();
        let inside = tempfile::tempdir().unwrap();
        let root = inside.path();
        fs::create_dir(root.join("sub")).unwrap();
        fs::write(root.join("sub/a.bin"), b"abc").unwrap();
        symlink("sub/a.bin", root.join("near")).unwrap();
        symlink(outside.path().join("secret"), root.join("far")).unwrap();
        symlink(outside.path(), root.join("way")).unwrap();
        symlink("self", root.join("self")).unwrap();
        rustix::fs::mknodat(
            rustix::fs::CWD,
            root.join("fifo"),
            rustix::fs::FileType::Fifo,
            rustix::fs::Mode::RUSR,
            0,
        )
        .unwrap();
        let folder = Folder::open(root).unwrap();
        type Way = fn(&Folder, &RelativePath) -> Result<u64, Refusal>;
        let ways: [Way; 2] = [
            |folder, path| {
                folder
                    .open_resolved(path)
                    .unwrap_or_else(|| folder.open_compared(path))
                    .and_then(|f| regular(&f))
            },
            |folder, path| folder.open_compared(path).and_then(|f| regular(&f)),
        ];
        for way in ways {
            assert!(matches!(way(&folder, &path("sub/a.bin")), Ok(3)));
            assert!(matches!(way(&folder, &path("near")), Ok(3)));
            assert!(matches!(way(&folder, &path("far")), Err(Refusal::Leaves)));
            assert!(matches!(way(&folder, &path("way/secret")), Err(Refusal::Leaves)));
            assert!(matches!(way(&folder, &path("fifo")), Err(Refusal::NotRegular("a FIFO"))));
            assert!(matches!(way(&folder, &path("sub")), Err(Refusal::NotRegular("a folder"))));
            assert!(matches!(way(&folder, &path("missing")), Err(Refusal::System(_))));
            assert!(way(&folder, &path("self")).is_err());
        }
    }

    #[test]
    fn a_folder_is_a_folder() {
        assert!(matches!(Folder::open(Path::new("/dev/null")), Err(SceneError::BadInput(_))));
        assert!(matches!(Folder::open(Path::new("/no/such")), Err(SceneError::Unreadable(_))));
        assert!(Folder::open(Path::new("")).is_ok());
    }
}

//! Files that appear whole or not at all.
//!
//! The content goes to a temporary file in the same folder, is brought to the disk, and then
//! takes the name in one step. Whatever fails on the way, the temporary file is removed and an
//! older file of that name stays as it was.

use std::fs::{self, File, Metadata};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};

use tempfile::NamedTempFile;

use super::{WriteError, display_name, is_standard_stream};

/// Writes what `fill` gives to `path`, whole or not at all; `-` is standard output, whose reader may
/// stop when it has seen enough (`| head`).
///
/// A symbolic link keeps pointing where it did and what it points to is replaced. Devices and
/// pipes cannot be replaced and are written to directly.
pub fn write_atomically(
    path: &Path,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Result<(), WriteError> {
    let file = display_name(path, "standard output");
    if is_standard_stream(path) {
        return match fill_and_flush(io::stdout().lock(), fill) {
            Err(source) if source.kind() != io::ErrorKind::BrokenPipe => {
                Err(WriteError::Io { file, source })
            }
            _ => Ok(()),
        };
    }
    check_place(path)?;
    // A path that cannot be resolved is a new file.
    let target = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
    match fs::metadata(&target) {
        Ok(old) if !old.is_file() => write_through(&target, fill),
        old => replace(&target, old.ok().as_ref(), fill),
    }
    .map_err(|source| WriteError::Io { file, source })
}

/// Whether there could be a file at `path`, so that a long computation need not end with a result
/// that has nowhere to go: its folder exists and takes files, and it is no folder itself.
pub fn check_place(path: &Path) -> Result<(), WriteError> {
    let file = display_name(path, "standard output");
    let target = path.canonicalize().unwrap_or_else(|_| path.to_path_buf());
    let folder = folder_of(&target);
    match fs::metadata(&target) {
        _ if is_standard_stream(path) => Ok(()),
        Ok(old) if old.is_dir() => Err(WriteError::Directory { file }),
        Ok(old) if old.is_file() && old.permissions().readonly() => {
            Err(WriteError::Protected { file })
        }
        Ok(old) if !old.is_file() => Ok(()),
        _ if !folder.is_dir() => Err(WriteError::NoFolder { file }),
        _ => match temporary_in(&folder) {
            Ok(_) => Ok(()),
            Err(source) => Err(WriteError::Io { file, source }),
        },
    }
}

fn temporary_in(folder: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    builder.prefix(".quadmend-").suffix(".tmp");
    // The usual permissions of a new file, less the umask, and not those of a secret.
    #[cfg(unix)]
    let open = std::os::unix::fs::PermissionsExt::from_mode(0o666);
    #[cfg(unix)]
    builder.permissions(open);
    builder.tempfile_in(folder)
}

fn replace(
    target: &Path,
    old: Option<&Metadata>,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let folder = folder_of(target);
    let mut temporary = temporary_in(&folder)?;
    fill_and_flush(temporary.as_file_mut(), fill)?;
    if let Some(old) = old {
        temporary.as_file().set_permissions(old.permissions())?;
    }
    temporary.as_file().sync_all()?;
    temporary.persist(target).map_err(|e| e.error)?;
    // The new name itself reaches the disk with the folder; not every system can do that, and
    // the content is safe by now.
    if let Ok(folder) = File::open(&folder) {
        let _ = folder.sync_all();
    }
    Ok(())
}

fn write_through(
    target: &Path,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    fill_and_flush(fs::OpenOptions::new().write(true).open(target)?, fill)
}

fn fill_and_flush<W: Write>(
    out: W,
    fill: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> io::Result<()> {
    let mut buffer = BufWriter::with_capacity(1 << 16, out);
    let filled = fill(&mut buffer).and_then(|()| buffer.flush());
    if filled.is_err() {
        // Dropping the buffer would try to write the rest once more.
        let _ = buffer.into_parts();
    }
    filled
}

fn folder_of(path: &Path) -> PathBuf {
    match path.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder.to_path_buf(),
        _ => PathBuf::from("."),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let entries = fs::read_dir(folder).unwrap();
        entries.map(|e| e.unwrap().file_name().into_string().unwrap()).collect()
    }

    #[test]
    fn a_failure_leaves_the_old_file_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.obj");
        write_atomically(&path, |w| w.write_all(b"old")).unwrap();
        let error = write_atomically(&path, |w| {
            w.write_all(&vec![b'x'; 100_000])?;
            Err(io::Error::other("disk full"))
        });
        let message = error.unwrap_err().to_string();
        assert!(message.contains("out.obj") && message.contains("disk full"), "{message}");
        assert_eq!(fs::read(&path).unwrap(), b"old");
        assert_eq!(names(folder.path()), ["out.obj"]);
    }

    #[test]
    fn a_failure_leaves_no_new_file() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.obj");
        assert!(write_atomically(&path, |_| Err(io::Error::other("no"))).is_err());
        assert!(names(folder.path()).is_empty());
    }

    #[test]
    fn a_missing_folder_and_a_folder_are_named() {
        let folder = tempfile::tempdir().unwrap();
        let missing = write_atomically(&folder.path().join("a/b.obj"), |_| Ok(()));
        assert!(matches!(missing, Err(WriteError::NoFolder { .. })));
        assert!(matches!(
            write_atomically(folder.path(), |_| Ok(())),
            Err(WriteError::Directory { .. })
        ));
    }

    #[cfg(unix)]
    #[test]
    fn permissions_links_and_devices_are_respected() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let (path, link) = (folder.path().join("out.obj"), folder.path().join("link.obj"));
        write_atomically(&path, |w| w.write_all(b"1")).unwrap();
        fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).unwrap();
        std::os::unix::fs::symlink(&path, &link).unwrap();
        write_atomically(&link, |w| w.write_all(b"2")).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"2");
        assert!(fs::symlink_metadata(&link).unwrap().is_symlink());
        assert_eq!(fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o640);
        fs::set_permissions(&path, fs::Permissions::from_mode(0o440)).unwrap();
        let refused = write_atomically(&path, |w| w.write_all(b"3"));
        assert!(matches!(refused, Err(WriteError::Protected { .. })));
        write_atomically(Path::new("/dev/null"), |w| w.write_all(b"4")).unwrap();
        assert!(!fs::metadata("/dev/null").unwrap().is_file());
    }
}

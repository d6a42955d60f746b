use super::*;

/// Everything in a folder except what is named.
fn others(folder: &Path, named: &[&str]) -> Vec<String> {
    let entries = fs::read_dir(folder).expect("a folder");
    let names = entries.map(|entry| entry.expect("an entry").file_name().into_string());
    let names = names.map(|name| name.expect("UTF-8"));
    names.filter(|name| !named.contains(&name.as_str())).collect()
}

fn fails(path: &Path) -> String {
    write(path, b"new").expect_err("it cannot be written").to_string()
}

#[test]
fn a_file_is_replaced_whole() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.txt");
    write(&path, b"first").expect("a new file");
    write(&path, b"second").expect("another");
    assert_eq!(fs::read(&path).expect("readable"), b"second");
    assert_eq!(others(folder.path(), &["a.txt"]), [""; 0], "nothing is left over");
}

#[test]
fn what_fails_half_way_leaves_the_old_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("a.txt");
    fs::write(&path, b"old").expect("writable");
    let place = Place::find(&path).expect("a place");
    let failure = place.write(|output| -> Result<(), FileError> {
        output.write_all(&vec![7; 1 << 16]).expect("room");
        assert_eq!(fs::read(&path).expect("readable"), b"old", "while the new one is written");
        Err(FileError { path: path.clone(), problem: io::Error::other("out of luck") })
    });
    assert!(failure.expect_err("told").to_string().contains("out of luck"));
    assert_eq!(fs::read(&path).expect("readable"), b"old");
    assert_eq!(others(folder.path(), &["a.txt"]), [""; 0], "nothing is left over");
}

#[test]
fn a_file_that_grows_can_be_read_and_comes_to_its_place_in_the_end() {
    let folder = tempfile::tempdir().expect("a folder");
    let (path, part) = (folder.path().join("a.csv"), folder.path().join("a.csv.part"));
    fs::write(&path, b"old").expect("writable");
    let mut growing = Growing::begin(Place::find(&path).expect("a place")).expect("writable");
    growing.write_all(b"one\n").expect("room");
    assert_eq!(fs::read(&part).expect("there"), b"one\n", "what there is by now");
    assert_eq!(fs::read(&path).expect("there"), b"old");
    growing.write_all(b"two\n").expect("room");
    growing.finish().expect("room");
    assert_eq!(fs::read(&path).expect("there"), b"one\ntwo\n");
    assert_eq!(others(folder.path(), &["a.csv"]), [""; 0]);
}

#[test]
fn a_place_is_tried_before_the_work() {
    let folder = tempfile::tempdir().expect("a folder");
    let missing = folder.path().join("no/such/a.txt");
    let complaint = Place::find(&missing).expect_err("no folder").to_string();
    assert!(complaint.contains("there is no such folder"), "{complaint}");
    assert!(fails(folder.path()).contains("directory"), "a folder");
    fs::write(folder.path().join("file"), b"").expect("writable");
    let complaint = fails(&folder.path().join("file/a.txt"));
    assert!(complaint.contains("cannot write"), "{complaint}");
    let free = folder.path().join("free.txt");
    Place::find(&free).expect("a free place");
    assert!(!free.exists(), "trying leaves nothing");
    assert_eq!(others(folder.path(), &["file"]), [""; 0]);
}

#[cfg(unix)]
mod unix {
    use std::os::unix::fs::{PermissionsExt as _, symlink};
    use std::process::Command;

    use super::*;

    #[test]
    fn what_a_link_points_to_is_replaced() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = |name: &str| folder.path().join(name);
        fs::create_dir(path("deep")).expect("a folder");
        fs::write(path("deep/target"), b"old").expect("writable");
        symlink("deep/target", path("near")).expect("a link");
        symlink("near", path("far")).expect("a link");
        write(&path("far"), b"new").expect("behind two links");
        assert_eq!(fs::read(path("deep/target")).expect("readable"), b"new");
        for link in ["near", "far"] {
            assert!(path(link).is_symlink(), "{link} stays one");
        }
        symlink("deep/fresh", path("dangling")).expect("a link");
        write(&path("dangling"), b"new").expect("what it points to is made");
        assert_eq!(fs::read(path("deep/fresh")).expect("readable"), b"new");
        symlink("circle", path("circle")).expect("a link");
        fails(&path("circle"));
    }

    #[test]
    fn a_protected_file_and_a_folder_without_leave_are_refused() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("a.txt");
        fs::write(&path, b"old").expect("writable");
        let mode = |path: &Path, mode| {
            fs::set_permissions(path, fs::Permissions::from_mode(mode)).expect("ours");
        };
        mode(&path, 0o444);
        // Whoever may do everything is kept out of a mount that cannot be written only.
        let is_root = OpenOptions::new().write(true).open(&path).is_ok();
        if !is_root {
            fails(&path);
            mode(folder.path(), 0o555);
            fails(&folder.path().join("b.txt"));
            mode(folder.path(), 0o755);
        }
        fails(Path::new("/proc/self/b.txt"));
        assert_eq!(fs::read(&path).expect("readable"), b"old");
    }

    #[test]
    fn permissions_are_those_of_any_file() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = |name: &str| folder.path().join(name);
        let mode = |name| fs::metadata(path(name)).expect("there").permissions().mode() & 0o777;
        fs::write(path("usual"), b"").expect("writable");
        write(&path("ours"), b"").expect("writable");
        assert_eq!(mode("ours"), mode("usual"), "the user's mask holds");
        fs::set_permissions(path("ours"), fs::Permissions::from_mode(0o640)).expect("ours");
        write(&path("ours"), b"again").expect("writable");
        assert_eq!(mode("ours"), 0o640, "the file that was there had them");
    }

    #[test]
    fn a_secret_is_its_owners_and_replaces_nothing() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("key");
        write_private(&path, b"secret").expect("writable");
        assert_eq!(fs::metadata(&path).expect("there").permissions().mode() & 0o777, 0o600);
        write_private(&path, b"another").expect_err("there is one");
        assert_eq!(fs::read(&path).expect("readable"), b"secret");
        assert_eq!(others(folder.path(), &["key"]), [""; 0]);
    }

    #[test]
    fn pipes_and_devices_are_written_directly() {
        let folder = tempfile::tempdir().expect("a folder");
        let pipe = folder.path().join("pipe");
        assert!(Command::new("mkfifo").arg(&pipe).status().expect("mkfifo").success());
        let place = Place::find(&pipe).expect("does not wait for a reader");
        assert!(place.is_stream());
        std::thread::scope(|scope| {
            let read = scope.spawn(|| fs::read_to_string(&pipe));
            let written = place.write(|output| -> Result<(), FileError> {
                output.write_all(b"xbc").expect("memory");
                output.seek(SeekFrom::Start(0)).expect("memory");
                output.write_all(b"a").expect("memory");
                Ok(())
            });
            written.expect("there is a reader");
            assert_eq!(read.join().expect("no panic").expect("readable"), "abc");
        });
        assert!(!pipe.is_file(), "the pipe stays one");
        if Path::new("/dev/full").exists() {
            let complaint = fails(Path::new("/dev/full"));
            assert!(complaint.contains("/dev/full") && complaint.contains("space"), "{complaint}");
        } else {
            ::tests::skip("there is no /dev/full: what a full device says is not seen");
        }
        write(Path::new("/dev/null"), b"gone").expect("a device");
        assert!(!Path::new("/dev/null").is_file(), "it stays a device");
    }
}

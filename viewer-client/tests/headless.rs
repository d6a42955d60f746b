//! The program without a window, as scripts use it: what was asked for is done, or told and no success.

use std::fs;
use std::io::Write as _;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

use host::picture::read_exr;
use tempfile::TempDir;

/// A folder with a script, and what the program makes of it there.
struct Run {
    folder: TempDir,
    output: Output,
}

impl Run {
    /// Follows `script` with a daemon inside the program.
    fn of(script: &str) -> Self {
        Self::with(&["--scene", "cornell", "--wait", "1"], script, &[])
    }

    /// The same with other `arguments`, where these `files` lie.
    fn with(arguments: &[&str], script: &str, files: &[(&str, &[u8])]) -> Self {
        let folder = tempfile::tempdir().expect("a folder");
        fs::write(folder.path().join("script"), script).expect("writable");
        for (name, content) in files {
            fs::write(folder.path().join(name), content).expect("writable");
        }
        let output = Command::new(env!("CARGO_BIN_EXE_viewer-client"))
            .current_dir(folder.path())
            // Drivers complain of its absence.
            .env_remove("XDG_RUNTIME_DIR")
            .args(["--headless", "--screenshot-to", "picture.png", "--size", "640x400"])
            .args(["--run", "script"])
            .args(arguments)
            .output()
            .expect("the program runs");
        Self { folder, output }
    }

    fn code(&self) -> Option<i32> {
        self.output.status.code()
    }

    fn log(&self) -> String {
        String::from_utf8_lossy(&self.output.stderr).into_owned()
    }

    fn printed(&self) -> String {
        String::from_utf8_lossy(&self.output.stdout).into_owned()
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    fn succeeds(&self) {
        assert_eq!(self.code(), Some(0), "{}", self.log());
    }

    /// It ends with 1, and says this.
    fn fails(&self, words: &str) {
        let log = self.log();
        assert_eq!(self.code(), Some(1), "{log}");
        assert!(log.contains(words), "{words}: {log}");
    }
}

fn is_picture(file: &Path) -> bool {
    image::open(file).is_ok_and(|picture| (picture.width(), picture.height()) == (640, 400))
}

#[test]
fn commands_do_what_they_say_without_a_window() {
    let run = Run::of(
        "camera view front\nimage save a.exr # a comment\nscreenshot window.png\nshare\n\
         copy status\nscreenshot b.png\n",
    );
    run.succeeds();
    assert_eq!(run.log(), "", "nothing is said where all goes well");
    for file in ["picture.png", "window.png", "b.png"] {
        assert!(is_picture(&run.path(file)), "{file}");
    }
    let image = read_exr(&run.path("a.exr")).expect("an image");
    assert!(image.pixels.iter().any(|pixel| pixel.luminance() > 0.0), "it is not black");
    let printed = run.printed();
    let mut lines = printed.lines();
    assert!(lines.next().is_some_and(|line| line.starts_with("lvis://127.0.0.1:")), "{printed}");
    assert!(printed.contains("cornell"), "the state of the session: {printed}");
}

#[test]
fn a_reader_of_the_log_that_goes_away_stops_nothing() {
    let folder = tempfile::tempdir().expect("a folder");
    let mut child = Command::new(env!("CARGO_BIN_EXE_viewer-client"))
        .current_dir(folder.path())
        .env("RUST_LOG", "debug")
        .args(["--headless", "--screenshot-to", "picture.png", "--size", "640x400"])
        .args(["--scene", "cornell", "--wait", "1"])
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program runs");
    drop(child.stderr.take());
    let ended = child.wait().expect("a child");
    assert_eq!(ended.code(), Some(0), "nobody reads what it logs");
    assert!(is_picture(&folder.path().join("picture.png")), "the picture is there");
}

#[test]
fn output_that_cannot_be_printed_costs_no_picture() {
    let Ok(full) = fs::OpenOptions::new().write(true).open("/dev/full") else {
        tests::skip("there is no /dev/full");
        return;
    };
    let folder = tempfile::tempdir().expect("a folder");
    fs::write(folder.path().join("script"), "copy status\n").expect("writable");
    let status = Command::new(env!("CARGO_BIN_EXE_viewer-client"))
        .current_dir(folder.path())
        .args(["--headless", "--screenshot-to", "picture.png", "--size", "640x400"])
        .args(["--scene", "cornell", "--wait", "1", "--run", "script"])
        .stdout(full)
        .status()
        .expect("the program runs");
    assert_ne!(status.code(), Some(0), "it was not printed");
    assert!(is_picture(&folder.path().join("picture.png")), "the picture is there");
}

#[test]
fn a_command_that_cannot_be_followed_is_a_failure() {
    let run = Run::of("image save no/such/folder/a.exr\nimage save a.bmp\n");
    run.fails("no such folder");
    run.fails("`a.bmp` has no known extension");
    assert!(is_picture(&run.path("picture.png")), "the picture is written all the same");
    Run::of("image reference gone.exr\n").fails("gone.exr");
    Run::of("filter set any on object \"heffalump\"\n").fails("The filter is left out");
    let typo = Run::of("image sve a.exr\n");
    assert_eq!(typo.code(), Some(2), "wrong usage: {}", typo.log());
    assert!(typo.log().contains("script, line 1"), "{}", typo.log());
}

#[test]
fn looks_are_compared_with_a_reference() {
    // As large as the picture of the scene, and as bright as its lamp all over.
    let reference = grey([256, 256]);
    let run = Run::with(
        &["--scene", "cornell", "--wait", "1"],
        "image reference a.exr\nimage show flip\ncopy image\n",
        &[("a.exr", &reference)],
    );
    run.succeeds();
    let printed = run.printed();
    let flip = printed.lines().find_map(|line| line.strip_prefix("FLIP\t")).expect("its mean");
    let flip: f64 = flip.parse().expect("a number");
    assert!(flip > 0.1 && flip <= 1.0, "{flip}");
}

/// An EXR file of so many pixels of radiance 1.
fn grey(size: [usize; 2]) -> Vec<u8> {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("grey.exr");
    let place = host::file::Place::find(&file).expect("a place");
    let written = place.write(|output| -> Result<(), host::file::FileError> {
        let extras = host::picture::Extras::default();
        host::picture::write_exr(output, size, |_, _| [1.0; 3], &extras).expect("memory");
        output.flush().expect("room");
        Ok(())
    });
    written.expect("written");
    fs::read(&file).expect("readable")
}

#[test]
fn a_reference_of_another_size_is_told() {
    let small = grey([2, 2]);
    let arguments = ["--scene", "cornell", "--wait", "1"];
    let run = Run::with(&arguments, "image reference small.exr\n", &[("small.exr", &small)]);
    run.fails("has 2 × 2 pixels");
}

#[test]
fn a_daemon_that_is_not_there_is_a_failure() {
    let free = std::net::TcpListener::bind("127.0.0.1:0").expect("a free port");
    let address = free.local_addr().expect("bound").to_string();
    drop(free);
    for wait in [["--wait", "1"], ["--wait-paths", "10"]] {
        let run = Run::with(&[&address, wait[0], wait[1]], "", &[("picture.png", b"old")]);
        run.fails(&format!("nobody listens at {address}"));
        let old = fs::read(run.path("picture.png")).expect("readable");
        assert_eq!(old, b"old", "there is no picture to replace it");
    }
}

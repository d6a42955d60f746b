//! What must never import what, as a table that is checked.

use crate::names::{lies_under, references, test_modules};
use crate::workspace::{Source, sources};

/// One row: files whose path starts with one of `files`, but with none of `except`, name none of
/// the paths in `never`.
struct Rule {
    files: &'static [&'static str],
    except: &'static [&'static str],
    never: &'static [&'static str],
    because: &'static str,
}

/// Transport: everything from random numbers to the engine, none of which knows the network.
const TRANSPORT: &[&str] = &[
    "tracer-server/src/math",
    "tracer-server/src/scene",
    "tracer-server/src/bsdf",
    "tracer-server/src/path",
    "tracer-server/src/mutation",
    "tracer-server/src/target",
    "tracer-server/src/base",
    "tracer-server/src/chain",
    "tracer-server/src/integrator",
    "tracer-server/src/replicate",
    "tracer-server/src/parallel",
    "tracer-server/src/film",
    "tracer-server/src/render",
    "tracer-server/src/engine",
    "tracer-server/src/explorer",
    "tracer-server/src/trade",
    "tracer-server/src/verify",
];

const RULES: &[Rule] = &[
    // Crates.
    Rule {
        files: &["common/src"],
        except: &[],
        never: &[
            "egui", "eframe", "prost", "proto", "std::fs", "std::net", "tokio", "tonic", "wgpu",
        ],
        because: "it is vocabulary, and knows no network, GPU or file format",
    },
    Rule {
        files: &["common/host/src"],
        except: &[],
        never: &["egui", "proto", "std::net", "tonic", "tracer_server", "viewer_client", "wgpu"],
        because: "the machine does not know what the programs are for",
    },
    Rule {
        files: &["tracer-server/src", "viewer-client/src"],
        except: &[],
        never: &[
            "File::create",
            "File::options",
            "OpenOptions::new",
            "fs::OpenOptions",
            "fs::copy",
            "fs::rename",
            "fs::write",
            "std::fs::File::create",
            "std::fs::OpenOptions",
            "std::fs::copy",
            "std::fs::rename",
            "std::fs::write",
        ],
        because: "files come to their place whole or not at all, by `host::file`",
    },
    Rule {
        files: &["proto/src"],
        except: &[],
        never: &["std::fs", "std::net", "tokio", "tracer_server", "viewer_client", "wgpu"],
        because: "the wire knows the vocabulary and nothing else",
    },
    Rule {
        files: &["shaders/src"],
        except: &[],
        never: &["common", "egui", "wgpu"],
        because: "shader sources and their layouts are data",
    },
    Rule {
        files: &["tracer-server/src"],
        except: &[],
        never: &["eframe", "egui", "shaders", "viewer_client", "wgpu"],
        because: "the daemon has no window",
    },
    Rule {
        files: &["viewer-client/src"],
        except: &["viewer-client/src/source/embedded"],
        never: &["tracer_server"],
        because: "viewer and daemon meet in the protocol only, but for the embedded daemon",
    },
    Rule {
        files: &["tests/src"],
        except: &[],
        never: &["common", "proto", "tracer_server", "viewer_client"],
        because: "the laboratory measures the others and must not depend on them",
    },
    // Layers of the daemon.
    Rule {
        files: TRANSPORT,
        except: &[],
        never: &["prost", "proto", "tokio", "tonic", "crate::cli", "crate::service"],
        because: "transport is mathematics and must run without a network",
    },
    Rule {
        files: TRANSPORT,
        except: &["tracer-server/src/engine", "tracer-server/src/explorer"],
        never: &["crate::engine", "crate::explorer", "crate::hub", "crate::steering"],
        because: "only the engine and the explorer show anybody what chains do, and take orders",
    },
    Rule {
        files: &["tracer-server/src/math"],
        except: &[],
        never: &["crate::bsdf", "crate::chain", "crate::mutation", "crate::path", "crate::scene"],
        because: "mathematics knows nothing of light",
    },
    Rule {
        files: &["tracer-server/src/bsdf"],
        except: &[],
        never: &["crate::chain", "crate::mutation", "crate::path", "crate::scene"],
        because: "scattering is local",
    },
    Rule {
        files: &["tracer-server/src/scene"],
        except: &[],
        never: &["crate::chain", "crate::film", "crate::mutation", "crate::path"],
        because: "a scene does not know that it is sampled",
    },
    Rule {
        files: &["tracer-server/src/scene/description"],
        except: &[],
        never: &[
            "crate::scene::builtin",
            "crate::scene::load",
            "crate::scene::mitsuba",
            "crate::scene::obj",
            "crate::scene::reading",
            "crate::scene::toml",
            "crate::scene::world",
        ],
        because: "a description is data, whatever file it came from and whatever becomes of it",
    },
    Rule {
        files: &["tracer-server/src/scene/reading"],
        except: &[],
        never: &[
            "crate::scene::builtin",
            "crate::scene::load",
            "crate::scene::mitsuba",
            "crate::scene::obj",
            "crate::scene::toml",
            "crate::scene::world",
        ],
        because: "what readers share knows none of them",
    },
    Rule {
        files: &["tracer-server/src/scene/mitsuba", "tracer-server/src/scene/obj"],
        except: &[],
        never: &[
            "crate::scene::builtin",
            "crate::scene::load",
            "crate::scene::toml",
            "crate::scene::world",
        ],
        because: "a reader ends in a description",
    },
    Rule {
        files: &["tracer-server/src/scene/toml"],
        except: &[],
        never: &[
            "crate::scene::builtin",
            "crate::scene::load",
            "crate::scene::mitsuba",
            "crate::scene::world",
        ],
        because: "a reader ends in a description",
    },
    Rule {
        files: &["tracer-server/src/scene/world"],
        except: &[],
        never: &[
            "crate::scene::builtin",
            "crate::scene::load",
            "crate::scene::mitsuba",
            "crate::scene::obj",
            "crate::scene::reading",
            "crate::scene::toml",
        ],
        because: "the world that is traced begins with a description, whatever file it came from",
    },
    Rule {
        files: &["tracer-server/src/path"],
        except: &[],
        never: &["crate::chain", "crate::engine", "crate::film", "crate::mutation"],
        because: "a path does not know how it was found",
    },
    Rule {
        files: &["tracer-server/src/target"],
        except: &[],
        never: &["crate::base", "crate::chain", "crate::film", "crate::mutation"],
        because: "a target is a function of the path alone",
    },
    Rule {
        files: &["tracer-server/src/base"],
        except: &[],
        never: &["crate::chain", "crate::mutation", "crate::replicate"],
        because: "base samples are independent of chains",
    },
    Rule {
        files: &["tracer-server/src/mutation"],
        except: &[],
        never: &["crate::chain", "crate::engine", "crate::film"],
        because: "a strategy proposes, the chain disposes",
    },
    Rule {
        files: &["tracer-server/src/chain"],
        except: &[],
        never: &["crate::engine", "std::time"],
        because: "a chain is a state machine, and never waits",
    },
    Rule {
        files: &["tracer-server/src/film"],
        except: &[],
        never: &["crate::chain", "crate::mutation", "crate::path", "crate::scene"],
        because: "a film adds up splats, whoever sends them",
    },
    Rule {
        files: &["tracer-server/src/hub"],
        except: &[],
        never: &[
            "crate::chain",
            "crate::mutation",
            "crate::path",
            "crate::scene",
            "proto",
            "tonic",
        ],
        because: "the hub moves batches, whatever is in them",
    },
    // One owner for each library.
    Rule {
        files: &["tracer-server/src"],
        except: &["tracer-server/src/scene/world/accel"],
        never: &["obvhs"],
        because: "the acceleration structure has one owner",
    },
    Rule {
        files: &["tracer-server/src"],
        except: &["tracer-server/src/scene/obj"],
        never: &["tobj"],
        because: "the reader of OBJ files has one owner",
    },
    Rule {
        files: &["tracer-server/src"],
        except: &["tracer-server/src/service"],
        never: &["proto", "tonic", "tonic_health", "tonic_reflection"],
        because: "wire types stop at the door",
    },
    // Layers of the viewer.
    Rule {
        files: &["viewer-client/src"],
        except: &["viewer-client/src/source/connection", "viewer-client/src/app/watch"],
        never: &["proto", "tonic"],
        because: "wire types stop at the door",
    },
    // From the ground up; each imports rooms below it only.
    Rule {
        files: &["viewer-client/src/value"],
        except: &[],
        never: &[
            "crate::command",
            "crate::settings",
            "crate::camera",
            "crate::imaging",
            "crate::source",
            "crate::draw",
            "crate::world",
            "crate::keys",
            "crate::panel",
            "crate::app",
        ],
        because: "values know nothing else of the viewer",
    },
    Rule {
        files: &["viewer-client/src/command"],
        except: &[],
        never: &[
            "crate::settings",
            "crate::camera",
            "crate::imaging",
            "crate::source",
            "crate::draw",
            "crate::world",
            "crate::keys",
            "crate::panel",
            "crate::app",
        ],
        because: "a command does not know who carries it out, nor what is set already",
    },
    Rule {
        files: &["viewer-client/src/settings"],
        except: &[],
        never: &[
            "crate::camera",
            "crate::imaging",
            "crate::source",
            "crate::draw",
            "crate::world",
            "crate::keys",
            "crate::panel",
            "crate::app",
        ],
        because: "what is chosen does not know what it is chosen for",
    },
    Rule {
        files: &["viewer-client/src/camera"],
        except: &[],
        never: &[
            "crate::imaging",
            "crate::source",
            "crate::draw",
            "crate::world",
            "crate::keys",
            "crate::panel",
            "crate::app",
        ],
        because: "an eye is arithmetic",
    },
    Rule {
        files: &["viewer-client/src/imaging"],
        except: &[],
        never: &[
            "crate::source",
            "crate::draw",
            "crate::world",
            "crate::keys",
            "crate::panel",
            "crate::app",
        ],
        because: "a picture does not know where it comes from",
    },
    Rule {
        files: &["viewer-client/src/source"],
        except: &[],
        never: &["crate::draw", "crate::world", "crate::keys", "crate::panel", "crate::app"],
        because: "what is looked at does not know who looks, nor how",
    },
    Rule {
        files: &["viewer-client/src/draw"],
        except: &[],
        never: &["crate::world", "crate::keys", "crate::panel", "crate::app"],
        because: "drawing does not know what it is drawn for",
    },
    Rule {
        files: &["viewer-client/src/world"],
        except: &[],
        never: &["crate::keys", "crate::panel", "crate::app"],
        because: "what is read does not know its readers",
    },
    Rule {
        files: &["viewer-client/src/keys"],
        except: &[],
        never: &["crate::panel", "crate::app"],
        because: "keys say what panels could say",
    },
    Rule {
        files: &["viewer-client/src/panel"],
        except: &[],
        never: &["crate::app"],
        because: "panels are shown, and own nothing",
    },
    Rule {
        files: &["viewer-client/src"],
        except: &[
            "viewer-client/src/app",
            "viewer-client/src/draw/raster",
            "viewer-client/src/imaging/exchange",
            "viewer-client/src/imaging/tev",
            "viewer-client/src/main",
            "viewer-client/src/source/connection",
            "viewer-client/src/source/dump/mod",
            "viewer-client/src/source/dump/tests",
            "viewer-client/src/source/embedded",
        ],
        never: &["host", "std::fs", "std::net", "std::process", "std::thread", "tokio"],
        because: "a browser has no files, sockets or threads, and will run it one day",
    },
    // What stands in rooms without a window, and for whom they are.
    Rule {
        files: &[
            "viewer-client/src/value",
            "viewer-client/src/camera",
            "viewer-client/src/command",
            "viewer-client/src/draw/pick",
            "viewer-client/src/draw/raster",
            "viewer-client/src/imaging",
            "viewer-client/src/settings",
            "viewer-client/src/source",
        ],
        except: &["viewer-client/src/value/theme"],
        never: &["eframe", "egui", "wgpu", "crate::draw::gpu"],
        because: "state can be asked and tested without a window",
    },
    Rule {
        files: &["viewer-client/src/draw"],
        except: &[],
        never: &["crate::source::connection"],
        because: "drawing takes slices and draws them",
    },
    Rule {
        files: &["viewer-client/src/panel"],
        except: &["viewer-client/src/panel/viewport"],
        never: &["wgpu", "crate::draw::gpu", "crate::source::connection"],
        because: "panels read the world and return commands",
    },
];

/// Complaints about `files`, one a breach.
fn breaches(rules: &[Rule], files: &[Source]) -> Vec<String> {
    let mut complaints = Vec::new();
    let tests = test_modules(files);
    for file in files {
        let applicable: Vec<_> = rules.iter().filter(|rule| rule.covers(&file.path)).collect();
        let is_test = tests.iter().any(|module| lies_under(&file.path, module));
        if applicable.is_empty() || is_test {
            continue;
        }
        for (named, line) in references(file) {
            for rule in applicable.iter().filter(|rule| rule.forbids(&named)) {
                let path = &file.path;
                complaints.push(format!("{path}:{line} names {named}, but {}", rule.because));
            }
        }
    }
    complaints
}

impl Rule {
    fn covers(&self, path: &str) -> bool {
        let starts = |prefixes: &[&str]| prefixes.iter().any(|prefix| lies_under(path, prefix));
        starts(self.files) && !starts(self.except)
    }

    fn forbids(&self, named: &str) -> bool {
        self.never.iter().any(|path| {
            named.strip_prefix(path).is_some_and(|rest| rest.is_empty() || rest.starts_with("::"))
        })
    }
}

#[test]
fn no_layer_names_what_it_must_not_know() {
    let complaints = breaches(RULES, &sources(&["rs"]));
    assert!(complaints.is_empty(), "{}", complaints.join("\n"));
}

#[test]
fn every_rule_covers_a_file() {
    let files = sources(&["rs"]);
    for rule in RULES {
        for prefix in rule.files.iter().chain(rule.except) {
            let covers = files.iter().any(|file| lies_under(&file.path, prefix));
            assert!(covers, "no file lies under {prefix}: the row that names it checks nothing");
        }
    }
}

/// The complaints about a file at `path` with this text.
fn planted(path: &str, text: &str) -> Vec<String> {
    breaches(RULES, &[Source::made_up(path, text)])
}

#[test]
fn a_planted_breach_is_found_however_it_is_written() {
    let bsdf = "tracer-server/src/bsdf/lambert.rs";
    for text in [
        "use crate::path::Path;",
        "use crate::{math::Frame, path};",
        "use crate::{math, path::{Path}};",
        "use super::super::path::Path;",
        "mod inner { use super::super::super::path::Path; }",
        "fn f(x: &crate::path::Path) {}",
        "fn f() { vec![crate::path::Path::new()]; }",
        "type P = Option<crate::path::Path>;",
    ] {
        let found = planted(bsdf, &format!("//! A lobe.\n{text}\n"));
        assert_eq!(found.len(), 1, "{text} gives {found:?}");
        assert!(found[0].starts_with(&format!("{bsdf}:2 names crate::path")), "{}", found[0]);
    }
    let hub = planted("tracer-server/src/hub/lane.rs", "async fn f() -> tonic::Status { g() }");
    assert_eq!(hub.len(), 2, "both rows that forbid it complain: {hub:?}");
}

#[test]
fn what_is_no_breach_is_let_pass() {
    let bsdf = "tracer-server/src/bsdf/lambert.rs";
    for text in [
        "// use crate::path::Path;",
        "/// See [`crate::path::Path`].\nfn f() {}",
        "const HELP: &str = \"crate::path::Path\";",
        "use crate::pathology::Finding;",
        "use super::Sample;",
        "#[cfg(test)]\nmod tests { use crate::path::Path; }",
        "#[cfg(test)]\nuse crate::path::Path;",
        "fn f(path: &str, scene: u32) -> bool { path.is_empty() }",
    ] {
        let found = planted(bsdf, text);
        assert!(found.is_empty(), "{text} gives {found:?}");
    }
    let owner = planted("tracer-server/src/scene/world/accel.rs", "use obvhs::cwbvh::CwBvh;");
    assert!(owner.is_empty(), "the owner of a library may name it: {owner:?}");
    let law = [
        Source::made_up("tracer-server/src/bsdf/mod.rs", "#[cfg(test)]\nmod laws;"),
        Source::made_up("tracer-server/src/bsdf/laws.rs", "use crate::path::Path;"),
    ];
    assert_eq!(breaches(RULES, &law), [""; 0], "laws may use anything");
    assert_eq!(breaches(RULES, &law[1..]).len(), 1, "but only where they are laws");
}

#[test]
fn code_behind_a_test_module_is_still_read() {
    let text = "#[cfg(test)]\nmod tests { fn g() {} }\nuse crate::path::Path;";
    let found = planted("tracer-server/src/bsdf/lambert.rs", text);
    assert_eq!(found.len(), 1, "{found:?}");
}

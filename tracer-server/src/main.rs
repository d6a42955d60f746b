//! The `tracer-server` program: see [`tracer_server::cli`].

use std::process::ExitCode;

fn main() -> ExitCode {
    tracer_server::cli::main()
}

//! Compiles the schema without a system `protoc`.

use std::error::Error;
use std::path::PathBuf;

use prost::Message as _;

fn main() -> Result<(), Box<dyn Error>> {
    println!("cargo::rerun-if-changed=lvis");
    let descriptors = protox::compile(["lvis/v1/tracer.proto"], ["."])?;
    let out = PathBuf::from(std::env::var("OUT_DIR")?);
    std::fs::write(out.join("lvis.v1.descriptors.bin"), descriptors.encode_to_vec())?;
    // Columns as `Bytes`: decoding shares the received buffer, and one batch serves many viewers.
    tonic_prost_build::configure().bytes(".lvis.v1").compile_fds(descriptors)?;
    Ok(())
}

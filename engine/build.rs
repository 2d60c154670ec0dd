//! Marks cached results by the libraries that calculate them, so that results of other versions are not taken for this one's.

use std::hash::Hasher;
use std::path::{Path, PathBuf};
use std::{env, fs};

use fnv::FnvHasher;

fn main() {
    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    let lock = root.join("../Cargo.lock");
    // As an installed dependency there is no lock file of the workspace beside it.
    let libraries = fs::read(&lock).unwrap_or_else(|_| env!("CARGO_PKG_VERSION").into());
    // A checkout may end lines in another way.
    let mut digest = FnvHasher::default();
    digest.write(&libraries.into_iter().filter(|&byte| byte != b'\r').collect::<Vec<u8>>());
    let mark = digest.finish();
    // Sums may be ordered in another way on another kind of processor.
    let target = env::var("TARGET").unwrap_or_default();
    println!("cargo::rustc-env=OVERHEAR_LIBRARIES_SCHEMA={mark:016x}-{target}");
    if Path::new(&lock).exists() {
        println!("cargo::rerun-if-changed={}", lock.display());
    }
    println!("cargo::rerun-if-changed=build.rs");
}

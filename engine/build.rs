//! Marks cached results by the libraries that calculate them, so that results of other versions are not taken for this one's.

use std::path::{Path, PathBuf};
use std::{env, fs};

fn main() {
    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    let lock = root.join("../Cargo.lock");
    // As an installed dependency there is no lock file of the workspace beside it.
    let libraries = fs::read(&lock).unwrap_or_else(|_| env!("CARGO_PKG_VERSION").into());
    // A checkout may end lines in another way.
    let mark =
        libraries.into_iter().filter(|&byte| byte != b'\r').fold(0xcbf2_9ce4_8422_2325_u64, |mark, byte| {
            (mark ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3)
        });
    // Sums may be ordered in another way on another kind of processor.
    let target = env::var("TARGET").unwrap_or_default();
    println!("cargo::rustc-env=OVERHEAR_LIBRARIES_MARK={mark:016x}-{target}");
    if Path::new(&lock).exists() {
        println!("cargo::rerun-if-changed={}", lock.display());
    }
    println!("cargo::rerun-if-changed=build.rs");
}

//! Marks cached results by what calculates them, so that results of other equations or libraries are not taken for this
//! version's: a digest of the engine's sources and of the lock file, and the kind of processor.

use std::hash::Hasher;
use std::path::{Path, PathBuf};
use std::{env, fs};

use fnv::FnvHasher;

fn main() {
    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    let (sources, lock) = (root.join("src"), root.join("../Cargo.lock"));
    let mut digest = FnvHasher::default();
    let mut files = Vec::new();
    collect(&sources, &mut files);
    // By name: folders list their files in any order.
    files.sort();
    for file in &files {
        digest_file(file, &mut digest);
    }
    println!("cargo::rerun-if-changed={}", sources.display());
    // As an installed dependency there is no lock file of the workspace beside it.
    if lock.exists() {
        digest_file(&lock, &mut digest);
        println!("cargo::rerun-if-changed={}", lock.display());
    } else {
        digest.write(env!("CARGO_PKG_VERSION").as_bytes());
    }
    // Sums may be ordered in another way on another kind of processor.
    let target = env::var("TARGET").unwrap_or_default();
    println!("cargo::rustc-env=OVERHEAR_SCHEMA={:016x}-{target}", digest.finish());
    println!("cargo::rerun-if-changed=build.rs");
}

/// Adds the files of a folder and of those in it.
fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    for entry in fs::read_dir(folder).expect("the engine's sources").flatten() {
        let path = entry.path();
        if path.is_dir() {
            collect(&path, files);
        } else {
            files.push(path);
        }
    }
}

/// Adds a file's bytes, however a checkout ends its lines.
fn digest_file(path: &Path, digest: &mut FnvHasher) {
    let bytes = fs::read(path).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
    let unix: Vec<u8> = bytes.into_iter().filter(|&byte| byte != b'\r').collect();
    digest.write(&unix);
}

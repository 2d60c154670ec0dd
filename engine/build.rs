//! Marks the engine by its sources, so that results kept from other ones are never taken for its own.

use std::path::{Path, PathBuf};
use std::{env, fs, io};

fn main() -> io::Result<()> {
    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap_or_default());
    let mut files = Vec::new();
    collect(&root.join("src"), &mut files)?;
    files.sort();
    let mut mark = 0xcbf2_9ce4_8422_2325_u64;
    for file in &files {
        let name = file.strip_prefix(&root).unwrap_or(file).to_string_lossy().replace('\\', "/");
        for byte in name.into_bytes().into_iter().chain(fs::read(file)?) {
            // A checkout may end lines in another way.
            if byte != b'\r' {
                mark = (mark ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
            }
        }
    }
    // Sums may be ordered in another way.
    let target = env::var("TARGET").unwrap_or_default();
    println!("cargo::rustc-env=OVERHEAR_ENGINE_MARK={mark:016x}-{target}");
    println!("cargo::rerun-if-changed=src");
    Ok(())
}

/// Every file under a folder.
fn collect(folder: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let path = entry?.path();
        if path.is_dir() {
            collect(&path, files)?;
        } else {
            files.push(path);
        }
    }
    Ok(())
}

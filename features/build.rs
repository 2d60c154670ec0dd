//! Does nothing: without a build script cargo leaves the build dependencies out.

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
}

//! Requirements of a machine beside Rust, and their installation.
//!
//! Debian's packages are installed by apt-get when the command runs as root; otherwise, and on
//! other systems, the command lists what is missing and stops.

use std::env;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::{Context, Result, bail};

/// A requirement of a command.
#[derive(Debug, Clone, Copy)]
pub struct Need {
    /// Its purpose, in a few words.
    pub what: &'static str,
    /// Whether it is present.
    pub present: fn() -> bool,
    /// Debian packages that bring it.
    pub packages: &'static [&'static str],
}

/// A C compiler and linker with the C library.
pub const LINKER: Need = Need {
    what: "a C compiler and linker (cc)",
    present: || program("cc").is_some(),
    packages: &["gcc", "libc6-dev"],
};

/// A display server without a display.
pub const XVFB: Need =
    Need { what: "a virtual display (Xvfb)", present: || program("Xvfb").is_some(), packages: &["xvfb"] };

/// Libraries that the editor loads when it is shown.
pub const WINDOW_LIBRARIES: Need = Need {
    what: "the X11 and OpenGL libraries of the editor",
    present: || {
        ["libX11.so.6", "libX11-xcb.so.1", "libxcb.so.1", "libGL.so.1", "libXcursor.so.1"]
            .iter()
            .all(|name| library(name))
    },
    packages: &["libx11-6", "libx11-xcb1", "libxcb1", "libgl1", "libgl1-mesa-dri", "libxcursor1"],
};

/// Headers for the standalone program.
pub const SOUND_HEADERS: Need = Need {
    what: "the headers of ALSA and JACK",
    present: || {
        !cfg!(target_os = "linux") || quiet(Command::new("pkg-config").args(["--exists", "alsa", "jack"]))
    },
    packages: &["pkg-config", "libasound2-dev", "libjack-jackd2-dev"],
};

/// Python with virtual environments.
pub const PYTHON: Need = Need {
    what: "Python 3 with venv",
    present: || {
        ["venv", "ensurepip"]
            .iter()
            .all(|module| quiet(Command::new("python3").args(["-c", &format!("import {module}")])))
    },
    packages: &["python3", "python3-venv"],
};

/// Libraries of the VST3 host of the tests, beyond the editor's.
pub const HOST_LIBRARIES: Need = Need {
    what: "the libraries of the VST3 test host (DawDreamer)",
    present: || ["libglib-2.0.so.0", "libstdc++.so.6"].iter().all(|name| library(name)),
    packages: &["libglib2.0-0", "libstdc++6"],
};

/// A host that is driven by scripts.
pub const ARDOUR: Need = Need {
    what: "the host Ardour 7",
    present: || {
        program("ardour7-lua").is_some() && Path::new("/usr/lib/ardour7/ardour-vst3-scanner").exists()
    },
    packages: &["ardour"],
};

/// Makes sure of everything, installing what is missing if that is possible.
///
/// # Errors
/// Naming what is missing and the packages to install.
pub fn ensure(needs: &[Need]) -> Result<()> {
    let missing: Vec<_> = needs.iter().filter(|need| !(need.present)()).collect();
    if missing.is_empty() {
        return Ok(());
    }
    let what = missing.iter().map(|need| need.what).collect::<Vec<_>>().join(", ");
    let packages: Vec<_> = missing.iter().flat_map(|need| need.packages).copied().collect();
    let list = packages.join(" ");
    if program("apt-get").is_none() {
        bail!("missing: {what}; install what your system calls {list}");
    }
    if !is_root() {
        bail!("missing: {what}; run: sudo apt-get install {list}");
    }
    eprintln!("installing {list}, for {what}");
    // The lists of a fresh machine are empty or old.
    apt_get(&["update", "-q"])?;
    apt_get(&[&["install", "-y", "-q", "--no-install-recommends"], &packages[..]].concat())?;
    match needs.iter().find(|need| !(need.present)()) {
        None => Ok(()),
        Some(need) => bail!("still missing after installing {list}: {}", need.what),
    }
}

fn apt_get(arguments: &[&str]) -> Result<()> {
    let status = Command::new("apt-get")
        .args(arguments)
        .env("DEBIAN_FRONTEND", "noninteractive")
        .stdout(Stdio::null())
        .status()
        .context("cannot run apt-get")?;
    if !status.success() {
        bail!("apt-get {} failed", arguments.join(" "));
    }
    Ok(())
}

/// Path of a program, if it is in the search path.
pub fn program(name: &str) -> Option<PathBuf> {
    let folders = env::var_os("PATH")?;
    env::split_paths(&folders).map(|folder| folder.join(name)).find(|path| path.is_file())
}

/// Whether the dynamic loader knows a library.
fn library(name: &str) -> bool {
    let loader = ["/sbin/ldconfig", "/usr/sbin/ldconfig", "ldconfig"];
    loader.iter().any(|ldconfig| {
        Command::new(ldconfig).arg("-p").output().is_ok_and(|output| {
            String::from_utf8_lossy(&output.stdout)
                .lines()
                .any(|line| line.split_whitespace().next() == Some(name))
        })
    })
}

fn is_root() -> bool {
    Command::new("id").arg("-u").output().is_ok_and(|output| output.stdout.trim_ascii() == b"0")
}

/// Whether a command succeeds; its output is ignored.
fn quiet(command: &mut Command) -> bool {
    command
        .stdin(Stdio::null())
        .stdout(Stdio::null())
        .stderr(Stdio::null())
        .status()
        .is_ok_and(|status| status.success())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cargo_is_found_and_nonsense_is_not() {
        assert!(program("cargo").is_some());
        assert!(program("no-such-program-anywhere").is_none());
    }

    #[test]
    fn every_need_names_its_packages() {
        for need in [LINKER, XVFB, WINDOW_LIBRARIES, PYTHON, HOST_LIBRARIES, ARDOUR] {
            assert!(!need.what.is_empty() && !need.packages.is_empty());
        }
    }
}

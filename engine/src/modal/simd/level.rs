//! Which instruction set the kernels are compiled for at run time.

use core::sync::atomic::{AtomicU8, Ordering};

use pulp::Arch;
#[cfg(target_arch = "x86_64")]
use pulp::x86::{V3, V4};

/// Instruction sets the kernels of x86-64 come in, narrowest first.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum InstructionSet {
    /// What every x86-64 has, four lanes; elsewhere the plain form.
    Sse2,
    /// AVX2 and FMA, eight lanes.
    Avx2,
    /// AVX-512, sixteen lanes.
    Avx512,
}

impl InstructionSet {
    /// All, narrowest first.
    pub const ALL: [InstructionSet; 3] = [InstructionSet::Sse2, InstructionSet::Avx2, InstructionSet::Avx512];

    /// Its name in lower case.
    pub fn name(self) -> &'static str {
        match self {
            InstructionSet::Sse2 => "sse2",
            InstructionSet::Avx2 => "avx2",
            InstructionSet::Avx512 => "avx512",
        }
    }

    /// Whether this machine has it.
    pub fn is_available(self) -> bool {
        self == InstructionSet::Sse2 || arch(self).is_some()
    }
}

/// The widest set that [`detect`] may choose.
static WIDEST: AtomicU8 = AtomicU8::new(InstructionSet::Avx512 as u8);

/// Keeps everything built from now on, in the whole process, from using more than this.
///
/// For measurements and comparisons; an instrument takes what the machine has.
pub fn limit(widest: InstructionSet) {
    WIDEST.store(widest as u8, Ordering::Relaxed);
}

/// The best this machine has within the [`limit`], or nothing but the plain form.
pub(super) fn detect() -> Option<Arch> {
    let widest = WIDEST.load(Ordering::Relaxed);
    if widest == InstructionSet::Avx512 as u8 {
        return match Arch::new() {
            Arch::Scalar => None,
            arch => Some(arch),
        };
    }
    (widest == InstructionSet::Avx2 as u8).then(|| arch(InstructionSet::Avx2)).flatten()
}

#[cfg(target_arch = "x86_64")]
fn arch(set: InstructionSet) -> Option<Arch> {
    match set {
        InstructionSet::Sse2 => None,
        InstructionSet::Avx2 => V3::try_new().map(Arch::V3),
        InstructionSet::Avx512 => V4::try_new().map(Arch::V4),
    }
}

#[cfg(not(target_arch = "x86_64"))]
fn arch(_set: InstructionSet) -> Option<Arch> {
    None
}

//! Loops over doubles, compiled for machines that multiply and add in one rounding.
//!
//! On x86 a compiler by default uses SSE2 alone, which every such processor has. Loops are therefore compiled for
//! wider registers as well, and the processor is queried once for the code that it can run. Code for other
//! architectures needs no such choice. Sums have a fixed number of lanes, so that the width of the registers changes
//! no bit.
//!
//! `pack` chooses code by the same rules. Loops that the compiler vectorizes by itself do not need packs.

/// Types that prove that the processor has some instructions. One list makes both the query and the compiled code.
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
macro_rules! instructions {
    ($($(#[$about:meta])* $Set:ident { $($feature:tt)* })*) => {
        $(
            $(#[$about])*
            #[derive(Clone, Copy)]
            struct $Set(());

            impl $Set {
                /// Returns the proof; queries the processor on the first call.
                #[inline(always)]
                fn find() -> Option<Self> {
                    static FOUND: std::sync::LazyLock<Option<$Set>> = std::sync::LazyLock::new(|| {
                        let has_all = $(std::arch::is_x86_feature_detected!($feature))&&*;
                        has_all.then_some($Set(()))
                    });
                    *FOUND
                }

                /// Computes in code for these instructions; every function called there is `#[inline(always)]`.
                #[inline(always)]
                fn run<R>(self, compute: impl FnOnce() -> R) -> R {
                    #[inline]
                    #[target_feature($(enable = $feature),*)]
                    fn compiled<R>(compute: impl FnOnce() -> R) -> R {
                        compute()
                    }
                    // SAFETY: the call is safe on processors that have all of the list, and `find`, which makes the only values
                    // of this type, has asked for the same list.
                    #[allow(unsafe_code)] // the one way from code for every processor to code for some
                    unsafe {
                        compiled(compute)
                    }
                }
            }
        )*
    };
}

#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
instructions! {
    /// x86-64-v3.
    Avx2 {
        "avx2" "bmi1" "bmi2" "cmpxchg16b" "f16c" "fma" "fxsr" "lzcnt" "movbe" "popcnt" "xsave"
    }
    /// x86-64-v4 on processors of 2019 and later, which wide registers do not slow down.
    Avx512 {
        "avx2" "bmi1" "bmi2" "cmpxchg16b" "f16c" "fma" "fxsr" "lzcnt" "movbe" "popcnt" "xsave"
        "avx512bw" "avx512cd" "avx512dq" "avx512f" "avx512vbmi2" "avx512vl"
    }
}

/// Returns the instructions that this processor lacks and code that is [`compiled_once`] needs; `None` if it has all.
pub fn missing() -> Option<&'static str> {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    return Avx2::find().is_none().then_some("AVX2 and fused multiply-add (x86-64-v3)");
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    None
}

/// Runs scalar code in which a fused multiply-add is one instruction, where the processor has it. Elsewhere it is a call of the
/// mathematical library: slower, the same bits. Compiled twice.
#[inline(always)]
pub fn in_fused_code<R>(compute: impl FnOnce() -> R) -> R {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    if let Some(avx2) = Avx2::find() {
        return avx2.run(compute);
    }
    compute()
}

/// Runs scalar code in which a fused multiply-add is one instruction: [`in_fused_code`] for code that takes long to compile, as
/// walks do. A second copy, for processors without the instruction, would take a tenth of the time of a build.
///
/// # Panics
///
/// If instructions are [`missing`]. The command says so and ends before it comes here.
#[inline(always)]
pub fn compiled_once<R>(compute: impl FnOnce() -> R) -> R {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    return Avx2::find().unwrap_or_else(lacking).run(compute);
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    compute()
}

#[cold]
#[inline(never)]
#[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
fn lacking() -> Avx2 {
    panic!("this processor lacks {}", missing().unwrap_or_default())
}

/// A loop over doubles that is compiled for each width of registers.
pub trait Loop {
    /// Runs the loop. All that it calls is `#[inline(always)]`: other code would be compiled for the baseline.
    fn run(self);
}

/// Runs a loop by the widest code that the machine has.
#[inline(always)]
pub fn run(task: impl Loop) {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    if let Some(avx512) = Avx512::find() {
        return avx512.run(
            #[inline(always)]
            || task.run(),
        );
    }
    in_fused_code(
        #[inline(always)]
        || task.run(),
    );
}

#[cfg(all(test, feature = "packs"))]
mod tests {
    use fearless_simd::Level;

    use super::*;

    #[test]
    fn loops_and_packs_choose_the_same_code() {
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        assert_eq!(Avx512::find().is_some(), Level::new().as_avx512().is_some());
        #[cfg(target_arch = "x86_64")]
        assert_eq!(missing().is_none(), crate::pack::has_packs(Level::new()));
    }
}

//! Loops over doubles, compiled for machines that multiply and add in one rounding.
//!
//! On x86 a compiler by default uses SSE2 alone, which every such processor has. Loops are therefore compiled for
//! wider registers as well, and the processor is queried once for the code that it can run. Code for other
//! architectures needs no such choice. Sums have a fixed number of lanes, so that the width of the registers changes
//! no bit.
//!
//! `pack` chooses code by the same rules. Loops that the compiler vectorizes by itself do not need packs.

use super::scalar_lane::{Fused, Plain, ScalarLane};

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

/// Returns true if packs of this machine, and so its scalars, multiply and add in one rounding.
#[inline(always)]
pub fn fuses() -> bool {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    return Avx2::find().is_some();
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    return cfg!(all(target_arch = "aarch64", target_feature = "neon"));
}

/// Runs scalar code in which a fused multiply-add is one instruction, where the machine has it.
#[inline(always)]
pub fn in_fused_code<R>(compute: impl FnOnce() -> R) -> R {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    if let Some(avx2) = Avx2::find() {
        return avx2.run(compute);
    }
    compute()
}

/// A loop over doubles that is compiled for each rounding and each width of registers.
pub trait Loop {
    /// Result of the loop.
    type Output;

    /// Runs the loop. All that it calls is `#[inline(always)]`: other code would be compiled for the baseline.
    fn run<L: ScalarLane>(self) -> Self::Output;
}

/// Runs a loop in the rounding of [`super::Lane`] for `f64`, by the widest code that the machine has.
#[inline(always)]
pub fn run<T: Loop>(task: T) -> T::Output {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    if let Some(avx512) = Avx512::find() {
        return avx512.run(
            #[inline(always)]
            || task.run::<Fused>(),
        );
    }
    if !fuses() {
        return task.run::<Plain>();
    }
    in_fused_code(
        #[inline(always)]
        || task.run::<Fused>(),
    )
}

/// Runs a computation in the rounding of [`super::Lane`] for `f64`, if wider registers would not speed it up.
#[inline(always)]
pub fn in_own_rounding<T: Loop>(task: T) -> T::Output {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    if let Some(avx2) = Avx2::find() {
        return avx2.run(
            #[inline(always)]
            || task.run::<Fused>(),
        );
    }
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    if fuses() {
        return task.run::<Fused>();
    }
    plainly(task)
}

/// Runs a computation on one of the few machines that round twice, out of line.
#[cold]
#[inline(never)]
fn plainly<T: Loop>(task: T) -> T::Output {
    task.run::<Plain>()
}

#[cfg(all(test, feature = "packs"))]
mod tests {
    use fearless_simd::Level;

    use super::*;

    #[test]
    fn loops_and_packs_choose_the_same_code() {
        assert_eq!(fuses(), crate::pack::fuses(Level::new()));
        #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
        assert_eq!(Avx512::find().is_some(), Level::new().as_avx512().is_some());
    }
}

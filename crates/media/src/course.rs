//! Eight walks side by side through straight pieces.
//!
//! Specification: walk i of a course stands where a [`super::Cursor`] stands after the same flights
//! through the same [`Piecewise`] field, to the bit.

use fearless_simd::{ExtractToken, Simd, SimdBase, SimdMask, f64x8, mask64x8};

use super::{Piecewise, even};
use numeric::Lane;
use numeric::pack::WIDTH;

/// Where eight walks stand.
pub trait Course<S: Simd> {
    /// Each flies on through an optical depth; answers which are still before the last knot.
    fn fly(&mut self, depth: f64x8<S>) -> mask64x8<S>;

    /// The distances reached.
    fn reached(&self) -> f64x8<S>;

    /// `σ̂` there.
    fn sampling(&self) -> f64x8<S>;

    /// The mean free paths `1/σ̂` there.
    fn mean_free_path(&self) -> f64x8<S>;

    /// These begin anew.
    fn restart(&mut self, which: mask64x8<S>);
}

/// A course that walks may go back, too.
pub trait BothWays<S: Simd>: Course<S> {
    /// Each flies on or back through an optical depth; answers which are still between the ends.
    fn fly_either_way(&mut self, depth: f64x8<S>, is_forward: mask64x8<S>) -> mask64x8<S>;

    /// These stand where they stand on another course through the same field.
    fn stand_as(&mut self, which: mask64x8<S>, other: &Self);
}

/// Through one value, but for gaps.
#[derive(Clone, Copy)]
pub struct Even<'a, S: Simd> {
    field: &'a even::Even,
    begin: f64x8<S>,
    end: f64x8<S>,
    rate: f64x8<S>,
    path: f64x8<S>,
    way: f64x8<S>,
}

impl<'a, S: Simd> Even<'a, S> {
    /// At the beginning of a field.
    #[inline(always)]
    pub fn new(simd: S, field: &'a even::Even) -> Self {
        let begin = f64x8::splat(simd, field.from);
        let end = f64x8::splat(simd, field.to);
        let path = f64x8::splat(simd, 1.0 / field.value);
        let rate = f64x8::splat(simd, field.value);
        Self { field, begin, end, rate, path, way: begin }
    }

    /// At its end.
    #[must_use]
    #[inline(always)]
    pub fn from_end(self) -> Self {
        Self { way: self.end, ..self }
    }
}

impl<S: Simd> Course<S> for Even<'_, S> {
    #[inline(always)]
    fn fly(&mut self, depth: f64x8<S>) -> mask64x8<S> {
        self.way = depth.times_plus(self.path, self.way);
        self.way.below(self.end)
    }

    #[inline(always)]
    fn reached(&self) -> f64x8<S> {
        self.field.spread(self.way)
    }

    #[inline(always)]
    fn sampling(&self) -> f64x8<S> {
        self.rate
    }

    #[inline(always)]
    fn mean_free_path(&self) -> f64x8<S> {
        self.path
    }

    #[inline(always)]
    fn restart(&mut self, which: mask64x8<S>) {
        self.way = Lane::select(which, self.begin, self.way);
    }
}

impl<S: Simd> BothWays<S> for Even<'_, S> {
    #[inline(always)]
    fn fly_either_way(&mut self, depth: f64x8<S>, is_forward: mask64x8<S>) -> mask64x8<S> {
        self.way = Lane::select(is_forward, depth, -depth).times_plus(self.path, self.way);
        (is_forward & self.way.below(self.end)) | (!is_forward & self.begin.below(self.way))
    }

    #[inline(always)]
    fn stand_as(&mut self, which: mask64x8<S>, other: &Self) {
        self.way = Lane::select(which, other.way, self.way);
    }
}

/// Through any pieces: each walk has its own at hand, and looks the next one up when it crosses.
#[derive(Clone, Copy)]
pub struct Pieces<'a, S: Simd> {
    field: &'a Piecewise,
    piece: [usize; WIDTH],
    knot: f64x8<S>,
    end: f64x8<S>,
    left: f64x8<S>,
    right: f64x8<S>,
    slope: f64x8<S>,
    t: f64x8<S>,
}

impl<'a, S: Simd> Pieces<'a, S> {
    /// At the first knot.
    #[inline(always)]
    pub fn new(simd: S, field: &'a Piecewise) -> Self {
        let zero = f64x8::splat(simd, 0.0);
        let t = f64x8::splat(simd, field.knots[0]);
        let (knot, end, left, right, slope) = (t, zero, zero, zero, zero);
        let mut walks = Self { field, piece: [0; WIDTH], knot, end, left, right, slope, t };
        walks.look_up(u64::MAX);
        walks
    }

    /// σ̂ at the distances reached.
    #[inline(always)]
    fn here(&self) -> f64x8<S> {
        self.left + self.slope * (self.t - self.knot)
    }

    /// Takes the pieces of some walks to hand.
    #[inline(always)]
    fn look_up(&mut self, which: u64) {
        let packs =
            [&mut self.knot, &mut self.end, &mut self.left, &mut self.right, &mut self.slope];
        let mut rows = [[0.0; WIDTH]; 5];
        for (number, row) in rows.iter_mut().enumerate() {
            packs[number].store_slice(row);
        }
        for (lane, &piece) in self.piece.iter().enumerate() {
            if which >> lane & 1 == 1 {
                let (knot, end) = (self.field.knots[piece], self.field.knots[piece + 1]);
                let (left, slope) = (self.field.left[piece], self.field.slope[piece]);
                let values = [knot, end, left, self.field.line(piece, end), slope];
                for (number, row) in rows.iter_mut().enumerate() {
                    row[lane] = values[number];
                }
            }
        }
        let simd = self.t.token();
        for (number, pack) in packs.into_iter().enumerate() {
            *pack = f64x8::from_slice(simd, &rows[number]);
        }
    }

    /// Each flies through an optical depth: on, or, where `BOTH`, either way.
    #[inline(always)]
    fn go<const BOTH: bool>(
        &mut self,
        mut depth: f64x8<S>,
        is_forward: mask64x8<S>,
    ) -> mask64x8<S> {
        let simd = depth.token();
        let zero = depth.each(0.0);
        let signed = |x: f64x8<S>| if BOTH { Lane::select(is_forward, x, -x) } else { x };
        let forward = if BOTH { is_forward.to_bitmask() } else { u64::MAX };
        let last = self.field.left.len() - 1;
        let mut flying = mask64x8::splat(simd, true);
        let mut arrived = mask64x8::splat(simd, false);
        loop {
            let here = self.here();
            let (mut edge, mut there) = (self.end, self.right);
            if BOTH {
                edge = Lane::select(is_forward, edge, self.knot);
                there = Lane::select(is_forward, there, self.left);
            }
            let left = signed(edge - self.t) * 0.5 * (here + there);
            let arrives = depth.below(left) & flying;
            let root = (here * here + signed(self.slope * 2.0 * depth)).or_more(zero).root();
            let landed = self.t + signed(depth * 2.0 / (here + root));
            self.t = Lane::select(arrives, landed, self.t);
            arrived |= arrives;
            flying &= !arrives;
            if !flying.any_true() {
                return arrived;
            }
            depth = Lane::select(flying, depth - left, depth);
            self.t = Lane::select(flying, edge, self.t);
            let mut crossing = flying.to_bitmask();
            for (lane, piece) in self.piece.iter_mut().enumerate() {
                if crossing >> lane & 1 == 1 {
                    let is_forward = forward >> lane & 1 == 1;
                    if *piece == if is_forward { last } else { 0 } {
                        crossing &= !(1 << lane);
                    } else {
                        *piece = if is_forward { *piece + 1 } else { *piece - 1 };
                    }
                }
            }
            flying = mask64x8::from_bitmask(simd, crossing);
            self.look_up(crossing);
        }
    }
}

impl<S: Simd> Course<S> for Pieces<'_, S> {
    #[inline(always)]
    fn fly(&mut self, depth: f64x8<S>) -> mask64x8<S> {
        self.go::<false>(depth, mask64x8::splat(depth.token(), true))
    }

    #[inline(always)]
    fn reached(&self) -> f64x8<S> {
        self.t
    }

    #[inline(always)]
    fn sampling(&self) -> f64x8<S> {
        self.here()
    }

    #[inline(always)]
    fn mean_free_path(&self) -> f64x8<S> {
        self.t.each(1.0) / self.here()
    }

    #[inline(always)]
    fn restart(&mut self, which: mask64x8<S>) {
        let bits = which.to_bitmask();
        if bits != 0 {
            for (lane, piece) in self.piece.iter_mut().enumerate() {
                if bits >> lane & 1 == 1 {
                    *piece = 0;
                }
            }
            self.look_up(bits);
            self.t = Lane::select(which, self.t.each(self.field.knots[0]), self.t);
        }
    }
}

impl<S: Simd> BothWays<S> for Pieces<'_, S> {
    #[inline(always)]
    fn fly_either_way(&mut self, depth: f64x8<S>, is_forward: mask64x8<S>) -> mask64x8<S> {
        self.go::<true>(depth, is_forward)
    }

    #[inline(always)]
    fn stand_as(&mut self, which: mask64x8<S>, other: &Self) {
        let bits = which.to_bitmask();
        if bits == 0 {
            return;
        }
        for (lane, piece) in self.piece.iter_mut().enumerate() {
            if bits >> lane & 1 == 1 {
                *piece = other.piece[lane];
            }
        }
        self.knot = Lane::select(which, other.knot, self.knot);
        self.end = Lane::select(which, other.end, self.end);
        self.left = Lane::select(which, other.left, self.left);
        self.right = Lane::select(which, other.right, self.right);
        self.slope = Lane::select(which, other.slope, self.slope);
        self.t = Lane::select(which, other.t, self.t);
    }
}

//! Positions of walks on their course through σ̂.

use media::sampling::{BothWays, PackedFlight};
use numeric::Lane;

/// The positions of walks, and vertices to which they may return. A vertex is the beginning of the course until another
/// is marked.
#[derive(Clone, Copy)]
pub struct Route<C> {
    /// The positions.
    pub here: C,
    vertex: C,
}

impl<C: Copy> Route<C> {
    /// Positions at the beginning of a course.
    #[inline(always)]
    pub fn new(course: C) -> Self {
        Self { here: course, vertex: course }
    }

    /// Stores the positions of the lanes in `which` as their vertices.
    #[inline(always)]
    pub fn mark_where<L: Lane>(&mut self, which: L::Mask)
    where
        C: BothWays<L>,
    {
        self.vertex.copy_where(which, &self.here);
    }

    /// Returns the lanes in `which` to their vertices.
    #[inline(always)]
    pub fn return_where<L: Lane>(&mut self, which: L::Mask)
    where
        C: BothWays<L>,
    {
        self.here.copy_where(which, &self.vertex);
    }
}

/// The course of walks that keep their own positions and use no other.
#[derive(Clone, Copy)]
pub struct Nowhere;

impl<L: Lane> PackedFlight<L> for Nowhere {
    #[inline(always)]
    fn fly(&mut self, depth: L) -> L::Mask {
        depth.below(depth)
    }

    #[inline(always)]
    fn reached(&self) -> L {
        unreachable!("the walk keeps its own position")
    }

    #[inline(always)]
    fn sampling(&self) -> L {
        unreachable!("the walk keeps its own position")
    }

    #[inline(always)]
    fn mean_free_path(&self) -> L {
        unreachable!("the walk keeps its own position")
    }

    #[inline(always)]
    fn restart(&mut self, _: L::Mask) {}
}

impl<L: Lane> BothWays<L> for Nowhere {
    type Place = ();

    #[inline(always)]
    fn place(&self) {}

    #[inline(always)]
    fn return_to(&mut self, (): ()) {}

    #[inline(always)]
    fn fly_either_way(&mut self, depth: L, _: L::Mask) -> L::Mask {
        depth.below(depth)
    }

    #[inline(always)]
    fn copy_where(&mut self, _: L::Mask, _: &Self) {}
}

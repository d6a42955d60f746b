//! A worker's view of the scene.

use std::cell::Cell;
use std::ops::Deref;

use glam::DVec3;

use super::{Anchor, Hit, Scene};

/// How many rays of each sort were cast.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RayCounts {
    /// Closest-hit rays.
    pub rays: u64,
    /// Shadow rays.
    pub shadow_rays: u64,
}

impl RayCounts {
    /// What a worker has cast so far.
    pub fn of(worker: &Tracer<'_>) -> Self {
        Self { rays: worker.rays.get(), shadow_rays: worker.shadow_rays.get() }
    }

    /// What was cast since an earlier count.
    #[must_use]
    pub fn since(self, earlier: Self) -> Self {
        Self { rays: self.rays - earlier.rays, shadow_rays: self.shadow_rays - earlier.shadow_rays }
    }

    /// Both together.
    #[must_use]
    pub fn and(self, other: Self) -> Self {
        Self { rays: self.rays + other.rays, shadow_rays: self.shadow_rays + other.shadow_rays }
    }

    /// Adds what a worker has cast.
    pub fn add(&mut self, worker: &Tracer<'_>) {
        self.rays += worker.rays.get();
        self.shadow_rays += worker.shadow_rays.get();
    }
}

/// A scene as one worker sees it: the same world, with a count of the rays the worker has cast.
#[derive(Debug)]
pub struct Tracer<'s> {
    scene: &'s Scene,
    rays: Cell<u64>,
    shadow_rays: Cell<u64>,
}

impl<'s> Tracer<'s> {
    /// A view of `scene` with counts of zero.
    pub fn new(scene: &'s Scene) -> Self {
        Self { scene, rays: Cell::new(0), shadow_rays: Cell::new(0) }
    }

    /// The nearest surface seen from `from` in the unit `direction`.
    #[inline]
    pub fn closest(&self, from: &Anchor, direction: DVec3) -> Option<Hit> {
        self.rays.set(self.rays.get() + 1);
        self.scene.closest(from, direction)
    }

    /// True when nothing stands between the two points.
    #[inline]
    pub fn visible(&self, a: &Anchor, b: &Anchor) -> bool {
        self.shadow_rays.set(self.shadow_rays.get() + 1);
        self.scene.visible(a, b)
    }
}

impl Deref for Tracer<'_> {
    type Target = Scene;

    fn deref(&self) -> &Scene {
        self.scene
    }
}

//! What the device decides for itself while it makes steps.
//!
//! One group of dispatches is: a check, with the search that may follow; `group` steps;
//! `settle`. A check is real only when `base` has come to `good`; so its moments, and with
//! them the order of grains and sums, depend on the motion alone and not on how many steps
//! the host asks for at a time.
//!
//! - Step `base + k` is made if it is before `end` and before `good` (`may_step`). It computes
//!   forces at its places, then moves; the lists must hold for its places, not for those it
//!   moves to.
//! - A real check measures the farthest way D since the last search and the highest speed v.
//!   Lists hold as long as no grain has gone half the skin. The steps that this allows at
//!   1.25 v are m = (skin/2 - D) / (1.25 v dt), at most `group`. If new lists would allow
//!   more, a search follows. Then `good = base + m`, and `allowed = (skin/2 - D) / (m dt)`.
//! - A body that moves faster than `allowed` in step s ends the group: `good = s + 1`
//!   (`watch`). Its step is whole, and the check at its end measures where it got to.
//! - `settle` sets `base` to the steps made, and begins new maxima for the next check.
//! - Any flag stops all: `good = base`, until the host has cleared it. [`CROWDED`]: the
//!   search changed nothing; the host gives lists more room ([`Control::entries`],
//!   [`Control::touching`]) and goes on.
//!
//! Twin: shaders/dem/control.wgsl.

use bytemuck::{Pod, Zeroable};

/// A body was faster than [`Control::limit`], or nowhere, in step `base - 1`.
pub const UNSTABLE: u32 = 1;
/// The lists need more room than there is.
pub const CROWDED: u32 = 2;
/// A grain has left the range of positions.
pub const GONE: u32 = 4;
/// A running sum overflows.
pub const FULL: u32 = 8;

/// The device's own view of its progress.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub struct Control {
    /// The first step that is not asked for; the host's.
    pub end: u32,
    /// Steps recorded between two checks; the host's.
    pub group: u32,
    /// Speed of a body that has run away [m/s]; the host's.
    pub limit: f32,
    /// Skin of the next search [m], unless that adapts it.
    pub wanted_skin: f32,
    /// Steps made.
    pub base: u32,
    /// The first step for which the neighbour lists may miss a pair.
    pub good: u32,
    /// [`UNSTABLE`], [`CROWDED`], [`GONE`], [`FULL`].
    pub flags: u32,
    /// Speed up to which `good` holds [m/s].
    pub allowed: f32,
    /// Gaps up to here are in the lists [m]; 0 where there are no lists yet.
    pub skin: f32,
    /// Searches so far.
    pub searches: u32,
    /// Step of the last search.
    pub searched_at: u32,
    /// Neighbours of all grains in the last search, also if they found no room.
    pub entries: u32,
    /// Entries that touched when the last search began.
    pub touching: u32,
    /// Of these, those that are not in the new lists. The lists are wrong if there is any.
    pub lost: u32,
    /// Bits of the largest squared way since the last search [units²].
    pub farthest: u32,
    /// Bits of the highest squared speed [m²/s²].
    pub fastest: u32,
}

impl Control {
    /// The control of a solver that has made no step and has no lists.
    pub fn new(group: u32, limit: f32, skin: f32) -> Self {
        Self {
            group,
            limit,
            wanted_skin: skin,
            ..Self::default()
        }
    }
}

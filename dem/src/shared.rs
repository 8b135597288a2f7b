//! Arrays that several threads write in turn.

use std::cell::UnsafeCell;
use std::ops::Range;

/// An array of which each thread writes its own range between two barriers, and which all
/// read after the next one.
pub struct Shared<T>(Box<[UnsafeCell<T>]>);

// SAFETY: access from several threads goes through `read` and `write`, whose callers
// promise that nobody reads what another one writes.
unsafe impl<T: Send + Sync> Sync for Shared<T> {}

impl<T> Shared<T> {
    /// Take over `values`.
    pub fn new(values: Vec<T>) -> Self {
        Self(values.into_iter().map(UnsafeCell::new).collect())
    }

    /// All values.
    ///
    /// # Safety
    /// Nobody writes until the reader has passed its next barrier.
    pub unsafe fn read(&self) -> &[T] {
        // SAFETY: UnsafeCell<T> has the layout of T; the caller excludes writers.
        unsafe { std::slice::from_raw_parts(self.0.as_ptr().cast(), self.0.len()) }
    }

    /// The values of a range, to be written.
    ///
    /// # Safety
    /// Until the writer has passed its next barrier nobody else touches the range.
    #[allow(
        clippy::mut_from_ref,
        reason = "that is the point; the caller excludes others"
    )]
    pub unsafe fn write(&self, range: Range<usize>) -> &mut [T] {
        let cells = &self.0[range];
        // SAFETY: as above, and the cells allow mutation.
        unsafe { std::slice::from_raw_parts_mut(cells.as_ptr() as *mut T, cells.len()) }
    }

    /// All values, to a single thread.
    pub fn get_mut(&mut self) -> &mut [T] {
        // SAFETY: the exclusive borrow excludes everyone else.
        unsafe { std::slice::from_raw_parts_mut(self.0.as_mut_ptr().cast(), self.0.len()) }
    }
}

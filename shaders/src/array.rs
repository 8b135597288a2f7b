//! Typed arrays on the device.
//!
//! A binding holds 2 GiB at most, on some devices 128 MiB. An array that outgrows that lies in
//! several parts, a buffer and a binding each, of a power of two of elements but for the last
//! ([`Device::array_in_parts`](crate::Device::array_in_parts)); the kernels' side is told in
//! [`Flags::parts`](crate::Flags::parts).

use std::marker::PhantomData;
use std::ops::Range;
use std::sync::Arc;

/// An array of `T` on the device. Cheap to clone: clones are the same array.
#[derive(Debug)]
pub struct Array<T> {
    parts: Arc<[wgpu::Buffer]>,
    /// Elements of each part but the last.
    chunk: usize,
    len: usize,
    element: PhantomData<fn() -> T>,
}

impl<T> Clone for Array<T> {
    fn clone(&self) -> Self {
        Self::new(self.parts.clone(), self.chunk, self.len)
    }
}

/// Elements that lie side by side in one part.
pub(crate) struct Piece<'a> {
    pub buffer: &'a wgpu::Buffer,
    /// Place in the buffer [bytes].
    pub offset: u64,
    /// Elements.
    pub count: usize,
}

impl<T> Array<T> {
    pub(crate) fn new(parts: Arc<[wgpu::Buffer]>, chunk: usize, len: usize) -> Self {
        Self {
            parts,
            chunk,
            len,
            element: PhantomData,
        }
    }

    /// Number of elements.
    pub fn len(&self) -> usize {
        self.len
    }

    /// Has it no element?
    pub fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// The same memory as words.
    pub fn words(&self) -> Array<u32> {
        let words = size_of::<T>() / 4;
        Array::new(self.parts.clone(), self.chunk * words, self.len * words)
    }

    /// Memory on the device [bytes].
    pub fn bytes(&self) -> u64 {
        self.parts.iter().map(wgpu::Buffer::size).sum()
    }

    /// The elements from `at` on, up to `most` of them, that lie in one part.
    pub(crate) fn piece(&self, at: usize, most: usize) -> Piece<'_> {
        let part = (at / self.chunk).min(self.parts.len() - 1);
        let inside = at - part * self.chunk;
        let left = match part + 1 == self.parts.len() {
            true => most,
            false => self.chunk - inside,
        };
        Piece {
            buffer: &self.parts[part],
            offset: (inside * size_of::<T>()) as u64,
            count: most.min(left),
        }
    }

    /// All elements of `range` in pieces, in order.
    pub(crate) fn pieces(&self, range: Range<usize>) -> impl Iterator<Item = Piece<'_>> {
        let mut at = range.start;
        std::iter::from_fn(move || {
            let piece = (at < range.end).then(|| self.piece(at, range.end - at))?;
            at += piece.count;
            Some(piece)
        })
    }
}

/// What a kernel can be bound to: an [`Array`] of any type.
pub trait Bindable {
    /// The memory behind it: a buffer for each part.
    fn parts(&self) -> &[wgpu::Buffer];

    /// Memory on the device [bytes].
    fn bytes(&self) -> u64 {
        self.parts().iter().map(wgpu::Buffer::size).sum()
    }
}

impl<T> Bindable for Array<T> {
    fn parts(&self) -> &[wgpu::Buffer] {
        &self.parts
    }
}

//! Typed arrays on the device.

use std::marker::PhantomData;

/// An array of `T` on the device. Cheap to clone: clones are the same array.
#[derive(Debug)]
pub struct Array<T> {
    pub(crate) buffer: wgpu::Buffer,
    len: usize,
    element: PhantomData<fn() -> T>,
}

impl<T> Clone for Array<T> {
    fn clone(&self) -> Self {
        Self::new(self.buffer.clone(), self.len)
    }
}

impl<T> Array<T> {
    pub(crate) fn new(buffer: wgpu::Buffer, len: usize) -> Self {
        Self {
            buffer,
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
        Array::new(self.buffer.clone(), self.buffer.size() as usize / 4)
    }

    /// Memory on the device [bytes].
    pub fn bytes(&self) -> u64 {
        self.buffer.size()
    }
}

/// What a kernel can be bound to: an [`Array`] of any type.
pub trait Bindable {
    /// The memory behind it.
    fn buffer(&self) -> &wgpu::Buffer;
}

impl<T> Bindable for Array<T> {
    fn buffer(&self) -> &wgpu::Buffer {
        &self.buffer
    }
}

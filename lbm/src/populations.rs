//! The populations of all cells in one array, streamed in place (Esoteric-Pull).
//!
//! A link joins a cell and its neighbour along a forward direction c. Both of its populations
//! are stored at the neighbour's place, in two slots. In even steps a cell finds what arrived
//! along c in the first slot of its own place, and what arrived along -c in the second slot of
//! the place at c; after collision it leaves what goes along -c in the former and what goes
//! along c in the latter. For odd steps the slots change names. Nobody else touches these
//! slots during the step, so that the cells may come in any order.
//!
//! Between two steps a link thus holds what its two ends have emitted: a wall between them
//! only has to exchange the two slots (`links.rs`).
//!
//! Source: Lehmann (2022), Computation 10, 92.

use crate::collide::Cell;
use crate::grid::{Grid, shift};
use crate::lanes::{Lanes, Real};
use crate::lattice::{C, Direction, PAIRS};
use std::cell::UnsafeCell;

/// Fluid cells side by side in one row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Span {
    pub y: u32,
    pub z: u32,
    pub begin: u32,
    pub end: u32,
}

/// One array for each population, one after the other.
pub(crate) struct Populations<T> {
    pub grid: Grid,
    slots: Box<[UnsafeCell<T>]>,
    /// From the array of one population to the next.
    step: usize,
    /// From the start of the allocation to its first cache line.
    first: usize,
}

// SAFETY: several threads write at once only through the unsafe functions below, whose callers
// promise that no two of them touch the same slot.
unsafe impl<T: Send + Sync> Sync for Populations<T> {}

/// Numbers in a cache line of single precision.
const LINE: usize = 16;

impl<T: Real> Populations<T> {
    /// At rest.
    pub fn new(grid: Grid) -> Self {
        // Nineteen arrays at the same distance from a multiple of 4 kB would all fall into
        // the same few lines of the caches.
        let step = grid.places().next_multiple_of(LINE) + 5 * LINE;
        let count = step * (1 + 2 * PAIRS) + LINE;
        let slots: Box<[UnsafeCell<T>]> =
            (0..count).map(|_| UnsafeCell::new(T::default())).collect();
        let first = slots.as_ptr().align_offset(64);
        Self {
            grid,
            slots,
            step,
            first,
        }
    }

    /// Bytes of memory.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.slots)
    }

    /// Are all populations at rest numbers? A moving one that is none spreads to these.
    pub fn finite(&self) -> bool {
        let numbers = self.grid.places();
        // SAFETY: places of the lattice, which nobody writes: threads write only while the
        // solver is borrowed exclusively.
        let rest = unsafe { std::slice::from_raw_parts(self.rest(), numbers) };
        // Not one by one: most of the time they are.
        rest.iter().map(|f| f.double() * 0.0).sum::<f64>() == 0.0
    }

    fn array(&self, number: usize) -> *mut T {
        let start = self.first + number * self.step;
        self.slots[start..start + self.grid.places()].as_ptr() as *mut T
    }

    fn rest(&self) -> *mut T {
        self.array(0)
    }

    /// The first and the second slot of each pair in this step.
    fn pairs(&self, odd: bool) -> ([*mut T; PAIRS], [*mut T; PAIRS]) {
        let mut first = [std::ptr::null_mut(); PAIRS];
        let mut second = first;
        for pair in 0..PAIRS {
            let [a, b] = [1 + 2 * pair, 2 + 2 * pair].map(|n| self.array(n));
            (first[pair], second[pair]) = if odd { (b, a) } else { (a, b) };
        }
        (first, second)
    }

    /// Where the cell at `at` finds what arrived along `direction`, before step `odd`; and
    /// where it has left what goes that way in the step before.
    pub fn slot(&self, at: [usize; 3], direction: Direction, odd: bool) -> *mut T {
        let (first, second) = self.pairs(odd);
        let (array, place) = if direction.forward {
            (first[direction.pair], at)
        } else {
            let next = self.grid.neighbour(at, C[direction.pair]);
            (second[direction.pair], next)
        };
        // SAFETY: a place of the lattice.
        unsafe { array.add(self.grid.place(place)) }
    }

    /// The arrays of a link before step `odd`: what its near end has emitted along
    /// `direction`, and what that end will find as arriving against it.
    pub fn link(&self, direction: Direction, odd: bool) -> (*mut T, *mut T) {
        let (first, second) = self.pairs(odd);
        let pair = direction.pair;
        if direction.forward {
            (first[pair], second[pair])
        } else {
            (second[pair], first[pair])
        }
    }

    /// The sum of what arrived at each cell of the domain, before step `odd`, row by row.
    ///
    /// # Safety
    /// Nobody writes.
    pub unsafe fn contents(&self, odd: bool, to: &mut [f64]) {
        let (first, second) = self.pairs(odd);
        let [nx, ny, nz] = self.grid.cells;
        for z in 0..nz {
            for y in 0..ny {
                let start = (z * ny + y) * nx;
                let to = &mut to[start..start + nx];
                let row = self.grid.row(y, z);
                for (x, sum) in to.iter_mut().enumerate() {
                    // SAFETY: a place of the lattice, which nobody writes; so below.
                    *sum = unsafe { (*self.rest().add(row + x)).double() };
                }
                for pair in 0..PAIRS {
                    let [_, py, pz] = self.grid.neighbour([0, y, z], C[pair]);
                    let far = self.grid.row(py, pz);
                    for (x, sum) in to.iter_mut().enumerate() {
                        let next = shift(x, C[pair][0], self.grid.extent[0]);
                        // SAFETY: as above.
                        let pair = unsafe {
                            let forward = (*first[pair].add(row + x)).double();
                            forward + (*second[pair].add(far + next)).double()
                        };
                        *sum += pair;
                    }
                }
            }
        }
    }

    /// What arrived at a cell, before step `odd`.
    ///
    /// # Safety
    /// Nobody writes.
    pub unsafe fn read(&self, at: [usize; 3], odd: bool) -> Cell<T> {
        let get = |forward: bool| {
            let mut pair = 0..;
            [(); PAIRS].map(|()| {
                let pair = pair.next().expect("there is no end of numbers");
                // SAFETY: a slot of the lattice, which nobody writes.
                unsafe { *self.slot(at, Direction { pair, forward }, odd) }
            })
        };
        Cell {
            // SAFETY: as above.
            rest: unsafe { *self.rest().add(self.grid.place(at)) },
            forward: get(true),
            backward: get(false),
        }
    }

    /// The other way.
    pub fn write(&mut self, at: [usize; 3], odd: bool, cell: &Cell<T>) {
        // SAFETY: slots of the lattice, which are borrowed exclusively.
        unsafe {
            *self.rest().add(self.grid.place(at)) = cell.rest;
            for pair in 0..PAIRS {
                *self.slot(
                    at,
                    Direction {
                        pair,
                        forward: true,
                    },
                    odd,
                ) = cell.forward[pair];
                *self.slot(
                    at,
                    Direction {
                        pair,
                        forward: false,
                    },
                    odd,
                ) = cell.backward[pair];
            }
        }
    }

    /// The slots of all cells in step `odd`, to be asked for rows of them.
    #[inline(always)]
    pub fn slots(&self, odd: bool) -> Slots<T> {
        let (first, second) = self.pairs(odd);
        Slots {
            grid: self.grid,
            rest: self.rest(),
            first,
            second,
        }
    }
}

/// Where the slots of a lattice begin.
pub(crate) struct Slots<T> {
    grid: Grid,
    rest: *mut T,
    first: [*mut T; PAIRS],
    second: [*mut T; PAIRS],
}

impl<T> Slots<T> {
    /// Those of a row of cells.
    #[inline(always)]
    pub fn row(&self, y: usize, z: usize) -> Row<T> {
        let grid = &self.grid;
        let own = grid.row(y, z);
        let (mut first, mut second) = (self.first, self.second);
        // SAFETY: rows of the lattice; the one shifted by a place ends where the row ends,
        // since a row has a place more than cells.
        unsafe {
            for pair in 0..PAIRS {
                let [dx, dy, dz] = C[pair];
                let next = grid.row(shift(y, dy, grid.extent[1]), shift(z, dz, grid.extent[2]));
                first[pair] = first[pair].add(own);
                second[pair] = second[pair].add(next + dx as usize);
            }
            Row {
                place: own,
                rest: self.rest.add(own),
                first,
                second,
            }
        }
    }
}

/// Where the slots of a row begin.
pub(crate) struct Row<T> {
    /// Place of the first cell.
    pub place: usize,
    rest: *mut T,
    first: [*mut T; PAIRS],
    second: [*mut T; PAIRS],
}

impl<T> Row<T> {
    /// What arrived at the cells from `x` on.
    ///
    /// # Safety
    /// They are cells of this row, and nobody else touches their slots.
    #[inline(always)]
    pub unsafe fn load<V: Lanes<T>>(&self, x: usize) -> Cell<V> {
        // SAFETY: the caller's promise.
        unsafe {
            let rest = V::load(self.rest.add(x));
            let mut cell = Cell {
                rest,
                forward: [rest; PAIRS],
                backward: [rest; PAIRS],
            };
            for pair in 0..PAIRS {
                cell.forward[pair] = V::load(self.first[pair].add(x));
                cell.backward[pair] = V::load(self.second[pair].add(x));
            }
            cell
        }
    }

    /// Leave what they emit.
    ///
    /// # Safety
    /// As above.
    #[inline(always)]
    pub unsafe fn store<V: Lanes<T>>(&self, x: usize, cell: Cell<V>) {
        // SAFETY: the caller's promise.
        unsafe {
            cell.rest.store(self.rest.add(x));
            for pair in 0..PAIRS {
                cell.backward[pair].store(self.first[pair].add(x));
                cell.forward[pair].store(self.second[pair].add(x));
            }
        }
    }

    /// Copy the slots that the last cell of a row shares with the first one of a row around
    /// the end of a periodic lattice, to behind the end of the row, or back.
    ///
    /// # Safety
    /// `cells` is the number of cells in the row, and nobody else touches the slots of the last.
    #[inline(always)]
    pub unsafe fn wrap(&self, cells: usize, back: bool) {
        for (second, c) in self.second.iter().zip(C) {
            if c[0] == 0 {
                continue;
            }
            // SAFETY: `second` is shifted by a place along x already: its place before is the
            // first of the row, the one at the last cell is behind the end of the row.
            unsafe {
                let first = second.sub(1);
                let last = first.add(cells);
                if back {
                    first.copy_from(last, 1);
                } else {
                    last.copy_from(first, 1);
                }
            }
        }
    }
}

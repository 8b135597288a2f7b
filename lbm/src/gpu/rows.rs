//! What the links of each cell end at, in words. Twin: shaders/lbm/links.wgsl.

use super::sides::sides;
use crate::grid::Grid;
use crate::lattice::Direction;
use crate::links::{Answer, answer};
use crate::{Model, Side};
use std::collections::HashMap;

/// Nothing happens in a cell.
pub(super) const SOLID: u32 = 1 << 31;
/// Links of a cell end at something that does more than reflect.
const SPECIAL: u32 = 1 << 30;
/// Places of the forward directions among the links of a word: along x, y, z, x + y, x - y,
/// x + z, x - z, y + z, y - z. The backward ones follow nine bits on.
const BIT: [u32; 9] = [0, 1, 2, 3, 6, 4, 7, 5, 8];

/// Links by what they end at: all closed ones, those of each side, and those that free slip
/// mirrors where they leave along the first or the second of their axes.
type Row = [u32; 9];
const MIRRORED: usize = 7;

/// What the cells are.
#[derive(Debug, Default)]
pub(super) struct Rows {
    /// One word for each place where there are solids, else for each set of sides (64).
    pub words: Vec<u32>,
    /// Rows of the special words.
    pub rows: Vec<Row>,
    known: HashMap<Row, u32>,
}

impl Rows {
    /// Find what the links of all cells end at; nothing where no link ends at anything.
    pub fn new(model: &Model, grid: &Grid, fluid: &[bool]) -> Self {
        let mut rows = Self::default();
        if model.has_solids() {
            rows.words = vec![SOLID; grid.places()];
            for (cell, at) in grid.all().enumerate() {
                if fluid[cell] {
                    rows.words[grid.place(at)] = rows.word(model, grid, fluid, at);
                }
            }
        } else if model.walled().contains(&true) {
            rows.words = vec![0; 64];
            for code in 0..64 {
                if let Some(at) = touching(grid, model.walled(), code) {
                    rows.words[code] = rows.word(model, grid, fluid, at);
                }
            }
        }
        rows
    }

    /// Is a link mirrored?
    pub fn mirrors(&self) -> bool {
        let mirrored = |row: &Row| row[MIRRORED] | row[MIRRORED + 1] != 0;
        self.rows.iter().any(mirrored)
    }

    fn word(&mut self, model: &Model, grid: &Grid, fluid: &[bool], at: [usize; 3]) -> u32 {
        let mut row = Row::default();
        for direction in Direction::all() {
            let Some(answer) = answer(model, grid, fluid, at, direction) else {
                continue;
            };
            let behind = if direction.forward { 0 } else { 9 };
            let link = 1 << (BIT[direction.pair] + behind);
            match answer {
                Answer::Mirror(mirror) if mirror != direction => {
                    let (c, d) = (direction.c(), mirror.c());
                    // It leaves along the axis along which the mirrored one does too.
                    let first = (0..3).find(|&axis| c[axis] != 0);
                    let second = first.is_some_and(|axis| c[axis] != d[axis]);
                    row[MIRRORED + usize::from(second)] |= link;
                    continue;
                }
                Answer::Side { axis, upper } => {
                    let side = 2 * axis + usize::from(upper);
                    if !matches!(sides(model)[side], Some(Side::NoSlip(v)) if *v == [0.0; 3]) {
                        row[1 + side] |= link;
                    }
                }
                Answer::Solid | Answer::Mirror(_) => {}
            }
            row[0] |= link;
        }
        if row[1..] == [0; 8] {
            return row[0];
        }
        let next = self.rows.len() as u32;
        let rows = &mut self.rows;
        SPECIAL
            | *self.known.entry(row).or_insert_with(|| {
                rows.push(row);
                next
            })
    }
}

/// A cell that touches the sides of `code`: two bits an axis, the lower one and the upper one.
fn touching(grid: &Grid, walled: [bool; 3], code: usize) -> Option<[usize; 3]> {
    let mut at = [0; 3];
    for axis in 0..3 {
        let (n, sides) = (grid.cells[axis], code >> (2 * axis) & 3);
        at[axis] = match (sides, n) {
            (0, _) if !walled[axis] => 0,
            (_, _) if !walled[axis] => return None,
            (0, 3..) => 1,
            (1, 2..) => 0,
            (2, 2..) => n - 1,
            (3, 1) => 0,
            _ => return None,
        };
    }
    Some(at)
}

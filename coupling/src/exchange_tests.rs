//! Sums over terms of polynomials against weights that are made one by one.

use crate::exchange::{Exchange, Place};
use crate::faces::{Fields, Frozen, Pass};
use crate::kernel::{folded_cell, folded_face, half_width, shares};
use crate::kernels::Kernels;
use crate::lattice::Lattice;
use dem::Row;

/// Weights of a grain in the lower faces of all cells.
fn weights<const N: usize>(lattice: &Lattice, place: Place) -> Vec<[f64; 3]> {
    let mut weights = vec![[0.0; 3]; lattice.count()];
    let [x, y, z] = place.within.map(shares::<N>);
    let m = half_width(N) as i64;
    let nz = lattice.cells[2];
    for (i, j, k) in (0..N * N * N).map(|k| (k / N / N, k / N % N, k % N)) {
        let [plane, column] = [(0, i), (1, j)]
            .map(|(axis, k)| lattice.wrapped(axis, (place.cell[axis] + k) as i64 - m));
        let up = (place.cell[2] + k) as i64 - m;
        let cell = lattice.cell([plane, column, folded_cell(up, nz)]);
        weights[cell][0] += x.1[i] * y.0[j] * z.0[k];
        weights[cell][1] += x.0[i] * y.1[j] * z.0[k];
        let (face, behind) = folded_face(up, nz);
        // The faces at the walls are their own.
        if face > 0 && face < nz {
            let sign = if behind.is_some() { -1.0 } else { 1.0 };
            weights[lattice.cell([plane, column, face])][2] += sign * x.0[i] * y.0[j] * z.1[k];
        }
    }
    weights
}

fn agree<const N: usize>(cells: [usize; 3], kernels: &Kernels<N>) {
    let lattice = Lattice {
        cells,
        spacing: 1.0,
        bottom: 0.0,
        height: 1.0,
    };
    let mut random = crate::tests::random();
    let mut unit = || 0.5 + 0.5 * random();
    let count = 90;
    let places: Vec<Place> = (0..count)
        // Some have left the box since the last search.
        .map(|_| Place::of(&lattice, cells.map(|n| (1.2 * unit() - 0.1) * n as f64)))
        .collect();
    let counts: Vec<f64> = (0..count).map(|_| unit()).collect();
    let mut exchange = Exchange::default();
    exchange.lay(&lattice, &places);
    for (k, &(slot, lane)) in exchange.at.iter().enumerate() {
        exchange.counts[slot as usize].0[lane as usize] = counts[k];
    }
    let (fields, frozen) = (Fields::new::<N>(&lattice), Frozen::default());
    let pass = Pass {
        lattice: &lattice,
        kernels,
        exchange: &exchange,
        frozen: &frozen,
        fields: &fields,
        walls: [0, 1],
        step: 1.0,
        share: None,
    };
    let [sums] = pass.sums_of([&exchange.counts]);
    let field: Vec<Row> = (0..lattice.count())
        .map(|_| Row([unit(), unit(), unit(), 0.0]))
        .collect();
    let mut found = vec![[Row::ZERO; 3]; exchange.slots.len()];
    pass.found(&field, &mut found);

    let mut all = vec![[0.0; 3]; lattice.count()];
    for (k, place) in places.iter().enumerate() {
        let weights = weights::<N>(&lattice, *place);
        let (slot, lane) = exchange.at[k];
        for axis in 0..3 {
            let mut sum = 0.0;
            for (cell, weight) in weights.iter().enumerate() {
                all[cell][axis] += counts[k] * weight[axis];
                sum += weight[axis] * field[cell].0[axis];
            }
            let found = found[slot as usize][axis].0[lane as usize];
            assert!((sum - found).abs() < 1e-14, "grain {k}: {found}, not {sum}");
        }
    }
    for (cell, (sum, all)) in sums.iter().zip(&all).enumerate() {
        let bottom = cell % cells[2] == 0;
        for axis in 0..if bottom { 2 } else { 3 } {
            let off = (sum.0[axis] - all[axis]).abs();
            assert!(
                off < 1e-14 * all[axis].abs().max(1.0),
                "cell {cell}: {sum:?}, not {all:?}"
            );
        }
    }
}

#[test]
fn sums_over_terms_are_sums_over_weights() {
    // Also in boxes narrower than the kernel, and with planes that are no multiple of four cells.
    for cells in [[6, 5, 7], [3, 3, 6], [1, 1, 5], [2, 1, 9], [1, 4, 8]] {
        for kernels in [Kernels::<3>::choose(), Kernels::portable()] {
            agree(cells, &kernels);
        }
        for kernels in [Kernels::<5>::choose(), Kernels::portable()] {
            agree(cells, &kernels);
        }
    }
}

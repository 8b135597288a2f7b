// Free water in the incompressible limit. Twin of lbm/src/collide/free.rs, which carries the
// formulas, their limits and sources.

#define_import_path lbm::collide::free
#import lbm::collide::{Moments, sums, forced, odd_part, relaxed, first_order, second_order}
#import lbm::lattice::Cell
#import lbm::setting::setting

fn collide(place: u32, cell: Cell) -> Cell {
    let found = sums(cell);
    let omega = setting.omega_even;
    let pressure = (cell.rest + found.moving) / 3.0;
    let u = forced(found.momentum);
    let g = odd_part(u, found.momentum);

    let three_p = 3.0 * omega * pressure;
    // The rest population gives what the moving ones get beyond what they lose.
    let lost = omega * found.moving + cell.rest;
#ifdef INERTIA
    var v = 4.5 * omega * u;
#ifdef FORCE
    v += (18.0 - 9.0 * omega) * setting.half_force;
#endif
    let even = second_order(three_p, u, v);
#else
    let even = first_order(three_p);
#endif
    return relaxed(lost - even.got, found, even.each, g);
}

// Pressure and velocity between two steps.
fn moments(place: u32, cell: Cell) -> Moments {
    let found = sums(cell);
    return Moments((cell.rest + found.moving) / 3.0, forced(found.momentum));
}

// What happens inside a cell, whatever the law. Twin of lbm/src/collide/mod.rs, which says why.

#define_import_path lbm::collide
#import lbm::lattice::{Cell, Pairs, W_AXIS, W_DIAGONAL, project}
#import lbm::setting::{setting, as_rounded}

// Pressure and flux of a cell, lattice units.
struct Moments {
    pressure: f32,
    flux: vec3<f32>,
}

// What the pairs of a cell tell: s = f + f̄ and d = f - f̄ of each, Σs and Σcf.
struct Sums {
    s: Pairs,
    d: Pairs,
    moving: f32,
    momentum: vec3<f32>,
}

fn sums(cell: Cell) -> Sums {
    let f = cell.forward;
    let b = cell.backward;
    let s = Pairs(f.axis + b.axis, f.plus + b.plus, f.minus + b.minus);
    let d = Pairs(f.axis - b.axis, f.plus - b.plus, f.minus - b.minus);
    let diagonal = s.plus + s.minus;
    let moving = ((s.axis.x + s.axis.y) + (s.axis.z + diagonal.x)) + (diagonal.y + diagonal.z);
    let up = d.plus + d.minus;
    let down = d.plus - d.minus;
    let momentum = d.axis + vec3<f32>(up.x + up.y, down.x + up.z, down.y + down.z);
    return Sums(s, d, moving, momentum);
}

// Σcf + G/2 for the body force G.
fn forced(momentum: vec3<f32>) -> vec3<f32> {
#ifdef FORCE
    return momentum + setting.half_force;
#else
    return momentum;
#endif
}

// g = 2 j - (2 - ω⁻) Σcf
fn odd_part(j: vec3<f32>, momentum: vec3<f32>) -> vec3<f32> {
    return 2.0 * j - (2.0 - setting.omega_odd) * momentum;
}

// The relaxed pairs: `even` is ω⁺ e⁺ of each pair, `g` as above.
fn relaxed(rest: f32, sums: Sums, even: Pairs, g: vec3<f32>) -> Cell {
    let keep_even = 0.5 - 0.5 * setting.omega_even;
    let keep_odd = 0.5 - 0.5 * setting.omega_odd;
    let odd = project(g);
    // 3 w, the one for the axes and the one for the diagonals.
    let s = Pairs(
        keep_even * sums.s.axis + even.axis,
        keep_even * sums.s.plus + even.plus,
        keep_even * sums.s.minus + even.minus,
    );
    let d = Pairs(
        keep_odd * sums.d.axis + 3.0 * W_AXIS * odd.axis,
        keep_odd * sums.d.plus + 3.0 * W_DIAGONAL * odd.plus,
        keep_odd * sums.d.minus + 3.0 * W_DIAGONAL * odd.minus,
    );
    return Cell(
        rest,
        Pairs(s.axis + d.axis, s.plus + d.plus, s.minus + d.minus),
        Pairs(s.axis - d.axis, s.plus - d.plus, s.minus - d.minus),
    );
}

// An even part, and what all moving populations get together.
struct Even {
    each: Pairs,
    got: f32,
}

// w a of each pair; `got` is 2/3 a, but with the very weights that the pairs get. Compilers make
// one product of two by constants: not of this one.
fn first_order(a: f32) -> Even {
    let axis = as_rounded(W_AXIS * a);
    let diagonal = 0.5 * axis;
    let each = Pairs(vec3<f32>(axis), vec3<f32>(diagonal), vec3<f32>(diagonal));
    return Even(each, 12.0 * axis);
}

// w (a + (c·u)(c·v) - u·v/3) of each pair.
fn second_order(a: f32, u: vec3<f32>, v: vec3<f32>) -> Even {
    let first = first_order(a);
    let uv = dot(u, v);
    let less = -uv / 3.0;
    let cu = project(u);
    let cv = project(v);
    let each = Pairs(
        W_AXIS * (cu.axis * cv.axis + less) + first.each.axis,
        W_DIAGONAL * (cu.plus * cv.plus + less) + first.each.plus,
        W_DIAGONAL * (cu.minus * cv.minus + less) + first.each.minus,
    );
    return Even(each, uv / 9.0 + first.got);
}

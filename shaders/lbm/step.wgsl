// One time step of the water is one dispatch: what arrived at a cell, and came back from its
// walls, is relaxed and emitted. One thread a cell, x fastest. Twin of lbm/src/step.rs.

#import lbm::setting::setting
#import lbm::populations::{places, arrived, leave}
#ifdef LINKS
#import lbm::links::{word_of, answered, SOLID}
#endif
#ifdef POROUS
#import lbm::collide::porous as law
#else
#import lbm::collide::free as law
#endif

// Number of the step, even with the number since the start; and row of what the sides give.
@group(0) @binding(31) var<uniform> tick: u32;

#ifdef GUARDED
// 0: nothing is to be done.
@group(0) @binding(35) var<storage, read> guard: array<u32>;
#endif

@compute @workgroup_size(#{GROUP_X}, #{GROUP_Y}, #{GROUP_Z})
fn time_step(@builtin(global_invocation_id) at: vec3<u32>) {
#ifdef GUARDED
    if guard[0] == 0u {
        return;
    }
#endif
    if any(at >= setting.cells) {
        return;
    }
    let here = places(at);
    let odd = tick & 1u;
#ifdef LINKS
    let word = word_of(at, here);
    if word == SOLID {
        return;
    }
    let cell = answered(at, here, tick, word);
#else
    let cell = arrived(here, odd, 0u);
#endif
    leave(here, odd, law::collide(here.own, cell));
}

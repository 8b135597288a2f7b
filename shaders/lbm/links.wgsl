// Links that end at a side of the box or at a solid: what comes back of what was emitted. Twin
// of lbm/src/links.rs, which carries the formulas and their sources.
//
// On the CPU the sides answer between two steps. Here a cell answers to itself when it takes
// what arrived: a closed link keeps what was emitted in one of its slots for a whole step,
// since each step writes the other one.

#define_import_path lbm::links
#import lbm::lattice::{Cell, project}
#import lbm::setting::setting
#import lbm::populations::{Places, arrived, bits, fetch_one, row, further, back}

// What the cells are: by place where there are solids, else by the sides that they touch.
//
//   SOLID          nothing happens here
//   SPECIAL + row  links end at something that does more than reflect, see `rows`
//   else           links that end at something at rest, as for `arrived`
@group(0) @binding(50) var<storage, read> words: array<u32>;
const SOLID: u32 = 0x80000000u;
const SPECIAL: u32 = 0x40000000u;
const REST_OF_WORD: u32 = 0x3fffffffu;

#ifdef SPECIALS
// Rows of links: all closed ones, those that each side answers (lower x, upper x, lower y, ...),
// and those that free slip mirrors where they leave the box along the first of their two axes,
// or along the second.
@group(0) @binding(51) var<storage, read> rows: array<u32>;
const ROW: u32 = 9u;
const MIRRORED: u32 = 7u;
#endif

// What the sides give in a step: flux or velocity, and pressure.
struct Given {
    sides: array<vec4<f32>, 6>,
    fresh: u32, // 1: what arrived was given by the host, answers included
}
@group(0) @binding(52) var<storage, read> given: array<Given>;

fn word_of(at: vec3<u32>, here: Places) -> u32 {
#ifdef SOLIDS
    return words[here.own];
#else
    let lower = select(vec3<u32>(0u), vec3<u32>(1u), at == vec3<u32>(0u));
    let upper = select(vec3<u32>(0u), vec3<u32>(2u), at + 1u == setting.cells);
    let touched = (lower | upper) & setting.walled;
    return words[touched.x + 4u * touched.y + 16u * touched.z];
#endif
}

// What arrived at a cell that is not solid before step `tick`, answers of the sides included.
fn answered(at: vec3<u32>, here: Places, tick: u32, word: u32) -> Cell {
    let odd = tick & 1u;
    var closed = word;
    if word != 0u && given[tick].fresh == 1u {
        closed = 0u;
    }
#ifdef SPECIALS
    let special = (closed & SPECIAL) != 0u;
    let first = ROW * (closed & REST_OF_WORD);
    if special {
        closed = rows[first];
    }
    var cell = arrived(here, odd, closed);
    if special {
        for (var side = 0u; side < 6u; side++) {
            let links = rows[first + 1u + side];
            if links != 0u {
                let pressure = extractBits(setting.pressures, side, 1u) == 1u;
                cell = beside(cell, links, pressure, given[tick].sides[side]);
            }
        }
#ifdef MIRRORS
        let along_first = rows[first + MIRRORED];
        let along_second = rows[first + MIRRORED + 1u];
        for (var links = along_first | along_second; links != 0u; links &= links - 1u) {
            let link = firstTrailingBit(links);
            let second = extractBits(along_second, link, 1u) == 1u;
            cell = mirrored(cell, at, odd, link, second);
        }
#endif
    }
    return cell;
#else
    return arrived(here, odd, closed);
#endif
}

#ifdef SPECIALS
// A side answers: f - 6 w c·j, or -f + 6 w P.
fn beside(cell: Cell, links: u32, pressure: bool, value: vec4<f32>) -> Cell {
    var after = cell;
    let keep = select(1.0, -1.0, pressure);
    let cj = project(value.xyz);
    let one = vec3<u32>(1u);
    let f = cell.forward;
    let b = cell.backward;
    let p = value.w;
    // 6 w is 1/3 along the axes, 1/6 along the diagonals.
    after.backward.axis = select(b.axis, keep * b.axis + (p - cj.axis) / 3.0, bits(links, 0u) == one);
    after.backward.plus = select(b.plus, keep * b.plus + (p - cj.plus) / 6.0, bits(links, 3u) == one);
    after.backward.minus = select(b.minus, keep * b.minus + (p - cj.minus) / 6.0, bits(links, 6u) == one);
    after.forward.axis = select(f.axis, keep * f.axis + (p + cj.axis) / 3.0, bits(links, 9u) == one);
    after.forward.plus = select(f.plus, keep * f.plus + (p + cj.plus) / 6.0, bits(links, 12u) == one);
    after.forward.minus = select(f.minus, keep * f.minus + (p + cj.minus) / 6.0, bits(links, 15u) == one);
    return after;
}

#ifdef MIRRORS
// Free slip: what comes back along `link`, a diagonal, is what the mirrored link has emitted.
// `second`: it leaves the box along the second of its axes.
fn mirrored(cell: Cell, at: vec3<u32>, odd: u32, link: u32, second: bool) -> Cell {
    let forward = link < 9u;
    let pair = link % 9u;
    let plus = pair < 6u;
    let plane = pair % 3u; // x y, x z, y z
    // The mirrored link belongs to the cell beside, and has the other sign along the side. If
    // it is a forward one it is stored where it ends, behind the side next to this cell.
    let its_pair = select(pair - 3u, pair + 3u, plus);
    let is_forward = forward != second;
    let of_first = second != is_forward;
    let positive = forward == (plus || of_first);
    let axes = select(vec3<u32>(1u, 2u, 2u), vec3<u32>(0u, 0u, 1u), of_first);
    let moves = vec3<u32>(0u, 1u, 2u) == vec3<u32>(axes[plane]);
    let to = select(at, select(back(at), further(at), positive), moves);
    let which = select(1u - odd, odd, is_forward);
    let f = fetch_one(its_pair, which, row(to.y, to.z) + to.x);

    var after = cell;
    let here = vec3<u32>(plane) == vec3<u32>(0u, 1u, 2u);
    after.backward.plus = select(cell.backward.plus, vec3<f32>(f), here & vec3<bool>(forward && plus));
    after.backward.minus = select(cell.backward.minus, vec3<f32>(f), here & vec3<bool>(forward && !plus));
    after.forward.plus = select(cell.forward.plus, vec3<f32>(f), here & vec3<bool>(!forward && plus));
    after.forward.minus = select(cell.forward.minus, vec3<f32>(f), here & vec3<bool>(!forward && !plus));
    return after;
}
#endif
#endif

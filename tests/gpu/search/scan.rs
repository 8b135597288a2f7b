//! Prefix sums of awkward lengths.

use super::*;

/// Elements of a workgroup.
const BLOCK: usize = 2048;

pub fn list(suite: &mut Suite) {
    suite.gpu(
        "prefix_sums_of_any_length_are_exact",
        prefix_sums_of_any_length_are_exact,
    );
}

/// Scan `items` with the kernels of `flags`, where the length is one more than `plan.count`
/// and `grid.total`.
fn scanned<T: bytemuck::Pod>(device: &Device, flags: &Flags, items: &[T]) -> Vec<T> {
    let last = items.len() as u32 - 1;
    let module = compose("dem/search/scan.wgsl", flags).unwrap();
    let mut plan = Plan::default();
    plan.count = last;
    let mut grid = Grid::default();
    grid.total = last;
    let plan = device.array_of("plan", &[plan]).unwrap();
    let grid = device.array_of("grid", &[grid]).unwrap();
    let blocks = items.len().div_ceil(BLOCK);
    let sums = device.array::<[u32; 2]>("blocks", blocks).unwrap();
    let array = device.array_of("items", items).unwrap();
    let mut recording = device.record();
    let all = groups(items.len(), BLOCK as u32);
    for (entry, groups) in [("sums", all), ("top", [1, 1, 1]), ("scan", all)] {
        let kernel = device.kernel(&module, entry).unwrap();
        let arrays: [(&str, &dyn Bindable); 4] = [
            ("plan", &plan),
            ("grid", &grid),
            ("blocks", &sums),
            ("items", &array),
        ];
        recording.dispatch(&kernel.bind(device, &arrays).unwrap(), groups);
    }
    recording.submit().unwrap();
    device.read(&array).unwrap()
}

fn prefix_sums_of_any_length_are_exact(device: &Device) {
    let mut dice = Dice(7);
    for len in [1, 2, 255, 256, 257, 2047, 2048, 2049, 65_537, 1_000_000] {
        let one: Vec<u32> = (0..len).map(|_| (9.0 * dice.next()) as u32).collect();
        let two: Vec<[u32; 2]> = one
            .iter()
            .map(|&k| [k, (5.0 * dice.next()) as u32])
            .collect();
        let mut sum = [0, 0];
        let mut expected = Vec::new();
        for item in &two {
            expected.push(sum);
            sum = [sum[0] + item[0], sum[1] + item[1]];
        }
        let pairs = Flags::new().set("PAIRS");
        assert_eq!(scanned(device, &pairs, &two), expected, "{len} pairs");
        let first: Vec<u32> = expected.iter().map(|sum| sum[0]).collect();
        assert_eq!(scanned(device, &Flags::new(), &one), first, "{len}");
    }
}

//! The kernels of the coupling, each bound to the arrays that it sees.

use super::arrays::Arrays;
use shaders::{Bindable, Bound, Device, Error, Flags, compose};

/// Those of a step.
pub(super) struct Steps {
    pub scatter: Bound,
    pub add_up: Option<Bound>,
    pub means: Bound,
    /// With the drag of loose grains beside.
    pub scatter_both: Bound,
    pub add_up_drags: Option<Bound>,
    pub react: Bound,
    pub collect: Bound,
    pub collect_and_feel: Bound,
    pub feel_drained: Bound,
    pub feel_renewed: Bound,
    pub push: Bound,
    pub widen: Option<Bound>,
    pub widen_easing: Option<Bound>,
    pub gather: Bound,
    /// Of a reading.
    pub scatter_look: Bound,
    pub look: Bound,
}

/// Those that need the lattice of the water.
pub(super) struct OfLattice {
    pub drain: Bound,
    pub lay_bed: Bound,
}

/// Who runs over what.
#[derive(Clone, Copy, Debug)]
pub(super) enum Over {
    Grains,
    Cells,
    /// Cells and one more.
    Counts,
    /// A workgroup a cell.
    Lists,
    Blocks,
    One,
}

/// Kernels of the order of the grains and of a renewal.
pub(super) struct Renewal {
    pub number: Bound,
    pub relabel: Bound,
    pub stages: Vec<(Bound, Over)>,
}

/// Composes and binds.
pub(super) struct Binder<'a> {
    pub device: &'a Device,
    /// What the grains compile in, and the coupling.
    pub flags: Flags,
    pub arrays: &'a Arrays,
    /// Those of the grains.
    pub grains: Vec<(&'static str, &'a dyn Bindable)>,
}

type Named<'a> = (&'a str, &'a dyn Bindable);

impl Binder<'_> {
    fn bind(&self, place: [&str; 2], flags: &[&str], more: &[Named]) -> Result<Bound, Error> {
        let [file, entry] = place;
        let flags = flags
            .iter()
            .fold(self.flags.clone(), |flags, flag| flags.set(flag));
        let module = compose(&format!("coupling/{file}.wgsl"), &flags)?;
        // The first of a name counts.
        let mut named = more.to_vec();
        named.extend(self.arrays.named());
        named.extend(self.grains.iter().copied());
        self.device
            .kernel(&module, entry)?
            .bind(self.device, &named)
    }

    pub fn steps(&self) -> Result<Steps, Error> {
        let a = self.arrays;
        let shares: Named = ("shares", &a.shares);
        let drag_shares: Named = ("shares", &a.drag_shares);
        let drags_beside: Named = ("drag_shares", &a.drag_shares);
        let pushes: Named = ("pushes", &a.pushes);
        let easing: Named = ("easing", &a.easing);
        let follow = |entry, more: &[Named]| self.bind(["follow", entry], &[], more);
        let moves = ["scatter", "scatter"];
        Ok(match &a.wide {
            None => Steps {
                scatter: self.bind(moves, &["MOVES"], &[shares])?,
                add_up: None,
                means: follow("means", &[shares])?,
                scatter_both: self.bind(moves, &["MOVES", "DRAGS"], &[shares, drags_beside])?,
                add_up_drags: None,
                react: follow("react", &[drag_shares])?,
                collect: follow("collect", &[])?,
                collect_and_feel: follow("collect_and_feel", &[])?,
                feel_drained: follow("feel_drained", &[])?,
                feel_renewed: follow("feel_renewed", &[])?,
                scatter_look: self.bind(moves, &["MOVES", "LOOKS"], &[shares])?,
                look: follow("look", &[])?,
                push: self.bind(["push", "push"], &[], &[pushes, easing])?,
                widen: None,
                widen_easing: None,
                gather: self.bind(["gather", "gather"], &[], &[pushes, easing])?,
            },
            Some(wide) => {
                let rough: [Named; 2] = [
                    ("pushes", &wide.rough_pushes),
                    ("easing", &wide.rough_easing),
                ];
                let widen = |from: Named, to: Named| self.bind(["push", "widen"], &[], &[from, to]);
                Steps {
                    scatter: self.bind(moves, &["MOVES"], &[shares])?,
                    add_up: Some(follow("add_up", &[shares, ("rough_sums", &wide.sums)])?),
                    means: follow("means", &[("rough", &wide.sums)])?,
                    scatter_both: self.bind(moves, &["MOVES", "DRAGS"], &[shares, drags_beside])?,
                    add_up_drags: Some(follow(
                        "add_up",
                        &[drag_shares, ("rough_sums", &wide.drag_sums)],
                    )?),
                    react: follow("react", &[("rough", &wide.drag_sums)])?,
                    collect: follow("collect", &[])?,
                    collect_and_feel: follow("collect_and_feel", &[])?,
                    feel_drained: follow("feel_drained", &[])?,
                    feel_renewed: follow("feel_renewed", &[])?,
                    scatter_look: self.bind(moves, &["MOVES", "LOOKS"], &[shares])?,
                    look: follow("look", &[])?,
                    push: self.bind(["push", "push"], &[], &rough)?,
                    widen: Some(widen(("rough", &wide.rough_pushes), pushes)?),
                    widen_easing: Some(widen(
                        ("rough", &wide.rough_easing),
                        ("pushes", &a.easing),
                    )?),
                    gather: self.bind(["gather", "gather"], &[], &[pushes, easing])?,
                }
            }
        })
    }

    pub fn renewal(&self) -> Result<Renewal, Error> {
        let a = self.arrays;
        let shares: Named = ("shares", &a.shares);
        let drag_shares: Named = ("shares", &a.drag_shares);
        let mut stages = Vec::new();
        let mut add = |bound: Result<Bound, Error>, over: Over| -> Result<(), Error> {
            stages.push((bound?, over));
            Ok(())
        };
        let loads = |entry| self.bind(["loads", entry], &[], &[]);
        let touch = |entry| self.bind(["touch", entry], &[], &[("grid", &a.scan_grid)]);
        let scatter = |flags: &[&str], to| self.bind(["scatter", "scatter"], flags, &[to]);
        // Sums of the wide kernel are added up before the filter.
        let bed = |entry, from: Named, rough: Option<Named>| {
            let more: Vec<Named> = [Some(from), rough].into_iter().flatten().collect();
            self.bind(["bed", entry], &[], &more)
        };
        let wide = a.wide.as_ref();
        let rough = wide.map(|wide| ("rough", &wide.sums as &dyn Bindable));
        let rough_drags = wide.map(|wide| ("rough", &wide.drag_sums as &dyn Bindable));
        let to = wide.map(|wide| ("rough_sums", &wide.sums as &dyn Bindable));
        let to_drags = wide.map(|wide| ("rough_sums", &wide.drag_sums as &dyn Bindable));

        add(touch("clear"), Over::Counts)?;
        add(loads("average"), Over::Grains)?;
        add(loads("mean"), Over::One)?;
        add(touch("touch_down"), Over::Grains)?;
        let scan = compose("dem/search/scan.wgsl", &Flags::new())?;
        for (entry, over) in [
            ("sums", Over::Blocks),
            ("top", Over::One),
            ("scan", Over::Blocks),
        ] {
            let items: [Named; 3] = [
                ("items", &a.starts),
                ("blocks", &a.blocks),
                ("grid", &a.scan_grid),
            ];
            add(
                self.device.kernel(&scan, entry)?.bind(self.device, &items),
                over,
            )?;
        }
        add(touch("place_in"), Over::Grains)?;
        add(touch("rank"), Over::Grains)?;
        add(scatter(&["DEPOSIT"], shares), Over::Lists)?;
        if wide.is_some() {
            add(bed("add_up_cells", shares, to), Over::Cells)?;
        }
        add(bed("pores", shares, rough), Over::Cells)?;
        add(touch("loosen"), Over::Grains)?;
        add(scatter(&[], shares), Over::Lists)?;
        if wide.is_some() {
            add(bed("add_up", shares, to), Over::Cells)?;
        }
        add(bed("freeze", shares, rough), Over::Cells)?;
        add(scatter(&["DRAGS"], drag_shares), Over::Lists)?;
        if wide.is_some() {
            add(bed("add_up", drag_shares, to_drags), Over::Cells)?;
        }
        add(bed("freeze_drags", drag_shares, rough_drags), Over::Cells)?;
        add(scatter(&["PACES"], drag_shares), Over::Lists)?;
        if wide.is_some() {
            add(bed("add_up", drag_shares, to_drags), Over::Cells)?;
        }
        add(bed("soften", drag_shares, rough_drags), Over::Cells)?;
        let eased: Named = match wide {
            Some(_) => {
                let more: [Named; 2] = [("rough", &a.ease), ("pushes", &a.easing)];
                add(self.bind(["push", "widen"], &[], &more), Over::Cells)?;
                ("easing", &a.easing)
            }
            None => ("easing", &a.ease),
        };
        add(
            self.bind(["gather", "grip"], &[], &[("pushes", &a.pushes), eased]),
            Over::Grains,
        )?;
        Ok(Renewal {
            number: loads("number")?,
            relabel: loads("relabel")?,
            stages,
        })
    }

    pub fn of_lattice(&self, lattice: &[Named]) -> Result<OfLattice, Error> {
        let of = |file, entry| self.bind([file, entry], &[], lattice);
        Ok(OfLattice {
            drain: of("drain", "drain")?,
            lay_bed: of("bed", "lay_bed")?,
        })
    }
}

//! Grains and water that go along together.

use crate::water::Pending;
use crate::{Ledger, Model, Report, Snapshot, State, Water};

/// Why a coupled run was not made, or stopped.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Error {
    /// The description cannot be right, or what it asks for cannot be had.
    #[error("{0}")]
    Invalid(String),
    /// The grains.
    #[error(transparent)]
    Grains(#[from] dem::Error),
    /// The water.
    #[error("water: {0}")]
    Water(lbm::Error),
    /// The device of a coupled bed on the GPU fails.
    #[error(transparent)]
    Device(#[from] shaders::Error),
}

/// Its text is in this one's: a source would be told twice.
impl From<lbm::Error> for Error {
    fn from(error: lbm::Error) -> Self {
        Self::Water(error)
    }
}

/// A bed with its water; the kernel reaches `N` cells, 3 in cells of two grain diameters, 5 in
/// those of one.
pub struct Coupled<const N: usize> {
    grains: dem::Solver,
    water: Water<N>,
}

impl<const N: usize> Coupled<N> {
    /// Fill the pores of the bed `state` with water, with the state `water_state` or at rest, on
    /// `threads` threads (0: one for each core). The same states give the same bits whatever
    /// `threads` is.
    ///
    /// # Errors
    /// [`Error`] for descriptions or states that cannot be right, or stable, or accurate.
    pub fn new(
        grains: dem::Model,
        state: dem::State,
        water: Model,
        water_state: Option<&State>,
        threads: usize,
    ) -> Result<Self, Error> {
        let grains = dem::Solver::new(grains, state, threads)?;
        let water = Water::new(water, &grains, water_state)?;
        Ok(Self { grains, water })
    }

    /// Advance by `steps` grain steps, and the water with them.
    ///
    /// # Errors
    /// [`Error`] when the numbers run away, or the bed has become one that cannot be coupled.
    pub fn advance(&mut self, steps: u64) -> Result<(), Error> {
        Ok(self.grains.advance_together(steps, &mut self.water)?)
    }

    /// The grains.
    pub fn grains(&self) -> &dem::Solver {
        &self.grains
    }

    /// The water.
    pub fn water(&self) -> &Water<N> {
        &self.water
    }

    /// The water now, also between two exchanges.
    pub fn snapshot(&self) -> Snapshot {
        self.water
            .snapshot_after(&Pending::of(&self.water, &self.grains))
    }

    /// What must be known of the water to go on from now.
    pub fn state(&self) -> State {
        self.water
            .state_after(&Pending::of(&self.water, &self.grains))
    }

    /// What the numbers of the coupling are, and what was seen of it.
    pub fn report(&self) -> Report {
        Report::of(&self.water)
    }

    /// Where the water's energy and volume are.
    pub fn ledger(&self) -> Ledger {
        Ledger::of(&self.water, &self.grains)
    }
}

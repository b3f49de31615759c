//! Sliding along surfaces on which flows meet, as Filippov defines it.
//!
//! Two locations with forced transitions into each other, whose guards hold on the two sides of one
//! surface σ(x) = 0, are the two sides of a discontinuous vector field. Where both flows lead to the
//! surface, neither can be followed: jumps go back and forth, and a run of such an automaton ends with
//! the reason [`Sliding`](crate::executor::Reason::Sliding). A solution in the sense of Filippov (1988,
//! doi:10.1007/978-94-015-7793-9) goes on along the surface, by the mixture of the two flows that stays
//! on it.
//!
//! [`Automaton::with_sliding`] makes this motion a location of its own, between each such two. With
//! a = d σ/dt in the flow before the surface and b that in the flow behind it:
//!
//! | | |
//! | --- | --- |
//! | flow | f = f₁ + a (f₂ − f₁) ÷ (a − b), so that d σ/dt = 0 |
//! | entered | where a crossing would be taken, if a > 0 and b < 0 |
//! | left for the first location | as soon as a ≤ 0 |
//! | left for the second location | as soon as b ≥ 0 |
//! | crossed without sliding | where a > 0 and b ≥ 0, as before |
//!
//! All of this is formulas. So what is guaranteed of events holds for the beginning and the end of
//! sliding, and checks, drawings, trajectories and temporal logic know it as any location.
//!
//! ẋ = −sgn x comes to rest at 0:
//!
//! ```
//! use pleach_automaton::{Automaton, Filippov, coordinates, from};
//! use pleach_discrete::vocabulary;
//!
//! vocabulary! {
//!     enum Side: Location { Right = "right", Left = "left" }
//!     enum Way: Event { Down = "down", Up = "up" }
//! }
//! coordinates! { struct Point { x } }
//! use {Side::{Left, Right}, Way::{Down, Up}};
//!
//! let Point { x } = Point::coordinates();
//! let sign = Automaton::starting_in(Right)
//!     .initially(Point { x: 1.0 })
//!     .flow(Right, x.rate(-1.0))
//!     .flow(Left, x.rate(1.0))
//!     .transition(from(Right).on(Down).to(Left).must(x.at_most(0.0)))
//!     .transition(from(Left).on(Up).to(Right).must(x.at_least(0.0)))
//!     .build()?;
//!
//! let trajectory = sign.with_sliding()?.run(3.0)?;
//! assert_eq!(trajectory.jumps().len(), 1);
//! assert_eq!(trajectory.location(0, 2.0), Some("right | left"));
//! assert_eq!(trajectory.value("x", 3.0), Ok(0.0));
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod surface;

use pleach_discrete::{Event, Location, Row, Urgency};
use pleach_guards::{Guard, Predicate, always, never};

use crate::automaton::Automaton;
use crate::builder::{BuildError, Builder};
use crate::coordinates::Coordinates;
use crate::edge::Edge;
use crate::named::kept;
use surface::Surface;

/// A location of an automaton [with sliding](Automaton::with_sliding).
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Filippov<L> {
    /// A location of the automaton without sliding.
    Beside(L),
    /// On the surface between two of them; its name is those of both with a stroke between them.
    Sliding(L, L),
}

use Filippov::{Beside, Sliding};

impl<L: Location> Location for Filippov<L> {
    const ALL: &'static [Self] = &[];
    const IS_OPEN: bool = true;

    fn name(self) -> &'static str {
        match self {
            Beside(location) => location.name(),
            Sliding(one, other) => kept(&format!("{} | {}", one.name(), other.name())),
        }
    }
}

impl<L: Location, E: Event, S: Coordinates> Automaton<L, E, S> {
    /// The same automaton with a location for the motion along each surface between two of its
    /// locations; see the [module](crate::sliding).
    ///
    /// A surface lies between two locations whose flows are formulas, with forced transitions into
    /// each other that reset nothing, and of whose guards one asks for σ ≥ 0 and the other for σ ≤ 0
    /// (or the strict comparisons), each perhaps together with other conditions; where one of those
    /// fails, sliding ends, too. An automaton without surfaces stays as it is.
    ///
    /// States beyond a surface by at most a billionth, of the comparison's right side or of 1 if that
    /// is larger, are on it: landings are beyond it by a rounding error. A state that begins to slide
    /// is put on it, and one that leaves is put beside it by a trillionth of the same. While it
    /// slides, a surface that is a formula of degree one is not left but for rounding; on a curved one
    /// errors of the integration add up, as in any integrated flow. Sliding on two surfaces at once is not
    /// defined by Filippov's convention and ends the run as before.
    ///
    /// # Errors
    ///
    /// [`BuildError`] as for any automaton. A [composition](crate::Composition) refuses components
    /// that read a coordinate of a surface from another component, whose rate is not known here.
    pub fn with_sliding(&self) -> Result<Automaton<Filippov<L>, E, S>, BuildError> {
        let surfaces = self.surfaces();
        let mut builder = Builder::after(self, Beside(self.initial));
        for (&location, mode) in self.locations.iter().zip(&self.modes) {
            if let Some(flow) = &mode.flow {
                builder = builder.flow(Beside(location), flow.clone());
            }
            if let Some(invariant) = &mode.invariant {
                builder = builder.invariant(Beside(location), invariant.clone());
            }
        }
        for (number, row) in self.rows.iter().enumerate() {
            let crossed = surfaces.iter().find_map(|surface| surface.crossed_by(number));
            let edge = self.edge(number, Beside(row.source), Beside(row.target));
            match crossed {
                None => builder = builder.transition(edge),
                Some((surface, side)) => {
                    let [enters, crosses] = surface.entry(side);
                    let [one, other] = surface.sides;
                    let sliding = self.edge(number, Beside(row.source), Sliding(one, other));
                    builder = builder
                        .transition(narrowed(edge, crosses))
                        .transition(narrowed(sliding, enters).then(surface.onto()));
                }
            }
        }
        for surface in &surfaces {
            builder = self.slide(builder, surface);
        }
        let mut automaton = builder.build()?;
        automaton.own = surfaces.iter().flat_map(Surface::variables).collect();
        Ok(automaton)
    }

    /// Adds the location of a surface, with all that leaves it.
    fn slide(
        &self,
        mut builder: Builder<Filippov<L>, E, S>,
        surface: &Surface<L, S>,
    ) -> Builder<Filippov<L>, E, S> {
        let [one, other] = surface.sides;
        let here = Sliding(one, other);
        builder = builder.flow(here, surface.flow());
        let invariants =
            surface.sides.iter().filter_map(|side| self.mode(*side)?.invariant.as_ref());
        let invariant = Predicate::all(invariants.map(|one| surface.closure(one)));
        if invariant != always() {
            builder = builder.invariant(here, invariant);
        }
        for side in 0..2 {
            // Who leaves for a side takes the event that leads there.
            let row = &self.rows[surface.crossings[1 - side]];
            let (event, target, priority) = (row.event, Beside(surface.sides[side]), 0);
            let row = Row { source: here, event, target, urgency: Urgency::Must, priority };
            let (guard, reset) = (surface.exit(side).into(), surface.off(side));
            builder = builder.transition(Edge::of_row(row, guard, reset));
        }
        for (number, row) in self.rows.iter().enumerate() {
            if !surface.sides.contains(&row.source) || surface.crossings.contains(&number) {
                continue;
            }
            let edge = self.edge(number, here, Beside(row.target));
            let guard = surface.truth(edge.guard.predicate());
            if guard != never() {
                builder = builder.transition(Edge { guard: guard.into(), ..edge });
            }
        }
        builder
    }

    /// The transition of a row between other locations.
    fn edge<M: Copy>(&self, number: usize, source: M, target: M) -> Edge<M, E, S> {
        let Row { event, urgency, priority, .. } = self.rows[number];
        let transition = &self.graph[petgraph::graph::EdgeIndex::new(number)];
        let row = Row { source, event, target, urgency, priority };
        Edge::of_row(row, transition.guard.clone(), transition.reset.clone())
    }
}

/// The transition where a condition holds, too.
fn narrowed<L, E, S>(edge: Edge<L, E, S>, condition: Predicate) -> Edge<L, E, S> {
    let guard = Guard::from(edge.guard.predicate().clone() & condition);
    Edge { guard, ..edge }
}

//! The flow of one visit, stretch by stretch, whatever its dynamics.

use std::sync::Arc;

use pleach_guards::Interval;
use rayon::prelude::*;

use super::affine::{Steps, Track};
use super::model::Dynamics;
use super::polytope::Template;
use super::set::StateSet;
use super::settings::Settings;
use super::taylor::Integration;

/// How many steps of an affine flow are computed at a time: some are in vain where it ends.
const BLOCK: usize = 32;

/// When a clock ends a flow, for all states of the set.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Exit {
    /// In seconds after it began.
    pub until: Interval,
}

impl Exit {
    /// Whether that is the same instant for all of them, up to rounding.
    pub(super) fn is_an_instant(self) -> bool {
        const ROUNDING: f64 = 1e-9;
        self.until.width() <= ROUNDING * (1.0 + self.until.upper())
    }
}

/// Bounds on a flow over a stretch of time.
pub(super) struct Stretch {
    /// In seconds after the flow began.
    pub from: f64,
    /// Likewise.
    pub to: f64,
    /// In each direction of the template, at every instant.
    pub during: Vec<f64>,
    /// At its end.
    pub after: Vec<f64>,
}

/// A flow that is followed.
pub(super) enum FlowPipe<'a> {
    Affine { steps: Steps<'a>, tracks: Vec<Track>, taken: usize, count: usize, length: f64 },
    Formulas { integration: Integration, template: Arc<Template>, until: f64 },
}

impl<'a> FlowPipe<'a> {
    /// The flow from `start`, for at most `remaining` seconds and not beyond `exit`.
    pub(super) fn new(
        dynamics: &'a Dynamics,
        variables: &[String],
        start: &'a StateSet,
        template: &Arc<Template>,
        settings: &Settings,
        remaining: f64,
        exit: Option<Exit>,
    ) -> Self {
        let until = exit.map_or(remaining, |exit| exit.until.upper().min(remaining)).max(0.0);
        match dynamics {
            Dynamics::Affine(flow) => {
                let count = (until / settings.step).ceil();
                let length = if count.is_finite() && count > 0.0 {
                    // Whole steps up to the end, and not less for rounding.
                    (Interval::point(until) / Interval::point(count)).upper()
                } else {
                    settings.step
                };
                let count = if count.is_finite() { count as usize } else { usize::MAX };
                let steps = Steps::new(flow, start, length);
                let tracks =
                    template.directions().par_iter().map(|direction| steps.track(direction));
                let tracks = tracks.collect();
                FlowPipe::Affine { steps, tracks, taken: 0, count, length }
            }
            Dynamics::Formulas(rates) => FlowPipe::Formulas {
                integration: Integration::new(rates, variables, start, settings),
                template: template.clone(),
                until,
            },
        }
    }

    /// The next stretches; none at the end, and `None` where the flow cannot be enclosed.
    pub(super) fn advance(&mut self) -> Option<Vec<Stretch>> {
        match self {
            FlowPipe::Affine { steps, tracks, taken, count, length } => {
                let block = BLOCK.min(*count - *taken);
                steps.reserve(*taken + block);
                let bounds: Vec<Vec<_>> = tracks
                    .par_iter_mut()
                    .map(|track| (0..block).map(|_| steps.advance(track)).collect())
                    .collect();
                let at = |step: usize| Interval::point(*length) * Interval::point(step as f64);
                let stretch = |step: usize| Stretch {
                    from: at(*taken + step).lower(),
                    to: at(*taken + step + 1).upper(),
                    during: bounds.iter().map(|of_one| of_one[step].during).collect(),
                    after: bounds.iter().map(|of_one| of_one[step].after).collect(),
                };
                let stretches: Vec<Stretch> = (0..block).map(stretch).collect();
                *taken += block;
                let is_finite =
                    |stretch: &Stretch| stretch.during.iter().all(|bound| bound.is_finite());
                stretches.iter().all(is_finite).then_some(stretches)
            }
            FlowPipe::Formulas { integration, template, until } => {
                if integration.time() >= *until {
                    return Some(Vec::new());
                }
                let stretch = integration.step(template, *until)?;
                Some(vec![stretch])
            }
        }
    }

    /// Whether all of `duration` has passed.
    pub(super) fn is_at(&self, duration: f64) -> bool {
        match self {
            FlowPipe::Affine { taken, length, .. } => *length * *taken as f64 >= duration,
            FlowPipe::Formulas { integration, .. } => integration.time() >= duration,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::reach::affine::AffineFlow;
    use crate::reach::exact::{fraction, points};
    use crate::reach::vector::IntervalMatrix;
    use crate::reach::zonotope::Zonotope;

    /// Whatever the duration, the steps cover it, and each says when it may be at least.
    #[test]
    fn steps_cover_the_duration() {
        let still =
            AffineFlow::new(IntervalMatrix::zero(1, 1), Zonotope::from_box(&points(&[0.0])));
        let (still, start) = (Dynamics::Affine(still), StateSet::from_box(points(&[1.0])));
        let template = Arc::new(Template::boxes(1));
        for number in 1..200 {
            let until = f64::from(number) / 7.0;
            let settings = Settings { step: 0.3, ..Settings::default() };
            let names = ["x".to_owned()];
            let mut pipe = FlowPipe::new(&still, &names, &start, &template, &settings, until, None);
            let FlowPipe::Affine { length, count, .. } = pipe else { panic!("it is affine") };
            assert!(fraction(length) * fraction(count as f64) >= fraction(until), "{until}");
            let stretches = pipe.advance().expect("it is enclosed");
            for (step, stretch) in stretches.iter().enumerate() {
                assert!(fraction(stretch.from) <= fraction(length) * fraction(step as f64));
                assert!(fraction(stretch.to) >= fraction(length) * fraction(step as f64 + 1.0));
            }
        }
    }
}

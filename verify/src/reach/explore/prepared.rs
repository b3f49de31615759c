//! What is known of a location before sets flow through it.

use std::sync::Arc;

use crate::reach::model::{Mode, Model};
use crate::reach::polytope::Template;
use crate::reach::region::{Conjunction, HalfSpace, Region};
use crate::reach::settings::{Directions, Settings};

/// What a location needs for sets.
pub(super) struct Prepared {
    pub template: Arc<Template>,
    /// What flows stay in, by the invariant: of several alternatives, nothing.
    pub staying: Vec<HalfSpace>,
    /// What they stay in until a jump has to be taken: the number of the jump, and the half-space.
    pub waiting: Vec<(usize, HalfSpace)>,
    /// Whether no time passes, because a jump whose guard always holds has to be taken.
    pub is_urgent: bool,
}

impl Prepared {
    pub(super) fn new(
        model: &Model,
        number: usize,
        settings: &Settings,
        extra: &[Vec<f64>],
    ) -> Self {
        let place = &model.locations()[number];
        let dimension = model.variables().len();
        let mut template = match &settings.directions {
            Directions::Boxes => Template::boxes(dimension),
            Directions::Octagons => Template::octagons(dimension),
            Directions::Listed(listed) => {
                let mut template = Template::boxes(dimension);
                listed.iter().for_each(|direction| template.add_both(direction));
                template
            }
        };
        let add = |template: &mut Template, region: &Region| {
            for conjunction in &region.alternatives {
                conjunction.half_spaces.iter().for_each(|half_space| half_space.add_to(template));
            }
        };
        add(&mut template, &place.invariant);
        for jump in &place.jumps {
            add(&mut template, &jump.guard);
            add(&mut template, &model.locations()[jump.target].invariant);
        }
        extra.iter().for_each(|direction| template.add_both(direction));
        let staying = match &place.invariant.alternatives[..] {
            [only] => only.half_spaces.clone(),
            _ => Vec::new(),
        };
        let waiting = Prepared::waiting(place);
        let is_urgent = Prepared::is_urgent(place);
        Prepared { template: Arc::new(template), staying, waiting, is_urgent }
    }

    /// Whether a jump has to be taken in every state.
    fn is_urgent(place: &Mode) -> bool {
        let is_always = |conjunction: &Conjunction| *conjunction == Conjunction::default();
        place
            .jumps
            .iter()
            .any(|jump| jump.is_forced && jump.guard.alternatives.iter().any(is_always))
    }

    /// A jump that has to be taken where one affine comparison holds keeps flows out of there.
    fn waiting(place: &Mode) -> Vec<(usize, HalfSpace)> {
        let forced = place.jumps.iter().enumerate().filter(|(_, jump)| jump.is_forced);
        let alone = forced.filter_map(|(number, jump)| match &jump.guard.alternatives[..] {
            [Conjunction { half_spaces, others }] if others.is_empty() => match &half_spaces[..] {
                [only] => Some((number, only.opposite())),
                _ => None,
            },
            _ => None,
        });
        alone.collect()
    }
}

//! Components as checks read them.

use pleach_guards::Interval;

use super::Composition;
use crate::check::model::Model;

impl Composition {
    /// The model of every component with its name, its labels and its inputs. An input has the
    /// range of what it reads, too.
    pub(crate) fn models(&self) -> Vec<Model> {
        (0..self.components.len()).map(|component| self.model(component)).collect()
    }

    fn model(&self, number: usize) -> Model {
        let component = &self.components[number];
        let mut model = Model::clone(&component.model);
        model.component = Some(component.name.clone());
        model.events.clone_from(&component.events);
        model.continuation = component.continuation;
        model.is_label = component.labels.iter().map(Option::is_some).collect();
        let coordinates = component.blueprint.coordinates.iter().zip(&component.slots);
        for ((name, &slot), is_owned) in coordinates.clone().zip(&component.owned) {
            if !is_owned {
                model.inputs.push((*name).to_owned());
                let own = model.region.get(*name).copied().unwrap_or(Interval::WHOLE);
                let range = own.intersection(self.range_of(slot)).unwrap_or(own);
                model.region.insert((*name).to_owned(), range);
            }
        }
        let values = coordinates.map(|(name, &slot)| ((*name).to_owned(), self.initial[slot]));
        model.initial_state = Some(values.collect());
        model
    }

    /// The range that the owner of a variable declares for it.
    fn range_of(&self, slot: usize) -> Interval {
        let mut ranges = self.components.iter().filter_map(|component| {
            let mut coordinates = component.slots.iter().zip(&component.owned);
            let place = coordinates.position(|(one, is_owned)| *one == slot && *is_owned)?;
            component.model.region.get(component.blueprint.coordinates[place]).copied()
        });
        ranges.next().unwrap_or(Interval::WHOLE)
    }
}

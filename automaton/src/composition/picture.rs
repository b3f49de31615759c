//! What pictures of a composition show: its components in words, and what joins them.

use super::{Component, Composition};
use crate::diagram::sketch::{Sketch, equation};

/// A coordinate of one component that another reads.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Connection {
    /// The component whose coordinate it is.
    pub output: usize,
    /// What it is called there.
    pub coordinate: &'static str,
    /// The component that reads it.
    pub input: usize,
    /// What it is called there.
    pub read_as: &'static str,
}

impl Connection {
    /// What is read and, where it differs, as what.
    pub(crate) fn label(&self) -> String {
        match (self.coordinate, self.read_as) {
            (coordinate, read_as) if coordinate == read_as => coordinate.to_owned(),
            (coordinate, read_as) => format!("{coordinate} → {read_as}"),
        }
    }
}

impl Composition {
    /// Each component's name and sketch.
    pub(crate) fn sketches(&self) -> Vec<(&str, Sketch)> {
        let sketch = |component: &Component| {
            let mut sketch = component.blueprint.sketch.clone();
            for link in &mut sketch.links {
                link.event.clone_from(&component.events[link.event_number]);
            }
            sketch.start = component
                .owned_coordinates()
                .map(|(coordinate, slot)| equation(coordinate, self.initial[slot]))
                .collect();
            sketch
        };
        self.components.iter().map(|component| (&*component.name, sketch(component))).collect()
    }

    /// What each component reads of others, in the order of the readers.
    pub(crate) fn connections(&self) -> Vec<Connection> {
        let owner = |slot: usize| {
            self.components.iter().enumerate().find_map(|(number, component)| {
                let mut owned = component.owned_coordinates();
                let (coordinate, _) = owned.find(|(_, own_slot)| *own_slot == slot)?;
                Some((number, coordinate))
            })
        };
        let mut connections = Vec::new();
        for (input, component) in self.components.iter().enumerate() {
            let names = component.blueprint.coordinates.iter();
            for (number, read_as) in names.enumerate().filter(|(at, _)| !component.owned[*at]) {
                if let Some((output, coordinate)) = owner(component.slots[number]) {
                    connections.push(Connection { output, coordinate, input, read_as });
                }
            }
        }
        connections
    }
}

impl Component {
    /// The coordinates that belong to the component, each with its slot.
    fn owned_coordinates(&self) -> impl Iterator<Item = (&'static str, usize)> {
        let all = self.blueprint.coordinates.iter().zip(&self.slots).zip(&self.owned);
        all.filter(|(_, owned)| **owned).map(|((name, slot), _)| (*name, *slot))
    }
}

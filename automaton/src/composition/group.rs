//! Groups: components that have something to do with one another.
//!
//! Components that share a label or a connection belong together, and so do those of which each
//! belongs to a third. Nothing that happens in one group concerns another: each is followed by
//! itself, from one of its own events to the next.

use super::Composition;

/// Components that flow and jump together.
#[derive(Clone, Debug)]
pub(super) struct Group {
    /// Ascending.
    pub(super) components: Vec<usize>,
    /// The variables that belong to the components, ascending.
    pub(super) slots: Vec<usize>,
    /// The labels that they share.
    pub(super) labels: Vec<usize>,
}

impl Composition {
    /// Finds the groups; components, variables and labels are complete.
    pub(super) fn form_groups(&mut self) {
        let leaders = self.leaders();
        // By component that leads a group: its number.
        let mut numbers = vec![usize::MAX; self.components.len()];
        for (index, component) in self.components.iter_mut().enumerate() {
            let number = &mut numbers[leaders[index]];
            if *number == usize::MAX {
                *number = self.groups.len();
                let (components, slots, labels) = (Vec::new(), Vec::new(), Vec::new());
                self.groups.push(Group { components, slots, labels });
            }
            component.group = *number;
            let group = &mut self.groups[*number];
            group.components.push(index);
            let own = component.slots.iter().zip(&component.owned).filter(|(_, owned)| **owned);
            group.slots.extend(own.map(|(slot, _)| slot));
        }
        for group in &mut self.groups {
            group.slots.sort_unstable();
        }
        for component in &mut self.components {
            let slots = &self.groups[component.group].slots;
            let place = |slot: &usize| slots.partition_point(|one| one < slot);
            component.places = component.slots.iter().map(place).collect();
            let follow = component.places.windows(2).all(|pair| pair[1] == pair[0] + 1);
            component.window = component.places.first().copied().filter(|_| follow);
        }
        for (number, label) in self.labels.iter().enumerate() {
            if let Some(&(first, _)) = label.participants.first() {
                self.groups[self.components[first].group].labels.push(number);
            }
        }
    }

    /// By component: one of its group, the same for all of them.
    fn leaders(&self) -> Vec<usize> {
        let mut forest = Forest((0..self.components.len()).collect());
        let mut owners = vec![0; self.variables.len()];
        for (index, component) in self.components.iter().enumerate() {
            for (&slot, _) in component.slots.iter().zip(&component.owned).filter(|(_, own)| **own)
            {
                owners[slot] = index;
            }
        }
        for (index, component) in self.components.iter().enumerate() {
            component.slots.iter().for_each(|&slot| forest.join(index, owners[slot]));
        }
        for label in &self.labels {
            for pair in label.participants.windows(2) {
                forest.join(pair[0].0, pair[1].0);
            }
        }
        (0..self.components.len()).map(|component| forest.root(component)).collect()
    }
}

/// Disjoint sets, each a tree of indices that point to their parents (B. A. Galler and
/// M. J. Fischer 1964, doi:10.1145/364099.364331).
struct Forest(Vec<usize>);

impl Forest {
    fn root(&mut self, mut one: usize) -> usize {
        while self.0[one] != one {
            self.0[one] = self.0[self.0[one]];
            one = self.0[one];
        }
        one
    }

    fn join(&mut self, one: usize, other: usize) {
        let (one, other) = (self.root(one), self.root(other));
        self.0[one.max(other)] = one.min(other);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Automaton, Name, Record};

    /// Where components find their coordinates among those of their group, and whether they stand together.
    #[test]
    fn components_know_their_places_and_whether_these_follow_each_other() {
        let state = Record::new([("a", 1.0), ("b", 2.0), ("c", 3.0)]).expect("the names differ");
        let triple = Automaton::<Name, Name, Record>::starting_in(Name::new("resting"))
            .initially(state)
            .build()
            .expect("it is sound");
        let names = ["alone", "first", "second", "third", "fourth"];
        let composition = names
            .into_iter()
            .fold(Composition::builder(), |all, name| all.add(name, &triple))
            .connect("third.b", "first.a")
            .connect("first.b", "second.a")
            .connect("first.b", "second.b")
            .connect("second.c", "third.c")
            .build()
            .expect("the parts fit");
        let groups: Vec<&[usize]> =
            composition.groups.iter().map(|group| &*group.components).collect();
        assert_eq!(groups, [&[0][..], &[1, 2, 3], &[4]]);
        let places: Vec<&[usize]> = composition.components.iter().map(|one| &*one.places).collect();
        // Of the group of three: b and c of the first, c of the second, a and b of the third.
        assert_eq!(places, [&[0, 1, 2], &[4, 0, 1], &[0, 0, 2], &[3, 4, 2], &[0, 1, 2]]);
        let windows: Vec<_> = composition.components.iter().map(|one| one.window).collect();
        assert_eq!(windows, [Some(0), None, None, None, Some(0)]);
        let back = Composition::builder().add("before", &triple).add("after", &triple);
        let back = back.connect("before.c", "after.a").build().expect("the parts fit");
        let windows: Vec<_> = back.components.iter().map(|one| one.window).collect();
        assert_eq!(windows, [Some(0), Some(2)]);
    }
}

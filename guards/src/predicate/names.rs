//! The names that occur in a predicate.

use std::collections::BTreeSet;

use super::Predicate;

impl Predicate {
    /// The names of the variables that occur, in alphabetical order; those that a function reads
    /// are not known.
    pub fn variables(&self) -> BTreeSet<&str> {
        let mut names = BTreeSet::new();
        self.each_atom(&mut |atom| {
            if let Predicate::Comparison(comparison) = atom {
                comparison.left.collect_variables(&mut names);
                comparison.right.collect_variables(&mut names);
            }
        });
        names
    }

    /// The names of the propositions that occur, in alphabetical order.
    pub fn propositions(&self) -> BTreeSet<&str> {
        let mut names = BTreeSet::new();
        self.each_atom(&mut |atom| {
            if let Predicate::Proposition(name) = atom {
                names.insert(&**name);
            }
        });
        names
    }

    /// The names of the functions that occur, in alphabetical order: what no analysis can check.
    pub fn functions(&self) -> BTreeSet<&str> {
        let mut names = BTreeSet::new();
        self.each_atom(&mut |atom| {
            if let Predicate::Function(function) = atom {
                names.insert(function.name());
            }
        });
        names
    }

    /// Whether no function occurs, so that the whole predicate is data.
    pub fn is_data(&self) -> bool {
        self.functions().is_empty()
    }

    /// Shows `visit` the comparisons, propositions and functions that the predicate is made of.
    fn each_atom<'a>(&'a self, visit: &mut dyn FnMut(&'a Predicate)) {
        match self {
            Predicate::Not(inner) => inner.each_atom(visit),
            Predicate::All(parts) | Predicate::Any(parts) => {
                parts.iter().for_each(|part| part.each_atom(visit));
            }
            Predicate::Comparison(_) | Predicate::Proposition(_) | Predicate::Function(_) => {
                visit(self);
            }
        }
    }
}

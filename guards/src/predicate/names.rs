//! The names that occur in a predicate.

use std::collections::BTreeSet;

use super::Predicate;

impl Predicate {
    /// The names of the variables that occur, in alphabetical order; those that a function reads
    /// are not known.
    pub fn variables(&self) -> BTreeSet<&str> {
        let mut names = BTreeSet::new();
        self.collect_variables(&mut names);
        names
    }

    fn collect_variables<'a>(&'a self, names: &mut BTreeSet<&'a str>) {
        match self {
            Predicate::Comparison(comparison) => {
                comparison.left.collect_variables(names);
                comparison.right.collect_variables(names);
            }
            Predicate::Not(inner) => inner.collect_variables(names),
            Predicate::All(parts) | Predicate::Any(parts) => {
                parts.iter().for_each(|part| part.collect_variables(names));
            }
            Predicate::Proposition(_) | Predicate::Function(_) => {}
        }
    }

    /// The names of the propositions that occur, in alphabetical order.
    pub fn propositions(&self) -> BTreeSet<&str> {
        let mut names = BTreeSet::new();
        self.collect_propositions(&mut names);
        names
    }

    fn collect_propositions<'a>(&'a self, names: &mut BTreeSet<&'a str>) {
        match self {
            Predicate::Proposition(name) => {
                names.insert(name);
            }
            Predicate::Not(inner) => inner.collect_propositions(names),
            Predicate::All(parts) | Predicate::Any(parts) => {
                parts.iter().for_each(|part| part.collect_propositions(names));
            }
            Predicate::Comparison(_) | Predicate::Function(_) => {}
        }
    }

    /// The names of the functions that occur, in alphabetical order: what no analysis can check.
    pub fn functions(&self) -> BTreeSet<&str> {
        let mut names = BTreeSet::new();
        self.collect_functions(&mut names);
        names
    }

    /// Whether no function occurs, so that the whole predicate is data.
    pub fn is_data(&self) -> bool {
        self.functions().is_empty()
    }

    fn collect_functions<'a>(&'a self, names: &mut BTreeSet<&'a str>) {
        match self {
            Predicate::Comparison(_) | Predicate::Proposition(_) => {}
            Predicate::Not(inner) => inner.collect_functions(names),
            Predicate::All(parts) | Predicate::Any(parts) => {
                parts.iter().for_each(|part| part.collect_functions(names));
            }
            Predicate::Function(function) => {
                names.insert(function.name());
            }
        }
    }
}

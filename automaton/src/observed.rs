//! States that are not their coordinates: what guards may speak of, by name and by number.
//!
//! Guards name what they speak of. Where the names are known when the automaton is built, each is
//! looked up once, and a guard is evaluated by numbers from then on.

use std::sync::Arc;

use pleach_guards::{Comparison, EvaluationError, Expression, Predicate, Relation, Valuation};

/// A state with quantities and propositions that have names and numbers.
pub trait Observed: Valuation {
    /// The names of the quantities, each different.
    const VARIABLES: &'static [&'static str];
    /// The names of the propositions, each different.
    const PROPOSITIONS: &'static [&'static str];

    /// The quantity whose name is `VARIABLES[number]`; NaN beyond the end.
    fn quantity(&self, number: usize) -> f64;

    /// Whether the proposition whose name is `PROPOSITIONS[number]` is true; false beyond the end.
    fn proposition(&self, number: usize) -> bool;
}

/// Implements [`Observed`] and [`Valuation`] for a state: each quantity and each proposition with
/// its name, its documentation, and the expression that measures it. The glossary, which may be left out, is a
/// constant with the name and the documentation of each.
///
/// ```
/// use pleach_automaton::{Observed, observed};
/// use pleach_guards::Valuation;
///
/// struct Lamp { hours: f64, is_lit: bool }
/// observed! {
///     impl Observed for Lamp as lamp;
///     /// What guards may speak of.
///     pub const GLOSSARY;
///     quantities {
///         /// Hours since the lamp was made.
///         age: lamp.hours,
///     }
///     propositions {
///         /// The lamp is lit.
///         lit: lamp.is_lit,
///     }
/// }
/// let lamp = Lamp { hours: 12.0, is_lit: true };
/// assert_eq!((lamp.quantity(0), lamp.truth("lit")), (12.0, Some(true)));
/// assert_eq!(GLOSSARY[0], ("age", " Hours since the lamp was made."));
/// ```
#[macro_export]
macro_rules! observed {
    (
        impl Observed for $state:ident as $this:ident;
        $(#[$note:meta])* $visibility:vis const $glossary:ident;
        quantities { $($(#[doc = $measure:literal])+ $quantity:ident: $number:expr,)* }
        propositions { $($(#[doc = $text:literal])+ $name:ident: $holds:expr,)* }
    ) => {
        $(#[$note])*
        $visibility const $glossary: &[(&str, &str)] = &[
            $((stringify!($quantity), concat!($($measure),+)),)*
            $((stringify!($name), concat!($($text),+)),)*
        ];

        $crate::observed! {
            impl Observed for $state as $this;
            quantities { $($(#[doc = $measure])+ $quantity: $number,)* }
            propositions { $($(#[doc = $text])+ $name: $holds,)* }
        }
    };
    (
        impl Observed for $state:ident as $this:ident;
        quantities { $($(#[doc = $measure:literal])+ $quantity:ident: $number:expr,)* }
        propositions { $($(#[doc = $text:literal])+ $name:ident: $holds:expr,)* }
    ) => {
        const _: () = {
            #[allow(non_camel_case_types, dead_code)]
            enum Quantity { $($quantity,)* }

            #[allow(non_camel_case_types, dead_code)]
            enum Proposition { $($name,)* }

            impl $crate::Observed for $state {
                const VARIABLES: &'static [&'static str] = &[$(stringify!($quantity)),*];
                const PROPOSITIONS: &'static [&'static str] = &[$(stringify!($name)),*];

                fn quantity(&self, number: usize) -> f64 {
                    let $this = self;
                    $(if number == Quantity::$quantity as usize {
                        return $number;
                    })*
                    f64::NAN
                }

                fn proposition(&self, number: usize) -> bool {
                    let $this = self;
                    let _ = ($this, number); // where there are none
                    $(if number == Proposition::$name as usize {
                        return $holds;
                    })*
                    false
                }
            }

            impl $crate::guards::Valuation for $state {
                fn value(&self, variable: &str) -> Option<f64> {
                    let names = <Self as $crate::Observed>::VARIABLES;
                    let number = names.iter().position(|name| *name == variable)?;
                    Some($crate::Observed::quantity(self, number))
                }

                fn truth(&self, proposition: &str) -> Option<bool> {
                    let names = <Self as $crate::Observed>::PROPOSITIONS;
                    let number = names.iter().position(|name| *name == proposition)?;
                    Some($crate::Observed::proposition(self, number))
                }
            }
        };
    };
}

/// A guard over quantities and propositions by their numbers.
pub(crate) struct Watch<S> {
    test: Test,
    quantity: fn(&S, usize) -> f64,
    proposition: fn(&S, usize) -> bool,
}

/// Whether `predicate` holds in `state`: by numbers where there is a watch of it and it has a
/// verdict, by names otherwise, so that what is wrong is told by name.
#[inline]
pub(crate) fn holds<S: Valuation>(
    predicate: &Predicate,
    watch: Option<&Watch<S>>,
    state: &S,
) -> Result<bool, EvaluationError> {
    match watch.and_then(|watch| watch.holds(state)) {
        Some(holds) => Ok(holds),
        None => predicate.holds(state),
    }
}

#[derive(Clone, Debug)]
enum Test {
    Proposition(usize),
    Comparison(Operand, Relation, Operand),
    Not(Box<Test>),
    All(Arc<[Test]>),
    Any(Arc<[Test]>),
}

#[derive(Clone, Copy, Debug)]
enum Operand {
    Constant(f64),
    Quantity(usize),
}

impl<S: Observed> Watch<S> {
    /// The guard by numbers; none where an operand is more than a quantity or a constant, or a name
    /// is not known.
    pub(crate) fn of(predicate: &Predicate) -> Option<Self> {
        Some(Watch {
            test: Test::of::<S>(predicate)?,
            quantity: S::quantity,
            proposition: S::proposition,
        })
    }
}

impl<S> Watch<S> {
    /// Whether the guard holds; none where a quantity is not a number, so that it has no verdict.
    #[inline]
    pub(crate) fn holds(&self, state: &S) -> Option<bool> {
        match &self.test {
            Test::All(parts) if parts.is_empty() => Some(true),
            Test::Proposition(number) => Some((self.proposition)(state, *number)),
            Test::Comparison(left, relation, right) => {
                self.compare(*left, *relation, *right, state)
            }
            test => self.judge(test, state),
        }
    }

    #[inline(never)]
    fn judge(&self, test: &Test, state: &S) -> Option<bool> {
        Some(match test {
            Test::Proposition(number) => (self.proposition)(state, *number),
            Test::Comparison(left, relation, right) => {
                self.compare(*left, *relation, *right, state)?
            }
            Test::Not(inner) => !self.judge(inner, state)?,
            Test::All(parts) => {
                for part in parts.iter() {
                    if !self.judge(part, state)? {
                        return Some(false);
                    }
                }
                true
            }
            Test::Any(parts) => {
                for part in parts.iter() {
                    if self.judge(part, state)? {
                        return Some(true);
                    }
                }
                false
            }
        })
    }

    #[inline]
    fn compare(
        &self,
        left: Operand,
        relation: Relation,
        right: Operand,
        state: &S,
    ) -> Option<bool> {
        let (left, right) = (self.value(left, state), self.value(right, state));
        let order = left.partial_cmp(&right)?;
        Some(match relation {
            Relation::AtMost => order.is_le(),
            Relation::LessThan => order.is_lt(),
            Relation::AtLeast => order.is_ge(),
            Relation::MoreThan => order.is_gt(),
        })
    }

    #[inline]
    fn value(&self, operand: Operand, state: &S) -> f64 {
        match operand {
            Operand::Constant(value) => value,
            Operand::Quantity(number) => (self.quantity)(state, number),
        }
    }
}

/// Groups of propositions of which at most one is true at a time.
pub(crate) struct Exclusion<S> {
    groups: Vec<Vec<Excluded>>,
    proposition: fn(&S, usize) -> bool,
}

/// A proposition of such a group, with its number if the state knows it.
#[derive(Clone, Debug)]
struct Excluded {
    name: String,
    number: Option<usize>,
}

impl<S> Exclusion<S> {
    /// Nothing is excluded.
    pub(crate) fn none() -> Self {
        Exclusion { groups: Vec::new(), proposition: |_, _| false }
    }

    /// The names in each group.
    pub(crate) fn names(&self) -> Vec<Vec<&str>> {
        names_in(&self.groups)
    }

    /// Two propositions of one group that are both true.
    pub(crate) fn violation(&self, state: &S) -> Option<[&str; 2]> {
        let is_true = |number| (self.proposition)(state, number);
        self.groups.iter().find_map(|group| {
            let mut true_ones = group.iter().filter(|it| it.number.is_some_and(is_true));
            Some([&*true_ones.next()?.name, &*true_ones.next()?.name])
        })
    }
}

impl<S: Observed> Exclusion<S> {
    /// One more group.
    pub(crate) fn and(mut self, propositions: &[&str]) -> Self {
        let excluded = |name: &&str| Excluded {
            name: (*name).to_owned(),
            number: number(S::PROPOSITIONS, name),
        };
        self.groups.push(propositions.iter().map(excluded).collect());
        Exclusion { proposition: S::proposition, ..self }
    }
}

impl Test {
    fn of<S: Observed>(predicate: &Predicate) -> Option<Test> {
        let each = |parts: &[Predicate]| -> Option<Arc<[Test]>> {
            parts.iter().map(Test::of::<S>).collect()
        };
        Some(match predicate {
            Predicate::Proposition(name) => Test::Proposition(number(S::PROPOSITIONS, name)?),
            Predicate::Comparison(Comparison { left, relation, right }) => {
                Test::Comparison(Operand::of::<S>(left)?, *relation, Operand::of::<S>(right)?)
            }
            Predicate::Not(inner) => Test::Not(Box::new(Test::of::<S>(inner)?)),
            Predicate::All(parts) => Test::All(each(parts)?),
            Predicate::Any(parts) => Test::Any(each(parts)?),
            _ => return None,
        })
    }
}

impl Operand {
    fn of<S: Observed>(expression: &Expression) -> Option<Operand> {
        match expression {
            Expression::Constant(value) => Some(Operand::Constant(*value)),
            Expression::Variable(name) => Some(Operand::Quantity(number(S::VARIABLES, name)?)),
            _ => None,
        }
    }
}

/// Apart from the type of the state, so that it is compiled once.
fn names_in(groups: &[Vec<Excluded>]) -> Vec<Vec<&str>> {
    groups.iter().map(|group| group.iter().map(|it| &*it.name).collect()).collect()
}

fn number(names: &[&str], name: &str) -> Option<usize> {
    names.iter().position(|known| *known == name)
}

// Written by hand, because derives would ask the same of S.

impl<S> Clone for Watch<S> {
    fn clone(&self) -> Self {
        Watch { test: self.test.clone(), ..*self }
    }
}

impl<S> Clone for Exclusion<S> {
    fn clone(&self) -> Self {
        Exclusion { groups: self.groups.clone(), ..*self }
    }
}

impl<S> std::fmt::Debug for Exclusion<S> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "Exclusion({:?})", self.groups)
    }
}

impl<S> std::fmt::Debug for Watch<S> {
    fn fmt(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(formatter, "Watch({:?})", self.test)
    }
}

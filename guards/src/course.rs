//! What becomes of a predicate while its variables move.
//!
//! A [`Tracker`] is a predicate prepared for being followed over time. Given an [`Enclosure`] of
//! each variable during a span, it tells the predicate's [`Course`]: that it holds throughout or
//! nowhere, that it changes at most once and in which direction, or that a shorter span is needed.
//! The first two are proofs; together with halving they isolate the first instant at which a
//! predicate begins to hold.

mod formula;

use crate::enclosure::{Definedness, Enclosure};
use crate::interval::Interval;
use crate::predicate::{Comparison, Predicate, Relation};
use crate::range::Truth;
use crate::ring::Ring;
use crate::valuation::EvaluationError;

use formula::{Context, Formula};

/// What a predicate does during a span of time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Course {
    /// It holds at every instant.
    Always,
    /// It holds at no instant.
    Never,
    /// It changes at most once, from not holding to holding.
    Rising,
    /// It changes at most once, from holding to not holding.
    Falling,
    /// As rising, and for rounding a shorter span tells no more of where.
    FaintlyRising,
    /// As falling, and for rounding a shorter span tells no more of where.
    FaintlyFalling,
    /// It may change several times; a shorter span may tell more.
    Open,
    /// It may change several times, and rounding alone says so: a shorter span tells no more.
    Blurred,
    /// A proposition or a named function decides, of which nothing is known.
    Opaque,
}

impl Course {
    /// The course of a conjunction.
    #[must_use]
    pub fn and(self, other: Course) -> Course {
        use Course::{
            Always, Blurred, FaintlyFalling, FaintlyRising, Falling, Never, Opaque, Rising,
        };
        match (self, other) {
            (Never, _) | (_, Never) => Never,
            (Always, course) | (course, Always) => course,
            (Opaque, _) | (_, Opaque) => Opaque,
            (FaintlyRising, FaintlyRising) => FaintlyRising,
            (FaintlyFalling, FaintlyFalling) => FaintlyFalling,
            (Rising | FaintlyRising, Rising | FaintlyRising) => Rising,
            (Falling | FaintlyFalling, Falling | FaintlyFalling) => Falling,
            // One rises and the other falls, or nothing is known about one of them; a shorter span
            // tells more if it does so of one.
            (
                Blurred | FaintlyRising | FaintlyFalling,
                Blurred | FaintlyRising | FaintlyFalling,
            ) => Blurred,
            _ => Course::Open,
        }
    }

    /// The course of a disjunction.
    #[must_use]
    pub fn or(self, other: Course) -> Course {
        self.opposite().and(other.opposite()).opposite()
    }

    /// The course of the negation.
    #[must_use]
    pub fn opposite(self) -> Course {
        match self {
            Course::Always => Course::Never,
            Course::Never => Course::Always,
            Course::Rising => Course::Falling,
            Course::Falling => Course::Rising,
            Course::FaintlyRising => Course::FaintlyFalling,
            Course::FaintlyFalling => Course::FaintlyRising,
            Course::Open | Course::Blurred | Course::Opaque => self,
        }
    }
}

impl From<bool> for Course {
    fn from(holds: bool) -> Course {
        if holds { Course::Always } else { Course::Never }
    }
}

impl From<Truth> for Course {
    fn from(truth: Truth) -> Course {
        match truth {
            Truth::Always => Course::Always,
            Truth::Never => Course::Never,
            Truth::Undecided => Course::Open,
        }
    }
}

/// A predicate prepared for being followed over time, made by [`Predicate::track`].
///
/// ```
/// use pleach_guards::{Course, Enclosure, Interval, variable};
///
/// // x = t² − 1 during [0.5, 1.5] seconds, where it passes 0.
/// let x = Enclosure {
///     middle: Interval::point(0.0),
///     range: Interval::new(-0.75, 1.25)?,
///     rate: Interval::new(1.0, 3.0)?,
/// };
/// let course = |predicate: pleach_guards::Predicate| {
///     let tracker = predicate.track(&["x"]).expect("x is the only variable");
///     tracker.course(&[x], &[0], 0.5, 0.0, &|_| None)
/// };
/// assert_eq!(course(variable("x").at_least(0.0)), Course::Rising);
/// assert_eq!(course(variable("x").at_least(2.0)), Course::Never);
/// assert_eq!(course(!variable("x").at_least(0.0)), Course::Falling);
/// # Ok::<(), pleach_guards::EmptyInterval>(())
/// ```
#[derive(Clone, Debug)]
pub struct Tracker {
    root: Node,
    comparisons: Box<[Tracked]>,
}

/// The logic; negations are resolved into the comparisons.
#[derive(Clone, Debug)]
enum Node {
    Comparison(usize),
    All(Box<[Node]>),
    Any(Box<[Node]>),
    Function,
}

/// A comparison as a margin: it holds where `upper` ≥ `lower`, or, if it is strict, `upper` > `lower`.
#[derive(Clone, Debug)]
pub struct Tracked {
    upper: Formula,
    lower: Formula,
    is_strict: bool,
    form: Option<Affine>,
}

/// a₁·x₁ + … + aₙ·xₙ + b, over variables by their place.
#[derive(Clone, Debug, PartialEq)]
pub struct Affine {
    /// Places and coefficients, none of them 0.
    pub coefficients: Box<[(usize, f64)]>,
    /// What is added.
    pub constant: f64,
}

impl Predicate {
    /// The predicate prepared for being followed, where variable *i* is `variables[i]`.
    ///
    /// # Errors
    ///
    /// [`EvaluationError::UnknownVariable`] if a variable of the predicate is not listed.
    pub fn track(&self, variables: &[impl AsRef<str>]) -> Result<Tracker, EvaluationError> {
        let mut comparisons = Vec::new();
        let root = Node::of(self, false, variables, &mut comparisons)?;
        Ok(Tracker { root, comparisons: comparisons.into() })
    }
}

impl Tracker {
    /// The course during a span of twice `half_width` seconds, where variable *i* is
    /// `states[slots[i]]`.
    ///
    /// A comparison may fail by up to `slack`, ≥ 0, in the unit of what it compares. The course of a
    /// comparison that is known, by its number, is not computed again.
    pub fn course(
        &self,
        states: &[Enclosure],
        slots: &[usize],
        half_width: f64,
        slack: f64,
        known: &impl Fn(usize) -> Option<Course>,
    ) -> Course {
        let context = Context { states, slots, half_width, slack };
        let (course, definedness) = self.root.course(&self.comparisons, &context, known);
        definedness.limit(course)
    }

    /// The comparisons by their numbers; those under a negation are turned.
    pub fn comparisons(&self) -> &[Tracked] {
        &self.comparisons
    }

    /// Whether a proposition or a named function occurs.
    pub fn is_opaque(&self) -> bool {
        self.root.is_opaque()
    }
}

impl Tracked {
    /// Whether equality does not count as holding.
    pub fn is_strict(&self) -> bool {
        self.is_strict
    }

    /// The margin as an affine form, if it is one.
    pub fn form(&self) -> Option<&Affine> {
        self.form.as_ref()
    }

    /// The margin during a span, as far as it has a value there; see [`Tracker::course`].
    pub fn margin(&self, states: &[Enclosure], slots: &[usize], half_width: f64) -> Enclosure {
        let context = Context { states, slots, half_width, slack: 0.0 };
        let (upper, lower) = (self.upper.run(&context).0, self.lower.run(&context).0);
        upper.minus(&lower).sharpened(half_width)
    }

    /// What becomes of it during a span, and its margin; see [`Tracker::course`].
    pub fn follow(
        &self,
        states: &[Enclosure],
        slots: &[usize],
        half_width: f64,
    ) -> (Course, Enclosure) {
        let context = Context { states, slots, half_width, slack: 0.0 };
        let (course, definedness, margin) = self.course(&context);
        (definedness.limit(course), margin)
    }

    /// The margin in a ring, given that of each variable by its place; `None` if it is no polynomial of
    /// them, or if an operation of the ring gives up.
    pub fn in_ring<R: Ring>(&self, variable: &mut impl FnMut(usize) -> Option<R>) -> Option<R> {
        self.upper.in_ring(variable)?.minus(&self.lower.in_ring(variable)?)
    }

    /// What becomes of the comparison where its margin has a value everywhere and is enclosed by this.
    pub fn course_of(&self, margin: &Enclosure) -> Course {
        course_of(margin, self.is_strict, false)
    }

    fn course(&self, context: &Context<'_>) -> (Course, Definedness, Enclosure) {
        let (upper, is_upper) = self.upper.run(context);
        let (lower, is_lower) = self.lower.run(context);
        let definedness = is_upper.and(is_lower);
        let is_strict = self.is_strict && context.slack == 0.0;
        let margin = upper.minus(&lower).sharpened(context.half_width);
        let is_exact = context.slack == 0.0;
        let is_apart = |one: Interval, other: Interval| is_exact && one.upper() <= other.lower();
        let course = if !is_strict && is_apart(lower.range, upper.range) {
            Course::Always
        } else if is_strict && is_apart(upper.range, lower.range) {
            Course::Never
        } else {
            let slack = Interval::point(context.slack);
            let margin = Enclosure { range: margin.range + slack, ..margin };
            course_of(&margin, is_strict, definedness == Definedness::Steep)
        };
        (course, definedness, margin)
    }
}

impl Definedness {
    /// What is known of a course if this is known of what it is the course of.
    fn limit(self, course: Course) -> Course {
        match self {
            Definedness::Everywhere | Definedness::Steep => course,
            Definedness::Blurred => Course::Blurred,
            Definedness::Open => Course::Open,
        }
    }
}

/// What becomes of a comparison with this margin.
fn course_of(margin: &Enclosure, is_strict: bool, is_steep: bool) -> Course {
    let (least, most) = (margin.range.lower(), margin.range.upper());
    if least > 0.0 || !is_strict && least >= 0.0 {
        return Course::Always;
    }
    if most < 0.0 || is_strict && most <= 0.0 {
        return Course::Never;
    }
    let is_blurred = is_steep || margin.is_blurred();
    match (margin.rate.lower() >= 0.0, margin.rate.upper() <= 0.0) {
        (true, _) if is_blurred => Course::FaintlyRising,
        (true, _) => Course::Rising,
        (_, true) if is_blurred => Course::FaintlyFalling,
        (_, true) => Course::Falling,
        _ if is_blurred => Course::Blurred,
        _ => Course::Open,
    }
}

impl Node {
    fn of(
        predicate: &Predicate,
        is_negated: bool,
        variables: &[impl AsRef<str>],
        comparisons: &mut Vec<Tracked>,
    ) -> Result<Node, EvaluationError> {
        let mut parts = |parts: &[Predicate]| -> Result<Box<[Node]>, EvaluationError> {
            let part = |part| Node::of(part, is_negated, variables, comparisons);
            parts.iter().map(part).collect()
        };
        Ok(match (predicate, is_negated) {
            (Predicate::Comparison(comparison), _) => {
                comparisons.push(Tracked::of(comparison, is_negated, variables)?);
                Node::Comparison(comparisons.len() - 1)
            }
            (Predicate::Not(inner), _) => Node::of(inner, !is_negated, variables, comparisons)?,
            (Predicate::All(all), false) | (Predicate::Any(all), true) => Node::All(parts(all)?),
            (Predicate::Any(any), false) | (Predicate::All(any), true) => Node::Any(parts(any)?),
            (Predicate::Proposition(_) | Predicate::Function(_), _) => Node::Function,
        })
    }

    fn course(
        &self,
        comparisons: &[Tracked],
        context: &Context<'_>,
        known: &impl Fn(usize) -> Option<Course>,
    ) -> (Course, Definedness) {
        let join = |parts: &[Node], first: Course, combine: fn(Course, Course) -> Course| {
            parts.iter().fold((first, Definedness::Everywhere), |(course, definedness), part| {
                let (next, is_defined) = part.course(comparisons, context, known);
                (combine(course, next), definedness.and(is_defined))
            })
        };
        match self {
            Node::Comparison(number) => match known(*number) {
                Some(course) => (course, Definedness::Everywhere),
                None => {
                    let (course, definedness, _) = comparisons[*number].course(context);
                    (course, definedness)
                }
            },
            Node::All(parts) => join(parts, Course::Always, Course::and),
            Node::Any(parts) => join(parts, Course::Never, Course::or),
            Node::Function => (Course::Opaque, Definedness::Everywhere),
        }
    }

    fn is_opaque(&self) -> bool {
        match self {
            Node::Comparison(_) => false,
            Node::All(parts) | Node::Any(parts) => parts.iter().any(Node::is_opaque),
            Node::Function => true,
        }
    }
}

impl Tracked {
    fn of(
        comparison: &Comparison,
        is_negated: bool,
        variables: &[impl AsRef<str>],
    ) -> Result<Tracked, EvaluationError> {
        let Comparison { left, relation, right } = comparison;
        // a ≤ b is not so where a > b.
        let (upper, lower, is_strict) = match (relation, is_negated) {
            (Relation::AtMost, false) | (Relation::MoreThan, true) => (right, left, false),
            (Relation::LessThan, false) | (Relation::AtLeast, true) => (right, left, true),
            (Relation::AtLeast, false) | (Relation::LessThan, true) => (left, right, false),
            (Relation::MoreThan, false) | (Relation::AtMost, true) => (left, right, true),
        };
        let form = (upper - lower).linear_form().and_then(|form| {
            let place = |name: &str| variables.iter().position(|one| one.as_ref() == name);
            let coefficients = form.coefficients().map(|(name, &a)| Some((place(name)?, a)));
            Some(Affine {
                coefficients: coefficients.collect::<Option<_>>()?,
                constant: *form.constant(),
            })
        });
        let (upper, lower) = (Formula::of(upper, variables)?, Formula::of(lower, variables)?);
        Ok(Tracked { upper, lower, is_strict, form })
    }
}

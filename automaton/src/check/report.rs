//! What checks have to say, for people and for tests.

use std::fmt;

use pleach_guards::Predicate;

use crate::decision::{Proof, State};

/// What was found out about a model before anything runs.
///
/// It prints as a list, the worst first.
#[derive(Clone, Debug, Default, PartialEq)]
#[must_use = "a report is of use only if it is read"]
pub struct Report {
    findings: Vec<Finding>,
    exclusions: Vec<Exclusion>,
}

/// One thing that is wrong with a model, or could be.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Finding {
    /// What it is.
    pub kind: Kind,
    /// How bad it is.
    pub severity: Severity,
    /// Where it is.
    pub place: FindingPlace,
    /// What is wrong, and what would be right.
    pub message: String,
    /// A state in which it shows. For what happens in a jump, it is the state before, x⁻.
    pub witness: Option<State>,
    /// All such states of its location, of which the witness is one, so that it can be asked whether
    /// a run comes to any of them.
    pub states: Option<Predicate>,
}

/// A state in which a fault shows, and what holds in all such states.
#[derive(Clone, Debug)]
pub(super) struct Shown {
    pub(super) state: State,
    pub(super) states: Option<Predicate>,
}

/// A fault that was looked for and cannot be, with the proof.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub struct Exclusion {
    /// What cannot be.
    pub kind: Kind,
    /// Where.
    pub place: FindingPlace,
    /// Why.
    pub proof: Proof,
}

/// How bad a finding is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Severity {
    /// Runs that come there cannot go on, or something can never happen that all rests on.
    Error,
    /// The model says something that its writer most likely does not mean.
    Warning,
    /// Worth knowing: a deliberate freedom of the model, or a limit of what was checked.
    Note,
}

/// What a finding is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub enum Kind {
    /// Two forced transitions of one location and priority can be due together.
    Overlap,
    /// Several transitions may be taken, and the model leaves it open which.
    Choice,
    /// A transition can be due only where another goes first.
    Shadowed,
    /// A transition can never be taken.
    NeverFires,
    /// A location can never be entered.
    Unreachable,
    /// A state that neither time nor a transition can leave.
    Blocked,
    /// An invariant that holds nowhere.
    EmptyInvariant,
    /// A jump that lands outside the invariant of its target; an error if nothing can go on there.
    LandsOutside,
    /// A formula without a finite value in a state that the model admits.
    Undefined,
    /// A jump that gives a coordinate a value outside its declared range.
    LeavesRange,
    /// Forced transitions that follow each other forever while no time passes.
    TimelessCycle,
    /// Two locations whose flows both lead to the boundary between them.
    Sliding,
    /// Nothing says in which state a run starts.
    NoInitialState,
    /// The initial state is outside the invariant of the initial location; an error if nothing can go
    /// on there.
    StartsOutside,
    /// The initial state is outside the declared ranges.
    StartsOutOfRange,
    /// A location waits for something to change that rests there and moves elsewhere.
    NothingMoves,
    /// A function, which no check can see into.
    Unchecked,
    /// A label that only one component knows.
    LonelyLabel,
    /// A label that one of its components never takes.
    RefusedLabel,
    /// A label whose components never come together where all of them take it.
    BlockedLabel,
    /// A component that waits forever for labels that no other takes any more.
    Deadlock,
    /// A channel that holds fewer messages than can be under way.
    LosesMessages,
    /// A channel whose messages may never arrive.
    KeepsMessages,
    /// A connected input that no formula reads.
    UnreadInput,
    /// An exploration that was given up.
    Unexplored,
}

/// Where a finding is, as far as that makes sense for its kind.
#[derive(Clone, Debug, Default, PartialEq, Eq, PartialOrd, Ord)]
#[non_exhaustive]
pub struct FindingPlace {
    /// The component of a composition.
    pub component: Option<String>,
    /// The location.
    pub location: Option<&'static str>,
    /// The events of the transitions.
    pub events: Vec<String>,
    /// The variable.
    pub variable: Option<String>,
}

impl Report {
    /// The findings, the worst first, and otherwise in the order of the model.
    pub fn findings(&self) -> &[Finding] {
        &self.findings
    }

    /// The findings of one severity.
    pub fn of(&self, severity: Severity) -> impl Iterator<Item = &Finding> {
        self.findings.iter().filter(move |finding| finding.severity == severity)
    }

    /// The faults that were proven not to be there.
    pub fn exclusions(&self) -> &[Exclusion] {
        &self.exclusions
    }

    /// Whether there is no error and no warning. Notes do not count.
    pub fn is_sound(&self) -> bool {
        self.findings.iter().all(|finding| finding.severity == Severity::Note)
    }

    pub(super) fn add(&mut self, finding: Finding) {
        self.findings.push(finding);
    }

    pub(super) fn exclude(&mut self, kind: Kind, place: FindingPlace, proof: Proof) {
        self.exclusions.push(Exclusion { kind, place, proof });
    }

    pub(super) fn merge(&mut self, other: Report) {
        self.findings.extend(other.findings);
        self.exclusions.extend(other.exclusions);
    }

    /// The worst first; what is noted of several components alike, is noted once.
    pub(super) fn finished(mut self) -> Report {
        self.findings.sort_by_key(|finding| finding.severity);
        let mut findings: Vec<Finding> = Vec::with_capacity(self.findings.len());
        let mut alike: Vec<Vec<String>> = Vec::with_capacity(self.findings.len());
        for finding in self.findings {
            match findings.iter().position(|known| known.is_repeated_by(&finding)) {
                Some(known) => alike[known].extend(finding.place.component),
                None => {
                    findings.push(finding);
                    alike.push(Vec::new());
                }
            }
        }
        for (finding, others) in findings.iter_mut().zip(alike) {
            if !others.is_empty() {
                let names = others.iter().map(|name| format!("`{name}`"));
                let names = names.collect::<Vec<_>>().join(", ");
                finding.message.push_str(&format!("; likewise in {names}"));
            }
        }
        Report { findings, exclusions: self.exclusions }
    }
}

impl Finding {
    pub(super) fn new(
        kind: Kind,
        severity: Severity,
        place: FindingPlace,
        message: String,
    ) -> Self {
        Finding { kind, severity, place, message, witness: None, states: None }
    }

    /// Whether both are notes that differ in nothing but the component.
    fn is_repeated_by(&self, other: &Finding) -> bool {
        let at = |finding: &Finding| FindingPlace { component: None, ..finding.place.clone() };
        self.severity == Severity::Note
            && other.severity == Severity::Note
            && self.place.component != other.place.component
            && (self.kind, at(self), &self.message) == (other.kind, at(other), &other.message)
    }

    pub(super) fn shown_by(self, shown: Shown) -> Self {
        Finding { witness: Some(shown.state), states: shown.states, ..self }
    }
}

impl Shown {
    /// A state that is the only one asked about.
    pub(super) fn alone(state: &State) -> Self {
        Shown { state: state.clone(), states: None }
    }
}

impl Kind {
    /// The name in reports.
    pub const fn name(self) -> &'static str {
        match self {
            Kind::Overlap => "overlap",
            Kind::Choice => "choice",
            Kind::Shadowed => "shadowed priority",
            Kind::NeverFires => "never fires",
            Kind::Unreachable => "unreachable",
            Kind::Blocked => "blocked",
            Kind::EmptyInvariant => "empty invariant",
            Kind::LandsOutside => "lands outside",
            Kind::Undefined => "no value",
            Kind::LeavesRange => "leaves its range",
            Kind::TimelessCycle => "timeless cycle",
            Kind::Sliding => "sliding",
            Kind::NoInitialState => "no initial state",
            Kind::StartsOutside => "starts outside",
            Kind::StartsOutOfRange => "starts out of range",
            Kind::NothingMoves => "nothing moves",
            Kind::Unchecked => "unchecked",
            Kind::LonelyLabel => "lonely label",
            Kind::RefusedLabel => "refused label",
            Kind::BlockedLabel => "blocked label",
            Kind::Deadlock => "deadlock",
            Kind::LosesMessages => "loses messages",
            Kind::KeepsMessages => "keeps messages",
            Kind::UnreadInput => "unread input",
            Kind::Unexplored => "unexplored",
        }
    }
}

impl fmt::Display for Kind {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(self.name())
    }
}

impl fmt::Display for Severity {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Severity::Error => "error",
            Severity::Warning => "warning",
            Severity::Note => "note",
        })
    }
}

impl fmt::Display for FindingPlace {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let component = self.component.iter().map(|name| format!("component `{name}`"));
        let location = self.location.iter().map(|name| format!("location `{name}`"));
        let events = self.events.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>();
        let events = (!events.is_empty()).then(|| format!("on {}", events.join(" and ")));
        let variable = self.variable.iter().map(|name| format!("variable `{name}`"));
        let parts: Vec<String> = component.chain(location).chain(events).chain(variable).collect();
        formatter.write_str(if parts.is_empty() { "the model" } else { "" })?;
        formatter.write_str(&parts.join(", "))
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Finding { kind, severity, place, message, witness, .. } = self;
        write!(formatter, "{severity}: {kind}: {place}: {message}")?;
        if let Some(state) = witness.as_ref().filter(|state| !state.is_empty()) {
            let values = state.iter().map(|(name, value)| format!("{name} = {value}"));
            write!(formatter, "\n    for example at {}", values.collect::<Vec<_>>().join(", "))?;
        }
        Ok(())
    }
}

impl fmt::Display for Report {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        for finding in &self.findings {
            writeln!(formatter, "{finding}")?;
        }
        let count = |severity| match (self.of(severity).count(), severity) {
            (1, severity) => format!("1 {severity}"),
            (number, severity) => format!("{number} {severity}s"),
        };
        let [errors, warnings, notes] =
            [Severity::Error, Severity::Warning, Severity::Note].map(count);
        let excluded = match self.exclusions.len() {
            1 => "1 fault".to_owned(),
            number => format!("{number} faults"),
        };
        write!(formatter, "{errors}, {warnings}, {notes}; {excluded} excluded by proof")
    }
}

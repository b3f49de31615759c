//! The shape of a scenario file: which keys it may hold, and what each of them looks like.
//!
//! The shape is checked before the file becomes a scenario, so that every mistake is found in one
//! reading, and each is told with what would be right.

use crate::automaton::network::scenario::{
    AGENDA, CONTROL, KeyPath, LinkModel, MOST_PERIODS, Values,
};
use toml::Spanned;
use toml::de::{DeArray, DeFloat, DeInteger, DeTable, DeValue};

/// What a value looks like.
#[derive(Clone, Copy)]
pub(super) enum Shape {
    Text,
    Number,
    /// A whole number from the first to the second.
    Count(u64, u64),
    /// A whole number of either sign, of 32 bits.
    Integer,
    OneOf(&'static [&'static str]),
    Point,
    ListOf(&'static Shape),
    Table(&'static [Entry]),
}

/// A key of a table.
#[derive(Clone, Copy)]
pub(super) struct Entry {
    name: &'static str,
    required: bool,
    shape: Shape,
}

const fn required(name: &'static str, shape: Shape) -> Entry {
    Entry { name, required: true, shape }
}

const fn optional(name: &'static str, shape: Shape) -> Entry {
    Entry { name, required: false, shape }
}

/// A whole scenario.
pub(super) const SCENARIO: &[Entry] = &[
    required("name", Shape::Text),
    optional("description", Shape::Text),
    required(
        "workspace",
        Shape::Table(&[
            required("boundary", Shape::ListOf(&Shape::Point)),
            optional("holes", Shape::ListOf(&Shape::ListOf(&Shape::Point))),
        ]),
    ),
    required(
        "link",
        Shape::Table(&[
            optional("model", Shape::OneOf(LinkModel::NAMES)),
            required("full_range", Shape::Number),
            required("max_range", Shape::Number),
            optional("steepness", Shape::Number),
        ]),
    ),
    optional("control", Shape::Table(&CONTROL_ENTRIES)),
    optional("mission", Shape::Table(&AGENDA_ENTRIES)),
    required("access_point", Shape::ListOf(&Shape::Table(&[required("position", Shape::Point)]))),
    required(
        "robot",
        Shape::ListOf(&Shape::Table(&[
            required("position", Shape::Point),
            optional("rate", Shape::Number),
            optional("access_point", ACCESS_POINT),
        ])),
    ),
    optional(
        "task",
        Shape::ListOf(&Shape::Table(&[
            required("position", Shape::Point),
            optional("announced", Shape::Count(0, MOST_PERIODS as u64)),
            optional("withdrawn", Shape::Count(1, MOST_PERIODS as u64)),
            optional("lasts", Shape::Count(1, MOST_PERIODS as u64)),
            optional("priority", Shape::Integer),
            optional("access_point", ACCESS_POINT),
        ])),
    ),
];

/// The number of an access point. Whether there is one is seen later.
const ACCESS_POINT: Shape = Shape::Count(0, u32::MAX as u64);

/// The keys of `[control]`, each with the shape of its values.
const CONTROL_ENTRIES: [Entry; CONTROL.len()] = {
    let mut entries = [optional("", Shape::Number); CONTROL.len()];
    let mut row = 0;
    while row < CONTROL.len() {
        let shape = match CONTROL[row].values {
            Values::Count(most, _) => Shape::Count(1, most as u64),
            Values::OneOf(words) => Shape::OneOf(words),
            _ => Shape::Number,
        };
        entries[row] = optional(CONTROL[row].name, shape);
        row += 1;
    }
    entries
};

/// The keys of `[mission]`, each with its words.
const AGENDA_ENTRIES: [Entry; AGENDA.len()] = {
    let mut entries = [optional("", Shape::Number); AGENDA.len()];
    let mut row = 0;
    while row < AGENDA.len() {
        let (name, words) = AGENDA[row];
        entries[row] = optional(name, Shape::OneOf(words));
        row += 1;
    }
    entries
};

/// A place where a file departs from its shape.
pub(super) struct Departure {
    /// The key concerned; for an unknown or missing key the one that the file should not or
    /// should hold.
    pub key: KeyPath,
    /// The bytes of the file that are wrong.
    pub span: std::ops::Range<usize>,
    /// What is wrong and what would be right.
    pub message: String,
}

/// Every place where the parsed file departs from the shape of a scenario, in the order of the
/// file.
pub(super) fn departures(file: &Spanned<DeTable<'_>>) -> Vec<Departure> {
    let mut comparison = Comparison::default();
    comparison.table(&KeyPath::root(), file.span(), file.get_ref(), SCENARIO);
    comparison.found.sort_by_key(|departure| departure.span.start);
    comparison.found
}

/// A walk through a file beside its shape.
#[derive(Default)]
struct Comparison {
    found: Vec<Departure>,
}

impl Comparison {
    fn value(&mut self, key: &KeyPath, value: &Spanned<DeValue<'_>>, shape: &Shape) {
        match (value.get_ref(), shape) {
            (DeValue::String(_), Shape::Text) => {}
            (DeValue::Float(digits), Shape::Number) if !overflows(digits) => {}
            (DeValue::Integer(digits), Shape::Number) if whole(digits).is_some() => {}
            // What is too small is told with what else the values are held against.
            (DeValue::Integer(digits), Shape::Count(_, most))
                if whole(digits).is_some_and(|count| {
                    u64::try_from(count).is_ok_and(|count| count <= *most)
                }) => {}
            (DeValue::Integer(digits), Shape::Integer)
                if whole(digits).is_some_and(|number| i32::try_from(number).is_ok()) => {}
            (DeValue::Float(_) | DeValue::Integer(_), Shape::Number) => {
                let message = format!(
                    "{} is too large: numbers go up to {:e}; write whole numbers from {:e} on with a point or an exponent",
                    spoken(value.get_ref()),
                    f64::MAX,
                    i64::MAX as f64
                );
                self.found.push(Departure { key: key.clone(), span: value.span(), message });
            }
            (DeValue::String(text), Shape::OneOf(choices)) if choices.contains(&text.as_ref()) => {}
            (DeValue::Array(numbers), Shape::Point) => self.point(key, value.span(), numbers),
            (DeValue::Array(elements), Shape::ListOf(shape)) => {
                for (index, element) in elements.iter().enumerate() {
                    self.value(&key.clone().index(index), element, shape);
                }
            }
            (DeValue::Table(table), Shape::Table(entries)) => {
                self.table(key, value.span(), table, entries);
            }
            (other, shape) => {
                let message =
                    format!("{} stands where {} belongs", spoken(other), shape.wanted(key));
                self.found.push(Departure { key: key.clone(), span: value.span(), message });
            }
        }
    }

    fn point(&mut self, key: &KeyPath, span: std::ops::Range<usize>, numbers: &DeArray<'_>) {
        if numbers.len() == 2 {
            for (axis, number) in numbers.iter().enumerate() {
                self.value(&key.clone().index(axis), number, &Shape::Number);
            }
        } else {
            let message = format!(
                "a point is a list of two numbers, [x, y], and this one has length {}",
                numbers.len()
            );
            self.found.push(Departure { key: key.clone(), span, message });
        }
    }

    fn table(
        &mut self,
        key: &KeyPath,
        span: std::ops::Range<usize>,
        table: &DeTable<'_>,
        entries: &[Entry],
    ) {
        for (name, value) in table {
            let here = key.clone().key(name.get_ref().as_ref());
            match entries.iter().find(|entry| entry.name == name.get_ref().as_ref()) {
                Some(entry) => self.value(&here, value, &entry.shape),
                None => {
                    let known: Vec<_> = entries.iter().map(|entry| entry.name).collect();
                    let message =
                        format!("unknown key; the keys known here are {}", known.join(", "));
                    self.found.push(Departure { key: here, span: name.span(), message });
                }
            }
        }
        for entry in entries.iter().filter(|entry| entry.required) {
            if !table.contains_key(entry.name) {
                let here = key.clone().key(entry.name);
                let message = format!("missing; it must be {}", entry.shape.wanted(&here));
                self.found.push(Departure { key: here, span: span.clone(), message });
            }
        }
    }
}

impl Shape {
    /// What belongs at `key`, where this shape is asked for.
    fn wanted(&self, key: &KeyPath) -> String {
        match self {
            Shape::Text => "a text in quotation marks".into(),
            Shape::Number => "a number".into(),
            Shape::Count(least, most) => format!("a whole number from {least} to {most}"),
            Shape::Integer => format!("a whole number from {} to {}", i32::MIN, i32::MAX),
            Shape::OneOf(choices) => {
                let quoted: Vec<_> = choices.iter().map(|choice| format!("{choice:?}")).collect();
                quoted.join(" or ")
            }
            Shape::Point => "a point [x, y]".into(),
            Shape::ListOf(Shape::Point) => "a polygon [[x, y], [x, y], [x, y], …]".into(),
            Shape::ListOf(Shape::Table(_)) => format!("a list of tables, each under its [[{key}]]"),
            Shape::ListOf(_) => "a list of polygons [[[x, y], …], …]".into(),
            Shape::Table(entries) => {
                let required: Vec<_> =
                    entries.iter().filter(|entry| entry.required).map(|entry| entry.name).collect();
                match required.as_slice() {
                    [] => "a table".into(),
                    names => format!("a table with {}", names.join(" and ")),
                }
            }
        }
    }
}

/// A whole number, in whichever base it is written, if it is one of TOML.
fn whole(digits: &DeInteger<'_>) -> Option<i64> {
    i64::from_str_radix(digits.as_str(), digits.radix()).ok()
}

/// Whether a number with a point or an exponent is larger than those of 64 bits.
fn overflows(digits: &DeFloat<'_>) -> bool {
    let is_infinite = digits.as_str().parse().is_ok_and(f64::is_infinite);
    is_infinite && !digits.as_str().contains("inf")
}

/// A value as one would say it.
fn spoken(value: &DeValue<'_>) -> String {
    match value {
        DeValue::String(text) => format!("the text {text:?}"),
        DeValue::Integer(digits) => format!("the whole number {digits}"),
        DeValue::Float(digits) => format!("the number {digits}"),
        DeValue::Boolean(value) => format!("the truth value {value}"),
        DeValue::Datetime(moment) => format!("the date {moment}"),
        DeValue::Array(_) => "a list".into(),
        DeValue::Table(_) => "a table".into(),
    }
}

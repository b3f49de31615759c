//! Numbers over the steps of a run, small enough to be put into a page.
//!
//! A column is a string: the differences from step to step, in units of the last decimal, as
//! Base64 VLQ numbers (the notation of source maps, ECMA-426). Steps without a change are counted:
//! a difference of 0 is followed by how many steps it holds for. What is no number is written as
//! the digit `B`, a zero with a minus sign that nothing else needs.

use serde::Serialize;

const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
/// Stands for what is no number.
const NO_NUMBER: char = 'B';
/// The largest whole number that a script can tell from its neighbours.
const LARGEST: f64 = 9_007_199_254_740_991.0;

/// Numbers by step and column, rounded to `decimals`.
#[derive(Clone, Debug, Serialize)]
pub(super) struct Table {
    decimals: i32,
    columns: Vec<Column>,
    #[serde(skip)]
    steps: usize,
}

/// One number as it goes through the steps.
#[derive(Clone, Debug, Default, Serialize)]
#[serde(into = "String")]
struct Column {
    text: String,
    last: i64,
    /// Steps without a change that are not written yet.
    unchanged: i64,
}

impl Table {
    /// A table without columns.
    pub(super) fn new(decimals: i32) -> Table {
        Table { decimals, columns: Vec::new(), steps: 0 }
    }

    /// Adds a step. Where the row is longer than those before it, its new columns were 0; where
    /// it is shorter, the columns that it lacks keep their numbers.
    pub(super) fn push(&mut self, row: impl IntoIterator<Item = f64>) {
        let scale = 10f64.powi(self.decimals);
        let mut filled = 0;
        for (at, value) in row.into_iter().enumerate() {
            if at == self.columns.len() {
                self.columns.push(Column::unchanged_for(self.steps));
            }
            self.columns[at].push((value * scale).round());
            filled = at + 1;
        }
        self.columns.iter_mut().skip(filled).for_each(|column| column.unchanged += 1);
        self.steps += 1;
    }
}

impl Column {
    fn unchanged_for(steps: usize) -> Column {
        Column { unchanged: steps as i64, ..Column::default() }
    }

    fn push(&mut self, value: f64) {
        if value.is_nan() {
            self.write_unchanged();
            self.text.push(NO_NUMBER);
            return;
        }
        let value = value.clamp(-LARGEST, LARGEST) as i64;
        if value == self.last {
            self.unchanged += 1;
            return;
        }
        self.write_unchanged();
        write(value - self.last, &mut self.text);
        self.last = value;
    }

    fn write_unchanged(&mut self) {
        if self.unchanged > 0 {
            write(0, &mut self.text);
            write(self.unchanged, &mut self.text);
            self.unchanged = 0;
        }
    }
}

impl From<Column> for String {
    fn from(mut column: Column) -> String {
        column.write_unchanged();
        column.text
    }
}

/// Appends a number: its sign is the lowest bit, and five bits make a digit, the lowest first, each
/// but the last with the sixth bit set.
fn write(number: i64, text: &mut String) {
    let mut rest = number.unsigned_abs() << 1 | u64::from(number < 0);
    loop {
        let more = if rest > 31 { 32 } else { 0 };
        text.push(char::from(DIGITS[(rest & 31 | more) as usize]));
        rest >>= 5;
        if rest == 0 {
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Reads a column as the script does.
    fn read(text: &str, steps: usize) -> Vec<f64> {
        let mut digits = text
            .bytes()
            .map(|byte| DIGITS.iter().position(|digit| *digit == byte).expect("a digit") as u64);
        let mut number = || {
            let (mut bits, mut shift) = (0, 0);
            loop {
                let digit = digits.next().expect("another digit");
                bits |= (digit & 31) << shift;
                shift += 5;
                if digit < 32 {
                    return (bits >> 1, bits & 1 == 1);
                }
            }
        };
        let (mut values, mut last) = (Vec::new(), 0);
        while values.len() < steps {
            match number() {
                (0, true) => values.push(f64::NAN),
                (0, false) => {
                    let (count, _) = number();
                    values.extend((0..count).map(|_| last as f64));
                }
                (size, negative) => {
                    last += if negative { -(size as i64) } else { size as i64 };
                    values.push(last as f64);
                }
            }
        }
        values
    }

    #[test]
    fn numbers_look_as_in_source_maps() {
        let written = |number| {
            let mut text = String::new();
            write(number, &mut text);
            text
        };
        assert_eq!(
            [0, 1, -1, 15, 16, -123, 1_000_000].map(written),
            ["A", "C", "D", "e", "gB", "3H", "gkh9B"]
        );
    }

    #[test]
    fn a_late_column_begins_with_zeros_and_a_missing_one_stays() {
        let mut table = Table::new(1);
        for row in [vec![1.0], vec![1.0, 2.5], vec![1.0], vec![3.0, 2.5]] {
            table.push(row);
        }
        let columns: Vec<String> = table.columns.into_iter().map(String::from).collect();
        assert_eq!(read(&columns[0], 4), [10.0, 10.0, 10.0, 30.0]);
        assert_eq!(read(&columns[1], 4), [0.0, 25.0, 25.0, 25.0]);
    }

    proptest! {
        #![proptest_config(cases::usually(64))]
        #[test]
        fn what_is_read_is_what_was_rounded(
            values in prop::collection::vec(
                prop_oneof![Just(0.25), Just(f64::NAN), -1e6..1e6f64], 1..60
            ),
        ) {
            let mut table = Table::new(3);
            values.iter().for_each(|value| table.push([*value]));
            let text = String::from(table.columns.remove(0));
            let read = read(&text, values.len());
            prop_assert_eq!(read.len(), values.len());
            for (read, value) in read.iter().zip(&values) {
                let same = read.is_nan() && value.is_nan();
                prop_assert!(same || (read / 1e3 - value).abs() <= 0.500_001e-3, "{read} {value}");
            }
        }
    }
}

//! A value that observers may see late.

/// A value and those that it had lately.
///
/// News passes one link in a round of messages, and an observer reads the robot that knows the
/// newest: what it shows may be what was true some control periods ago.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Lately<T> {
    current: T,
    /// Earlier values, each with the last step at which it was true.
    past: Vec<(T, usize)>,
}

impl<T: PartialEq> Lately<T> {
    pub(super) fn new(value: T) -> Self {
        Lately { current: value, past: Vec::new() }
    }

    /// From `step` on it has this value; what is older than `patience` steps is forgotten.
    pub(super) fn update(&mut self, value: T, step: usize, patience: usize) {
        if value != self.current {
            let earlier = std::mem::replace(&mut self.current, value);
            self.past.push((earlier, step));
        }
        self.past.retain(|(_, last)| last + patience >= step);
    }

    /// The value now.
    pub(super) fn current(&self) -> &T {
        &self.current
    }

    /// The value now and those that it had lately.
    pub(super) fn values(&self) -> impl Iterator<Item = &T> {
        std::iter::once(&self.current).chain(self.past.iter().map(|(value, _)| value))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_is_remembered_for_a_while() {
        let mut value = Lately::new('a');
        value.update('b', 3, 2);
        assert!(value.values().eq(&['b', 'a']));
        value.update('b', 5, 2);
        assert!(value.values().eq(&['b', 'a']));
        value.update('b', 6, 2);
        assert!(value.values().eq(&['b']));
        assert_eq!(value.current(), &'b');
    }
}

//! Vocabularies in a few lines: enums of locations and events with their names.

/// Declares enums of [locations](crate::Location) or [events](crate::Event).
///
/// Each enum says what it is after a colon; a variant is called as it is written, or by the name
/// after an equals sign. The enums derive what the traits ask for, and `Hash`.
///
/// ```
/// use pleach_discrete::{vocabulary, Event, Location};
///
/// vocabulary! {
///     /// What the heater does.
///     pub enum Heater: Location { Off = "off", On = "on" }
///
///     /// What the sensor tells it.
///     pub enum Sensed: Event { Cold, Warm }
/// }
///
/// assert_eq!(Heater::ALL, [Heater::Off, Heater::On]);
/// assert_eq!(Heater::On.name(), "on");
/// assert_eq!(Sensed::Warm.name(), "Warm");
/// ```
///
/// Two variants of one name do not compile:
///
/// ```compile_fail
/// pleach_discrete::vocabulary! {
///     enum Heater: Location { Off = "off", On = "off" }
/// }
/// ```
#[macro_export]
macro_rules! vocabulary {
    ($(
        $(#[$attribute:meta])*
        $visibility:vis enum $name:ident : $kind:ident {
            $($(#[$note:meta])* $variant:ident $(= $word:literal)?),+ $(,)?
        }
    )+) => {$(
        $(#[$attribute])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
        $visibility enum $name {
            // A name says what a variant stands for.
            $($(#[$note])* #[allow(missing_docs)] $variant),+
        }

        impl $crate::$kind for $name {
            const ALL: &'static [Self] = &[$($name::$variant),+];

            fn name(self) -> &'static str {
                const NAMES: &[&str] = &[$($crate::vocabulary!(@word $variant $($word)?)),+];
                const _: () =
                    assert!($crate::vocabulary::all_differ(NAMES), "two names are the same");
                NAMES[self as usize]
            }

            $crate::vocabulary!(@place $kind);
        }
    )+};
    (@place Location) => {
        #[inline]
        fn place(self) -> Option<usize> {
            Some(self as usize)
        }
    };
    (@place $kind:ident) => {};
    (@word $variant:ident $word:literal) => { $word };
    (@word $variant:ident) => { stringify!($variant) };
}

/// Whether no two of `names` are the same, as a constant function for [`vocabulary!`](crate::vocabulary!).
#[must_use]
pub const fn all_differ(names: &[&str]) -> bool {
    let mut later = 1;
    while later < names.len() {
        let mut earlier = 0;
        while earlier < later {
            if same(names[earlier].as_bytes(), names[later].as_bytes()) {
                return false;
            }
            earlier += 1;
        }
        later += 1;
    }
    true
}

const fn same(left: &[u8], right: &[u8]) -> bool {
    if left.len() != right.len() {
        return false;
    }
    let mut at = 0;
    while at < left.len() {
        if left[at] != right[at] {
            return false;
        }
        at += 1;
    }
    true
}

#[cfg(test)]
mod tests {
    use super::all_differ;
    use crate::{Event, Location};

    vocabulary! {
        enum Only: Location { Here }
        enum Heard: Event {
            /// Notes may stand at variants.
            Loud = "loud",
            Soft,
        }
    }

    #[test]
    fn names_are_given_or_taken_from_the_variant() {
        assert_eq!(Only::ALL, [Only::Here]);
        assert_eq!(Only::Here.name(), "Here");
        assert!(Heard::ALL.iter().map(|event| event.name()).eq(["loud", "Soft"]));
    }

    #[test]
    fn names_that_repeat_are_seen() {
        assert!(all_differ(&[]) && all_differ(&["a", "b", "ab"]));
        assert!(!all_differ(&["a", "b", "a"]));
    }
}

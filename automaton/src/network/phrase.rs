//! Lists of nodes in sentences.

use std::fmt::Display;

/// "robot 3", "robots 3 and 5", "robots 3, 5 and 7"; "no robot" where there is none.
pub fn named(noun: &str, numbers: &[usize]) -> String {
    match numbers {
        [] => format!("no {noun}"),
        [only] => format!("{noun} {only}"),
        several => format!("{noun}s {}", listed(several)),
    }
}

/// "3", "3 and 5", "3, 5 and 7"; nothing of nothing.
pub fn listed<T: Display>(items: &[T]) -> String {
    let items: Vec<String> = items.iter().map(T::to_string).collect();
    match &*items {
        [first @ .., last] if !first.is_empty() => format!("{} and {last}", first.join(", ")),
        few => few.concat(),
    }
}

/// These robots with the verb that they take, as one robot does and as several do: "robot 3 has", "robots 3 and 5 have".
pub fn robots(numbers: &[usize], [of_one, of_several]: [&str; 2]) -> String {
    let verb = if numbers.len() < 2 { of_one } else { of_several };
    format!("{} {verb}", named("robot", numbers))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_is_no_list_and_takes_a_verb_of_its_own() {
        let told =
            [&[][..], &[3], &[3, 5], &[3, 5, 7]].map(|numbers| robots(numbers, ["has", "have"]));
        let expected =
            ["no robot has", "robot 3 has", "robots 3 and 5 have", "robots 3, 5 and 7 have"];
        assert_eq!(told, expected);
    }
}

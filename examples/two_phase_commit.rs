//! # Two-phase commit
//!
//! The participants of a transaction prepare to commit and say so, or abort. The coordinator commits
//! once all have reported that they are prepared; until then it may abort at any time. Each
//! participant receives the decision at some later time. Nothing bounds how long messages take, so
//! the model has no clock, and every reachable state is explored.
//!
//! The protocol is from Gray and Lamport, *Consensus on transaction commit* (2006),
//! [doi:10.1145/1132863.1132867](https://doi.org/10.1145/1132863.1132867), in the form of Lamport's
//! TLA⁺ specification `TwoPhase`: a message that has been sent stays and may arrive any number of
//! times. Each message has a channel of that kind. A ballot for each participant is what the
//! coordinator has received from it; `commit` is an event that the coordinator and all ballots take
//! together.
//!
//! The answer is the number of reachable states: 288 with three participants and 8,832 with five, as
//! the model checker stateright asserts for the same specification in its example `2pc`. In none of
//! them has one participant committed and another aborted.

mod exhibit;

use exhibit::{Exhibit, Shown};
use pleach::automaton::composition::{Channel, Exploration, Reached};
use pleach::prelude::*;
use std::error::Error;

// ---- The model ---------------------------------------------------------------------------------

vocabulary! {
    enum Coordinator: Location { Waiting = "waiting", Decided = "decided" }
    enum Decide: Event { Commit = "commit", Abort = "abort" }

    enum Ballot: Location { Missing = "missing", Received = "received" }
    enum Count: Event { Receive = "receive", Commit = "commit" }

    enum Participant: Location {
        Working = "working", Prepared = "prepared", Committed = "committed", Aborted = "aborted",
    }
    enum Act: Event {
        Prepare = "prepare", GiveUp = "give up",
        LearnCommit = "learn of commit", LearnAbort = "learn of abort",
    }
}

coordinates! {
    /// Whether the coordinator has decided.
    struct State { decided }
    /// The same, as a ballot reads it.
    struct Seen { decided }
}

fn coordinator() -> Result<Automaton<Coordinator, Decide, State>, BuildError> {
    use Coordinator::{Decided, Waiting};
    let State { decided } = State::coordinates();
    let mut coordinator = Automaton::starting_in(Waiting).initially(State { decided: 0.0 });
    for event in [Decide::Commit, Decide::Abort] {
        let decide = from(Waiting).on(event).to(Decided).may(always()).then(decided.becomes(1.0));
        coordinator = coordinator.transition(decide);
    }
    coordinator.build()
}

fn ballot() -> Result<Automaton<Ballot, Count, Seen>, BuildError> {
    use Ballot::{Missing, Received};
    let Seen { decided } = Seen::coordinates();
    let is_in_time = decided.equals_within(0.0, 0.0);
    Automaton::starting_in(Missing)
        .initially(Seen::default())
        .transition(from(Missing).on(Count::Receive).to(Received).may(is_in_time))
        .transition(from(Received).on(Count::Commit).to(Received).may(always()))
        .build()
}

fn participant() -> Result<Automaton<Participant, Act, ()>, BuildError> {
    use Participant::{Aborted, Committed, Prepared, Working};
    let mut participant = Automaton::starting_in(Working)
        .initially(())
        .transition(from(Working).on(Act::Prepare).to(Prepared).may(always()))
        .transition(from(Working).on(Act::GiveUp).to(Aborted).may(always()));
    for (event, end) in [(Act::LearnCommit, Committed), (Act::LearnAbort, Aborted)] {
        for &place in Participant::ALL.iter().filter(|place| **place != end) {
            participant = participant.transition(from(place).on(event).to(end).may(always()));
        }
    }
    participant.build()
}

fn two_phase_commit(participants: usize) -> Result<Composition, Box<dyn Error>> {
    let mut protocol = Composition::builder().add("coordinator", &coordinator()?).label("commit");
    for number in 1..=participants {
        let (name, ballot_name) = (format!("participant {number}"), format!("ballot {number}"));
        let message = |sent: &str, arrival: String| Channel::new(sent, &arrival).lasting();
        protocol = protocol
            .add(&name, &participant()?)
            .add(&ballot_name, &ballot()?)
            .connect("coordinator.decided", &format!("{ballot_name}.decided"))
            .channel(message(&format!("{name}.prepare"), format!("{ballot_name}.receive")))
            .channel(message("coordinator.commit", format!("{name}.learn of commit")))
            .channel(message("coordinator.abort", format!("{name}.learn of abort")));
    }
    Ok(protocol.build()?)
}

// ---- The answer --------------------------------------------------------------------------------

/// The numbers of states with three and with five participants that stateright's example asserts.
const PUBLISHED: [f64; 2] = [288.0, 8_832.0];

fn explored(participants: usize) -> Result<Exploration, Box<dyn Error>> {
    Ok(two_phase_commit(participants)?.explore(10_000)?)
}

/// How many participants end in each way: working, prepared, committed, aborted.
fn tally(state: &Reached<'_>) -> [usize; 4] {
    let count = |name| state.locations().filter(|one| *one == name).count();
    ["working", "prepared", "committed", "aborted"].map(count)
}

fn is_consistent(state: &Reached<'_>) -> bool {
    let [_, _, committed, aborted] = tally(state);
    committed == 0 || aborted == 0
}

/// All that three and five participants can come to.
pub fn exhibit() -> Shown {
    let (three, five) = (explored(3)?, explored(5)?);
    let found = [&three, &five].map(|exploration| exploration.states().len() as f64);
    let inconsistent = five.states().filter(|state| !is_consistent(state)).count() as f64;
    let agreed = three.find(|state| tally(state) == [0, 0, 3, 0]).ok_or("no state is committed")?;
    Ok(Exhibit::new("two_phase_commit", include_str!("two_phase_commit.rs"))
        .component("coordinator", &coordinator()?)
        .component("ballot", &ballot()?)
        .component("participant", &participant()?)
        .checked(&two_phase_commit(3)?.check())
        .compare_all("states with three and with five participants", found, PUBLISHED, 0.0)
        .compare("inconsistent ones among those with five", inconsistent, 0.0, 0.0)
        .story("One of the shortest ways to a commit of three", agreed.path()))
}

fn main() -> Result<(), Box<dyn Error>> {
    exhibit()?.show()
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    #[test]
    fn states_are_as_many_as_published_and_all_consistent() {
        let exhibit = exhibit().expect("it can be explored");
        assert_eq!(exhibit.disagreements(), [""; 0]);
    }

    /// Participants (working 0, prepared 1, committed 2, aborted 3), who has sent a vote, whose
    /// vote has arrived, and the decision (none 0, commit 1, abort 2).
    type State = (Vec<u8>, Vec<bool>, Vec<bool>, u8);

    /// The specification once more, on plain numbers.
    fn next((places, sent, heard, decision): &State) -> Vec<State> {
        let mut all = Vec::new();
        let mut push = |change: &dyn Fn(&mut State)| {
            let mut state = (places.clone(), sent.clone(), heard.clone(), *decision);
            change(&mut state);
            all.push(state);
        };
        if *decision == 0 {
            push(&|state| state.3 = 2);
            if heard.iter().all(|&heard| heard) {
                push(&|state| state.3 = 1);
            }
        }
        for (one, &place) in places.iter().enumerate() {
            if place == 0 {
                push(&|state| (state.0[one], state.1[one]) = (1, true));
                push(&|state| state.0[one] = 3);
            }
            if sent[one] && !heard[one] && *decision == 0 {
                push(&|state| state.2[one] = true);
            }
            let told = [place, 2, 3][usize::from(*decision)];
            if told != place {
                push(&|state| state.0[one] = told);
            }
        }
        all
    }

    #[test]
    fn states_transitions_and_ends_are_those_of_a_search_on_plain_numbers() {
        for participants in 1..=4 {
            let none = vec![false; participants];
            let mut todo = vec![(vec![0; participants], none.clone(), none, 0)];
            let mut seen: BTreeSet<State> = todo.iter().cloned().collect();
            let (mut transitions, mut ends) = (0, 0);
            while let Some(state) = todo.pop() {
                let followers = next(&state);
                transitions += followers.len();
                ends += usize::from(followers.is_empty());
                todo.extend(followers.into_iter().filter(|one| seen.insert(one.clone())));
            }
            let exploration = explored(participants).expect("it can be explored");
            assert_eq!(exploration.states().len(), seen.len());
            assert_eq!(exploration.transitions(), transitions);
            assert_eq!(exploration.deadlocks().count(), ends);
            let is_agreed = |state: Reached<'_>| tally(&state)[2..].contains(&participants);
            assert!(exploration.deadlocks().all(is_agreed));
        }
    }
}

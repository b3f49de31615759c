//! Nodes of the same session that have another scenario.
//!
//! Keys hold the digest of the scenario, so that nothing but their hellos is heard of them. Without a
//! word on them, who waits for a mission would only be told that nobody is there.

use crate::transport::Hello;
use pleach::automaton::network::scenario::ValidScenario;
use pleach::automaton::node::NodeId;
use pleach::cli::output::tell;
use std::collections::BTreeSet;

/// The nodes of a session that have another scenario than this one.
#[derive(Clone, Debug)]
pub struct Strangers<'a> {
    scenario: &'a ValidScenario,
    digest: String,
    told_of: BTreeSet<NodeId>,
}

impl<'a> Strangers<'a> {
    /// Those that have another scenario than this one, which has this digest.
    pub fn to(scenario: &'a ValidScenario, digest: &str) -> Self {
        Strangers { scenario, digest: digest.to_owned(), told_of: BTreeSet::new() }
    }

    /// Whether a hello is that of a stranger. Each is told of once.
    pub fn recognise(&mut self, from: NodeId, hello: &Hello) -> bool {
        let is_stranger = hello.digest != self.digest;
        if is_stranger && self.told_of.insert(from) {
            tell(self.warning_of(hello));
        }
        is_stranger
    }

    /// How many of them there are.
    pub fn count(&self) -> usize {
        self.told_of.len()
    }

    fn warning_of(&self, hello: &Hello) -> String {
        let Hello { name, scenario, digest, .. } = hello;
        let other = format!("{name:?} of this session has the scenario {scenario:?} ({digest})");
        let own = format!("{:?} ({})", self.scenario.name, self.digest);
        format!("warning: {other} and not {own}; all processes start with the same file")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use pleach::scenario_file;
    use std::path::Path;

    #[test]
    fn a_stranger_is_told_of_once_with_both_scenarios() {
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../scenarios/too-few.toml");
        let scenario = scenario_file::read(&path).unwrap();
        let mut strangers = Strangers::to(&scenario, "abc");
        let own = Hello::of("robot 3", "too-few", "abc");
        let other = Hello::of("robot 3", "study-1", "abd");
        assert!(!strangers.recognise(3, &own));
        assert_eq!(strangers.count(), 0);
        assert!(strangers.recognise(3, &other) && strangers.recognise(3, &other));
        assert_eq!(strangers.count(), 1);
        assert_eq!(
            strangers.warning_of(&other),
            "warning: \"robot 3\" of this session has the scenario \"study-1\" (abd) and not \
             \"too-few\" (abc); all processes start with the same file"
        );
    }
}

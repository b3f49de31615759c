//! Explores the coordination protocol exhaustively and says what it found.
//!
//! ```text
//! cargo run --release --example explore -- [thorough] [WORDS OF A CAMPAIGN'S NAME]
//! ```
//!
//! Without `thorough` it runs what the tests run too; otherwise the campaigns that take minutes.
//! A property that fails is told as a story, and the program ends with status 1. At the end it says
//! which rows of the tables no node has taken.

#[macro_use]
mod say;

use std::process::ExitCode;
use std::time::Instant;

use pleach_exploration::network::{Campaign, CampaignError, Counts, Findings, QUICK, THOROUGH};

fn main() -> Result<ExitCode, CampaignError> {
    let mut words: Vec<String> = std::env::args().skip(1).collect();
    let thorough = words.first().is_some_and(|word| word == "thorough");
    let campaigns = if thorough { THOROUGH } else { QUICK };
    words.drain(..usize::from(thorough));
    let wanted = words.join(" ");
    let chosen = campaigns.iter().filter(|campaign| campaign.name.contains(&wanted));
    let chosen: Vec<&Campaign> = chosen.collect();
    if chosen.is_empty() {
        eprintln!("usage: explore [thorough] [WORDS OF A CAMPAIGN'S NAME]");
        eprintln!("no campaign has '{wanted}' in its name; there are:");
        QUICK.iter().for_each(|campaign| eprintln!("    {}", campaign.name));
        THOROUGH.iter().for_each(|campaign| eprintln!("    thorough {}", campaign.name));
        return Ok(ExitCode::from(2));
    }
    let (mut all_met, mut all) = (true, Findings::default());
    for campaign in chosen {
        let findings = report(campaign)?;
        all_met &= campaign.is_met_by(&findings);
        all = all.and(findings);
    }
    let untaken: Vec<_> = all.rows.iter().filter(|(_, taken)| **taken == 0).collect();
    say!("rows that no node takes in any of them: {} of {}", untaken.len(), all.rows.len());
    untaken.iter().for_each(|(row, _)| say!("    {row}"));
    Ok(if all_met { ExitCode::SUCCESS } else { ExitCode::FAILURE })
}

/// Runs one campaign and says what it has come to.
fn report(campaign: &Campaign) -> Result<Findings, CampaignError> {
    let begin = Instant::now();
    let findings = campaign.run()?;
    say!(
        "{}: {} configurations, {} states (at most {} in one), {} transitions, {:.1} s",
        campaign.name,
        findings.counts.configurations,
        findings.counts.states,
        findings.largest,
        findings.counts.transitions,
        begin.elapsed().as_secs_f64(),
    );
    if findings.counts != campaign.expected {
        let Counts { configurations, states, transitions } = campaign.expected;
        say!(
            "    not as expected: {configurations} configurations, {states} states, {transitions} transitions"
        );
    }
    say!("    configurations in which a mission may end so: {:?}", findings.outcomes);
    say!("    properties that fail: {}", findings.failures.len());
    if let Some(failure) = findings.failures.iter().min_by_key(|failure| failure.story.len()) {
        say!("{failure}");
    }
    Ok(findings)
}

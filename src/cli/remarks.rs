//! Remarks on scenarios as lines: each with its key, of an outline with much to repair only the first ones.

use pleach::automaton::network::scenario::Remark;

/// The most repairs of the outline that are told one by one.
const REPAIRS_TOLD: usize = 8;

/// The remarks as lines.
pub(super) fn lines<'r>(remarks: impl IntoIterator<Item = &'r Remark>) -> Vec<String> {
    let (outline, others): (Vec<&Remark>, Vec<&Remark>) =
        remarks.into_iter().partition(|remark| matches!(remark, Remark::Outline(_)));
    let line = |remark: &&Remark| format!("{}: {remark}", remark.key());
    let more = match outline.len().saturating_sub(REPAIRS_TOLD) {
        0 => None,
        1 => Some("workspace: one more defect of the outline was repaired".to_owned()),
        more => Some(format!("workspace: {more} more defects of the outline were repaired")),
    };
    let told = outline.iter().take(REPAIRS_TOLD).map(line);
    others.iter().map(line).chain(told).chain(more).collect()
}

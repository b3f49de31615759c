//! What a robot sends of itself: its beacon, and reports for observers.

use std::sync::Arc;

use crate::network::beacon::{Beacon, LastBeacon};
use crate::network::member::NodeOutputs;
use crate::network::record::MissionEvent;

/// The beacon that was sent last, and the reports that wait.
#[derive(Clone, Debug, Default)]
pub(super) struct Outbox {
    last_beacon: LastBeacon,
    /// For observers; no robot reads it.
    log: Vec<MissionEvent>,
}

impl Outbox {
    /// That of a robot that begins again: its reports wait.
    pub(super) fn begun_again(self) -> Self {
        Outbox { log: self.log, ..Outbox::default() }
    }

    /// Observers receive an event.
    pub(super) fn report(&mut self, event: MissionEvent) {
        self.log.push(event);
    }

    /// Reports go to observers.
    pub(super) fn send_reports(&mut self, outputs: &mut NodeOutputs) {
        self.log.drain(..).for_each(|event| outputs.report(event));
    }

    /// The beacon that was sent last.
    pub(super) fn beacon(&self) -> Option<Arc<Beacon>> {
        self.last_beacon.get()
    }

    /// The beacon to send now, and whether it differs from the last one.
    pub(super) fn renew_beacon(&mut self, beacon: Beacon) -> (Arc<Beacon>, bool) {
        self.last_beacon.replace_by(beacon)
    }

    /// A control period begins, or what is sent beside the beacon has changed: it is sent again.
    pub(super) fn send_beacon_again(&mut self) {
        self.last_beacon.tell_anew();
    }

    /// Whether the beacon is sent in this round, which then counts.
    pub(super) fn takes_beacon(&mut self) -> bool {
        self.last_beacon.tell()
    }

    /// Whether the beacon has been sent in as many rounds as it takes to be received if some are lost.
    pub(super) fn is_sent(&self) -> bool {
        self.last_beacon.is_told()
    }
}

#[cfg(test)]
impl Outbox {
    /// The reports that wait.
    pub(super) fn take_reports(&mut self) -> Vec<MissionEvent> {
        std::mem::take(&mut self.log)
    }
}

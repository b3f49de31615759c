//! A scenario that a mission can start from.

use std::ops::Deref;
use std::sync::Arc;

use pleach_continuous::network::LinkReliability;
use pleach_continuous::network::reliability::check;

use super::fleet::{self, Fleet};
use super::{InvalidScenario, KeyPath, Problem, Scenario, Settings, Teams, placement};
use crate::network::Site;

/// A scenario that a mission can start from, with the [`Site`] that its robots know.
///
/// It reads as the [`Scenario`] that it holds, and cannot be changed: to get another one
/// takes the scenario out with [`into_scenario`](Self::into_scenario), changes it and makes a
/// valid one of it again. The geometry is prepared once, here, for the checks and for whatever
/// uses the site afterwards.
#[derive(Clone, Debug)]
pub struct ValidScenario {
    scenario: Scenario,
    site: Arc<Site>,
    fleets: Arc<[Fleet]>,
}

impl ValidScenario {
    /// Checks a scenario.
    ///
    /// A task that no robot can come close to is no fault: it ends the mission with an outcome of
    /// its own. [`remarks`](Self::remarks) names such tasks before anything runs.
    ///
    /// # Errors
    /// The faults, in the order of the keys. Later checks presuppose earlier ones (numbers are
    /// finite, then in their ranges, then settings fit each other, then polygons do not cross, then
    /// robots stand well, then they are connected, then links carry the rates), so only the first
    /// kind of check that fails is reported.
    pub fn new(scenario: Scenario) -> Result<Self, InvalidScenario> {
        scenario.check_values()?;
        let site = placement::site(&scenario).map_err(|fault| vec![fault])?;
        Self::on(scenario, site)
    }

    /// Checks a scenario whose links behave as `model` says, instead of as `[link]` does.
    ///
    /// # Errors
    /// As [`new`](Self::new), and when the model is seen to break a requirement of
    /// [`LinkReliability`]. `[link]` must state ranges that are valid by themselves.
    pub fn with_link(
        scenario: Scenario,
        model: impl LinkReliability + 'static,
    ) -> Result<Self, InvalidScenario> {
        scenario.check_values()?;
        check(&model).map_err(|broken| {
            vec![Problem::LinkModel(broken.to_string()).at(KeyPath::root().key("link"))]
        })?;
        let site = placement::site(&scenario).map_err(|fault| vec![fault])?;
        let site = site.with_link(model).map_err(|error| {
            vec![Problem::LinkModel(error.to_string()).at(KeyPath::root().key("link"))]
        })?;
        Self::on(scenario, site)
    }

    /// A scenario whose values are in range, on its site.
    pub(super) fn on(scenario: Scenario, site: Site) -> Result<Self, InvalidScenario> {
        let (site, fleets) = match site.settings.teams {
            Teams::One => (placement::start(&scenario, site)?, Vec::new()),
            Teams::PerAccessPoint => {
                placement::stand(&scenario, &site)?;
                let fleets = fleet::fleets(&scenario, &site)?;
                (site, fleets)
            }
        };
        Ok(Self { scenario, site: Arc::new(site), fleets: fleets.into() })
    }

    /// The same scenario with robots at other places, one for each. The geometry is not prepared
    /// again.
    ///
    /// # Errors
    /// When robots do not stand where a mission can start, or are not as many as before.
    pub fn with_starts(&self, starts: &[[f64; 2]]) -> Result<Self, InvalidScenario> {
        let mut scenario = self.scenario.clone();
        if starts.len() != scenario.robot.len() {
            let (stated, given) = (scenario.robot.len(), starts.len());
            let key = KeyPath::root().key("robot");
            return Err(vec![Problem::OtherNumber { stated, given }.at(key)].into());
        }
        for (robot, start) in scenario.robot.iter_mut().zip(starts) {
            robot.position = *start;
        }
        scenario.check_values()?;
        let site = self.site.with_starts(starts.iter().map(|&start| start.into()).collect());
        if !self.fleets.is_empty() {
            return Self::on(scenario, site);
        }
        let faults = placement::faults(&scenario, &site);
        match faults.is_empty() {
            true => Ok(Self { scenario, site: Arc::new(site), fleets: Arc::from([]) }),
            false => Err(faults.into()),
        }
    }

    /// The same scenario, whose robots derive everything anew at each tick instead of what has changed. All results are the
    /// same; it serves to verify that.
    #[must_use]
    pub fn without_caching(&self) -> Self {
        Self {
            scenario: self.scenario.clone(),
            site: Arc::new(self.site.without_caching()),
            fleets: self.fleets.iter().map(Fleet::without_caching).collect(),
        }
    }

    /// The scenario.
    pub const fn scenario(&self) -> &Scenario {
        &self.scenario
    }

    /// The scenario, to be changed.
    pub fn into_scenario(self) -> Scenario {
        self.scenario
    }

    /// What the robots know from the beginning: floor plan, access points, radio, settings.
    pub const fn site(&self) -> &Arc<Site> {
        &self.site
    }

    /// Its fleets, where each access point has a team of its own, by access point; none where there is one team.
    pub fn fleets(&self) -> &[Fleet] {
        &self.fleets
    }

    /// The settings with every default filled in.
    pub fn settings(&self) -> &Settings {
        &self.site.settings
    }
}

impl Deref for ValidScenario {
    type Target = Scenario;

    fn deref(&self) -> &Scenario {
        &self.scenario
    }
}

impl PartialEq for ValidScenario {
    fn eq(&self, other: &Self) -> bool {
        self.scenario == other.scenario
    }
}

impl TryFrom<Scenario> for ValidScenario {
    type Error = InvalidScenario;

    fn try_from(scenario: Scenario) -> Result<Self, InvalidScenario> {
        Self::new(scenario)
    }
}

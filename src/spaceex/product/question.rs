//! Where runs begin, where they must not come, and for how long.

use super::clause::{bound, fixed, predicate};
use super::{Product, Result, location_name};
use crate::discrete::first_mentions;
use crate::guards::{Expression, Predicate, Relation, Substitution, constant};
use crate::spaceex::configuration::{Bounded, Options};
use crate::spaceex::formula::{Clause, Side};
use crate::spaceex::network::Instance;
use crate::spaceex::{Initial, SpaceExError};
use crate::verify::reach::{Directions, Forbidden, Polytope, Region, Settings, StateSet, Template};

/// Whether a predicate is a comparison that excludes its boundary.
fn is_strict(predicate: &Predicate) -> bool {
    use Relation::{LessThan, MoreThan};
    matches!(predicate, Predicate::Comparison(it) if matches!(it.relation, LessThan | MoreThan))
}

impl Product<'_> {
    /// The names of the product's locations that clauses allow.
    fn allowed(&self, clauses: &[Clause], line: usize) -> Result<Vec<usize>> {
        let mut allowed: Vec<usize> = (0..self.tuples.len()).collect();
        for clause in clauses {
            let Clause::Location { component, location } = clause else { continue };
            let wrong = |problem: String| SpaceExError::Configuration { line, problem };
            // In a system that is one base component, its own name stands for it.
            let matching = |instance: &Instance<'_>| {
                instance.name == *component
                    || instance.name.is_empty() && instance.component.id == *component
                    || self.network.instances.len() == 1 && component.is_empty()
            };
            let at = self.network.instances.iter().position(matching);
            let at = at.ok_or_else(|| {
                let known: Vec<&str> = self
                    .network
                    .instances
                    .iter()
                    .map(|one| {
                        if one.name.is_empty() {
                            one.component.id.as_str()
                        } else {
                            one.name.as_str()
                        }
                    })
                    .collect();
                wrong(format!(
                    "`loc({component})`: there is no such component; there are {}",
                    known.join(", ")
                ))
            })?;
            let component = self.network.instances[at].component;
            let places: Vec<usize> = (0..component.locations.len())
                .filter(|place| {
                    component.locations[*place].name == *location
                        || location_name(component, *place) == *location
                })
                .collect();
            if places.is_empty() {
                let known: Vec<&str> =
                    component.locations.iter().map(|place| place.name.as_str()).collect();
                return Err(wrong(format!(
                    "there is no location `{location}`: there are {}",
                    known.join(", ")
                )));
            }
            allowed.retain(|tuple| places.contains(&self.tuples[*tuple][at]));
        }
        Ok(allowed)
    }

    fn names_of(&self, tuples: &[usize]) -> Vec<String> {
        tuples.iter().map(|tuple| self.names[*tuple].as_str().to_owned()).collect()
    }

    /// The names of what sets of states are over: coordinates, and constants within bounds.
    fn names_of_states(&self) -> Vec<String> {
        let resting = self.constants.iter().filter(|(_, values)| values.width() > 0.0);
        self.variables.iter().chain(resting.map(|(name, _)| name)).cloned().collect()
    }

    /// Where runs begin, one for each alternative.
    pub(super) fn initial(&self, options: &Options) -> Result<Vec<Initial>> {
        let (line, alternatives) = &options.initially;
        let wrong = |problem: String| SpaceExError::Configuration { line: *line, problem };
        let names = self.names_of_states();
        let open_inputs = self.strict_input_bounds()?;
        let mut initial = Vec::new();
        for clauses in alternatives {
            for clause in clauses {
                if let Some(states) = predicate(clause).map_err(wrong)? {
                    self.knows_all_of(&states).map_err(wrong)?;
                }
            }
            let locations = self.names_of(&self.allowed(clauses, *line)?);
            let mut sides = Vec::new();
            for name in &names {
                let side = fixed(std::slice::from_ref(clauses), name)
                    .filter(|side| side.width().is_finite());
                sides.push(side.ok_or_else(|| {
                    wrong(format!(
                        "`initially` does not bound `{name}` from both sides, or allows no value of it"
                    ))
                })?);
            }
            let states_of = |clauses: &mut dyn Iterator<Item = &Clause>| {
                let predicates = clauses.filter_map(|clause| predicate(clause).transpose());
                predicates.collect::<std::result::Result<Vec<_>, _>>().map_err(wrong)
            };
            let values = self.constants.iter().filter(|(_, values)| values.width() == 0.0);
            let values = values.map(|(name, values)| (name, constant(values.midpoint())));
            let values = Substitution::new(values);
            let mut conditions = states_of(&mut clauses.iter())?;
            conditions.retain(is_strict);
            conditions.extend(open_inputs.iter().cloned());
            let of_inputs = states_of(&mut clauses.iter().filter(|it| self.is_input_bound(it)))?;
            conditions.extend(of_inputs.into_iter().filter(|one| !is_strict(one)));
            conditions.iter_mut().for_each(|one| *one = one.substitute(&values));
            // All but the sides of the box cut it.
            let cuts = states_of(&mut clauses.iter().filter(|clause| bound(clause).is_none()))?;
            let cut = Predicate::all(cuts).substitute(&values);
            let region = Region::of(&cut, &names).map_err(|error| wrong(error.to_string()))?;
            for conjunction in &region.alternatives {
                let mut template = Template::boxes(names.len());
                conjunction
                    .half_spaces
                    .iter()
                    .for_each(|half_space| half_space.add_to(&mut template));
                let polytope = Polytope::around(template, &sides);
                let states = conjunction.cut(&polytope, &names).and_then(StateSet::from_polytope);
                let Some(states) = states else { continue };
                // Nor do sets of states end where comparisons end that are not affine.
                let others = conjunction.others.iter().cloned().map(Predicate::Comparison);
                let others = others.filter(|other| !conditions.contains(other));
                let condition = Predicate::all(conditions.iter().cloned().chain(others));
                initial.push(Initial { locations: locations.clone(), states, condition });
            }
        }
        if initial.is_empty() {
            return Err(wrong("`initially` allows no state".into()));
        }
        Ok(initial)
    }

    /// The bounds on inputs that exclude their boundary, in any location.
    fn strict_input_bounds(&self) -> Result<Vec<Predicate>> {
        let mut bounds = Vec::new();
        for instance in &self.network.instances {
            for place in &instance.component.locations {
                let wrong = |problem| SpaceExError::Model { line: place.invariant.line, problem };
                let clauses = instance.clauses(&place.invariant)?;
                for clause in clauses.iter().filter(|clause| self.is_input_bound(clause)) {
                    bounds.extend(predicate(clause).map_err(wrong)?);
                }
            }
        }
        // Components and locations say the same of an input.
        Ok(first_mentions(bounds.into_iter().filter(is_strict)))
    }

    /// Fails if a predicate reads what is no number of the system.
    fn knows_all_of(&self, states: &Predicate) -> std::result::Result<(), String> {
        match states.variables().into_iter().find(|name| !self.is_number(name)) {
            Some(stranger) => Err(format!("`{stranger}` is no variable or constant of the system")),
            None => Ok(()),
        }
    }

    /// Settings as the configuration says them.
    pub(super) fn settings(&self, options: &Options) -> Result<Settings> {
        let defaults = Settings::default();
        Ok(Settings {
            horizon: options.horizon.unwrap_or(defaults.horizon),
            step: options.step.unwrap_or(defaults.step),
            jump_limit: options.jumps.unwrap_or(defaults.jump_limit),
            directions: self.directions(options)?,
            enters_invariants: true,
            ..defaults
        })
    }

    /// The directions of all that the configuration names.
    fn directions(&self, options: &Options) -> Result<Directions> {
        let names = self.names_of_states();
        let (mut listed, mut has_octagons) = (Vec::new(), false);
        for (line, bounded) in &options.directions {
            match bounded {
                Bounded::Box => {}
                Bounded::Octagon => has_octagons = true,
                Bounded::Across(clauses) => {
                    let wrong = |problem| SpaceExError::Configuration { line: *line, problem };
                    for clause in clauses {
                        listed.push(self.across(clause, &names).map_err(wrong)?);
                    }
                }
            }
        }
        Ok(match (listed.is_empty(), has_octagons) {
            (true, false) => Directions::Boxes,
            (true, true) => Directions::Octagons,
            (false, false) => Directions::Listed(listed),
            (false, true) => {
                let octagons = Template::octagons(names.len()).directions().to_vec();
                Directions::Listed([octagons, listed].concat())
            }
        })
    }

    /// The direction across the boundary of a linear constraint.
    fn across(&self, clause: &Clause, names: &[String]) -> std::result::Result<Vec<f64>, String> {
        let constraint = "a direction is given by a linear constraint as x + y <= 0";
        let Clause::Compare { left: Side::Formula(left), right: Side::Formula(right), .. } = clause
        else {
            return Err(constraint.into());
        };
        let difference = left - right;
        self.knows_all_of(&difference.at_most(0.0))?;
        let direction = coefficients(&difference, names);
        let direction = direction.filter(|entries| entries.iter().any(|entry| *entry != 0.0));
        direction.ok_or_else(|| format!("`{difference}` has no direction: {constraint}"))
    }

    /// The variables to be shown.
    pub(super) fn shown(&self, options: &Options) -> Result<Vec<String>> {
        let (line, shown) = &options.shown;
        let outputs = &self.network.outputs;
        let is_known =
            |name: &&String| *name == "t" || self.is_number(name) || outputs.contains_key(*name);
        match shown.iter().find(|name| !is_known(name)) {
            Some(stranger) => Err(SpaceExError::Configuration {
                line: *line,
                problem: format!(
                    "`{stranger}` cannot be shown: there are t, {}",
                    self.variables.join(", ")
                ),
            }),
            None => Ok(shown.clone()),
        }
    }

    pub(super) fn forbidden(&self, options: &Options) -> Result<Vec<Forbidden>> {
        let (line, alternatives) = &options.forbidden;
        let wrong = |problem: String| SpaceExError::Configuration { line: *line, problem };
        let mut forbidden = Vec::new();
        for clauses in alternatives {
            let mut states = Vec::new();
            for clause in clauses {
                states.extend(predicate(clause).map_err(wrong)?);
            }
            let states = Predicate::all(states);
            if let Some(input) = states.variables().into_iter().find(|name| self.is_input(name)) {
                return Err(wrong(format!(
                    "`{input}` is an input, which states do not hold: forbid values of what it moves"
                )));
            }
            self.knows_all_of(&states).map_err(wrong)?;
            let is_local = clauses.iter().any(|clause| matches!(clause, Clause::Location { .. }));
            if is_local {
                for location in self.names_of(&self.allowed(clauses, *line)?) {
                    forbidden.push(Forbidden::within(&location, states.clone()));
                }
            } else {
                forbidden.push(Forbidden::anywhere(states));
            }
        }
        Ok(forbidden)
    }
}

/// The coefficients of the variables in a formula, if it is linear in them.
fn coefficients(formula: &Expression, variables: &[String]) -> Option<Vec<f64>> {
    let form = formula.linear_form()?;
    let entry = |name: &String| form.coefficient(name).copied().unwrap_or(0.0);
    let entries: Vec<f64> = variables.iter().map(entry).collect();
    entries.iter().all(|entry| entry.is_finite()).then_some(entries)
}

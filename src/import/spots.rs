//! Where access points, robots and tasks are to be.

use super::places::rounded;
use super::{Choices, MapPlaces, Plan, SkeletonError};

/// A place on a map.
#[derive(Clone, Debug, PartialEq)]
pub enum Spot {
    /// By its coordinates.
    At([f64; 2]),
    /// By the name that the map gives it.
    Named(String),
}

/// The places that are chosen, or else those that the map names; with as many digits as the outline has.
pub(super) struct Chosen {
    pub access_points: Vec<[f64; 2]>,
    pub robots: Vec<[f64; 2]>,
    pub near: Option<[f64; 2]>,
    pub tasks: Vec<[f64; 2]>,
}

impl Chosen {
    pub(super) fn of(plan: &Plan, choices: &Choices, extent: f64) -> Result<Self, SkeletonError> {
        let MapPlaces { access_points, robots, tasks, named } = &plan.places;
        let place = |spot: &Spot| match (plan.place(spot), spot) {
            (Some(place), _) => Ok(rounded(place, extent)),
            (None, Spot::At(place)) => Ok(*place),
            (None, Spot::Named(name)) => {
                let known: Vec<&str> = named.iter().map(|(name, _)| name.as_str()).collect();
                let known = match known[..] {
                    [] => "no point of the map has a name; places are stated as X,Y".to_owned(),
                    _ => format!("named are {}", known.join(", ")),
                };
                Err(SkeletonError::NoSuchPoint { name: name.clone(), known })
            }
        };
        let chosen = |spots: &[Spot], stated: &[[f64; 2]]| match spots {
            [] => Ok(stated.iter().map(|&place| rounded(place, extent)).collect()),
            spots => spots.iter().map(place).collect::<Result<Vec<_>, _>>(),
        };
        let near = choices.near.as_ref().map(place).transpose()?;
        Ok(Self {
            access_points: chosen(&choices.access_points, access_points)?,
            // Robots start where they are asked for, and not where the map says.
            robots: if near.is_some() { Vec::new() } else { chosen(&[], robots)? },
            near,
            tasks: chosen(&choices.tasks, tasks)?,
        })
    }
}

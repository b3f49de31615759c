//! What maps of polygons, lines and points show, by its properties.
//!
//! A property names a role by its value: `"type": "wall"`, `indoor=room`, the layer `WALLS` of a drawing. Values are
//! compared without regard to case. [`Reading::walls`] and [`Reading::floors`] come first.

use super::Reading;
use super::outline::Ring;
use std::collections::BTreeMap;

/// The properties by whose values a feature is recognised, the first that is there before the others.
const KINDS: [&str; 10] = [
    "kind",
    "indoor",
    "type",
    "feature",
    "feature_type",
    "class",
    "category",
    "barrier",
    "door",
    "layer",
];

/// Something that a map shows.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Feature {
    pub properties: BTreeMap<String, String>,
    pub shape: Shape,
}

#[derive(Clone, Debug, PartialEq)]
pub(super) enum Shape {
    /// Its boundary, then its holes.
    Polygon(Vec<Ring>),
    Line(Ring),
    Point([f64; 2]),
}

/// What a feature is for robots.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    Floor,
    /// Floor with walls around it, which are open at doors.
    Room,
    Wall,
    Door,
    AccessPoint,
    Robot,
    Task,
}

impl Role {
    /// Features in this role, in words.
    pub(super) const fn plural(self) -> &'static str {
        match self {
            Self::Floor => "floor",
            Self::Room => "rooms",
            Self::Wall => "walls",
            Self::Door => "doors",
            Self::AccessPoint => "access points",
            Self::Robot => "robots",
            Self::Task => "tasks",
        }
    }

    /// The role that a value of a property names.
    fn named(value: &str) -> Option<Self> {
        let value = value.to_lowercase();
        let has = |words: &[&str]| words.iter().any(|word| value.contains(word));
        match value.as_str() {
            "access_point" => Some(Self::AccessPoint),
            "robot" => Some(Self::Robot),
            "task" => Some(Self::Task),
            "room" => Some(Self::Room),
            _ if has(&["wall", "obstacle", "column", "pillar", "partition", "fence"]) => {
                Some(Self::Wall)
            }
            _ if has(&["door", "gate", "entrance", "opening"]) => Some(Self::Door),
            "area" | "hall" | "space" | "level" | "lobby" | "unit" => Some(Self::Floor),
            _ if has(&["floor", "corridor", "walkway", "footway", "walkable", "room"]) => {
                Some(Self::Floor)
            }
            _ => None,
        }
    }
}

impl Feature {
    /// The property that decides on the role, and the role if it names one.
    pub(super) fn role<'a>(
        &'a self,
        reading: &'a Reading,
    ) -> (Option<(&'a str, &'a str)>, Option<Role>) {
        for (chosen, role) in [(&reading.walls, Role::Wall), (&reading.floors, Role::Floor)] {
            let stated = chosen.iter().find(|(key, value)| self.properties.get(key) == Some(value));
            if let Some((key, value)) = stated {
                return (Some((key, value)), Some(role));
            }
        }
        let stated =
            KINDS.iter().filter_map(|key| Some((*key, self.properties.get(*key)?.as_str())));
        let mut stated = stated.filter(|(_, value)| !value.is_empty() && *value != "no").peekable();
        let first = stated.peek().copied();
        let mut named = stated.filter_map(|(key, value)| {
            // A door may be stated by its kind alone: door=hinged.
            let role = if key == "door" { Some(Role::Door) } else { Role::named(value) };
            // Layers of doors hold drawings of their leaves and how they swing.
            let role = role.filter(|role| !(key == "layer" && *role == Role::Door));
            role.map(|role| (Some((key, value)), Some(role)))
        });
        named.next().unwrap_or((first, None))
    }

    /// The width that it states, in metres.
    pub(super) fn width(&self) -> Option<f64> {
        let width = self.properties.get("width")?.trim_end_matches('m').trim().parse().ok()?;
        (width > 0.0 && width < f64::INFINITY).then_some(width)
    }
}

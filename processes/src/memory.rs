//! What a robot writes down: where it is, so that its process can be started again.
//!
//! The motion of a robot is simulated in its process, and the file stands for the body that stays
//! where it is when the process is killed. On a real robot localisation says where it is, and there
//! is nothing to write down.

use pleach::cli::status::Failure;
use serde::{Deserialize, Serialize};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// The contents of the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct State {
    /// The digest of the scenario.
    pub scenario: String,
    /// The number of the robot.
    pub robot: usize,
    /// Where it is.
    pub position: [f64; 2],
}

/// The file in which a robot writes down its state.
#[derive(Clone, Debug)]
pub struct Memory {
    path: PathBuf,
    state: State,
}

impl Memory {
    /// The memory in this file of a robot that would begin at `start`. If the file is there, it begins
    /// where the file says.
    ///
    /// # Errors
    /// The file cannot be read, or belongs to another robot or scenario.
    pub fn open(
        path: &Path,
        scenario: &str,
        robot: usize,
        start: [f64; 2],
    ) -> Result<Self, Failure> {
        let told = |what: String| Failure::Usage(format!("{}: {what}", path.display()));
        let state = State { scenario: scenario.into(), robot, position: start };
        let state = match fs::read_to_string(path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => state,
            Err(error) => return Err(told(format!("cannot be read: {error}"))),
            Ok(text) => {
                let read: State = serde_json::from_str(&text)
                    .map_err(|error| told(format!("is no state of a robot: {error}")))?;
                if (&read.scenario, read.robot) != (&state.scenario, robot) {
                    let State { scenario, robot, .. } = read;
                    let whose = format!("robot {robot} in the scenario {scenario}");
                    let remedy = "choose another file, or remove it";
                    return Err(told(format!("holds the state of {whose}; {remedy}")));
                }
                if !read.position.iter().all(|number| number.is_finite()) {
                    return Err(told("holds a position that is not finite; remove it".into()));
                }
                read
            }
        };
        Ok(Memory { path: path.to_owned(), state })
    }

    /// Where the robot is.
    pub const fn position(&self) -> [f64; 2] {
        self.state.position
    }

    /// Writes down where the robot is, at once or not at all.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(&mut self, position: [f64; 2]) -> io::Result<()> {
        self.state.position = position;
        let beside = self.beside();
        fs::write(&beside, serde_json::to_string(&self.state)?)?;
        fs::rename(&beside, &self.path)
    }

    /// Where the next state is written before it takes the place of the last one: `3.json.new`, since
    /// the files of other robots may differ from this one in their extension only.
    fn beside(&self) -> PathBuf {
        self.path.with_added_extension("new")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_state_is_read_back_by_the_same_robot_only() {
        let folder = std::env::temp_dir().join(format!("pleach-memory-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let path = folder.join("3.json");
        let mut memory = Memory::open(&path, "abc", 3, [0.5, 0.5]).unwrap();
        assert_eq!(memory.position(), [0.5, 0.5]);
        memory.write([0.1 + 0.2, -1e-300]).unwrap();
        let again = Memory::open(&path, "abc", 3, [0.0, 0.0]).unwrap();
        assert_eq!(again.position(), [0.1 + 0.2, -1e-300]);
        assert!(Memory::open(&path, "abc", 4, [0.0, 0.0]).is_err());
        assert!(Memory::open(&path, "abd", 3, [0.0, 0.0]).is_err());
        fs::write(&path, "{").unwrap();
        assert!(Memory::open(&path, "abc", 3, [0.0, 0.0]).is_err());
        fs::remove_dir_all(&folder).unwrap();
    }

    #[test]
    fn files_that_differ_in_their_extension_are_written_apart() {
        let memory = |name: &str| Memory::open(Path::new(name), "abc", 3, [0.0, 0.0]).unwrap();
        let [one, other] = ["run/state.0", "run/state.1"].map(|name| memory(name).beside());
        assert_eq!(one, Path::new("run/state.0.new"));
        assert_eq!(other, Path::new("run/state.1.new"));
    }
}

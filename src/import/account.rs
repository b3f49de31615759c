//! How much of the floor of a map becomes floor of the plan.

use crate::figures::quantity;
use std::fmt::{self, Display};

/// The floor of a map before and after its import.
#[derive(Clone, Debug, PartialEq)]
pub struct Account {
    /// The area that the map states as floor.
    pub stated: f64,
    /// What of it is in separate pieces, which are left out.
    pub in_pieces: f64,
    /// What of it lies between the walls of the map and the smoother ones of the plan.
    pub smoothed: f64,
    /// The unit of area: "free cells" or "square units".
    pub unit: &'static str,
}

impl Account {
    /// The share of the floor that is lost, 0 to 1.
    pub fn lost(&self) -> f64 {
        self.share(self.in_pieces + self.smoothed)
    }

    fn share(&self, area: f64) -> f64 {
        if self.stated > 0.0 { area / self.stated } else { 0.0 }
    }

    /// The account, or an error if more is lost than is accepted.
    pub(super) fn accepted(self, largest_loss: f64) -> Result<Self, String> {
        // What is accepted is stated in whole tenths of a percent.
        match self.lost() <= largest_loss + 5e-4 {
            true => Ok(self),
            false => Err(format!(
                "{self}; give --accept-loss {} if that is right",
                (1e3 * self.lost()).ceil() / 10.0
            )),
        }
    }
}

impl Display for Account {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { stated, in_pieces, smoothed, unit } = self;
        let kept = stated - in_pieces - smoothed;
        let [kept, stated] = [kept, *stated].map(|area| match *unit {
            CELLS => format!("{area:.0}"),
            _ => quantity(area),
        });
        write!(f, "{kept} of {stated} {unit} become floor: {} lost", percent(self.lost()))?;
        let parts = [(*in_pieces, "in separate pieces of floor"), (*smoothed, "to smoother walls")];
        let parts = parts.into_iter().filter(|(area, _)| self.share(*area) >= 5e-5);
        let parts: Vec<String> =
            parts.map(|(area, what)| format!("{} {what}", percent(self.share(area)))).collect();
        if parts.is_empty() { Ok(()) } else { write!(f, " ({})", parts.join(", ")) }
    }
}

/// The unit of maps of cells.
pub(super) const CELLS: &str = "free cells";

/// A share in percent.
pub(super) fn percent(share: f64) -> String {
    match 100.0 * share {
        0.0 => "0 %".into(),
        percent if percent < 0.01 => "less than 0.01 %".into(),
        percent if percent < 1.0 => format!("{percent:.2} %"),
        percent => format!("{percent:.1} %"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_loss_above_what_is_accepted_says_what_would_accept_it() {
        let account = Account { stated: 808.0, in_pieces: 759.0, smoothed: 0.5, unit: CELLS };
        let error = account.clone().accepted(0.02).unwrap_err();
        assert_eq!(
            error,
            "48 of 808 free cells become floor: 94.0 % lost (93.9 % in separate pieces of floor, 0.06 % to smoother \
             walls); give --accept-loss 94 if that is right"
        );
        assert_eq!(account.clone().accepted(0.94), Ok(account));
        let whole = Account { stated: 2.5, in_pieces: 0.0, smoothed: 0.0, unit: "square units" };
        assert_eq!(whole.to_string(), "2.5 of 2.5 square units become floor: 0 % lost");
    }
}

//! No crossing is missed, and none is seen twice.

use super::*;

/// Any four margins, infinite ones and NaN among them: crossings alternate between rising and
/// falling, and the last one tells on which side the last margin is.
#[kani::proof]
#[kani::unwind(5)]
fn crossings_alternate() {
    let margins: [f64; 4] = kani::any();
    let mut side = margins[0] >= 0.0;
    for (before, after) in [(0, 1), (1, 2), (2, 3)] {
        match Crossing::between_margins(margins[before], margins[after]) {
            Crossing::Rising => {
                kani::cover!();
                assert!(!side);
                side = true;
            }
            Crossing::Falling => {
                kani::cover!();
                assert!(side);
                side = false;
            }
            Crossing::None => {}
        }
    }
    kani::cover!(margins[0] < 0.0 && margins[1] == 0.0 && margins[2] < 0.0 && margins[3] == 0.0);
    assert!(side == (margins[3] >= 0.0));
}

/// Any two thresholds and margins: a switch is on above the band and off below it, whatever it was
/// before; within the band it stays as it is. Thresholds in the wrong order are refused.
#[kani::proof]
#[kani::unwind(2)]
fn a_switch_keeps_its_state_within_the_band_only() {
    let (release, engage, margin): (f64, f64, f64) = (kani::any(), kani::any(), kani::any());
    let was_on = kani::any();
    let band = Hysteresis::new(release, engage);
    assert!(band.is_ok() == (release <= engage));
    if let Ok(band) = band {
        let is_on = band.update(was_on, margin);
        kani::cover!(is_on && margin < engage);
        if margin >= engage {
            kani::cover!(!was_on);
            assert!(is_on);
        } else if margin >= release {
            kani::cover!(is_on);
            assert!(is_on == was_on);
        } else {
            kani::cover!(was_on);
            assert!(!is_on);
        }
    }
}

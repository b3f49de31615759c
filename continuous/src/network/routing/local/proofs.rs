//! The local minimiser is feasible.

use super::*;

/// Any number, also one that is none: its positive part is a share that may be given.
#[kani::proof]
#[kani::unwind(2)]
fn a_positive_part_is_never_negative() {
    let number: f64 = kani::any();
    let part = positive_part(number);
    kani::cover!(number.is_nan());
    kani::cover!(number == f64::INFINITY);
    assert!(part >= 0.0);
    assert!(part == if number > 0.0 { number } else { 0.0 });
}

/// How dear the robot and its neighbours are.
const MULTIPLIERS: [f64; 4] = [0.0, 1.0, 2.0, 8.0];

/// μ_i and the shares of a robot that is dear, with two links of reliability 1 and ½ to neighbours
/// of the given multipliers.
fn answer(one: f64, other: f64) -> (f64, [f64; 2]) {
    let links = [
        LinkOffer { reliability: 1.0, weight: 1.0, neighbour_multiplier: one },
        LinkOffer { reliability: 0.5, weight: 2.0, neighbour_multiplier: other },
    ];
    let price = budget_price(4.0, &links, 1.0);
    (price, [share(&links[0], 4.0, price), share(&links[1], 4.0, price)])
}

/// Two links with fixed reliabilities and weights, neighbours of any two of four multipliers: the
/// shares are feasible, and time has a price only if it is used up, which is complementary
/// slackness. With that and stationarity, which the closed form is, they are optimal.
///
/// All numbers are exact in binary. For other links, `meets_the_optimality_conditions`.
#[kani::proof]
#[kani::unwind(6)]
fn the_local_minimiser_is_feasible_and_pays_for_used_time_only() {
    let mut answers = [[(0.0, [0.0; 2]); 4]; 4];
    for (one, row) in answers.iter_mut().enumerate() {
        for (other, cell) in row.iter_mut().enumerate() {
            *cell = answer(MULTIPLIERS[one], MULTIPLIERS[other]);
        }
    }
    let (one, other): (u8, u8) =
        (kani::any_where(|one| *one < 4), kani::any_where(|other| *other < 4));
    let (price, shares) = answers[usize::from(one)][usize::from(other)];
    kani::cover!(price > 0.0 && shares[1] > 0.0);
    kani::cover!(price == 0.0 && shares[0] == 0.0);
    assert!(is_feasible(&shares, 1.0, 0.0));
    assert!(price == 0.0 || price > 0.0 && shares[0] + shares[1] == 1.0);
}

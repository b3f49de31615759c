//! The coefficients of Dormand and Prince's method of order 8.
//!
//! The triple of orders 8, 5 and 3 with a continuous extension of order 7, by E. Hairer, S. P.
//! Nørsett and G. Wanner, *Solving Ordinary Differential Equations I*, 2nd ed., section II.10,
//! doi:10.1007/978-3-540-78862-1, after P. J. Prince and J. R. Dormand, "High order embedded
//! Runge–Kutta formulae", *Journal of Computational and Applied Mathematics* 7 (1981),
//! doi:10.1016/0771-050X(81)90010-3. Twelve stages; a thirteenth is evaluated at the end of the step
//! and so is the first of the next one. Three more give the extension.

/// Where in the step stages 2 to 11 are evaluated, as fractions of it; 12 and 13 are at its end.
pub(super) const NODES: [f64; 10] = [
    0.05260015195876773,
    0.0789002279381516,
    0.1183503419072274,
    0.2816496580927726,
    0.3333333333333333,
    0.25,
    0.3076923076923077,
    0.6512820512820513,
    0.6,
    0.8571428571428571,
];

/// Where stages 14 to 16 are evaluated.
pub(super) const NODES_INSIDE: [f64; 3] = [1.0 / 10.0, 2.0 / 10.0, 7.0 / 9.0];

// The weights of earlier stages in the state at which a stage is evaluated; those not listed are 0.

/// Of stage 1.
pub(super) const SECOND: [f64; 1] = [0.05260015195876773];
/// Of stages 1, 2.
pub(super) const THIRD: [f64; 2] = [0.0197250569845379, 0.0591751709536137];
/// Of stages 1, 3.
pub(super) const FOURTH: [f64; 2] = [0.02958758547680685, 0.08876275643042054];
/// Of stages 1, 3, 4.
pub(super) const FIFTH: [f64; 3] = [0.2413651341592667, -0.8845494793282861, 0.924834003261792];
/// Of stages 1, 4, 5.
pub(super) const SIXTH: [f64; 3] = [0.037037037037037035, 0.17082860872947386, 0.12546768756682242];
/// Of stages 1, 4, 5, 6.
pub(super) const SEVENTH: [f64; 4] =
    [0.037109375, 0.17025221101954405, 0.06021653898045596, -0.017578125];
/// Of stages 1, 4, 5, 6, 7.
pub(super) const EIGHTH: [f64; 5] = [
    0.03709200011850479,
    0.17038392571223998,
    0.10726203044637328,
    -0.015319437748624402,
    0.008273789163814023,
];
/// Of stages 1, 4, 5, 6, 7, 8.
pub(super) const NINTH: [f64; 6] = [
    0.6241109587160757,
    -3.3608926294469414,
    -0.868219346841726,
    27.59209969944671,
    20.154067550477894,
    -43.48988418106996,
];
/// Of stages 1, 4, 5, 6, 7, 8, 9.
pub(super) const TENTH: [f64; 7] = [
    0.47766253643826434,
    -2.4881146199716677,
    -0.590290826836843,
    21.230051448181193,
    15.279233632882423,
    -33.28821096898486,
    -0.020331201708508627,
];
/// Of stages 1, 4, 5, 6, 7, 8, 9, 10.
pub(super) const ELEVENTH: [f64; 8] = [
    -0.9371424300859873,
    5.186372428844064,
    1.0914373489967295,
    -8.149787010746927,
    -18.52006565999696,
    22.739487099350505,
    2.4936055526796523,
    -3.0467644718982196,
];
/// Of stages 1, 4, 5, 6, 7, 8, 9, 10, 11.
pub(super) const TWELFTH: [f64; 9] = [
    2.273310147516538,
    -10.53449546673725,
    -2.0008720582248625,
    -17.9589318631188,
    27.94888452941996,
    -2.8589982771350235,
    -8.87285693353063,
    12.360567175794303,
    0.6433927460157636,
];
/// Of stages 1, 7, 8, 9, 10, 11, 12, 13.
pub(super) const FOURTEENTH: [f64; 8] = [
    0.056167502283047954,
    0.25350021021662483,
    -0.2462390374708025,
    -0.12419142326381637,
    0.15329179827876568,
    0.00820105229563469,
    0.007567897660545699,
    -0.008298,
];
/// Of stages 1, 6, 7, 8, 11, 12, 13, 14.
pub(super) const FIFTEENTH: [f64; 8] = [
    0.03183464816350214,
    0.028300909672366776,
    0.053541988307438566,
    -0.05492374857139099,
    -0.00010834732869724932,
    0.0003825710908356584,
    -0.00034046500868740456,
    0.1413124436746325,
];
/// Of stages 1, 6, 7, 8, 9, 13, 14, 15.
pub(super) const SIXTEENTH: [f64; 8] = [
    -0.42889630158379194,
    -4.697621415361164,
    7.683421196062599,
    4.06898981839711,
    0.3567271874552811,
    -0.0013990241651590145,
    2.9475147891527724,
    -9.15095847217987,
];

/// The weights of stages 1 and 6 to 12 in the solution of order 8.
pub(super) const SOLUTION: [f64; 8] = [
    0.054293734116568765,
    4.450312892752409,
    1.8915178993145003,
    -5.801203960010585,
    0.3111643669578199,
    -0.1521609496625161,
    0.20136540080403034,
    0.04471061572777259,
];

/// The weights of stages 1 and 6 to 12 in its difference from a solution of order 5.
pub(super) const FIFTH_ORDER_ERROR: [f64; 8] = [
    0.01312004499419488,
    -1.2251564463762044,
    -0.4957589496572502,
    1.6643771824549864,
    -0.35032884874997366,
    0.3341791187130175,
    0.08192320648511571,
    -0.022355307863886294,
];

/// The weights of stages 1, 9 and 12 in a solution of order 3.
pub(super) const THIRD_ORDER: [f64; 3] =
    [0.2440944881889764, 0.7338466882816118, 0.022058823529411766];

/// The weights of stages 1 and 6 to 16 in the terms of the extension from the fourth power on.
pub(super) const EXTENSION: [[f64; 12]; 4] = [
    [
        -8.428938276109013,
        0.5667149535193777,
        -3.0689499459498917,
        2.38466765651207,
        2.117034582445028,
        -0.871391583777973,
        2.2404374302607883,
        0.6315787787694688,
        -0.08899033645133331,
        18.148505520854727,
        -9.194632392478356,
        -4.436036387594894,
    ],
    [
        10.427508642579134,
        242.28349177525817,
        165.20045171727028,
        -374.5467547226902,
        -22.113666853125306,
        7.733432668472264,
        -30.674084731089398,
        -9.332130526430229,
        15.697238121770845,
        -31.139403219565178,
        -9.35292435884448,
        35.81684148639408,
    ],
    [
        19.985053242002433,
        -387.0373087493518,
        -189.17813819516758,
        527.8081592054236,
        -11.57390253995963,
        6.8812326946963,
        -1.0006050966910838,
        0.7777137798053443,
        -2.778205752353508,
        -60.19669523126412,
        84.32040550667716,
        11.99229113618279,
    ],
    [
        -25.69393346270375,
        -154.18974869023643,
        -231.5293791760455,
        357.6391179106141,
        93.40532418362432,
        -37.45832313645163,
        104.0996495089623,
        29.8402934266605,
        -43.53345659001114,
        96.32455395918828,
        -39.17726167561544,
        -149.72683625798564,
    ],
];

/// target = base + step · Σ weight · stage.
#[inline]
pub(super) fn combine<const N: usize>(
    target: &mut [f64],
    base: &[f64],
    step: f64,
    weights: [f64; N],
    stages: [&[f64]; N],
) {
    let weights = weights.map(|weight| step * weight);
    let dimension = target.len();
    let (base, stages) = (&base[..dimension], cut(stages, dimension));
    for i in 0..dimension {
        let mut sum = 0.0;
        for stage in 0..N {
            sum += weights[stage] * stages[stage][i];
        }
        target[i] = base[i] + sum;
    }
}

/// targets = step · Σ weight · (stage − first stage), for weights that sum to 0: of straight motion
/// they are exactly 0. Says whether all of them are finite.
#[inline]
pub(super) fn combine_differences<const M: usize, const N: usize>(
    mut targets: [&mut [f64]; M],
    step: f64,
    weights: [[f64; N]; M],
    stages: [&[f64]; N],
) -> bool {
    let dimension = stages[0].len();
    let stages = cut(stages, dimension);
    // It stays 0 while everything is finite.
    let mut trace = 0.0;
    let mut place = 0;
    while place + LANES <= dimension {
        trace += combine_in_lanes::<LANES, M, N>(&mut targets, place, step, &weights, &stages);
        place += LANES;
    }
    while place < dimension {
        trace += combine_in_lanes::<1, M, N>(&mut targets, place, step, &weights, &stages);
        place += 1;
    }
    trace == 0.0
}

/// How many components are combined at once: what is read of them is used for all targets.
const LANES: usize = 4;

/// Combines the components from `place` on; 0 if all are finite.
#[inline]
fn combine_in_lanes<const WIDTH: usize, const M: usize, const N: usize>(
    targets: &mut [&mut [f64]; M],
    place: usize,
    step: f64,
    weights: &[[f64; N]; M],
    stages: &[&[f64]; N],
) -> f64 {
    let row = |stage: usize| -> [f64; WIDTH] {
        let row = &stages[stage][place..place + WIDTH];
        std::array::from_fn(|lane| row[lane])
    };
    let (first, mut sums) = (row(0), [[0.0; WIDTH]; M]);
    for stage in 1..N {
        let row = row(stage);
        let differences: [f64; WIDTH] = std::array::from_fn(|lane| row[lane] - first[lane]);
        for (sums, weights) in sums.iter_mut().zip(weights) {
            for (sum, difference) in sums.iter_mut().zip(differences) {
                *sum += weights[stage] * difference;
            }
        }
    }
    let mut trace = 0.0;
    for (target, sums) in targets.iter_mut().zip(sums) {
        let results: [f64; WIDTH] = std::array::from_fn(|lane| step * sums[lane]);
        target[place..place + WIDTH].copy_from_slice(&results);
        trace += 0.0 * results.iter().sum::<f64>();
    }
    trace
}

/// Slices of one known length: a loop over them has no bounds to check.
#[inline]
pub(super) fn cut<const N: usize>(mut stages: [&[f64]; N], dimension: usize) -> [&[f64]; N] {
    for stage in &mut stages {
        *stage = &stage[..dimension];
    }
    stages
}

#[cfg(test)]
mod tests {
    use super::*;

    fn assert_sum(weights: &[f64], expected: f64) {
        let sum: f64 = weights.iter().sum();
        let size = weights.iter().fold(1.0, |size: f64, weight| size.max(weight.abs()));
        assert!((sum - expected).abs() < 1e-14 * size, "{weights:?} sums to {sum}, not {expected}");
    }

    #[test]
    fn weights_of_a_stage_sum_to_its_node() {
        let rows: [&[f64]; 10] = [
            &SECOND, &THIRD, &FOURTH, &FIFTH, &SIXTH, &SEVENTH, &EIGHTH, &NINTH, &TENTH, &ELEVENTH,
        ];
        for (weights, node) in rows.into_iter().zip(NODES) {
            assert_sum(weights, node);
        }
        let inside: [&[f64]; 3] = [&FOURTEENTH, &FIFTEENTH, &SIXTEENTH];
        for (weights, node) in inside.into_iter().zip(NODES_INSIDE) {
            assert_sum(weights, node);
        }
        for weights in [&TWELFTH[..], &SOLUTION, &THIRD_ORDER] {
            assert_sum(weights, 1.0);
        }
        assert_sum(&FIFTH_ORDER_ERROR, 0.0);
        EXTENSION.iter().for_each(|weights| assert_sum(weights, 0.0));
    }
}

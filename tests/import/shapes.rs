//! What the oracles of the import share: rings, labels, dice.

/// Random numbers: a linear congruential generator (Knuth's MMIX).
pub struct Dice(u64);

impl Dice {
    pub fn new(seed: u64) -> Self {
        let mut dice = Self(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) ^ 0x5851_f42d);
        for _ in 0..8 {
            dice.next();
        }
        dice
    }

    fn next(&mut self) -> u64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        self.0 >> 33
    }

    pub fn below(&mut self, count: usize) -> usize {
        self.next() as usize % count
    }

    /// From 0 to 1.
    pub fn unit(&mut self) -> f64 {
        self.next() as f64 / (1_u64 << 31) as f64
    }
}

/// The area within a ring.
#[allow(clippy::ptr_arg)] // it is mapped over rings
pub fn area(ring: &Vec<[f64; 2]>) -> f64 {
    let sides = ring.iter().zip(ring.iter().cycle().skip(1));
    (sides.map(|(a, b)| a[0] * b[1] - b[0] * a[1]).sum::<f64>() / 2.0).abs()
}

/// Whether a place is within an odd number of rings.
pub fn is_inside(rings: &[&Vec<[f64; 2]>], [x, y]: [f64; 2]) -> bool {
    let sides = rings.iter().flat_map(|ring| ring.iter().zip(ring.iter().cycle().skip(1)));
    let crossings = sides.filter(|(a, b)| {
        (a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0])
    });
    crossings.count() % 2 == 1
}

pub fn distance([x, y]: [f64; 2], [a, b]: [[f64; 2]; 2]) -> f64 {
    let [across, up] = [b[0] - a[0], b[1] - a[1]];
    let along = ((x - a[0]) * across + (y - a[1]) * up) / (across * across + up * up);
    let along = along.clamp(0.0, 1.0);
    (x - a[0] - along * across).hypot(y - a[1] - along * up)
}

/// The connected pieces of what is true, by number; also over corners or not.
pub fn label(is_there: &[bool], width: usize, over_corners: bool) -> Vec<Option<usize>> {
    let mut labels = vec![None; is_there.len()];
    let (columns, rows) = (width as isize, (is_there.len() / width) as isize);
    let mut pieces = 0;
    for start in (0..is_there.len()).filter(|&start| is_there[start]) {
        if labels[start].is_some() {
            continue;
        }
        labels[start] = Some(pieces);
        let mut waiting = vec![start];
        while let Some(point) = waiting.pop() {
            let (column, row) = ((point % width) as isize, (point / width) as isize);
            for (right, up) in (-1..=1).flat_map(|up| (-1..=1).map(move |right| (right, up))) {
                let (x, y) = (column + right, row + up);
                let is_next = over_corners || right == 0 || up == 0;
                if is_next && (0..columns).contains(&x) && (0..rows).contains(&y) {
                    let next = (y * columns + x) as usize;
                    if is_there[next] && labels[next].is_none() {
                        labels[next] = Some(pieces);
                        waiting.push(next);
                    }
                }
            }
        }
        pieces += 1;
    }
    labels
}

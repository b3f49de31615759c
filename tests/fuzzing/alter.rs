//! Random changes of a text.

/// Words and numbers that a reader may meet where it does not expect them.
const SCRAPS: [&str; 40] = [
    "0",
    "-0",
    "1",
    "-1",
    "1e305",
    "-1e305",
    "1e-320",
    "9e18",
    "1e19",
    "18446744073709551616",
    "4294967296",
    "nan",
    "inf",
    "-inf",
    "+",
    "-",
    "*",
    "/",
    "^",
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    "\"",
    "'",
    "`",
    "=",
    ",",
    ".",
    "\n",
    "\t",
    "\\",
    "null",
    "true",
    "∞",
    "⁻²",
    "√",
    "\u{0}",
];

/// SplitMix64 (doi:10.1145/2660193.2660195).
struct Dice(u64);

impl Dice {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut mixed = self.0;
        mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// A number below `end`, or 0.
    fn below(&mut self, end: usize) -> usize {
        if end == 0 { 0 } else { (self.next() % end as u64) as usize }
    }

    /// A stretch of `length` things, short ones more often.
    fn stretch(&mut self, length: usize) -> std::ops::Range<usize> {
        let begin = self.below(length + 1);
        let most = 1 << self.below(8);
        begin..(begin + self.below(most) + 1).min(length)
    }
}

/// One of the samples, changed as the seeds say.
pub fn alter(samples: &[String], seeds: &[u64]) -> String {
    let mut dice = Dice(0);
    for seed in seeds {
        dice.0 ^= seed.wrapping_mul(0xff51_afd7_ed55_8ccd);
        dice.0 = dice.next();
    }
    let sample = &samples[dice.below(samples.len())];
    let mut text: Vec<char> = sample.chars().collect();
    for _ in 0..=dice.below(4) {
        change(&mut text, &mut dice);
    }
    text.into_iter().collect()
}

fn change(text: &mut Vec<char>, dice: &mut Dice) {
    let stretch = dice.stretch(text.len());
    match dice.below(7) {
        0 => drop(text.drain(stretch)),
        1 => {
            let part: Vec<char> = text[stretch.clone()].to_vec();
            text.splice(stretch.start..stretch.start, part);
        }
        2 => {
            let part: Vec<char> = text.drain(stretch).collect();
            let at = dice.below(text.len() + 1);
            text.splice(at..at, part);
        }
        3 => text.truncate(stretch.start),
        4 => replace_number(text, stretch.start, dice),
        5 => {
            if let Some(character) = text.get_mut(stretch.start) {
                *character = char::from((32 + dice.below(95)) as u8);
            }
        }
        _ => {
            let scrap = SCRAPS[dice.below(SCRAPS.len())];
            text.splice(stretch, scrap.chars());
        }
    }
}

/// The number behind a place becomes another.
fn replace_number(text: &mut Vec<char>, from: usize, dice: &mut Dice) {
    let is_part = |character: &char| character.is_ascii_digit() || ".e-".contains(*character);
    let Some(begin) = text.iter().skip(from).position(char::is_ascii_digit) else { return };
    let begin = from + begin;
    let length = text[begin..].iter().take_while(|character| is_part(character)).count();
    let scrap = SCRAPS[dice.below(14)];
    text.splice(begin..begin + length, scrap.chars());
}

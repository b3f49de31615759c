
/// Which mutant is switched on: the number in `MUTANT`, or none. If `MUTANTS_REACHED` names a file, the
/// mutants that are reached are written there.
#[doc(hidden)]
#[allow(missing_docs, clippy::all)]
pub mod mutant_switches {
    use std::io::Write;
    use std::sync::atomic::{AtomicBool, AtomicU32, Ordering::Relaxed};

    const UNREAD: u32 = u32::MAX;
    const RECORDING: u32 = u32::MAX - 1;
    static CHOSEN: AtomicU32 = AtomicU32::new(UNREAD);
    static REACHED: [AtomicBool; 1 << 16] = [const { AtomicBool::new(false) }; 1 << 16];

    #[inline(always)]
    pub fn is(number: u32) -> bool {
        let chosen = CHOSEN.load(Relaxed);
        if chosen >= RECORDING {
            return read(&[number]) == number;
        }
        chosen == number
    }

    #[inline(always)]
    pub fn none(numbers: &[u32]) -> bool {
        let chosen = CHOSEN.load(Relaxed);
        if chosen >= RECORDING {
            return !numbers.contains(&read(numbers));
        }
        !numbers.contains(&chosen)
    }

    #[cold]
    fn read(numbers: &[u32]) -> u32 {
        if CHOSEN.load(Relaxed) == UNREAD {
            let number = std::env::var("MUTANT").ok().and_then(|text| text.parse().ok());
            let recording = std::env::var_os("MUTANTS_REACHED").is_some();
            CHOSEN.store(number.unwrap_or(if recording { RECORDING } else { 0 }), Relaxed);
        }
        let chosen = CHOSEN.load(Relaxed);
        if chosen == RECORDING {
            record(numbers);
            return 0;
        }
        chosen
    }

    fn record(numbers: &[u32]) {
        for number in numbers {
            if REACHED[*number as usize].swap(true, Relaxed) {
                continue;
            }
            let file = std::env::var_os("MUTANTS_REACHED").expect("it names a file");
            let mut file = std::fs::OpenOptions::new().append(true).create(true).open(file).expect("it is written");
            file.write_all(format!("{number}\n").as_bytes()).expect("it is written");
        }
    }
}

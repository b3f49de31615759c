//! Processor time and memory of this process.

use std::fs;
use std::hint::black_box;
use std::time::Duration;

use rustix::time::{ClockId, clock_gettime};

/// The time for which processors have worked for this process: what else runs on the machine does not count.
pub fn processor_time() -> Duration {
    clock_gettime(ClockId::ProcessCPUTime).try_into().unwrap_or_default()
}

/// The result of some work, and the processor time of it.
pub fn timed<T>(work: impl FnOnce() -> T) -> (T, Duration) {
    let begin = processor_time();
    let result = black_box(work());
    (result, processor_time() - begin)
}

/// The shortest of several times, of which the first warms up.
pub fn fastest<T>(times: usize, mut run: impl FnMut() -> T) -> Duration {
    (0..times).map(|_| timed(&mut run).1).min().unwrap_or_default()
}

/// The shortest of several times of each of some things, which take turns.
pub fn fastest_in_turn<T>(
    rounds: usize,
    count: usize,
    mut run: impl FnMut(usize) -> T,
) -> Vec<Duration> {
    let mut shortest = vec![Duration::MAX; count];
    for _ in 0..rounds {
        for (number, shortest) in shortest.iter_mut().enumerate() {
            *shortest = (*shortest).min(fastest(4, || run(number)));
        }
    }
    shortest
}

pub fn ratio(one: Duration, other: Duration) -> f64 {
    one.as_secs_f64() / other.as_secs_f64()
}

/// The most memory that the process has at a time during some work, in bytes, where Linux says it.
pub fn peak_of<T>(work: impl FnOnce() -> T) -> Option<u64> {
    // The peak begins anew.
    fs::write("/proc/self/clear_refs", "5").ok()?;
    black_box(work());
    let status = fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find_map(|line| line.strip_prefix("VmHWM:"))?;
    let kibibytes: u64 = line.trim().strip_suffix(" kB")?.trim().parse().ok()?;
    Some(1024 * kibibytes)
}

//! Work on several threads at once.

use std::sync::{LazyLock, Mutex, PoisonError};
use std::thread;

/// Does each of these pieces of work once, on as many threads as given; a thread that is done with one takes the next
/// that is left.
pub(crate) fn for_each<T>(
    threads: usize,
    pieces: impl IntoIterator<Item = T, IntoIter: Send>,
    work: impl Fn(T) + Sync,
) {
    let left = Mutex::new(pieces.into_iter());
    let next = || left.lock().unwrap_or_else(PoisonError::into_inner).next();
    let work_through = || std::iter::from_fn(next).for_each(&work);
    thread::scope(|scope| {
        for _ in 1..threads {
            // Where the system gives no more threads, those that there are do the work.
            if thread::Builder::new().spawn_scoped(scope, work_through).is_err() {
                break;
            }
        }
        work_through();
    });
}

/// How many threads can run at once here. The system is asked once.
pub(crate) fn threads() -> usize {
    static THREADS: LazyLock<usize> =
        LazyLock::new(|| thread::available_parallelism().map_or(1, usize::from));
    *THREADS
}

//! Many runs at once: parameter studies on all processors.

use std::sync::{Mutex, PoisonError};

use crate::parallel::{for_each, threads};

/// What `run` makes of each case, in the order of the cases, whatever the number of threads.
///
/// `progress` is told after each case how many are done, and of how many; it may be called from
/// several threads, one at a time.
///
/// ```
/// use pleach_automaton::{Automaton, coordinates, from, sweep};
/// use pleach_discrete::vocabulary;
/// use pleach_guards::variable;
///
/// vocabulary! {
///     enum Motion: Location { Falling = "falling" }
///     enum Contact: Event { Bounce = "bounce" }
/// }
/// coordinates! { struct Ball { h, v } }
/// let Ball { h, v } = Ball::coordinates();
/// let restitution = variable("e");
/// let ball = Automaton::starting_in(Motion::Falling)
///     .initially(Ball { h: 10.0, v: 0.0 })
///     .parameter("e", 0.8)
///     .flow(Motion::Falling, [h.rate(&v), v.rate(-9.81)])
///     .transition(
///         from(Motion::Falling)
///             .on(Contact::Bounce)
///             .to(Motion::Falling)
///             .must(h.at_most(0.0) & v.less_than(0.0))
///             .then(v.becomes(-restitution * &v)),
///     )
///     .build()?;
///
/// let jumps = sweep(&[0.25, 0.5, 0.75], |_, _| (), |e| {
///     let trajectory = ball.with("e", *e).map(|ball| ball.run(2.0));
///     trajectory.ok().and_then(Result::ok).map(|trajectory| trajectory.jumps()[0].at.t)
/// });
/// assert_eq!(jumps[0], jumps[2]);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn sweep<T: Sync, R: Send>(
    cases: &[T],
    mut progress: impl FnMut(usize, usize) + Send,
    run: impl Fn(&T) -> R + Sync,
) -> Vec<R> {
    let done = Mutex::new((Vec::with_capacity(cases.len()), &mut progress));
    for_each(threads().min(cases.len()), cases.iter().enumerate(), |(number, case)| {
        let result = run(case);
        // A panic in `run` ends the sweep; what others have added is whole.
        let mut done = done.lock().unwrap_or_else(PoisonError::into_inner);
        let (results, progress) = &mut *done;
        results.push((number, result));
        progress(results.len(), cases.len());
    });
    let (mut results, _) = done.into_inner().unwrap_or_else(PoisonError::into_inner);
    results.sort_by_key(|(number, _)| *number);
    results.into_iter().map(|(_, result)| result).collect()
}

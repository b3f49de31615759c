"""Events and sampled control by `solve_ivp` of SciPy: the rows of `src/loops`, with the same models.

    python3 benches/peers/solve_ivp.py

prints of each row its name, how many events or ticks there were, the processor time of one of them in microseconds
(the shortest of some runs, after one to warm up), and what the run ends with: the instant of the last event, or where
the plant is.
"""

import math
import time
from collections import deque

from scipy.integrate import solve_ivp

TOLERANCE = 1e-9
EVENTS = 128
TICKS = 512
RUNS = 10


def integrate(field, times, state, event=None):
    return solve_ivp(field, times, state, method="RK45", rtol=TOLERANCE, atol=TOLERANCE, events=event)


def impacts(field, margin, reset, start):
    """Resets the state where a margin falls through zero; the instant of the last time."""

    def event(t, x):
        return margin(x)

    event.terminal, event.direction = True, -1
    now, state = 0.0, start
    for _ in range(EVENTS):
        solution = integrate(field, (now, math.inf), state, event)
        now, state = solution.t_events[0][0], reset(solution.y_events[0][0])
    return now


PERIOD, DELAY, TARGET = 1 / 1024, 0.025, 1.0


def sampled(acceleration, is_delayed):
    """Samples a controller; where the plant is at the end."""
    state, force, integral, output = [0.0, 0.0], 0.0, 0.0, 0.0
    under_way = deque()

    def advance(state, start, end):
        def field(t, x):
            return [x[1], acceleration(*x) + force]

        return integrate(field, (start, end), state).y[:, -1]

    for tick in range(TICKS):
        now, following = PERIOD * tick, PERIOD * (tick + 1)
        if is_delayed:
            under_way.append((now + DELAY, output))
        error = TARGET - state[0]
        wanted = 4 * error + integral - 2 * state[1]
        output = min(max(wanted, -5), 5)
        integral += PERIOD * (2 * error + (output - wanted))
        if not is_delayed:
            force = output
        while under_way and under_way[0][0] < following:
            arrival, message = under_way.popleft()
            state = advance(state, now, arrival)
            now, force = arrival, message
        state = advance(state, now, following)
    return state[0]


def servo(x, v):
    return -x - 0.5 * v


def pendulum(x, v):
    return -math.sin(x) - 0.5 * v


def bounce(x):
    return [0.0, -x[1]]


def height(x):
    return x[0]


def to_switch(x):
    return 22 - x[0] if x[1] > 0.5 else x[0] - 18


ROWS = [
    ("bounce of a ball", EVENTS, lambda: impacts(lambda t, x: [x[1], -2.0], height, bounce, [1.0, 0.0])),
    (
        "kick of a pendulum",
        EVENTS,
        lambda: impacts(lambda t, x: [x[1], -math.sin(x[0])], height, lambda x: [0.0, 1.5], [0.0, 1.5]),
    ),
    (
        "switch of a thermostat",
        EVENTS,
        lambda: impacts(
            lambda t, x: [5 * x[1] - 0.1 * x[0], 0.0], to_switch, lambda x: [x[0], 1 - x[1]], [20.0, 0.0]
        ),
    ),
    ("tick of a servo", TICKS, lambda: sampled(servo, False)),
    ("tick of a servo, 25 ms late", TICKS, lambda: sampled(servo, True)),
    ("tick of a pendulum", TICKS, lambda: sampled(pendulum, False)),
    ("tick of a pendulum, 25 ms late", TICKS, lambda: sampled(pendulum, True)),
]

for name, count, run in ROWS:
    run()
    shortest = math.inf
    for _ in range(RUNS):
        begin = time.process_time()
        end = run()
        shortest = min(shortest, time.process_time() - begin)
    print(name, count, 1e6 * shortest / count, end, sep="\t")

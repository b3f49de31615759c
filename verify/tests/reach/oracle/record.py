#!/usr/bin/env python3
"""Records what independent validated programs enclose, for `cargo test -p pleach-verify reach`.

    pip install python-flint codac
    verify/tests/reach/oracle/record.py > verify/tests/reach/oracle/recorded.txt

Each line is a kind, the numbers that pose the question, and the ends of the enclosures found:

    exponential n a11 a12 …  lower upper …       e^A by ball arithmetic (python-flint)
    flow NAME t x0 y0  lower upper lower upper   a solution by Lohner's method (codac)
"""

import math
import random

import flint
from codac import AnalyticFunction, CtcLohner, IntervalVector, SlicedTube, VectorVar, create_tdomain


def ends(ball):
    """The ends of a ball, rounded outward."""
    lower, upper = float(ball.lower().mid()), float(ball.upper().mid())
    return math.nextafter(lower, -math.inf), math.nextafter(upper, math.inf)


def exponentials(count):
    flint.ctx.prec = 200
    draw = random.Random(1)
    for _ in range(count):
        n = draw.randint(1, 4)
        entries = [round(draw.uniform(-4, 4), 3) for _ in range(n * n)]
        matrix = flint.arb_mat(n, n, [flint.arb(flint.fmpq(*entry.as_integer_ratio())) for entry in entries])
        power = matrix.exp()
        found = [end for row in range(n) for column in range(n) for end in ends(power[row, column])]
        print("exponential", n, *map(repr, entries), *map(repr, found))


def flows():
    x = VectorVar(2)
    systems = {
        "van-der-pol": AnalyticFunction([x], [x[1], (1 - x[0] * x[0]) * x[1] - x[0]]),
        "lotka-volterra": AnalyticFunction([x], [3 * x[0] - 3 * x[0] * x[1], x[0] * x[1] - x[1]]),
    }
    starts = {
        "van-der-pol": [(1.25, 2.35), (1.55, 2.45), (1.4, 2.4), (1.25, 2.45), (1.55, 2.35)],
        "lotka-volterra": [(1.288, 1.0), (1.3, 1.0), (1.312, 1.0)],
    }
    for name, function in systems.items():
        for start in starts[name]:
            tube = SlicedTube(create_tdomain([0, 2], 0.005, True), IntervalVector(2))
            tube.set(IntervalVector([[start[0], start[0]], [start[1], start[1]]]), 0.0)
            CtcLohner(function).contract(tube)
            for t in (0.5, 1.0, 1.5, 2.0):
                state = tube(t)
                found = [end for side in (state[0], state[1]) for end in (side.lb(), side.ub())]
                print("flow", name, repr(t), *map(repr, start), *map(repr, found))


if __name__ == "__main__":
    exponentials(60)
    flows()

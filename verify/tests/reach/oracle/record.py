#!/usr/bin/env python3
"""Records what independent validated programs enclose, for `cargo test -p pleach-verify reach`.

    pip install python-flint codac
    verify/tests/reach/oracle/record.py > verify/tests/reach/oracle/recorded.txt

Each line is a kind, the numbers that pose the question, and the ends of the enclosures found:

    exponential n a11 a12 …  lower upper …       e^A by ball arithmetic (python-flint)
    flow NAME t x1 x2 …  lower upper …           a solution by Lohner's method (codac), or e^(At) x
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
    def system(dimension, rates, starts):
        x = VectorVar(dimension)
        return AnalyticFunction([x], rates(x)), starts

    def coupled(x):
        spring = x[4] * (x[2] - x[0])
        return [
            x[1],
            (1 - x[0] * x[0]) * x[1] + spring - x[0],
            x[3],
            (1 - x[2] * x[2]) * x[3] - spring - x[2],
            0 * x[4],
        ]

    def enzymes(x):
        return [
            1.4 * x[2] - 0.9 * x[0],
            2.5 * x[4] - 1.5 * x[1],
            0.6 * x[6] - 0.8 * (x[1] * x[2]),
            2.0 - 1.3 * (x[2] * x[3]),
            0.7 * x[0] - x[3] * x[4],
            0.3 * x[0] - 3.1 * x[5],
            1.8 * x[5] - 1.6 * (x[1] * x[6]),
        ]

    middle = [1.2, 1.05, 1.5, 2.4, 1.0, 0.1, 0.45]
    systems = {
        "van-der-pol": system(
            2,
            lambda x: [x[1], (1 - x[0] * x[0]) * x[1] - x[0]],
            [(1.25, 2.35), (1.55, 2.45), (1.4, 2.4), (1.25, 2.45), (1.55, 2.35)],
        ),
        "lotka-volterra": system(
            2,
            lambda x: [3 * x[0] - 3 * x[0] * x[1], x[0] * x[1] - x[1]],
            [(1.288, 1.0), (1.3, 1.0), (1.312, 1.0)],
        ),
        "coupled-van-der-pol": system(
            5,
            coupled,
            [(1.475, 2.35, 1.25, 2.35, 1.0), (1.55, 2.45, 1.325, 2.45, 1.5), (1.5, 2.4, 1.25, 2.45, 1.0)],
        ),
        "laub-loomis": system(
            7,
            enzymes,
            [tuple(center + sign * 0.01 for center in middle) for sign in (-1, 0, 1)],
        ),
    }
    for name, (function, starts) in systems.items():
        for start in starts:
            tube = SlicedTube(create_tdomain([0, 2], 0.005, True), IntervalVector(len(start)))
            tube.set(IntervalVector([[value, value] for value in start]), 0.0)
            CtcLohner(function).contract(tube)
            for t in (0.5, 1.0, 1.5, 2.0):
                state = tube(t)
                found = [end for side in range(len(start)) for end in (state[side].lb(), state[side].ub())]
                print("flow", name, repr(t), *map(repr, start), *map(repr, found))


def spacecraft():
    """From points of the rendezvous' initial set, e^(At) x by ball arithmetic."""
    flint.ctx.prec = 200
    gains = [
        [0.0, 0.0, 1.0, 0.0],
        [0.0, 0.0, 0.0, 1.0],
        [-0.057599765881773, 0.000200959896519766, -2.89995083970656, 0.00877200894463775],
        [-0.000174031357370456, -0.0665123984901026, -0.00875351105536225, -2.90300269286856],
    ]
    exact = [[flint.arb(flint.fmpq(*gain.as_integer_ratio())) for gain in row] for row in gains]
    for place in ((-925.0, -425.0), (-875.0, -375.0), (-900.0, -400.0), (-925.0, -375.0)):
        start = flint.arb_mat([[value] for value in (*place, 0.0, 0.0)])
        for t in (1, 10, 50, 100):
            state = (flint.arb_mat(exact) * t).exp() * start
            found = [end for row in range(4) for end in ends(state[row, 0])]
            print("flow", "spacecraft", repr(float(t)), *map(repr, (*place, 0.0, 0.0)), *map(repr, found))


if __name__ == "__main__":
    exponentials(60)
    flows()
    spacecraft()

"""Runs published decks to their end and checks what is known of them.

decks.py PROGRAM SHARED: SHARED holds decks/ (or the variable FABRICA_SHARED names it). Without that folder
the test is skipped (exit status 77) and says so.
"""
import csv
import math
import os
import subprocess
import sys
import tempfile

SKIPPED = 77
failures = []


def check(name, value, low, high):
    good = low <= value <= high
    print(f"  {'ok  ' if good else 'FAIL'} {name}: {value:.6g} in [{low:.6g}, {high:.6g}]")
    if not good:
        failures.append(name)


class Run:
    def __init__(self, program, deck, name, end):
        self.folder = tempfile.TemporaryDirectory()
        print(name, flush=True)
        done = subprocess.run([program, "run", deck, "--out", self.folder.name, "--threads", "1", "--quiet"],
                              stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
        check(name + " exit status", done.returncode, 0, 0)
        if done.returncode:
            print(done.stdout)
            raise SystemExit(1)
        ratio = self.column("glstat", "energy_ratio")
        check(name + " smallest energy ratio", min(ratio), 0.98, 1.02)
        check(name + " largest energy ratio", max(ratio), 0.98, 1.02)
        check(name + " end time", self.column("glstat", "time")[-1], end, 1.01 * end)

    def column(self, table, name):
        with open(os.path.join(self.folder.name, "csv", table + ".csv")) as f:
            values = [float(row[name]) for row in csv.DictReader(f)]
        assert values and all(math.isfinite(v) for v in values), (table, name)
        return values


def muscle(program, deck):
    """A muscle held at 0.7565 of its optimal length: PIS (a f g + h) with the deck's f = 0.85212, g = 1.00011 and
    h = 0.021604. Its activation passes two filters of 40 ms, functions in C, after a step of 1 ms at 0.341 s."""
    run = Run(program, deck, "isometric muscle", 4.1)
    peak, active, passive = 40.2658, 0.85212 * 1.00011, 0.021604
    for t, force in zip(run.column("elout_beam", "time"), run.column("elout_beam", "axial:1")):
        if 0.35 < t < 0.6 or t > 4.09:
            x = (t - 0.3415) / 0.04
            expected = peak * ((1 - (1 + x) * math.exp(-x)) * active + passive)
            check(f"isometric muscle force at {t:.2f} s", force, expected - 0.002 * peak, expected + 0.002 * peak)


def main():
    program = sys.argv[1]
    shared = os.environ.get("FABRICA_SHARED", sys.argv[2])
    decks = os.path.join(shared, "decks")
    if not os.path.isdir(decks):
        print(f"skipped: there is no {decks}")
        return SKIPPED
    ball = Run(program, f"{decks}/pydyna-ball-plate/ball_plate.k", "ball on plate", 10)
    # only plastic work and what rebounds is left; hardly any energy in hourglass modes or contact
    start = ball.column("glstat", "kinetic_energy")[0]
    for part in ("hourglass_energy", "sliding_interface_energy"):
        check("ball on plate " + part, abs(ball.column("glstat", part)[-1]) / start, 0, 0.01)
    pendulum = Run(program, f"{decks}/pydyna-reid-pendulum/pendulum.k", "pendulum", 11)
    # thrown along y, so that the weight does work on it and nothing moves it across
    check("pendulum speed of the thrown sphere", pendulum.column("rbdout", "global_vy:1")[0], -12.01, -11.99)
    pipe = Run(program, f"{decks}/pydyna-reid-pipe-whip/pipe.k", "pipe whip", 20)
    energy = pipe.column("glstat", "kinetic_energy")
    # nothing acts on the two rigid parts of the whip in this deck
    check("pipe whip kinetic energy kept", energy[-1] / energy[0], 1 - 1e-9, 1 + 1e-9)
    for speed in (275, 300, 325, 350):
        bar = Run(program, f"{decks}/pydyna-taylor-bar/taylor_bar_v{speed}.k", f"Taylor bar {speed} m/s", 8e-5)
        kinetic = bar.column("glstat", "kinetic_energy")
        check(f"Taylor bar {speed} m/s kinetic energy used up", kinetic[-1] / kinetic[0], 0, 0.01)
    muscle(program, f"{decks}/muscle-mat156-millard2024/MPP_R931/mat156/force_velocity/isometric_max/isometric_max.k")
    print(f"{len(failures)} failures")
    return 1 if failures else 0


sys.exit(main())

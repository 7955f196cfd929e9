"""Tasks by seed, each of them cut in the middle or not: the command line that such scripts share."""

import argparse
import os
import random


def play(make_task, run):
    """run(blactl, task) tells whether the task was cut in the middle. 0: some were, and nothing
    went wrong."""
    parser = argparse.ArgumentParser()
    parser.add_argument("blactl")
    parser.add_argument("--runs", type=int, default=500)
    parser.add_argument("--seed", type=int, default=1)
    given = parser.parse_args()
    blactl = os.path.abspath(given.blactl)
    cut, faults = 0, 0
    for seed in range(given.seed, given.seed + given.runs):
        task = make_task(random.Random(seed))
        try:
            cut += run(blactl, task)
        except AssertionError as fault:
            faults += 1
            print(f"seed {seed}: {task}\n  {fault}", flush=True)
    print(f"{given.runs} runs, {cut} of them cut in the middle: {faults} faults")
    return 1 if faults or not cut else 0

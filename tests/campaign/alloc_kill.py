#!/usr/bin/env python3
"""Kills `blactl alloc` with -9 at any moment, over and over, and compares its table with the wire.

Usage: alloc_kill.py BLACTL [--kills N] [--seed N] [--servos N]

Dynamic servos lose their supply, ask for node IDs again, and the allocator is killed in the middle:
while it opens its table, makes it, answers, writes. After each kill: every node ID that went over
the wire stands in the table, a unit has the ID that it always had, and no ID is two units'. At the
end the allocator runs undisturbed and every servo has its ID.
"""

import argparse
import os
import random
import sys
import tempfile
import time

import bench
from dynamic import INTERFACE, Wire, compare, scenario, table


def allocate(blactl, folder, tries=3):
    """To the end. On this wire a unit's answer may be lost that often that it seems to be gone."""
    done = bench.start(blactl, folder, INTERFACE, ["--json", "alloc", "--once"])
    out, err = done.communicate(timeout=bench.PATIENCE_S)
    if done.returncode != 0 and "[not_back]" in err and tries > 1:
        allocate(blactl, folder, tries - 1)
    else:
        assert done.returncode == 0, f"the last one ended with {done.returncode}: {out}{err}"


def run(blactl, folder, kills, servos, chance):
    """One life of the servos: kills, then an allocator to the end. How many were killed, how many
    of them after an ID had gone over the wire and before the end, and how many IDs went."""
    simulator = bench.Simulator(blactl, folder, scenario(
        servos, chance.randrange(1 << 30), wire={"loss": 0.02}))
    wire = Wire(blactl, folder)
    known, killed, between = table(blactl, folder), 0, 0
    try:
        for _ in range(kills):
            process = bench.start(blactl, folder, INTERFACE, ["--json", "alloc", "--once"])
            time.sleep(chance.uniform(0, 0.5) ** 2 * 2)
            killed += process.poll() is None
            between += process.poll() is None and 0 < len(set(wire.given)) < servos
            process.kill()
            process.communicate(timeout=bench.PATIENCE_S)
            now = table(blactl, folder)
            compare(known, now, wire.given)
            known = now
        allocate(blactl, folder)
        compare(known, table(blactl, folder), wire.given)
        states = simulator.dump()[1].values()
        ids = [state["node_id"] for state in states]
        assert 0 not in ids and len(set(ids)) == servos, f"at the end: {ids}"
    finally:
        wire.end()
        simulator.end()
    return killed, between, len(wire.given)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("blactl")
    parser.add_argument("--kills", type=int, default=500)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--servos", type=int, default=5)
    given = parser.parse_args()
    chance = random.Random(given.seed)
    killed, between, told, lives = 0, 0, 0, 0
    with tempfile.TemporaryDirectory(prefix="blactl-kill-") as folder:
        while killed < given.kills:
            fresh = chance.random() < 0.5  # half of the lives begin without a table
            with tempfile.TemporaryDirectory(prefix="life-", dir=folder) as life:
                home = life if fresh else folder
                counts = run(os.path.abspath(given.blactl), home, min(5, given.kills - killed),
                             given.servos, chance)
            killed, between, told = killed + counts[0], between + counts[1], told + counts[2]
            lives += 1
    print(f"{killed} kills, {between} of them between the first ID on the wire and the last, in "
          f"{lives} lives of {given.servos} servos: the {told} IDs that went over the wire are "
          f"kept, none is given twice")
    return 0 if told else 1


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Kills `blactl alloc` with -9 at any moment, over and over, and compares its table with the wire.

Usage: alloc_kill.py BLACTL [--kills N] [--seed N] [--servos N]

Dynamic servos lose their supply, ask for node IDs again, and the allocator is killed in the middle:
while it opens its table, makes it, answers, writes. After each kill: every node ID that went over
the wire stands in the table, a unit has the ID that it always had, and no ID is two units'. At the
end the allocator runs undisturbed and every servo has its ID.
"""

import argparse
import json
import os
import random
import subprocess
import sys
import tempfile
import threading
import time

import bench

INTERFACE = "sim:"


def scenario(servos, seed):
    return {"schema": "blactl-scenario/1", "clock": "virtual", "seed": seed,
            "servos": [{"model": "BLA21-12U-AB", "node_id": 0, "serial_number": number + 1}
                       for number in range(servos)],
            "wire": {"loss": 0.02}}


class Wire:
    """The node IDs that allocators gave, as a listener of its own hears them."""

    def __init__(self, blactl, folder):
        self.given = []
        self.process = bench.start(blactl, folder, INTERFACE,
                                   ["--json", "trace", "--type", "Allocation"])
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self):
        for line in self.process.stdout:
            event = json.loads(line)
            fields = event.get("fields") or {}
            if event.get("source") and fields.get("node_id"):
                self.given.append((fields["unique_id"], fields["node_id"]))

    def end(self):
        self.process.terminate()
        self.process.wait(timeout=bench.PATIENCE_S)
        self._reader.join(timeout=bench.PATIENCE_S)
        self.process.stdout.close()
        self.process.stderr.close()


def table(blactl, folder):
    """What `alloc --list` says; a table that cannot be read is a fault."""
    listed = subprocess.run([blactl, "-i", INTERFACE, "--json", "alloc", "--list"], text=True,
                            env=bench.environment(folder), capture_output=True, check=False,
                            timeout=bench.PATIENCE_S)
    if listed.returncode != 0:
        raise AssertionError(f"the table cannot be read: {listed.stderr}")
    entries = json.loads(listed.stdout)["entries"]
    return {entry["unique_id"]: entry["node_id"] for entry in entries}


def compare(known, now, given):
    """`known`: the table before; `given`: what went over the wire since the begin."""
    for unit, node_id in known.items():
        assert now.get(unit) == node_id, f"{unit} had {node_id}, now {now.get(unit)}"
    for unit, node_id in given:
        assert now.get(unit) == node_id, f"{unit} was told {node_id}, the table: {now.get(unit)}"
    assert len(set(now.values())) == len(now), f"an ID is two units': {now}"


def run(blactl, folder, kills, servos, chance):
    """One life of the servos: kills, then an allocator to the end. How many were killed, how many
    of them after an ID had gone over the wire and before the end, and how many IDs went."""
    simulator = bench.Simulator(blactl, folder, scenario(servos, chance.randrange(1 << 30)))
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
        done = bench.start(blactl, folder, INTERFACE, ["--json", "alloc", "--once"])
        out, err = done.communicate(timeout=bench.PATIENCE_S)
        assert done.returncode == 0, f"the last one ended with {done.returncode}: {out}{err}"
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

#!/usr/bin/env python3
"""Kills commands that change servos with -9 in the middle, over and over, and takes them back.

Usage: undo_cut.py BLACTL [--runs N] [--seed N]

After each kill `undo` ends with 0, and RAM and ROM of every servo are as they were before, its node
ID too; or it says that nothing is recorded, and then nothing was changed.
"""

import json
import os
import sys
import tempfile

import bench
import between
import seeded
import static_cut

INTERFACE = "sim:"
MODELS = ("BLA21-12U-AB", "BLA15-06U-A0", "BLA34-28U-AB")
SETTINGS = range(0x20, 0x47)


def settings(registers):
    return {address: raw for address, raw in registers.items() if int(address, 16) in SETTINGS}


class Task:
    """So many servos, what is done to them, and when it is killed."""

    def __init__(self, chance):
        self.count = chance.choice([1, 2, 3])
        self.units = [static_cut.uid(i + 1) for i in range(self.count)]
        self.shape = chance.choice(["set", "set --save", "erase --save", "apply", "rotate"])
        self.frames = chance.randint(100, 200 + 120 * self.count)
        self.seed = chance.randrange(1 << 30)

    def scenario(self):
        servos = [{"model": MODELS[i], "serial_number": i + 1, "unique_id": self.units[i],
                   "node_id": 11 + i, "servo_id": 1 + i} for i in range(self.count)]
        return {"schema": "blactl-scenario/1", "clock": "virtual", "seed": self.seed,
                "servos": servos}

    def fleet(self):
        """Every servo shall have the node ID of the next one, where they rotate."""
        step = 1 if self.shape == "rotate" else 0
        servos = [{"name": f"servo {i + 1}", "match": {"unique_id": self.units[i]},
                   "set": {"angle_limit_cw": "45deg", "smoothing": "off",
                           "static_node_id": 11 + (i + step) % self.count}}
                  for i in range(self.count)]
        return {"schema": "blactl-fleet/1", "servos": servos}

    def words(self, folder):
        shared = ["--json", "--yes"]
        if self.shape == "erase --save":
            return [*shared, "erase", "--save", "--keep-ids", "-n", "all"]
        if self.shape.startswith("set"):
            return [*shared, *self.shape.split(), "angle_limit_cw=45deg", "smoothing=off",
                    "-n", "all"]
        path = os.path.join(folder, "fleet.json")
        with open(path, "w", encoding="utf-8") as file:
            json.dump(self.fleet(), file)
        return [*shared, "apply", path]

    def __str__(self):
        return f"{self.shape} of {self.count}, killed after {self.frames} frames"


def check_as_before(before, after):
    static_cut.check_no_doubles(after)
    for serial, state in before.items():
        for memory in ("ram", "rom"):
            was, now = settings(state[memory]), settings(after[serial][memory])
            others = {address: (was[address], now[address])
                      for address in was if was[address] != now[address]}
            assert not others, f"{memory} of servo {serial}: {others}"
        assert after[serial]["node_id"] == 10 + serial, f"servo {serial}: {after[serial]['node_id']}"


def undo(blactl, folder):
    """Whether a change was taken back."""
    process = bench.start(blactl, folder, INTERFACE, ["--json", "--yes", "undo"])
    out, err = process.communicate(timeout=bench.PATIENCE_S)
    if process.returncode == 4:
        assert "no change of a servo is recorded" in err, err
        return False
    assert process.returncode == 0, f"undo: {process.returncode}\n{out}{err}"
    return True


def run(blactl, task):
    """Whether something was killed that had been recorded."""
    with tempfile.TemporaryDirectory(prefix="blactl-undo-") as folder:
        simulator = bench.Simulator(blactl, folder, task.scenario())
        try:
            simulator.settle()
            before = simulator.dump()[1]
            passing = between.GoBetween(folder, task.frames)
            status, _, _ = passing.run(
                bench.start(blactl, folder, f"sim:{passing.interface}", task.words(folder)))
            simulator.settle()
            was_recorded = undo(blactl, folder)
            check_as_before(before, simulator.dump()[1])
            return status != 0 and was_recorded
        finally:
            simulator.end()


def main():
    return seeded.play(Task, run)


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Cuts `blactl alloc --static` off in the middle, over and over, and runs it once more.

Usage: static_cut.py BLACTL [--runs N] [--seed N]

Servos exchange their node IDs, rotate them, or get them for the first time, while others stay. In
the middle all of them lose their supply, or the command is killed with -9. Every ID that the first
run called static is in the ROM of that servo; no two are ever left on one ID; the second run
ends with 0, and every servo is where it was wished, in its ROM too.
"""

import json
import sys
import tempfile
import time

import bench
import seeded

INTERFACE = "sim:"
STATIC = "0x46"


def uid(serial):
    return f"{serial:032x}"


class Task:
    """So many servos, where they are, where they shall be, and when the supply goes."""

    def __init__(self, chance):
        count = chance.choice([2, 2, 3, 8])
        self.begin = {serial: 10 + serial for serial in range(1, count + 3)}
        movers = list(range(1, count + 1))
        shape = chance.choice(["rotate", "shuffle", "chain", "fresh"])
        if shape == "chain":
            self.wish = {serial: 11 + serial for serial in movers[:-1]} | {movers[-1]: 40}
        elif shape == "shuffle":
            targets = [self.begin[serial] for serial in movers]
            chance.shuffle(targets)
            self.wish = dict(zip(movers, targets))
        else:
            self.wish = {serial: self.begin[movers[i - 1]] for i, serial in enumerate(movers)}
        if shape == "fresh":
            self.begin[movers[0]] = 0
        self.killed_after_s = chance.uniform(0.05, 0.1 + 0.08 * count) if chance.random() < 0.5 else None
        self.cut_at_s = None if self.killed_after_s else chance.uniform(1, 3 + 3 * count)
        self.seed = chance.randrange(1 << 30)
        self.shape = shape

    def scenario(self):
        events = []
        for serial in self.begin if self.cut_at_s else []:
            at = round(self.cut_at_s * 1e6)
            events.append({"at": at, "servo": serial, "happens": "power_off"})
            events.append({"at": at + 2000000, "servo": serial, "happens": "power_on"})
        servos = [{"model": "BLA21-12U-AB", "serial_number": serial, "unique_id": uid(serial),
                   "node_id": node_id}
                  for serial, node_id in self.begin.items()]
        return {"schema": "blactl-scenario/1", "clock": "virtual", "seed": self.seed,
                "servos": servos, "events": events}

    def words(self):
        wishes = [word for serial, node_id in self.wish.items()
                  for word in ("--assign", f"{uid(serial)}={node_id}")]
        return ["--json", "--yes", "alloc", "--static", *wishes]

    def __str__(self):
        return (f"{self.shape} {self.begin} -> {self.wish}, cut at {self.cut_at_s}, "
                f"killed after {self.killed_after_s}")


def told(out):
    """The IDs that a stream called static, by serial number."""
    lines = [json.loads(line) for line in out.splitlines() if line.endswith("}")]
    return {int(line["unique_id"], 16): line["node_id"] for line in lines
            if line.get("event") == "made_static"}


def check_no_doubles(states):
    """Where each is, and where it comes back after a loss of supply: never two in one place."""
    for places in ([state["node_id"] for state in states.values()],
                   [state["rom"][STATIC] for state in states.values()]):
        fixed = [place for place in places if place]
        assert len(set(fixed)) == len(fixed), f"two on one ID: {places}"


def wait_for_cut(blactl, folder, simulator, task):
    """Time stands without a command: until all have their supply again, somebody listens."""
    simulator.hold(1)
    listen = ["scan", "--listen", str(round(task.cut_at_s or 0) + 5)]
    bench.start(blactl, folder, INTERFACE, listen).communicate(timeout=bench.PATIENCE_S)
    simulator.hold(0)


def run(blactl, task):
    """Whether the first run was cut before its end."""
    with tempfile.TemporaryDirectory(prefix="blactl-static-") as folder:
        simulator = bench.Simulator(blactl, folder, task.scenario())
        try:
            first = bench.start(blactl, folder, INTERFACE, task.words())
            if task.killed_after_s:
                time.sleep(task.killed_after_s)
                first.kill()
            out, err = first.communicate(timeout=bench.PATIENCE_S)
            wait_for_cut(blactl, folder, simulator, task)
            states = simulator.dump()[1]
            check_no_doubles(states)
            for serial, node_id in told(out).items():
                held = states[serial]["rom"][STATIC]
                assert held == node_id, f"servo {serial} was called {node_id}, ROM: {held}\n{err}"
            begun = any(states[serial]["rom"][STATIC] != node_id or states[serial]["count"]
                        for serial, node_id in task.begin.items())
            second = bench.start(blactl, folder, INTERFACE, task.words())
            out, err = second.communicate(timeout=bench.PATIENCE_S)
            assert second.returncode == 0, f"the second run: {second.returncode}\n{out}{err}"
            states = simulator.dump()[1]
            check_no_doubles(states)
            for serial, node_id in {**task.begin, **task.wish}.items():
                state = states[serial]
                assert (state["node_id"], state["rom"][STATIC]) == (node_id, node_id), \
                    f"servo {serial}: {state['node_id']}, ROM {state['rom'][STATIC]}"
            return first.returncode != 0 and begun
        finally:
            simulator.end()


def main():
    return seeded.play(Task, run)


if __name__ == "__main__":
    sys.exit(main())

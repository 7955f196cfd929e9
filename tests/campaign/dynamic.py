"""Servos that ask for node IDs, what allocators answer them, and the table that stays."""

import json
import subprocess
import threading

import bench

INTERFACE = "sim:"


def scenario(servos, seed, **more):
    """So many servos without node IDs."""
    return {"schema": "blactl-scenario/1", "clock": "virtual", "seed": seed,
            "servos": [{"model": "BLA21-12U-AB", "node_id": 0, "serial_number": number + 1}
                       for number in range(servos)], **more}


class Wire:
    """What allocators answered, as a listener of its own hears it: `answers` of whatever kind, and
    the node IDs that were `given`."""

    def __init__(self, blactl, folder):
        self.answers, self.given = [], []
        self._asked = threading.Event()
        self.process = bench.start(blactl, folder, INTERFACE,
                                   ["--json", "trace", "--type", "Allocation"])
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()

    def _read(self):
        for line in self.process.stdout:
            event = json.loads(line)
            self._asked.set()
            fields = event.get("fields") or {}
            if event.get("source"):
                self.answers.append(event)
            if event.get("source") and fields.get("node_id"):
                self.given.append((fields["unique_id"], fields["node_id"]))

    def hears(self):
        """Waits until a servo has asked, so that no answer is missed."""
        if not self._asked.wait(timeout=bench.PATIENCE_S):
            raise bench.Hang("no servo asks")

    def end(self):
        self.process.terminate()
        self.process.wait(timeout=bench.PATIENCE_S)
        self._reader.join(timeout=bench.PATIENCE_S)
        self.process.stdout.close()
        self.process.stderr.close()


def listed(blactl, folder):
    """`alloc --list`, run to its end."""
    return subprocess.run([blactl, "-i", INTERFACE, "--json", "alloc", "--list"], text=True,
                          env=bench.environment(folder), capture_output=True, check=False,
                          timeout=bench.PATIENCE_S)


def table(blactl, folder):
    """What it says; a table that cannot be read is a fault."""
    said = listed(blactl, folder)
    if said.returncode != 0:
        raise AssertionError(f"the table cannot be read: {said.stderr}")
    return entries(said)


def entries(said):
    return {entry["unique_id"]: entry["node_id"] for entry in json.loads(said.stdout)["entries"]}


def compare(known, now, given):
    """`known`: the table before; `given`: what went over the wire since the begin."""
    for unit, node_id in known.items():
        assert now.get(unit) == node_id, f"{unit} had {node_id}, now {now.get(unit)}"
    for unit, node_id in given:
        assert now.get(unit) == node_id, f"{unit} was told {node_id}, the table: {now.get(unit)}"
    assert len(set(now.values())) == len(now), f"an ID is two units': {now}"

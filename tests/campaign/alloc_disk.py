#!/usr/bin/env python3
"""What becomes of node IDs where the table cannot be used, or its disk gets full on the way.

Usage: tests/net/namespace.sh python3 alloc_disk.py BLACTL

Refused before the first answer on the wire: `alloc`, and `alloc --static`, on a full or read-only
disk, on a damaged table and on one of a newer version; `doctor` tells of it. A `restart` says that,
and each servo has the ID that it had. A disk that gets full on the way: every ID that went over the
wire is in the table, and the next run ends well.

It mounts small file systems of its own, and so runs in a mount namespace.
"""

import argparse
import contextlib
import json
import os
import re
import sqlite3
import subprocess
import sys
import tempfile
import threading

import bench
import static_cut
from dynamic import INTERFACE, Wire, compare, entries, listed, scenario, table

OURS = (127, 126, 9)
PAGE = 4096
SERVOS = 6


class Disk:
    """The disk of a state folder, small."""

    def __init__(self, folder):
        self.path = os.path.join(folder, "blactl", "simulated")
        self.table = os.path.join(self.path, "allocations.db")
        self._filler = os.path.join(self.path, "filler")
        os.makedirs(self.path)
        mount("-t", "tmpfs", "-o", "size=512k,mode=0700", "tmpfs", self.path)

    def fill(self):
        with open(self._filler, "wb", buffering=0) as file:
            try:
                while True:
                    file.write(bytes(PAGE))
            except OSError:
                pass

    def commits(self):
        """To all files: the change counters of their headers (Database File Format, 1.3.7)."""
        count = 0
        for name in os.listdir(self.path):
            if name.endswith(".db"):
                with open(os.path.join(self.path, name), "rb") as file:
                    count += int.from_bytes(file.read(28)[24:], "big")
        return count

    @contextlib.contextmanager
    def full_after(self, commits):
        """It gets full as soon as something has been committed so often."""
        due, is_over = self.commits() + commits, threading.Event()

        def watch():
            while self.commits() < due:
                if is_over.is_set():
                    return
            self.fill()

        watcher = threading.Thread(target=watch)
        watcher.start()
        try:
            yield
        finally:
            is_over.set()
            watcher.join()

    def free(self):
        if os.path.exists(self._filler):
            os.remove(self._filler)

    def make_read_only(self):
        mount("-o", "remount,ro", self.path)

    def unmount(self):
        subprocess.run(["umount", self.path], check=True)

    def contents(self):
        """Of the table and its journal. An empty one means nothing."""
        found = {}
        for name in os.listdir(self.path):
            path = os.path.join(self.path, name)
            if name.startswith("allocations.db") and os.path.getsize(path) > 0:
                with open(path, "rb") as file:
                    found[name] = file.read()
        return found

    def clear(self):
        for name in os.listdir(self.path):
            os.remove(os.path.join(self.path, name))


def mount(*words):
    subprocess.run(["mount", *words], check=True)


class Place:
    """A folder with a small disk, and a simulator in it."""

    def __init__(self, blactl, servos):
        self.blactl = blactl
        self._folder = tempfile.TemporaryDirectory(prefix="blactl-disk-")
        self.folder = self._folder.name
        self.disk = Disk(self.folder)
        self._scenario = servos
        self.simulator = bench.Simulator(blactl, self.folder, servos)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.simulator.end()
        self.disk.unmount()
        self._folder.cleanup()

    def power_off(self):
        """The servos are switched off and on: they ask again."""
        self.simulator.end()
        self.simulator = bench.Simulator(self.blactl, self.folder, self._scenario)

    def run(self, *words):
        process = bench.start(self.blactl, self.folder, INTERFACE, ["--json", *words])
        out, err = process.communicate(timeout=bench.PATIENCE_S)
        return bench.Outcome(" ".join(words), process.returncode, out, err, None)

    def heard(self, *words):
        """With a listener: also what the wire carried."""
        wire = Wire(self.blactl, self.folder)
        try:
            wire.hears()
            return self.run(*words), wire
        finally:
            wire.end()

    def table(self):
        return table(self.blactl, self.folder)

    def ids(self):
        return {serial: state["node_id"] for serial, state in self.simulator.dump()[1].items()}


def codes(told):
    return [error["code"] for error in told.document["errors"]]


def check_refused(told, status, code, reason):
    assert (told.status, codes(told)) == (status, [code]) and re.search(reason, told.err), told


def damage(disk):
    with open(disk.table, "r+b") as file:
        file.write(b"no table")


def make_newer(disk):
    database = sqlite3.connect(disk.table)
    database.execute("PRAGMA user_version = 2")
    database.close()


# What is done to a table or its disk, and what must come of it: exit status, code and reason, and
# what doctor calls it.
BROKEN = {
    "a full disk": (Disk.fill, "io", 1, "io", "full|No space left"),
    "a read-only disk": (Disk.make_read_only, "permission", 3, "permission",
                         "Read-only file system"),
    "a damaged table": (damage, "state_damaged", 2, "bad_file",
                        "is not a blactl allocation table"),
    "a newer table": (make_newer, "state_damaged", 2, "bad_file", "version 2"),
}


def fixed(count):
    """Servos with node IDs."""
    servos = scenario(count, 1)
    for number, servo in enumerate(servos["servos"]):
        servo["node_id"] = 11 + number
        servo["servo_id"] = 1 + number
    return servos


def refuses(blactl, name, has_table):
    """`alloc`, and `alloc --static`."""
    make, finding, *due = BROKEN[name]
    with Place(blactl, scenario(2, 1)) as place:
        if has_table:
            assert place.run("alloc", "--once").status == 0
            place.power_off()
        make(place.disk)
        before = place.disk.contents()
        for words in (["alloc", "--once"], ["alloc"], ["alloc", "--once", "--range", "10-20"]):
            told, wire = place.heard(*words)
            check_refused(told, *due)
            ours = [answer for answer in wire.answers if answer["source"] in OURS]
            assert not ours, f"it answered {ours}: {told}"
        assert set(place.ids().values()) == {0}, place.ids()
        assert place.disk.contents() == before, "the files are others than before"
        said = listed(blactl, place.folder)
        assert said.returncode != 0 or len(entries(said)) == 2 * has_table, said.stdout
        found = place.run("doctor").document["findings"]
        assert finding in [each["code"] for each in found], f"doctor has found {found}"
        assert place.disk.contents() == before, "doctor has changed the files"


def refuses_static(blactl, name, has_table):
    make, _, *due = BROKEN[name]
    with Place(blactl, fixed(2)) as place:
        if has_table:
            assert place.run("alloc", "--static", "-n", "11", "-y").status == 0
        make(place.disk)
        rom = {serial: (state["rom"], state["count"])
               for serial, state in place.simulator.dump()[1].items()}
        told = place.run("alloc", "--static", "-n", "12", "--id", "40", "-y")
        check_refused(told, *due)
        after = {serial: (state["rom"], state["count"])
                 for serial, state in place.simulator.dump()[1].items()}
        assert after == rom, "ROM was written"


def restarts(blactl, name, has_table):
    make, *_ = BROKEN[name]
    with Place(blactl, scenario(3, 1)) as place:
        assert place.run("alloc", "--once").status == 0
        if not has_table:
            place.disk.clear()
        make(place.disk)
        ids, before = place.ids(), place.disk.contents()
        told = place.run("restart", "-n", "all", "-y")
        assert told.status == 0 and "are not kept" in told.err, told
        assert place.ids() == ids, f"{ids} before, {place.ids()} now"
        assert place.disk.contents() == before, "the files are others than before"


def gets_full(blactl, commits):
    """How many IDs went over the wire before the disk was full."""
    with Place(blactl, scenario(SERVOS, 1)) as place:
        with place.disk.full_after(commits):
            told, wire = place.heard("alloc", "--once")
        assert (told.status, codes(told)) in ((0, []), (1, ["io"])), told
        place.disk.free()
        known = place.table()
        compare({}, known, wire.given)
        assert (told.status == 0) == (len(known) == SERVOS), f"{len(known)} in the table: {told}"
        counts = told.document["counts"]
        assert counts.get("nodes", 0) == counts.get("assigned", 0), f"none, but counted: {told}"
        given = len(set(wire.given))
        place.power_off()
        told, wire = place.heard("alloc", "--once")
        assert told.status == 0, told
        compare(known, place.table(), wire.given)
        assert sorted(place.ids().values()) == sorted(place.table().values()), place.ids()
        return given


def gets_full_while_static(blactl, commits):
    """Three servos rotate their IDs. What was called static is; nobody is on another's ID."""
    with Place(blactl, fixed(3)) as place:
        units = {serial: state["unique_id"]
                 for serial, state in place.simulator.dump()[1].items()}
        wish = dict(zip(units, (12, 13, 11)))
        words = ["alloc", "--static", "-y", *(
            word for serial, node_id in wish.items()
            for word in ("--assign", f"{units[serial]}={node_id}"))]
        with place.disk.full_after(commits):
            told = place.run(*words)
        assert told.status == 0 or (told.status == 1 and "io" in codes(told)), told
        states = place.simulator.dump()[1]
        static_cut.check_no_doubles(states)
        rom = {units[serial]: state["rom"][static_cut.STATIC] for serial, state in states.items()}
        for unit, node_id in made_static(told).items():
            assert rom[unit] == node_id, f"{unit} has {rom[unit]}: {told}"
        place.disk.free()
        told_again = place.run(*words)
        assert told_again.status == 0 and place.ids() == wish, told_again
        return len(made_static(told))


def made_static(told):
    lines = [json.loads(line) for line in told.out.splitlines()]
    return {line["unique_id"]: line["node_id"] for line in lines
            if line.get("event") == "made_static"}


def restarts_while_full(blactl, commits):
    """IDs that are not in the table, and are not taken into it, are told of."""
    with Place(blactl, scenario(3, 1)) as place:
        assert place.run("alloc", "--once").status == 0
        for entry in place.table():
            assert place.run("alloc", "--forget", entry).status == 0
        ids = place.ids()
        with place.disk.full_after(commits):
            told = place.run("restart", "-n", "all", "-y")
        assert told.status == 0, told
        assert place.ids() == ids, f"{ids} before, {place.ids()} now"
        place.disk.free()
        kept = len(place.table())
        assert (kept < 3) == ("are not kept" in told.err), f"{kept} of 3 were kept: {told}"
        return kept


def cases():
    """What is tried, and with what."""
    for name in BROKEN:
        for has_table in (True, False) if "disk" in name else (True,):
            yield from ((case, name, has_table) for case in (refuses, refuses_static, restarts))
    for commits in range(SERVOS + 2):
        yield from ((case, commits) for case in SWEPT)


# How many IDs were given before the disk was full, of how many.
SWEPT = {gets_full: SERVOS, gets_full_while_static: 3, restarts_while_full: 3}


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("blactl")
    blactl = os.path.abspath(parser.parse_args().blactl)
    faults, given = 0, {case: [] for case in SWEPT}
    for case, *words in cases():
        try:
            count = case(blactl, *words)
            if case in SWEPT:
                given[case].append(count)
        except AssertionError as fault:
            faults += 1
            print(f"{case.__name__} {words}: {fault}", flush=True)
    # the disk gets full a moment later on a busy machine: once more
    in_between = {case: any(0 < count < SWEPT[case] for count in given[case]) for case in SWEPT}
    for case in [case for case in SWEPT if not in_between[case]]:
        given[case] += [case(blactl, commits) for commits in range(SERVOS + 2)]
        in_between[case] = any(0 < count < SWEPT[case] for count in given[case])
    for case, counts in given.items():
        print(f"{case.__name__}: of {SWEPT[case]} IDs before the disk was full: {counts}")
    print(f"{faults} faults")
    return 1 if faults or not all(in_between.values()) else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""A day on a production line, on the virtual clock: two stations, one ledger, much that goes wrong.

  day.py BLACTL [--servos N] [--seed N] [--kills N] [--calls FILE]

Servos come to each station one after the other; at least a third of them ask for a node ID. Some
are of the wrong model, pulled too early, plugged in two at once, lose their supply while they save,
come twice, have a ROM that takes nothing, or the label of another one; some take the place of the
one before within less than a second. One station reads labels;
the other is killed with -9 again and again, and started anew. Some units are scrapped in between.
With --calls (what is built from calls.cpp) the other station's disk is full from some write on, again
and again.

Afterwards ledger, output and the servos' memory agree one by one: each servo has a record, each pass
is what ROM holds, and nothing that was shown is missing; no record is missing or open; no two units have one ID within a
lap. Exit status 1: they do not.
"""

import argparse
import collections
import datetime
import json
import os
import pathlib
import random
import signal
import sqlite3
import subprocess
import sys
import tempfile
import time

RECIPE = {
    "schema": "blactl-recipe/1", "name": "aileron", "model": "BLA21-12U-AB", "firmware_min": 1400,
    "set": {"servo_id": {"first": 1, "last": 8, "at_end": "again"},
            "static_node_id": {"first": 11, "last": 18, "at_end": "again"},
            "angle_limit_cw": "45.0deg", "smoothing": "off"},
}
SET = {"0x38": 450, "0x22": 0}
VISIT_S = 40
BATCH = 40


BEGIN = datetime.datetime(2025, 1, 1, tzinfo=datetime.timezone.utc)  # of a virtual clock


class Visit:
    """Units on the bench of a station for some seconds."""

    def __init__(self, serials, label, pause, seconds=VISIT_S):
        self.serials = serials
        self.label = label
        self.seconds = seconds
        self.pause = pause  # until the next one
        self.begin = 0  # set by Line.scenario()


class Line:
    """What comes to one station."""

    def __init__(self, chance, first_serial, count):
        self.chance = chance
        self.servos = {}
        self.visits = []
        for serial in range(first_serial, first_serial + count):
            self.add(serial)

    def add(self, serial):
        chance = self.chance
        kind = chance.choices(
            ["good", "wrong model", "pulled", "two", "dip", "twice", "rom", "label"],
            [70, 4, 6, 5, 5, 5, 2, 3])[0]
        servo = {"model": "BLA34-12U-AB" if kind == "wrong model" else RECIPE["model"],
                 "serial_number": serial, "unique_id": f"{serial:032x}",
                 "node_id": 0 if chance.random() < 0.5 else chance.choice([1, 5, 11, 14, 60])}
        if kind == "dip":
            servo["faults"] = {"power_loss_in_save": chance.choice([1000, 20000, 60000])}
        if kind == "rom":
            servo["faults"] = {"rom_write_fails": True}
        self.servos[serial] = servo
        other = chance.choice(list(self.servos))
        if kind == "pulled":
            self.visits.append(Visit([serial], serial, 8, chance.choice([2, 4, 6, 8])))
        if kind == "two" and other != serial:
            self.visits.append(Visit([serial, other], serial, 8, 15))  # all have to be off
        pause = chance.choice([0.3, 1, 2.5, 8])
        self.visits.append(Visit([serial], serial + 1 if kind == "label" else serial, pause))
        if kind in ("twice", "dip"):
            self.visits.append(Visit([serial], serial, 8))

    def scenario(self, seed):
        events = [{"at": 0, "servo": serial, "happens": "power_off"} for serial in self.servos]
        now = 1
        for visit in self.visits:
            visit.begin = now
            for serial in visit.serials:
                events.append({"at": f"{now * 1000:.0f}ms", "servo": serial,
                               "happens": "power_on"})
                events.append({"at": f"{(now + visit.seconds) * 1000:.0f}ms", "servo": serial,
                               "happens": "power_off"})
            now += visit.seconds + visit.pause
        return {"schema": "blactl-scenario/1", "clock": "virtual", "seed": seed,
                "servos": list(self.servos.values()), "events": events}


class Bench:
    """A simulated bus, and the station on it."""

    def __init__(self, blactl, folder, name, line, seed):
        self.blactl, self.folder, self.name = blactl, folder, name
        self.interface = f"sim:{folder}/{name}"
        scenario = folder / f"{name}.json"
        scenario.write_text(json.dumps(line.scenario(seed)), encoding="utf-8")
        self.sim = subprocess.Popen(
            [blactl, "-i", self.interface, "sim", scenario, "--json"], text=True,
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL)
        assert "ready" in self.sim.stdout.readline()
        self.shown = []

    def start(self, *more, labels=None, more_environment=None):
        return subprocess.Popen(
            [self.blactl, "-i", self.interface, "provision", self.folder / "recipe.json", "-y",
             "--json", "--station", self.name, "--idle-timeout", "120", *more], text=True,
            stdin=subprocess.PIPE if labels else subprocess.DEVNULL, stdout=subprocess.PIPE,
            stderr=subprocess.DEVNULL, env=os.environ | (more_environment or {}))

    def memory(self):
        """Serial number to RAM and ROM."""
        print("dump", file=self.sim.stdin, flush=True)
        memory = {}
        for line in self.sim.stdout:
            event = json.loads(line)
            if event.get("event") == "state":
                memory[event["serial_number"]] = event
            elif event.get("event") == "dumped":
                return memory
        sys.exit("the simulator has ended")

    def stop(self):
        self.sim.send_signal(signal.SIGTERM)
        self.sim.communicate()


def ledger(blactl, bench, *more):
    """Exit status and output."""
    done = subprocess.run([blactl, "-i", bench.interface, "ledger", *more], text=True,
                          stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    return done.returncode, done.stdout


def records_in(text):
    return [record for record in map(json.loads, text.splitlines()) if "record_id" in record]


def label_after(line, record):
    """Of the visit that comes next."""
    ended = datetime.datetime.fromisoformat(record["time"].replace("Z", "+00:00")) - BEGIN
    for visit in line.visits:
        if visit.begin > ended.total_seconds():
            return visit.label
    return None


def run_labelled(bench, line):
    """A label for each visit; one that ends as an error keeps its own."""
    station = bench.start("--label", "-", labels=True)
    print(line.visits[0].label, file=station.stdin, flush=True)
    for text in station.stdout:
        for record in records_in(text):
            bench.shown.append(record)
            label = label_after(line, record) if record["verdict"] != "error" else None
            if label:
                print(label, file=station.stdin, flush=True)
            elif record["verdict"] != "error":
                station.stdin.close()
    station.wait()


def run_full(bench, chance, times, calls, judge):
    """The disk is full from some write on: what is shown is kept, and the run ends by itself."""
    for _ in range(times):
        station = bench.start(more_environment={"LD_PRELOAD": calls,
                                                "FAKED_FULL": str(chance.randint(1, 120))})
        bench.shown += records_in(station.communicate()[0])
        judge.full += station.returncode == 1
        judge.require(station.returncode >= 0, f"a full disk: {station.returncode}")


def run_killed(bench, chance, kills):
    """Killed some times, and started anew."""
    for left in range(kills, -1, -1):
        station = bench.start()
        if left == 0:
            bench.shown += records_in(station.communicate()[0])
            return
        time.sleep(chance.uniform(0.02, 0.5))
        station.kill()
        bench.shown += records_in(whole_lines(station.communicate()[0]))


def whole_lines(text):
    """One that was cut off was not shown."""
    return text[:text.rfind("\n") + 1]


class Judge:
    """What does not agree."""

    def __init__(self):
        self.wrong = []
        self.full = 0  # runs that ended by a full disk

    def require(self, holds, what):
        if not holds:
            self.wrong.append(what)

    def compare(self, records, shown, memories):
        known = {record["record_id"]: record for record in records}
        for record in shown:
            self.require(known.get(record["record_id"]) == record,
                         f"shown, not in the ledger: {record}")
        recorded = {record["serial_number"] for record in records}
        for serial in memories:
            self.require(serial in recorded, f"{serial} was there, and has no record")
        last = {}
        for record in records:
            if record["verdict"] in ("pass", "fail", "error"):
                last[record["serial_number"]] = record
        for record in last.values():
            if record["verdict"] == "pass":
                self.compare_memory(record, memories[record["serial_number"]])

    def compare_memory(self, record, memory):
        held = memory["rom"]
        want = SET | {"0x45": record["servo_id"], "0x46": record["static_node_id"]}
        for register, value in want.items():
            self.require(held[register] == value,
                         f"{record['serial_number']} passed, ROM holds {register}={held[register]},"
                         f" not {value}")

    def check_ids(self, records, counters):
        """A unit keeps its IDs until it is scrapped, and no ID is given twice within a lap."""
        holders = collections.defaultdict(set)
        for parameter, lap, value, unit in counters:
            holders[parameter, lap, value].add(unit)
        for place, units in holders.items():
            self.require(len(units) == 1, f"{place} is of {units}")
        given = {(parameter, unit): value for parameter, _, value, unit in counters}
        passed = {}
        for record in records:
            unit = record["unique_id"]
            if record["verdict"] == "scrap":
                passed.pop(unit, None)
            elif record["verdict"] == "pass":
                ids = {name: record[name] for name in ("servo_id", "static_node_id")}
                self.require(passed.get(unit, ids) == ids, f"{unit} had {passed.get(unit)}: {ids}")
                passed[unit] = ids
        for unit, ids in passed.items():
            for name, value in ids.items():
                self.require(given.get((name, unit)) == value,
                             f"{unit} has {name} {value}, given was {given.get((name, unit))}")

    def check_numbers(self, records):
        numbers = collections.defaultdict(list)
        for record in records:
            numbers[record["station"]].append(record["station_seq"])
        for station, all_of_it in numbers.items():
            self.require(sorted(all_of_it) == list(range(1, len(all_of_it) + 1)),
                         f"numbers of {station}")


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("blactl")
    parser.add_argument("--servos", type=int, default=BATCH, help="in batches of 40")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--kills", type=int, default=8, help="in each batch")
    parser.add_argument("--calls")
    given = parser.parse_args()
    chance = random.Random(given.seed)
    with tempfile.TemporaryDirectory() as name:
        wrong = play(given, chance, pathlib.Path(name))
    print("\n".join(wrong[:20]))
    return 1 if wrong else 0


def given_ids(folder):
    database = sqlite3.connect(folder / "state/simulated/counters.db")
    return list(database.execute("SELECT parameter, lap, value, lower(hex(unique_id)) FROM "
                                 "assignments WHERE unique_id IS NOT NULL"))


def play_hours(given, chance, blactl, folder, hour, judge):
    """Some servos at either station. Returns what was shown, and the servos' memory."""
    lines = [Line(chance, first + hour * BATCH, BATCH // 2) for first in (10000, 50000)]
    benches = [Bench(blactl, folder, name, line, given.seed + hour)
               for name, line in zip("AB", lines)]
    run_labelled(benches[0], lines[0])
    before = records_in(ledger(blactl, benches[0], "--json", "--verdict", "pass")[1])
    record_id = chance.choice(before)["record_id"]
    status, told = ledger(blactl, benches[0], "--scrap", record_id, "--reason", "x", "-y")
    judge.require(status == 0, f"scrap: {status} {told}")
    if given.calls:
        run_full(benches[1], chance, 6, given.calls, judge)
    run_killed(benches[1], chance, given.kills)
    memories = {}
    for bench in benches:
        memories |= bench.memory()
    shown = [record for bench in benches for record in bench.shown]
    return benches, shown, memories


def play(given, chance, folder):
    """A simulator gets slower with its servos: there are new ones for each batch."""
    os.environ["BLACTL_STATE_DIR"] = str(folder / "state")
    blactl = str(pathlib.Path(given.blactl).resolve())
    (folder / "recipe.json").write_text(json.dumps(RECIPE), encoding="utf-8")
    judge = Judge()
    shown, memories, benches = [], {}, []
    for hour in range(max(1, given.servos // BATCH)):
        for bench in benches:
            bench.stop()
        benches, more, held = play_hours(given, chance, blactl, folder, hour, judge)
        shown, memories = shown + more, memories | held
    status, check = ledger(blactl, benches[0], "--check")
    judge.require(status == 0, f"check: {status} {check}")
    records = records_in(ledger(blactl, benches[0], "--json")[1])
    judge.compare(records, shown, memories)
    judge.check_ids(records, given_ids(folder))
    judge.check_numbers(records)
    judge.require(judge.full or not given.calls, "no run met a full disk")
    for bench in benches:
        bench.stop()
    verdicts = collections.Counter((record["verdict"], record["code"]) for record in records)
    for (verdict, code), count in sorted(verdicts.items(), key=str):
        print(f"{count:6} {verdict} {code or ''}")
    dynamic = len({record["unique_id"] for record in records if record["node_id"] == 0})
    print(f"{len(records)} records of {len(memories)} servos, {dynamic} of which asked for a node ID;"
          f" {judge.full} runs ended by a full disk; {len(judge.wrong)} do not agree")
    return judge.wrong


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Kills a station with -9 after every single frame that it sends, and starts it anew.

  kill.py BLACTL [--first N] [--step N] [--calls FILE]

Three servos come one after the other, two of them without a node ID. A go-between passes frame
after frame on, and kills the station right after the Nth has been taken: N goes from the first frame to
the last. With --calls (what is built from calls.cpp) it dies before, and in another run after, the
Nth call that orders a database on the disk instead. The next run ends by itself. Then every servo has passed and holds what it shall, with an
ID of its own; what was shown is in the ledger, each unit has one pass there; nothing is open or
missing.
"""

import argparse
import json
import os
import pathlib
import signal
import sys
import tempfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "campaign"))

import bench  # noqa: E402: after the line above
import between  # noqa: E402
import static_cut  # noqa: E402

RECIPE = {"schema": "blactl-recipe/1", "name": "aileron", "model": "BLA21-12U-AB",
          "set": {"servo_id": {"first": 1, "last": 3}, "static_node_id": {"first": 11, "last": 13},
                  "angle_limit_cw": "45.0deg"}}
SERIALS = (1, 2, 3)
NODE_IDS = {1: 0, 2: 0, 3: 11}
VISIT_S = 60


def scenario():
    servos = [{"model": "BLA21-12U-AB", "serial_number": serial,
               "unique_id": static_cut.uid(serial), "node_id": NODE_IDS[serial]}
              for serial in SERIALS]
    events = [{"at": 0, "servo": serial, "happens": "power_off"} for serial in SERIALS]
    for place, serial in enumerate(SERIALS):
        begin = 1 + place * (VISIT_S + 8)
        events.append({"at": f"{begin}s", "servo": serial, "happens": "power_on"})
        if serial != SERIALS[-1]:
            events.append({"at": f"{begin + VISIT_S}s", "servo": serial, "happens": "power_off"})
    return {"schema": "blactl-scenario/1", "clock": "virtual", "servos": servos, "events": events}


def records_in(out):
    whole = out[:out.rfind("\n") + 1]
    return [line for line in map(json.loads, whole.splitlines()) if "record_id" in line]


def command(blactl, folder, *words):
    process = bench.start(blactl, folder, static_cut.INTERFACE, list(words))
    out, err = process.communicate(timeout=bench.PATIENCE_S)
    return process.returncode, out, err


def check_ledger(blactl, folder, shown):
    status, out, err = command(blactl, folder, "ledger", "--check")
    assert status == 0, f"check: {status} {out}{err}"
    _, out, _ = command(blactl, folder, "ledger", "--json")
    records = records_in(out)
    by_id = {record["record_id"]: record for record in records}
    for record in shown:
        assert by_id.get(record["record_id"]) == record, f"shown, not recorded: {record}"
    ids = set()
    for serial in SERIALS:
        verdicts = [record["verdict"] for record in records if record["serial_number"] == serial]
        assert verdicts.count("pass") == 1, f"servo {serial}: {verdicts}"
        assert set(verdicts) <= {"pass", "skip", "error"}, f"servo {serial}: {verdicts}"
        passed = next(record for record in records
                      if record["serial_number"] == serial and record["verdict"] == "pass")
        ids.add((passed["servo_id"], passed["static_node_id"]))
    assert ids == {(1, 11), (2, 12), (3, 13)}, f"IDs: {ids}"
    return {record["serial_number"]: record for record in records if record["verdict"] == "pass"}


def killed_after_frame(blactl, folder, words, frames):
    passing = between.GoBetween(folder, frames)
    return passing.run(bench.start(blactl, folder, f"sim:{passing.interface}", words))


def killed_at_call(blactl, folder, words, when, calls):
    os.environ.update({"LD_PRELOAD": calls, "FAKED_KILL": when})
    try:
        process = bench.start(blactl, folder, static_cut.INTERFACE, words)
    finally:
        del os.environ["LD_PRELOAD"], os.environ["FAKED_KILL"]
    out, err = process.communicate(timeout=bench.PATIENCE_S)
    return process.returncode, out, err


def run(blactl, killed):
    """One kill; None: the station had ended before. Else whether something had begun."""
    with tempfile.TemporaryDirectory(prefix="blactl-line-") as folder:
        path = pathlib.Path(folder, "recipe.json")
        path.write_text(json.dumps(RECIPE), encoding="utf-8")
        words = ["--json", "--yes", "provision", str(path), "--idle-timeout", "90"]
        simulator = bench.Simulator(blactl, folder, scenario())
        try:
            status, out, err = killed(blactl, folder, words)
            if status == 0:
                return None
            assert status == -signal.SIGKILL, f"the first run: {status}\n{out}{err}"
            shown = records_in(out)
            status, out, err = command(blactl, folder, *words)
            assert status == 0, f"the second run: {status}\n{out}{err}"
            shown += records_in(out)
            states = simulator.dump()[1]
            passed = check_ledger(blactl, folder, shown)
            for serial, record in passed.items():
                rom = states[serial]["rom"]
                assert rom["0x38"] == 450, f"servo {serial}: {rom['0x38']}"
                assert rom["0x45"] == record["servo_id"], f"servo {serial}: {rom['0x45']}"
                assert rom["0x46"] == record["static_node_id"], f"servo {serial}: {rom['0x46']}"
            return any(record["code"] == "interrupted" for record in shown)
        finally:
            simulator.end()


def kills(number, calls):
    """What happens at this place: words for it, and how."""
    if not calls:
        return {f"after frame {number}":
                lambda *given: killed_after_frame(*given, number)}
    return {when: lambda *given, when=when: killed_at_call(*given, when, calls)
            for when in (f"before {number}", f"after {number}")}


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("blactl")
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--step", type=int, default=1)
    parser.add_argument("--calls")
    given = parser.parse_args()
    blactl = str(pathlib.Path(given.blactl).resolve())
    count, begun, failed, number, has_ended = 0, 0, 0, given.first, False
    while not has_ended:
        for when, killed in kills(number, given.calls).items():
            try:
                done = run(blactl, killed)
            except AssertionError as fault:
                failed += 1
                print(f"{when}: {fault}", flush=True)
                done = False
            has_ended = has_ended or done is None
            count, begun = count + (done is not None), begun + bool(done)
        number += given.step
    print(f"{count} kills, {begun} of them in work that was begun: {failed} did not end as wished")
    return 1 if failed or not begun else 0


if __name__ == "__main__":
    sys.exit(main())

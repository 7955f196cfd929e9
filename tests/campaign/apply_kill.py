#!/usr/bin/env python3
"""Kills `blactl apply` with -9 after every single frame that it sends, and runs it once more.

Usage: apply_kill.py BLACTL [--first N] [--step N]

Three servos of three models get a fleet file that changes every kind of setting, rotates their
servo IDs, exchanges the node IDs of two and moves the third. A go-between on the simulated bus
passes frame after frame on, and kills the command right after the Nth has been taken: N goes from
the first frame to the last. Then no two are on one ID, nor would be after a loss of supply, and
`apply` once more ends with 0: ROM and RAM of each hold the file, every servo is where it shall be.
"""

import argparse
import json
import os
import signal
import sys
import tempfile

import bench
import between
import static_cut

SERVOS = [("BLA21-12U-AB", 11), ("BLA15-06U-A0", 12), ("BLA34-28U-AB", 13)]
WISHED_IDS = {1: 12, 2: 11, 3: 40}
WISHED = {"servo_id": "0x45", "static_node_id": "0x46"}
SETTINGS = {"angle_limit_cw": ("0x38", "450raw", 450), "angle_limit_ccw": ("0x39", "-450raw", -450),
            "smoothing": ("0x22", "off", 0), "timeout_time": ("0x27", "1500ms", 1500),
            "temperature_limit_high": ("0x3E", "70degC", 70)}


def scenario():
    servos = [{"model": model, "serial_number": serial, "unique_id": static_cut.uid(serial),
               "node_id": node_id, "servo_id": serial}
              for serial, (model, node_id) in enumerate(SERVOS, 1)]
    return {"schema": "blactl-scenario/1", "clock": "virtual", "servos": servos}


def fleet():
    common = {name: value for name, (_, value, _) in SETTINGS.items()}
    servos = [{"name": f"servo {serial}", "match": {"serial_number": serial},
               "set": {"servo_id": serial % len(SERVOS) + 1, "static_node_id": WISHED_IDS[serial]}}
              for serial in WISHED_IDS]
    return {"schema": "blactl-fleet/1", "common": common, "servos": servos}


def wished(serial):
    """What memory shall hold, by address."""
    values = {address: raw for address, _, raw in SETTINGS.values()}
    return {**values, "0x45": serial % len(SERVOS) + 1, "0x46": WISHED_IDS[serial]}


def check_wished(states):
    for serial, state in states.items():
        for address, raw in wished(serial).items():
            for memory in ("rom", "ram"):
                held = state[memory][address]
                assert held == raw, f"servo {serial}, {memory} {address}: {held}, not {raw}"
        assert state["node_id"] == WISHED_IDS[serial], f"servo {serial} is at {state['node_id']}"


def run(blactl, frames):
    """One kill; None: the command had ended before so many frames. Else what ROM was written in
    all, and whether the first run had changed anything."""
    with tempfile.TemporaryDirectory(prefix="blactl-apply-") as folder:
        path = os.path.join(folder, "fleet.json")
        with open(path, "w", encoding="utf-8") as file:
            json.dump(fleet(), file)
        words = ["--json", "--yes", "apply", path]
        simulator = bench.Simulator(blactl, folder, scenario())
        try:
            passing = between.GoBetween(folder, frames)
            status, out, err = passing.run(
                bench.start(blactl, folder, f"sim:{passing.interface}", words))
            if status == 0:
                return None
            assert status == -signal.SIGKILL, f"the first run: {status}\n{out}{err}"
            simulator.settle()
            states = simulator.dump()[1]
            static_cut.check_no_doubles(states)
            begun = any(state["count"] for state in states.values())
            second = bench.start(blactl, folder, static_cut.INTERFACE, words)
            out, err = second.communicate(timeout=bench.PATIENCE_S)
            assert second.returncode == 0, f"the second run: {second.returncode}\n{out}{err}"
            states = simulator.dump()[1]
            check_wished(states)
            return begun, sum(state["count"] for state in states.values())
        finally:
            simulator.end()


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("blactl")
    parser.add_argument("--first", type=int, default=1)
    parser.add_argument("--step", type=int, default=1)
    given = parser.parse_args()
    blactl = os.path.abspath(given.blactl)
    kills, after_save, writes, failed, frames = 0, 0, 0, 0, given.first
    while True:
        try:
            done = run(blactl, frames)
        except AssertionError as fault:
            failed += 1
            print(f"after frame {frames}: {fault}", flush=True)
            done = (False, 0)
        if done is None:
            break
        kills, after_save, writes = kills + 1, after_save + done[0], max(writes, done[1])
        frames += given.step
    print(f"{kills} kills after frames {given.first} to {frames - given.step}, {after_save} of them "
          f"after a first save: {failed} did not end as wished; at most {writes} ROM writes in all")
    return 1 if failed or not after_save else 0


if __name__ == "__main__":
    sys.exit(main())

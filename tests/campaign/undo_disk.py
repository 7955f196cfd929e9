#!/usr/bin/env python3
"""What `undo` still knows where the disk of the state folder gets full on the way.

Usage: tests/net/namespace.sh python3 undo_disk.py BLACTL

`set --save` goes on, and says so where its change is not recorded; `apply` changes nothing then. What
was recorded is taken back by `undo`, whatever the disk did afterwards, and a disk without room takes
nothing back that was recorded before. The earlier record still tells which settings are in RAM only.
"""

import argparse
import os
import sys

from alloc_disk import Place, codes, fixed
from undo_cut import Task, check_as_before

COMMITS = range(12)


class Three(Task):
    """Three servos that rotate their node IDs and change settings."""

    def __init__(self, shape):
        self.count, self.shape = 3, shape


def try_with(blactl, shape, commits, is_known):
    """Whether the change was recorded."""
    task = Three(shape)
    with Place(blactl, fixed(3)) as place:
        if is_known:
            assert place.run("set", "-n", "11", "-y", "reverse=on").status == 0
        else:
            place.simulator.settle()
        before = place.simulator.dump()[1]
        with place.disk.full_after(commits):
            told = place.run(*with_uids(task, before, place.folder))
        after = place.simulator.dump()[1]
        place.disk.free()
        if shape == "set --save":
            assert told.status == 0, told
            is_told = "reverse is on since a change in RAM only" in told.err
            assert is_told == is_known, told
            was_recorded = "this change is not recorded" not in told.err
        else:
            assert told.status == 0 or codes(told)[0] in ("state", "io"), told
            was_recorded = told.status == 0 or is_other(before, after)
        if was_recorded:
            undone = place.run("undo", "-y")
            assert undone.status == 0, undone
            # What was in RAM only was saved with the rest.
            memory = {serial: {**state, "rom": state["ram"]} for serial, state in before.items()}
            check_as_before(memory, place.simulator.dump()[1])
        elif is_known:
            check_known_is_taken_back(place)
        return was_recorded


def check_known_is_taken_back(place):
    """The change before, at once or after one that was recorded and not begun."""
    for _ in range(2):
        undone = place.run("undo", "-y", "-n", "11")
        assert undone.status == 0, undone
        if [state["ram"]["0x23"] for state in place.simulator.dump()[1].values()][0] == 0:
            return
    raise AssertionError(f"the change before is not taken back: {undone}")


def is_other(before, after):
    """Whether any servo has been changed."""
    try:
        check_as_before(before, after)
    except AssertionError:
        return True
    return False


def with_uids(task, states, folder):
    """The words of the task, for the unique IDs that these servos have."""
    task.units = [state["unique_id"] for state in states.values()]
    return task.words(folder)


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("blactl")
    blactl = os.path.abspath(parser.parse_args().blactl)
    faults, seen = 0, set()
    for shape in ("set --save", "apply", "rotate"):
        for is_known in (False, True):
            recorded = []
            for commits in COMMITS:
                try:
                    recorded.append(try_with(blactl, shape, commits, is_known))
                except AssertionError as fault:
                    faults += 1
                    print(f"{shape}, full after {commits} commits, known: {is_known}: {fault}",
                          flush=True)
            print(f"{shape}: recorded where the disk was full after so many commits: "
                  f"{[commits for commits, was in zip(COMMITS, recorded) if was]}", flush=True)
            seen.update(recorded)
    print(f"{faults} faults")
    return 1 if faults or seen != {True, False} else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Some things have one place in the source: SAVE, ERASE, a restart or the write of a setting is sent
there; somebody decides there on who has armed the vehicle or drives a servo; a node ID is entered
there into the allocation table. Whoever else wants that goes through this place, so that no guard
can be forgotten.

Usage: one_place_test.py ROOT. First the source of ROOT is looked at, then, in a copy, a violation
of every rule is planted on every floor that knows servos, to see that it is found.
"""

import pathlib
import re
import shutil
import sys
import tempfile

# What is done: how that looks in the source, and the files that may do it.
RULES = {
    "sends SAVE": (
        r"opcode\s*=\s*ExecuteOpcode::save\b",
        {"src/fleet/change/save_restart_job.cpp"}),
    "sends ERASE": (
        r"opcode\s*=\s*ExecuteOpcode::erase\b",
        {"src/fleet/change/erase_job.cpp"}),
    "sends a restart": (
        r"\bRestartNode::Request\b(?!::decode)",
        {"src/fleet/change/save_restart_job.cpp"}),
    "writes registers": (
        r"\bwrite_register\(",
        {"include/blactl/fleet/bus/register_access.hpp", "src/fleet/bus/register_access.cpp",
         "src/fleet/change/write_job.cpp",
         # 0x00 to 0x02 again and again, which are not settings.
         "src/fleet/motion/motion_job.cpp",
         # Measures on a bench, by one write() that asks the same guard.
         "src/fleet/characterize/test_bench.cpp"}),
    "runs a job that changes servos": (
        r"\b(Write|Erase|SaveRestart|Change)Job\b",
        {"include/blactl/fleet/change/", "src/fleet/change/",
         # The bench measures how servos start.
         "src/fleet/characterize/test_bench.hpp", "src/fleet/characterize/test_bench.cpp",
         "src/fleet/characterize/put_back.cpp"}),
    "carries plans out": (
        r"\bfleet::carry_out\(",
        {"src/fleet/change/carry_out_rounds.cpp"}),
    "decides by itself on who has armed the vehicle, or drives": (
        r"\b(armed_by|driver_of)\(",
        {"include/blactl/fleet/bus/command_watch.hpp", "src/fleet/bus/command_watch.cpp",
         "include/blactl/fleet/bus/roster.hpp", "src/fleet/bus/roster.cpp",
         "src/fleet/change/guard.cpp",
         # Not whether to write: whether 0x00 to 0x02 are still what ERASE has made them.
         "src/fleet/change/change_readings.cpp"}),
    "enters a node ID into the allocation table": (
        r"(store|table)_?(\.|->)(enter|allocate)\(",
        {"src/fleet/change/allocation_service.cpp", "src/fleet/change/carry_out_rounds.cpp",
         # IDs that were seen, or that a person wishes.
         "src/fleet/change/table_entries.cpp",
         # What a person imports, before any servo is asked.
         "src/cli/alloc/allocation_table.cpp"}),
}
# Floors that meet servos as their users do. sim is the servo, dronecan does not know any.
FLOORS = ("bla", "cli", "fleet", "state")

# For every rule a line that breaks it.
PLANTS = {
    "sends SAVE": "ExecuteOpcode::Request{.opcode = ExecuteOpcode::save}.encode();",
    "sends ERASE": "request.opcode = ExecuteOpcode::erase;",
    "sends a restart": "ask(id, RestartNode::type, RestartNode::Request{}.encode(), once);",
    "writes registers": "return write_register(servo.id, address, 900, patience);",
    "runs a job that changes servos": "SaveRestartJob job(roster, servo, {});",
    "carries plans out": "auto done = fleet::carry_out(session, profiles, plans, manner);",
    "decides by itself on who has armed the vehicle, or drives": "if (roster.armed_by(now)) {",
    "enters a node ID into the allocation table": "store->enter(wishes, wall);",
}

COMMENT = re.compile(r"//.*$", re.MULTILINE)


def faults_in(path, root):
    name = path.relative_to(root).as_posix()
    text = COMMENT.sub("", path.read_text(encoding="utf-8"))
    for rule, (pattern, places) in RULES.items():
        found = re.search(pattern, text)
        if found and not any(may(name, place) for place in places):
            line = text.count("\n", 0, found.start()) + 1
            yield f"{name}:{line}: {rule}: {found[0]}"


def sources(root):
    for folder in ("include/blactl", "src"):
        for floor in FLOORS:
            yield from sorted((root / folder / floor).rglob("*.?pp"))


def may(name, place):
    """Whether the file `name` is meant by a place, which may be a folder."""
    return name == place or (place.endswith("/") and name.startswith(place))


def idle_places(root):
    """Places that the table names, and that do not do it: the rule would look at nothing."""
    for rule, (pattern, places) in RULES.items():
        for place in sorted(places):
            path = root / place
            files = path.rglob("*.?pp") if path.is_dir() else [path] if path.is_file() else []
            if not any(re.search(pattern, COMMENT.sub("", file.read_text("utf-8")))
                       for file in files):
                yield f"{place}: does not do it: {rule}"


def has_leave(path, root):
    """Whether any rule names the file."""
    name = path.relative_to(root).as_posix()
    return any(may(name, place) for _, places in RULES.values() for place in places)


def faults(root):
    yield from idle_places(root)
    for path in sources(root):
        yield from faults_in(path, root)


def blind_spots(root):
    """What is planted and not found, in a copy of the source."""
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder)
        for part in ("include", "src"):
            shutil.copytree(root / part, copy / part)
        for floor in FLOORS:
            path = next(path for path in sources(copy) if floor in path.parts
                        and path.suffix == ".cpp" and not has_leave(path, copy))
            text = path.read_text(encoding="utf-8")
            for rule, line in PLANTS.items():
                path.write_text(text + f"\nvoid planted() {{\n  {line}\n}}\n", encoding="utf-8")
                if [rule for _ in faults_in(path, copy)] != [rule]:
                    yield f"{path.relative_to(copy)}: {line}: not found"
            path.write_text(text, encoding="utf-8")


def main():
    root = pathlib.Path(sys.argv[1]).resolve()
    if PLANTS.keys() != RULES.keys():
        sys.exit("a rule has no plant, or a plant no rule")
    found = list(faults(root)) or list(blind_spots(root))
    print("\n".join(found) or "each is done in one place")
    return 1 if found else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main())

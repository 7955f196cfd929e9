"""Whether what `blactl monitor` shows can be true."""

import json

import story
from story import require

VALUES = ("angle_deg", "speed_rpm", "torque_pct", "temperature_c", "voltage_v", "fault_summary")


def is_meant(outcome):
    return outcome.command.words[0] == "monitor"


def check(outcome, step, defaults, alone):
    """As story.check()."""
    del defaults  # it changes nothing
    if outcome.command.killed_after_s and outcome.status == story.KILLED:
        return
    story.check_document(outcome)
    last = {}
    for line in map(json.loads, outcome.out.splitlines()[:-1]):
        if line["serial_number"] is not None:
            story.check_identity(line, step)
            last[line["serial_number"]] = line
    if not alone:
        return
    require(not outcome.record.changes(), "it has sent what changes a servo")
    story.check_others(outcome, step)
    story.check_rom_writes(outcome, step)
    for serial in step.after:
        if not story.is_meant(outcome, serial, step):
            require(serial not in last, f"{serial} is told of, and not meant")
        elif step.is_doubled(serial, outcome.record):
            require(outcome.status != 0, f"0, but {serial} is one of two under a node ID")
            require(all(last.get(serial, {}).get(key) is None for key in VALUES),
                    f"data of {serial}, which is one of two")

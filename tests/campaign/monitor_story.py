"""Whether what `blactl monitor` shows can be true."""

import json

import story
from story import require

VALUES = ("angle_deg", "speed_rpm", "torque_pct", "temperature_c", "voltage_v", "fault_summary")
INTERFACE = 3  # exit status
LATENESS_S = 0.01  # of the clock of the record against that of the lines
# Key: register, and what 1 means in it. Angles come from actuator.Status as well.
ASKED = {"speed_rpm": ("0x09", 1), "torque_pct": ("0x0A", 1), "temperature_c": ("0x0B", 1),
         "voltage_v": ("0x0C", 10), "fault_summary": ("0x18", 1)}


def is_meant(outcome):
    return outcome.command.words[0] == "monitor"


def check(outcome, step, defaults, alone):
    """As story.check()."""
    del defaults  # it changes nothing
    if outcome.command.killed_after_s and outcome.status == story.KILLED:
        return
    story.check_document(outcome)
    last = {}
    lines = [json.loads(line) for line in outcome.out.splitlines()[:-1]]
    require(lines or outcome.status != 0, "0, but of no servo")
    require(not lines or outcome.status != 4 or lines[-1]["stale"], "4, but lines of a servo")
    check_values(outcome, lines)
    for line in lines:
        if line["serial_number"] is not None:
            story.check_identity(line, step)
            last[line["serial_number"]] = line
        else:  # not known, or not any more: what an earlier line told of a unit there is over
            last = {serial: told for serial, told in last.items()
                    if told["node_id"] != line["node_id"]}
    if not alone:
        return
    require(not outcome.record.changes(), "it has sent what changes a servo")
    story.check_others(outcome, step)
    story.check_rom_writes(outcome, step)
    for serial in step.after:
        if not story.is_meant(outcome, serial, step):
            require(serial not in last, f"{serial} is told of, and not meant")
        elif step.is_doubled(serial, outcome.record):
            knows_nobody = is_short(outcome.command) and \
                not has_recognised(lines, step.after[serial]["node_id"])
            require(outcome.status != 0 or knows_nobody,
                    f"0, but {serial} is one of two under a node ID")
            was_cut = outcome.status == INTERFACE  # before the second one was heard, perhaps
            require(was_cut or all(last.get(serial, {}).get(key) is None for key in VALUES),
                    f"data of {serial}, which is one of two")


def is_short(command):
    """Two units' answers to who they are may spoil each other for longer than it looked."""
    return float(command.words[command.words.index("--duration") + 1]) < 2


def has_recognised(lines, node_id):
    """Whether it told who is there."""
    return any(line["unique_id"] for line in lines if line["node_id"] == node_id)


def check_values(outcome, lines):
    """Every number was told by that node before."""
    registers = {register for register, _ in ASKED.values()}
    told = {}
    for time, node_id, register, value in outcome.record.answers(registers):
        told.setdefault((node_id, register, value), time)
    for line in lines:
        for key, (register, scale) in ASKED.items():
            if line[key] is not None:
                since = told.get((line["node_id"], register, round(line[key] * scale)))
                require(since is not None and since <= line["time"] + LATENESS_S,
                        f"{key} {line[key]}: node {line['node_id']} has not told so")

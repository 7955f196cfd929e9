"""Whether what `blactl command` has told agrees with what was sent and what the shaft did."""

import json
import re

import story
from record import GET_SET
from story import require

ARRAY_COMMAND = 1010
REGISTERS = {"angle": "0x00", "speed": "0x01", "torque": "0x02"}
SCALES = {"angle": 10, "speed": 1, "torque": 1}
LIMITS = {"angle": ("0x39", "0x38"), "speed": ("0x3B", "0x3A"), "torque": ("0x3D", "0x3C")}
ANGLE, SPEED, TORQUE = MEASURED = "0x08", "0x09", "0x0A"
SHOWN = {ANGLE: ("angle_deg", 10), SPEED: ("speed_rpm", 1), TORQUE: ("torque_pct", 1)}
HELD = re.compile(r"held at (-?\d+\.\d) deg")
AFTERWARDS = re.compile(r"(\d+) ms after the last command .*?\((hold|off|brake)\)")
ACTIONS = ["hold", "off", "brake"]
# One of them is said wherever it was commanded.
ENDS = ("stopped at", "held at", "nothing holds it", "is not known", "nothing more was written",
        "after the last command")
OUTPUT, CONTROL, TIMEOUT_ACTION, TIMEOUT = "0x20", "0x25", "0x26", "0x27"
HOLD = 0
NOT_ACTIVE = 555555555
REACHED, STANDING = 12, 1  # tenths of a degree, rpm


def is_meant(outcome):
    return outcome.command.words[0] == "command"


def check(outcome, step, defaults, alone):
    """As story.check()."""
    del defaults  # it changes no setting
    if outcome.command.killed_after_s and outcome.status == story.KILLED:
        return
    story.check_document(outcome)
    lines = [json.loads(line) for line in outcome.out.splitlines()[:-1]]
    for line in lines:
        story.check_identity(line, step)
    require(len({line["serial_number"] for line in lines}) <= 1, "it tells of two servos")
    if outcome.status == 0:
        require(lines, "0, but nothing was sampled")
    if not alone:
        return
    writes = writes_of(outcome.record)
    check_writes(outcome, writes, lines, step)
    check_samples(outcome, lines, step)
    require(not writes or any(end in outcome.err for end in ENDS), "how it ended is not said")
    story.check_refusal(outcome, step)
    story.check_others(outcome, step)
    story.check_rom_writes(outcome, step)
    if lines:
        check_end(outcome, lines[0]["serial_number"], writes, step)
    if must_move(outcome, step):
        require(outcome.status == 0, "nothing was in its way")


def motion(command):
    """What is commanded: "angle", and its register number; a wiggle is one of angles."""
    for word in command.words:
        kind, _, value = word.partition("=")
        if kind in REGISTERS:
            return kind, round(float(value.rstrip("degrpm%")) * SCALES[kind])
    return "angle", None


def writes_of(heard):
    """(time, destination, register, value) of every write that went out; an ArrayCommand has
    neither destination nor register."""
    writes, parts = [], {}
    for frame in heard.frames:
        own = frame.source in (127, 126, 9)
        if own and not frame.is_service and frame.type == ARRAY_COMMAND:
            writes.append((frame.time, None, None, None))
        if not (own and frame.is_request and frame.type == GET_SET):
            continue
        key = (frame.can_id, frame.data[-1] & 0x1F)
        if frame.starts:
            parts[key] = (frame.time, b"")
        begun, payload = parts.get(key, (frame.time, b""))
        parts[key] = (begun, payload + frame.data[:-1])
        is_end, is_only = frame.data[-1] & 0x40, frame.data[-1] & 0xC0 == 0xC0
        if is_end and not is_only:
            payload = parts[key][1][2:]  # without its CRC
            writes.append((begun, frame.can_id >> 8 & 0x7F, payload[10:].decode("ascii"),
                           int.from_bytes(payload[2:10], "little", signed=True)))
    return writes


def check_writes(outcome, writes, lines, step):
    kind, target = motion(outcome.command)
    for _, destination, register, value in writes:
        if register is None:
            require("--array" in outcome.command.words, "an ArrayCommand that nobody asked for")
            continue
        require(register == REGISTERS[kind], f"{register} was written")
        require(lines or outcome.status != 0, "written, but of no servo")
        if lines:
            serial = lines[0]["serial_number"]
            require(destination in step.node_ids(serial), f"node {destination} was written")
        if kind != "angle":
            require(value in (target, 0), f"{register} = {value}")


def check_samples(outcome, lines, step):
    """Every number of a line was told by the servo, one after the other."""
    if not lines:
        return
    if any(step.holders(node_id) > 1 for node_id in step.node_ids(lines[0]["serial_number"])):
        return
    for register, (key, scale) in SHOWN.items():
        told = iter(answer[3] for answer in outcome.record.answers([register]))
        for line in lines:
            shown = line[key]
            require(shown is None or round(shown * scale) in told, f"{key} {shown}: nobody told so")


def check_held(outcome, serial, after):
    """Where it is said to be held, it stays."""
    said = HELD.search(outcome.err)
    if said:
        held = round(float(said[1]) * SCALES["angle"])
        require(abs(after[ANGLE] - held) <= REACHED,
                f"{serial} is at {after[ANGLE]}, not at {held}")
        require(abs(after[SPEED]) <= STANDING, f"{serial} is held, and turns")


def check_afterwards(outcome, serial, after):
    """What it is said to do when commands end, is what it will do."""
    said = AFTERWARDS.search(outcome.err)
    if said:
        require((int(said[1]), said[2]) == (after[TIMEOUT], ACTIONS[after[TIMEOUT_ACTION]]),
                f"{serial}: {said[0]} is said, it is {after[TIMEOUT]} ms and "
                f"{ACTIONS[after[TIMEOUT_ACTION]]}")


def check_end(outcome, serial, writes, step):
    """What it was told last is so, and it did what was told."""
    kind, target = motion(outcome.command)
    after = step.after[serial]["ram"]
    if step.restarted_unheard(serial, outcome.record):
        return
    if kind != "angle" and (outcome.status == 0 or "stopped at" in outcome.err):
        require(after[REGISTERS[kind]] in (0, NOT_ACTIVE), f"{serial} was not stopped")
        require(abs(after[SPEED]) <= STANDING, f"{serial} still turns")
    check_held(outcome, serial, after)
    check_afterwards(outcome, serial, after)
    if outcome.status != 0:
        return
    moments = [write[0] for write in writes]
    require(not any(moments[0] < time < moments[-1] for time in step.restarts(serial)),
            f"0, but {serial} restarted meanwhile")
    if kind == "angle":
        due = after[REGISTERS[kind]] if target is None else target
        require(after[REGISTERS[kind]] == due, f"{serial} holds another command")
        require(abs(after[ANGLE] - due) <= REACHED, f"{serial} is at {after[ANGLE]}, not at {due}")
    gaps = [later - earlier for earlier, later in zip(moments, moments[1:])]
    longest = step.before[serial]["ram"][TIMEOUT] / 1000 / 2
    require(all(gap < longest + 0.01 for gap in gaps[:-1]), f"{max(gaps):.3f} s without a command")


def must_move(outcome, step):
    """Whether nothing is in its way."""
    words = outcome.command.words
    target, (kind, value) = outcome.command.target(), motion(outcome.command)
    serials = [serial for serial in step.after if story.is_meant(outcome, serial, step)]
    if (len(serials) != 1 or "--duration" in words or "--array" in words or target == "all"
            or not all(step.is_unhindered(serial) for serial in step.after)):
        return False
    serial = serials[0]
    before = step.before[serial]["ram"]
    if (step.before[serial]["node_id"] in (0, None) or step.restarts(serial)
            or step.before[serial]["node_id"] != step.after[serial]["node_id"]
            or any(step.holders(node_id) > 1 for node_id in step.node_ids(serial))
            or target.isdigit() and int(target) != step.after[serial]["node_id"]):
        return False
    low, high = (before[limit] for limit in LIMITS[kind])
    value = before[ANGLE] if value is None else value
    is_free = (before[OUTPUT] == 0 and low + 60 <= value <= high - 60
               and low <= before[ANGLE] <= high) if kind == "angle" else (
        before[OUTPUT] == 0 and low <= value <= high and before[CONTROL] == 1
        and before[TIMEOUT_ACTION] != HOLD)
    return is_free and not any(before[reg] for reg in ("0x1A", "0x1B"))

"""Whether what `blactl alloc` has told agrees with the node IDs that servos got."""

import json

import story
import truth
from story import require

GIVES = ("assigned", "kept")


def is_meant(outcome):
    return outcome.command.words[0] == "alloc"


def check(outcome, step, defaults, alone):
    """As story.check()."""
    del defaults  # it changes no register
    if outcome.command.killed_after_s and outcome.status == story.KILLED:
        return
    story.check_document(outcome)
    if "--list" in outcome.command.words:
        check_table(outcome, step, step.given if alone else step.given_before)
        return
    events = [json.loads(line) for line in outcome.out.splitlines()[:-1]]
    check_events(events, outcome, step)
    if alone:
        require(not outcome.record.changes(), "it has changed a servo")
        check_wire(events, outcome, step)
        story.check_others(outcome, step)
        story.check_rom_writes(outcome, step)
        if outcome.status == 0:
            check_success(events, outcome, step)


def check_table(outcome, step, given):
    """Every ID that a servo was ever given is in the table, and nobody else's."""
    entries = {entry["unique_id"]: entry["node_id"] for entry in outcome.document["entries"]}
    require(len(set(entries.values())) == len(entries), "an ID is two units'")
    units = {state["unique_id"] for state in step.after.values()}
    require(entries.keys() <= units, "the table has units that there never were")
    if not step.has_other_allocator() and outcome.status == 0:
        for serial, node_ids in given.items():
            found = entries.get(step.after[serial]["unique_id"])
            require(found in node_ids, f"{serial} was given {node_ids}, the table says {found}")


def check_events(events, outcome, step):
    """A unit is told of under one ID, and an ID of one unit."""
    told = {}
    units = {state["unique_id"] for state in step.after.values()}
    for event in events:
        require(event["unique_id"] in units, "there is no such unit")
        if event["event"] in GIVES:
            known = told.setdefault(event["unique_id"], event["node_id"])
            require(known == event["node_id"], f"{event['unique_id']} is told of twice")
    require(len(set(told.values())) == len(told), "an ID is told of two units")
    for kind in GIVES:
        count = sum(event["event"] == kind for event in events)
        require(outcome.document["counts"].get(kind, 0) == count, f"another number of {kind}")


def check_wire(events, outcome, step):
    """What a servo was given was told, and is new to the bus or to the others on it."""
    told = {event["unique_id"]: event["node_id"] for event in events if event["event"] in GIVES}
    if not step.has_other_allocator():
        for serial, node_id in step.allocated():
            due = told.get(step.after[serial]["unique_id"])
            require(due == node_id, f"{serial} was given {node_id}, told was {due}")
    for event in events:
        if event["event"] != "assigned":
            continue
        unit = event["unique_id"]
        serial = next(s for s, state in step.after.items() if state["unique_id"] == unit)
        heard = [time for time in outcome.record.times_of({event["node_id"]})
                 if time < event["time"] - truth.TOLERANCE_S]
        require(not heard or event["node_id"] in step.node_ids(serial),
                f"{serial} was given {event['node_id']}, which was heard before")


def check_success(events, outcome, step):
    """0: whoever got an ID is there under it, and nobody asks any more."""
    told = {event["unique_id"]: event["node_id"] for event in events if event["event"] in GIVES}
    for serial, state in step.after.items():
        has_read_rom = step.restarts(serial) and state["ram"]["0x46"] != 0  # and needs no other ID
        if has_read_rom or step.has_copy(serial) or step.restarted_unheard(serial, outcome.record):
            continue
        due = told.get(state["unique_id"], state["node_id"])
        require(state["node_id"] == due, f"{serial} is at {state['node_id']}, told was {due}")
        if step.is_unhindered(serial):
            require(state["node_id"] != 0, f"0, but {serial} has no node ID")

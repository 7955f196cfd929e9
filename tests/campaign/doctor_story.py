"""Whether what `blactl doctor` has found is there, and what is there it has found."""

import story
from story import require

# What is no fault of anybody where nothing goes wrong: what servos hold, or lack by themselves.
OF_SERVOS = {"duplicate_node_id", "duplicate_servo_id", "firmware_defect", "health", "no_node_id",
             "static_node_id"}
SERVO_ID = "0x45"


def is_meant(outcome):
    return outcome.command.words[0] == "doctor"


def check(outcome, step, defaults, alone):
    """As story.check()."""
    del defaults  # it changes no register
    if outcome.command.killed_after_s and outcome.status == story.KILLED:
        return
    document = outcome.document
    check_status(outcome, document)
    for finding in document["findings"]:
        check_finding(finding, step)
    if not alone:
        return
    require(not outcome.record.changes(), "it has sent what changes a servo")
    story.check_others(outcome, step)
    story.check_rom_writes(outcome, step)
    if not document["errors"]:
        check_conflicts(outcome, document, step)
    if all(step.is_unhindered(serial) for serial in step.after):
        check_unhindered(document)


def check_status(outcome, document):
    """8 where it has found something, and nothing else is worse."""
    require(document["exit_status"] == outcome.status, "exit_status is another in the document")
    require(document["fixed"] == [], "it has mended something")
    require(document["counts"]["findings"] == len(document["findings"]), "a wrong count")
    if document["errors"]:
        require(outcome.status not in (0, 8), f"errors, but exit status {outcome.status}")
    else:
        due = 8 if document["findings"] else 0
        require(outcome.status == due, f"exit status {outcome.status}, due was {due}")
    for finding in document["findings"]:
        require(finding["text"] and finding["fix"], f"{finding['code']} is not explained")


def check_finding(finding, step):
    """A finding that could not be true at any moment is a lie."""
    code, node_id = finding["code"], finding["node_id"]
    if code == "duplicate_node_id":
        require(node_id is not None and step.holders(node_id) > 1, f"nobody shares ID {node_id}")
    elif code == "duplicate_servo_id":
        require(shares_servo_id(step), "no servo ID is two servos'")
    elif code == "restarted":
        require(any(node_id in step.node_ids(serial) and step.restarts(serial)
                    for serial in step.after), f"node {node_id} did not restart")
    elif code == "commander":
        require(node_id in step.commanders(), f"node {node_id} commands nobody")
    elif code == "duplicate_serial_number":
        require(False, "each serial number is one servo's")
    elif code == "no_node_id":
        require(any(step.had_no_node_id(serial) for serial in step.after), "all have a node ID")


def shares_servo_id(step):
    """Whether two servos can have had the same one."""
    held = [{moment[SERVO_ID] for moment in step.moments(serial)} for serial in step.after]
    return any(one & other for i, one in enumerate(held) for other in held[:i])


def check_conflicts(outcome, document, step):
    """Every node ID that two servos shared for long enough is told, of those that were heard: not
    where the look ended early, which is told then."""
    if any(finding["code"] == "bus_off" for finding in document["findings"]):
        return
    told = {finding["node_id"] for finding in document["findings"]
            if finding["code"] == "duplicate_node_id"}
    for serial, state in step.after.items():
        node_id = state["node_id"]
        was_heard = outcome.record.times_of({node_id})
        if was_heard and step.is_doubled(serial, outcome.record):
            require(node_id in told, f"{node_id} is two servos', and not told")


def check_unhindered(document):
    require(not document["errors"], "nothing was in its way")
    others = {finding["code"] for finding in document["findings"]} - OF_SERVOS
    require(not others, f"nothing was wrong, told was {others}")

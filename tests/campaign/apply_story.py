"""Whether what `blactl apply` and `undo` have told agrees with what happened in the servos."""

import story
import truth
from story import require

STATUSES = story.STATUSES | {8}
DONE = {"changed", "unchanged"}
OTHERS = {"extra", "skipped"}  # nothing was wished of them
WORDS = DONE | OTHERS | {"failed", "missing"}
STATIC_NODE_ID = "0x46"


def is_meant(outcome):
    return outcome.command.words[0] in ("apply", "undo")


def check(outcome, step, defaults, alone):
    """As story.check()."""
    del defaults  # a fleet file says it all
    if outcome.command.killed_after_s and outcome.status == story.KILLED:
        return
    document = story.check_document(outcome, STATUSES)
    for node in document.get("nodes", []):
        require(node["status"] in WORDS or is_plan(outcome), f"status {node['status']}")
        if node.get("serial_number") is not None:
            story.check_identity(node, step)
            if alone:
                check_node(outcome, node, step)
    if outcome.status == 0:
        check_success(outcome, document)
    check_counts(outcome, document)
    if alone:
        check_plan(outcome, document)
        story.check_refusal(outcome, step)
        story.check_others(outcome, step)
        check_doubled(outcome, document, step)
        check_rom_writes(outcome, document, step)
        if not is_plan(outcome):
            story.check_copies(outcome, document, step)


def is_plan(outcome):
    return "--dry-run" in outcome.command.words


def saves(outcome):
    return "--no-save" not in outcome.command.words


def check_success(outcome, document):
    """0: everything that was asked for is done, and proven as far as that was asked."""
    nodes = [node for node in document["nodes"] if node["status"] not in OTHERS]
    require(nodes, "0, but of no servo")
    for node in nodes:
        require(node["status"] in DONE, f"0, but {node['status']}")
        is_proven = node.get("verified_after_restart", False)
        asks = outcome.command.fleet and not {"--no-save", "--trust-ram"} & {*outcome.command.words}
        require(is_proven or not asks, "0, but ROM is not proven")


def check_counts(outcome, document):
    if is_plan(outcome) or "changed" not in document["counts"]:
        return
    for word in DONE:
        count = sum(node["status"] == word for node in document["nodes"])
        require(document["counts"][word] == count, f"another number of {word}")


def check_plan(outcome, document):
    if not is_plan(outcome):
        return
    require(not outcome.record.changes(), "a plan has changed a servo")
    different = [node for node in document.get("nodes", []) if node["status"] == "different"]
    if not document["errors"]:
        require((outcome.status == 8) == bool(different), f"{outcome.status} of this plan")


def check_node(outcome, node, step):
    """What is told of one servo."""
    serial = node["serial_number"]
    if node["status"] not in DONE or is_plan(outcome):
        require(not (node.get("saved") and node["status"] != "failed"), "saved, but not changed")
        return
    after = step.after[serial]
    is_due = not step.restarted_unheard(serial, outcome.record)
    for change in node["changes"]:
        address, wished = change["address"], change["requested"]
        memories = ["rom"] if node["verified_after_restart"] else []
        memories += ["ram"] if node["verified_after_restart"] or is_due else []
        for memory in memories:
            require(after[memory][address] == wished, f"{serial} {address}: {memory} holds "
                    f"{after[memory][address]}, {node['status']} was to be {wished}")
        held = change["after"] == wished and change["status"] in story.HELD
        require(held, f"{node['status']}, but {change}")
    if node["status"] == "unchanged":
        require(not node["saved"], "unchanged, but saved")
        wished = {change["address"]: change["requested"] for change in node["changes"]}
        held = step.before[serial]["ram"]
        restarted = step.restarts(serial) or truth.has_lost_rom(after)
        require(restarted or all(held[address] == raw for address, raw in wished.items()),
                f"{serial}: unchanged, but it held something else")
    if node["node_id_after"] is not None and is_due:
        require(node["node_id_after"] == after["node_id"], f"{serial} is at {after['node_id']}")


def takes_last_run(outcome):
    return outcome.command.words[0] == "undo" and "-n" not in outcome.command.words


def check_doubled(outcome, document, step):
    """Of two servos under one node ID nothing is done."""
    told = {node.get("serial_number"): node for node in document.get("nodes", [])}
    for serial in step.after:
        # What the last run had changed is for the record to say.
        is_meant = serial in told if takes_last_run(outcome) else story.is_meant(outcome, serial, step)
        if is_meant and step.is_doubled(serial, outcome.record):
            require(outcome.status not in (0, 8), f"{serial} is one of two under a node ID")
            status = told.get(serial, {}).get("status")
            require(status not in DONE, f"{status}, but {serial} is one of two")


def check_rom_writes(outcome, document, step):
    """One a servo; two for one that makes way for others; none without need."""
    told = {node.get("serial_number"): node for node in document.get("nodes", [])}
    for serial in step.after:
        count = step.rom_writes(serial)
        moves = outcome.command.words[0] == "undo" or any(
            "static_node_id" in entry["set"] for entry in outcome.command.entries())
        most = (2 if moves else 1) if saves(outcome) and not is_plan(outcome) else 0
        require(count <= most, f"{serial}: {count} ROM writes")
        if told.get(serial, {}).get("status") in {"unchanged", *OTHERS}:
            require(count == 0, f"{serial}: {told[serial]['status']}, but ROM was written")
    story.check_unread_rom(outcome, step)

"""Whether a command has said what it made permanent, or took, of settings that stood in RAM only
and that it does not name. It can know those that commands had written since the servo's start."""

import truth
from story import HELD, require

SILENT = ("alloc", "characterize", "command", "doctor", "erase", "get", "monitor")


def check(outcome, step):
    if outcome.command.words[0] in SILENT or "--dry-run" in outcome.command.words:
        return
    for node in outcome.document.get("nodes", []):
        if node.get("serial_number") in step.before and is_done(node):
            check_node(node, step)


def check_node(node, step):
    serial = node["serial_number"]
    before, after = step.before[serial], step.after[serial]
    if truth.has_lost_rom(before):
        return
    named = {change["address"] for change in node.get("changes", [])}
    unnamed = [address for address in step.unsaved.get(serial, ()) if address not in named]
    saved = [address for address in unnamed
             if after["rom"][address] == before["ram"][address] != before["rom"][address]]
    require_told(node, "unnamed_saved", serial, saved)
    if len(step.restarts(serial)) == 1 and step.is_unhindered(serial):
        lost = [address for address in unnamed
                if after["ram"][address] == before["rom"][address] != before["ram"][address]]
        require_told(node, "unnamed_lost", serial, lost)


def is_done(node):
    statuses = {change["status"] for change in node.get("changes", [])}
    return node.get("status") in ("done", "changed", "unchanged") or (
        "status" not in node and statuses and statuses <= set(HELD))


def require_told(node, code, serial, addresses):
    told = [warning for warning in node.get("warnings", []) if warning["code"] == code]
    require(len(told) >= len(addresses), f"{serial}: {code} {addresses}, told was {told}")


def unsaved_after(outcomes, step):
    """The addresses of each servo that commands have written since its start and not saved."""
    known = {}
    for serial, state in step.after.items():
        written = {address for address, raw in state["ram"].items()
                   if raw != step.before[serial]["ram"].get(address)}
        if not all(outcome.status == 0 for outcome in outcomes):
            written = set()
        if not step.restarts(serial):
            written |= step.unsaved.get(serial, set())
        known[serial] = {address for address in written & state["rom"].keys()
                         if state["ram"][address] != state["rom"][address]}
    return known

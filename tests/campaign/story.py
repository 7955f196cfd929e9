"""Whether what a command has told agrees with what happened in the servos."""

import json

# Exit statuses of the contract that these commands can end with.
STATUSES = {0, 1, 2, 3, 4, 5, 6, 9}
KILLED = -9
NEVER_COMPARED = {"0x45", "0x46"}  # --keep-ids


class Lie(Exception):
    pass


def require(condition, text):
    if not condition:
        raise Lie(text)


class Step:
    """What the simulator says of one step."""

    def __init__(self, before, events, after):
        self.before, self.after = before, after
        self._events = events

    def count(self, serial, event):
        return sum(1 for line in self._events
                   if line["event"] == event and line["serial_number"] == serial)

    def is_doubled(self, serial):
        node_id = self.before[serial]["node_id"]
        return sum(1 for state in self.before.values() if state["node_id"] == node_id) > 1

    def rom_writes(self, serial):
        return self.after[serial]["count"] - self.before[serial]["count"]


def check(outcome, step, defaults, alone):
    """Raises Lie. `alone`: no other command ran meanwhile."""
    if outcome.command.killed_after_s and outcome.status == KILLED:
        return
    require(outcome.status in STATUSES, f"exit status {outcome.status}")
    document = json.loads(outcome.out)
    require(document["exit_status"] == outcome.status, "exit_status is another in the document")
    errors = [error["code"] for error in document["errors"]]
    require(bool(errors) == (outcome.status != 0), f"status {outcome.status}, errors {errors}")
    for code in errors:
        require(f"[{code}]" in outcome.err, f"{code} is not on stderr")
    saves = "--save" in outcome.command.words or outcome.command.words[0] == "save"
    for node in document.get("nodes", []):
        serial = node.get("serial_number")
        if serial is None:
            continue
        require(serial in step.after, f"there is no servo {serial}")
        if outcome.command.words[0] not in ("get", "set") or not step.is_doubled(serial):
            # Known: these ask no more than they must, and may take two servos of one node ID for
            # one before the bus has shown that there are two.
            require(node["unique_id"] in (None, step.after[serial]["unique_id"]),
                    "a wrong unique ID")
        check_node(outcome, node, serial, step, defaults, saves, alone)
        if alone and saves:
            require(step.rom_writes(serial) <= 1, f"{serial}: {step.rom_writes(serial)} ROM writes")
    if alone and not saves:
        for serial in step.after:
            require(step.rom_writes(serial) == 0, f"{serial}: ROM was written")


def check_node(outcome, node, serial, step, defaults, saves, alone):
    verb = outcome.command.words[0]
    done = node.get("status") == "done" or node.get("saved") is True
    if outcome.status == 0 and verb != "get":
        require(verb == "set" or node["status"] == "done", "0, but not everything is done")
    if not alone:
        return  # another one may have written after this one had proved what it wrote
    if verb == "set":
        check_changes(node, serial, step)
    elif done and verb == "erase":
        check_erased(outcome, node, serial, step, defaults, saves)
    elif done and verb == "restart":
        require(step.count(serial, "restart") >= 1, f"{serial} was not restarted")
    if done and saves:
        check_saved(serial, step)


def check_changes(node, serial, step):
    for change in node.get("changes", []):
        if change["status"] not in ("written", "unchanged"):
            continue
        require(change["after"] == change["requested"], "written, but not as requested")
        address, after = change["address"], step.after[serial]
        if node.get("saved") is True:
            require(after["rom"][address] == change["after"], f"{serial} {address} is not in ROM")
        elif step.count(serial, "restart") == 0:
            require(after["ram"][address] == change["after"], f"{serial} {address} is not in RAM")


def check_erased(outcome, node, serial, step, defaults, saves):
    memory = "rom" if saves else "ram"
    if not saves and step.count(serial, "restart") > 0:
        return  # what was not saved is gone again
    kept = NEVER_COMPARED if "--keep-ids" in outcome.command.words else set()
    for address, default in defaults[node["model"]].items():
        if address not in kept and address in step.after[serial]["rom"]:
            found = step.after[serial][memory][address]
            require(found == default, f"{serial} {address}: {found} in {memory}, not {default}")


def check_saved(serial, step):
    """ROM was written, or held everything before: then a restart proves as much."""
    before, after = step.before[serial], step.after[serial]
    written = step.rom_writes(serial) >= 1
    for address, value in after["rom"].items():
        require(written or before["ram"][address] == value, f"{serial} {address} was not saved")
        if step.count(serial, "restart") <= 1:
            require(after["ram"][address] == value, f"{serial} {address}: RAM differs from ROM")

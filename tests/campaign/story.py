"""Whether what a command has told agrees with what happened in the servos.

Nothing is exempt that a client can know. What it cannot: a restart after the last frame that could
have told of it (Step.restarted_unheard)."""

import truth
from record import EXECUTE_OPCODE, RESTART_NODE

# Exit statuses of the contract that these commands can end with.
STATUSES = {0, 1, 2, 3, 4, 5, 6, 7, 9}
UNTOUCHED = {2, 7, 9}  # refusals: then nothing was sent that changes a servo
KILLED = -9
IDS = ("0x45", "0x46")  # --keep-ids
HELD = ("written", "unchanged")


class Lie(Exception):
    pass


def require(condition, text):
    if not condition:
        raise Lie(text)


def check(outcome, step, defaults, alone):
    """Raises Lie. `alone`: no other command ran meanwhile."""
    if outcome.command.killed_after_s and outcome.status == KILLED:
        return
    document = check_document(outcome)
    for node in document.get("nodes", []):
        if node.get("serial_number") is not None:
            check_identity(node, step)
            if alone:
                check_node(Told(outcome, node, step), defaults)
    if outcome.status == 0:
        check_success(outcome, document)
    if alone:
        check_refusal(outcome, step)
        check_doubled(outcome, document, step)
        check_others(outcome, step)
        check_rom_writes(outcome, step)
        check_copies(outcome, document, step)


def check_copies(outcome, document, step):
    """What is not told from others by its unique ID is not changed."""
    if outcome.command.words[0] == "get" or outcome.status != 0:
        return
    for node in document["nodes"]:
        serial = node.get("serial_number")
        is_changed = serial is not None and node.get("status") not in ("skipped", "extra")
        require(not is_changed or not step.is_one_of_several(serial),
                f"0, but the unique ID of {serial} is not its own")


def check_document(outcome, statuses=frozenset(STATUSES)):
    require(outcome.status in statuses, f"exit status {outcome.status}")
    document = outcome.document
    require(document["exit_status"] == outcome.status, "exit_status is another in the document")
    errors = [error["code"] for error in document["errors"]]
    require(bool(errors) == (outcome.status not in (0, 8)),
            f"status {outcome.status}, errors {errors}")
    for code in errors:
        require(f"[{code}]" in outcome.err, f"{code} is not on stderr")
    return document


def check_identity(node, step):
    serial = node["serial_number"]
    require(serial in step.after, f"there is no servo {serial}")
    require(node["unique_id"] in (None, step.after[serial]["unique_id"]), "a wrong unique ID")


def may_save(outcome):
    """characterize saves what ROM holds already."""
    return saves(outcome) or outcome.command.words[0] == "characterize"


def saves(outcome):
    return "--save" in outcome.command.words or outcome.command.words[0] == "save"


def check_success(outcome, document):
    """0: everything that was asked for is done."""
    verb = outcome.command.words[0]
    require(document["nodes"], "0, but of no servo")
    for node in document["nodes"]:
        if verb == "set":
            statuses = {change["status"] for change in node["changes"]}
            require(statuses <= set(HELD), f"0, but {statuses}")
            require(node["saved"] or not saves(outcome) or statuses == {"unchanged"},
                    "0, but it is not saved")
        elif verb != "get":
            require(node["status"] == "done", "0, but not everything is done")


def check_refusal(outcome, step):
    """A second servo under a node ID ends a command also while it is at work, and so does another
    node that arms the vehicle or drives."""
    record = outcome.record
    sent = record.changes()
    if outcome.status in UNTOUCHED and sent:
        is_begun = sent[0].time < min(record.armed_at(), record.driven_at()) < float("inf")
        require(outcome.status == 9 and (is_begun or step.comes_to_another(sent[0].time)),
                f"refused with {outcome.status}, but {len(sent)} changes were sent")
    for frame in sent:
        since = f"{frame.time - record.armed_at():.3f} s after"
        require(frame.time < record.armed_at() + truth.TOLERANCE_S, f"sent {since} armed: {frame}")
        restarts = frame.type in (RESTART_NODE, EXECUTE_OPCODE)
        is_late = frame.time > record.driven_at() + truth.TOLERANCE_S
        require(not (restarts and is_late), f"sent to a driven servo: {frame}")


def is_meant(outcome, serial, step):
    """Whether the command's -n takes in a servo."""
    if outcome.command.words[0] in ("alloc", "doctor"):
        return False
    if outcome.command.words[0] == "apply" and not any(
            entry["match"]["serial_number"] == serial for entry in outcome.command.entries()):
        return False
    target = outcome.command.target()
    if target == "all":
        return True
    if target.startswith("serial:"):
        return target == f"serial:{serial}"
    return int(target) in step.node_ids(serial)


def check_doubled(outcome, document, step):
    """Of two servos under one node ID nothing is told, and nothing is done to them."""
    told = {node.get("serial_number"): node for node in document.get("nodes", [])}
    for serial in step.after:
        if not (serial in told or is_meant(outcome, serial, step)):
            continue
        if step.is_doubled(serial, outcome.record):
            require(outcome.status != 0, f"0, but {serial} is one of two under a node ID")
            require(not tells_data(told.get(serial, {})), f"data of {serial}, which is one of two")


def tells_data(node):
    return (bool(node.get("params")) or node.get("status") == "done" or
            any(change["status"] in HELD for change in node.get("changes", [])))


def check_others(outcome, step):
    """Whom the command does not mean, it leaves alone."""
    for serial in step.after:
        if is_meant(outcome, serial, step):
            continue
        require(step.rom_writes(serial) == 0, f"ROM of {serial} was written, which is not meant")
        if step.restarts(serial):
            continue
        for address in step.saved_addresses(serial):
            require(step.before[serial]["ram"][address] == step.after[serial]["ram"][address],
                    f"{serial} {address} has changed, which is not meant")


def check_rom_writes(outcome, step):
    most = 1 if may_save(outcome) else 0
    for serial in step.after:
        count = step.rom_writes(serial)
        require(count <= most, f"{serial}: {count} ROM writes")
    check_unread_rom(outcome, step)


def check_unread_rom(outcome, step):
    """Nobody saves over it who has not said so."""
    is_agreed = outcome.command.words[0] == "erase" or "--overwrite-rom" in outcome.command.words
    for serial in step.after:
        require(is_agreed or not step.wrote_over_unread_rom(serial),
                f"{serial}: saved over a ROM that was not read")


class Told:
    """What a command says of one servo, and what is true of it."""

    def __init__(self, outcome, node, step):
        self.outcome, self.node, self.step = outcome, node, step
        self.serial = node["serial_number"]
        self.verb = outcome.command.words[0]
        self.before, self.after = step.before[self.serial], step.after[self.serial]
        self.done = node.get("status") == "done" or node.get("saved") is True

    def ram_is_due(self):
        """RAM is as told, unless a restart took it that nobody could hear of."""
        return not self.step.restarted_unheard(self.serial, self.outcome.record)

    def require_held(self, memory, address, value):
        found = self.after[memory][address]
        require(found == value,
                f"{self.serial} {address}: {memory} holds {found}, told was {value}")


def check_node(told, defaults):
    if told.verb == "get":
        check_values(told)
    elif told.verb == "set":
        check_changes(told)
    elif told.done and told.verb == "erase":
        check_erased(told, defaults)
    elif told.done and told.verb == "restart":
        require(told.step.restarts(told.serial), f"{told.serial} was not restarted")
        if not truth.has_lost_rom(told.after):
            check_same_memories(told)
    elif told.done and told.verb == "save":
        check_saved(told)
    elif told.verb == "characterize":
        check_as_before(told)
    after = told.node.get("node_id_after")
    if told.done and after is not None and told.ram_is_due():
        require(after == told.after["node_id"], f"{told.serial} is at {told.after['node_id']}")


def check_values(told):
    """All values of one servo were true at one moment."""
    if told.outcome.status != 0:
        return
    shown = {param["address"]: param["raw"] for param in told.node["params"]
             if param["address"] in told.step.saved_addresses(told.serial)}
    moments = told.step.moments(told.serial)
    require(any(all(held[address] == raw for address, raw in shown.items()) for held in moments),
            f"{told.serial}: these values never stood in RAM together")


def check_changes(told):
    """What --save did not save because ROM holds it is in ROM as well."""
    saved = told.node.get("saved") is True
    spared = (not saved and told.outcome.status == 0 and saves(told.outcome) and
              not truth.has_lost_rom(told.after))
    for change in told.node.get("changes", []):
        if change["status"] not in HELD:
            require(not saved, f"{told.serial}: saved, but {change['status']}")
            continue
        require(change["after"] == change["requested"], "written, but not as requested")
        if saved or spared:
            told.require_held("rom", change["address"], change["after"])
        if saved or told.ram_is_due():
            told.require_held("ram", change["address"], change["after"])


def check_erased(told, defaults):
    kept = IDS if "--keep-ids" in told.outcome.command.words else ()
    saved = saves(told.outcome)
    if not saved and not told.ram_is_due():
        return
    for address, default in defaults[told.node["model"]].items():
        if address in told.step.saved_addresses(told.serial):
            due = told.before["ram"][address] if address in kept else default
            told.require_held("ram", address, due)
            if saved:
                told.require_held("rom", address, due)


def check_as_before(told):
    """Nothing stays changed, or it is said."""
    is_said = ("not put back" in told.outcome.err or "is not known" in told.outcome.err)
    if truth.has_lost_rom(told.after) or not told.ram_is_due() or (is_said and not told.done):
        return
    if not (told.done or told.outcome.record.changes()):
        return
    found = told.step.ram_at_first_contact(told.serial, told.outcome.record)
    require(found, f"{told.serial}: its ROM could not be read")
    for address in told.step.saved_addresses(told.serial):
        told.require_held("rom", address, told.before["rom"][address])
        told.require_held("ram", address, found[address])


def check_saved(told):
    """ROM is what RAM was when the command first heard of the servo."""
    due = told.step.ram_at_first_contact(told.serial, told.outcome.record)
    require(due, f"{told.serial}: saved, but its ROM could not be read")
    for address in told.step.saved_addresses(told.serial):
        told.require_held("rom", address, due[address])
    check_same_memories(told)


def check_same_memories(told):
    for address, value in told.after["rom"].items():
        told.require_held("ram", address, value)

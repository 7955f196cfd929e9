"""What an episode of the campaign consists of, all from its seed: servos, faults, commands."""

import json
import random
import typing

MODELS = ["BLA15-06U-A0", "BLA15-12U-A0", "BLA21-06U-A0", "BLA21-06U-AB", "BLA21-12U-A0",
          "BLA21-12U-AB", "BLA21-28U-A0", "BLA21-28U-AB", "BLA34-12U-AB", "BLA34-28U-AB"]
FIRST_SERIAL = 240900001

# Values that every model takes, for registers that neither drive the shaft nor change IDs.
SETTINGS = {
    "angle_limit_cw": ["90deg", "45.5deg", "120deg"],
    "angle_limit_ccw": ["-90deg", "-10.1deg"],
    "smoothing": ["on", "off"],
    "reverse": ["on", "off"],
    "soft_start": ["on", "off"],
    "timeout_time": ["500ms", "1500ms"],
    "torque_output": ["off", "on"],
    "servo_id": ["101", "102", "103"],
    "static_node_id": ["61", "62", "63"],
    "voltage_limit_high": ["99V"],  # what no model takes
}

FOREIGN = [
    {"kind": "autopilot", "node_id": 100, "armed": True},
    {"kind": "autopilot", "node_id": 100, "allocates": True},
    {"kind": "autopilot", "node_id": 100, "commands": {
        "servo_ids": [1, 2], "type": 1, "value": 0.1, "rate": 50}},
    {"kind": "gnss", "node_id": 101},
    {"kind": "esc", "node_id": 102},
    {"kind": "babbler", "node_id": 103, "priority": 0, "load": 0.5},
    {"kind": "node", "node_id": 127},  # which blactl takes if nobody has it
    {"kind": "gnss", "node_id": 61},  # which a servo may be given
]


class Command(typing.NamedTuple):
    words: list
    killed_after_s: float | None = None  # of real time: the one thing that a seed does not repeat
    fleet: dict | None = None  # the file that words[1] names

    def __str__(self):
        return "blactl " + " ".join(self.words)

    def entries(self):
        """Of its fleet file."""
        return self.fleet["servos"] if self.fleet else []

    def target(self):
        """Whom -n names."""
        return self.words[self.words.index("-n") + 1] if "-n" in self.words else "all"

    def may_change_ids(self):
        """After it a target may be known by another ID, or by none."""
        return self.words[0] in ("erase", "undo") or any(
            "static_node_id" in word for word in self.words) or any(
            "static_node_id" in entry["set"] for entry in self.entries())

    def is_about_one(self):
        """It takes just one servo, and is told to take all."""
        return self.words[:3] == ["characterize", "-n", "all"]

    def is_right(self):
        """No servo has a reason to refuse it."""
        # IDs may be another servo's already, and one ID is not given to several.
        if self.fleet:  # each ID is the servo's own, or nobody's, or it is given up by another
            is_plain = not {"--dry-run", "-n"} & {*self.words}
            return is_plain and not ("--no-save" in self.words and self.may_change_ids())
        wrong = ("static_node_id", "servo_id", "voltage_limit_high")
        return not any(word.startswith(wrong) for word in self.words)


class Episode:
    def __init__(self, seed):
        self.seed = seed
        chance = random.Random(seed)
        count = chance.choice([1, 1, 2, 3, 4])
        self.ids = chance.sample(range(10, 60), count)
        if count > 1 and chance.random() < 0.15:
            self.ids[1] = self.ids[0]  # two servos under one node ID
        self.serials = [FIRST_SERIAL + i for i in range(count)]
        self.scenario = {
            "schema": "blactl-scenario/1", "clock": "virtual", "seed": seed,
            "servos": [self._servo(chance, i) for i in range(count)],
            "wire": self._wire(chance),
            "events": self._events(chance),
        }
        self._spare_the_undecidable()
        if chance.random() < 0.2:
            self.scenario["foreign"] = [chance.choice(FOREIGN)]
        self.steps = [self._step(chance) for _ in range(chance.randint(1, 5))]
        kind = chance.random()
        if kind < 0.25:
            self._stumble_once(chance)
        elif kind < 0.35:
            self._let_alone()
        self._let_ask(random.Random(f"alloc {seed}"))
        self._let_diagnose(random.Random(f"doctor {seed}"))
        self._let_apply(random.Random(f"apply {seed}"))
        self._let_undo(random.Random(f"undo {seed}"))
        self._let_move(random.Random(f"move {seed}"))
        self._let_begin(random.Random(f"begin {seed}"))
        self._let_start_unread(random.Random(f"unread {seed}"))
        self._let_share_unique_id(random.Random(f"copy {seed}"))

    def _let_ask(self, chance):
        """Some servos have no node ID, and get one. It is drawn apart: the other episodes, and the
        rest of these, stay what they were before there was `alloc`."""
        self.asking = []
        if chance.random() < 0.75:
            return
        if chance.random() < 0.4:
            self._let_alone()
        self.asking = chance.sample(self.serials, chance.randint(1, len(self.serials)))
        for servo in self.scenario["servos"]:
            if servo["serial_number"] in self.asking:
                servo["node_id"] = 0
        once, listing = Command(["alloc", "--once"]), Command(["alloc", "--list"])
        killed = once._replace(killed_after_s=chance.uniform(0.005, 0.05))
        beside = chance.choice([[], [], [], [once], [listing], [killed]])
        self.steps = [[once] + beside, *self.steps[:3]]
        again = chance.randint(1, len(self.steps))
        self.steps[again:again] = [[once]]
        self.steps.append([listing])

    def _let_begin(self, chance):
        """While commands run the vehicle is armed, or another node begins to drive; drawn apart, too."""
        if chance.random() < 0.85:
            return
        self.scenario["foreign"] = [{
            "kind": "node", "node_id": 104, "begins": f"{chance.randint(1000, 20000)}ms",
            **chance.choice([{"armed": True}, {"commands": {"servo_ids": [255], "rate": 50}}])}]

    def _let_start_unread(self, chance):
        """A ROM that is whole is not read at some starts, and some agree to lose it; drawn apart,
        too."""
        if chance.random() < 0.9:
            return
        for servo in self.scenario["servos"]:
            if chance.random() < 0.6:
                servo.setdefault("rom", {})["angle_limit_cw"] = "77deg"
                servo.setdefault("faults", {})["rom_unread_starts"] = chance.randint(1, 4)
        restart = [Command(["restart", "-n", "all", "-y"])]
        self.steps[:0] = [[Command(["alloc", "--once"])], *[restart] * chance.choice([0, 0, 1])]
        for step in self.steps:
            for command in step:
                if chance.random() < 0.3 and command.words[0] != "alloc":
                    command.words.append("--overwrite-rom")

    def _let_share_unique_id(self, chance):
        """Some servos have a unique ID that does not tell them from others; drawn apart, too."""
        if chance.random() < 0.95:
            return
        shared = chance.choice(["ab" * 16, "ab" * 16, "00" * 16, "ff" * 16])
        for servo in chance.sample(self.scenario["servos"], min(2, len(self.serials))):
            servo["unique_id"] = shared

    def _let_diagnose(self, chance):
        """A look at it all, between other commands or beside one; drawn apart, too."""
        doctor = Command(["doctor"])
        kind = chance.random()
        at = chance.randint(1, len(self.steps))
        if kind < 0.3:
            self.steps[at:at] = [[doctor]]
        elif kind < 0.35:
            self.steps[at - 1] = [*self.steps[at - 1], doctor]

    def _let_apply(self, chance):
        """A fleet file, and the same once more; drawn apart, too."""
        if chance.random() < 0.6:
            return
        if chance.random() < 0.3:
            self._let_alone()
        fleet = self._fleet(chance)
        first = self._apply(chance, fleet)
        again = Command(["apply", "fleet.json", "-y"], fleet=fleet)
        beside = [Command(self._command(chance))] if chance.random() < 0.05 else []
        at = chance.randint(0, len(self.steps))
        self.steps[at:] = [[first] + beside, [again], *self.steps[at:at + 1]]

    def _let_undo(self, chance):
        """Back, and sometimes forth again; drawn apart, too."""
        if chance.random() < 0.6:
            return
        at = chance.randint(1, len(self.steps))
        words = ["undo", "-y"] + chance.choice([[], [], ["-n", "all"], ["--no-save"], [
            "-n", f"serial:{chance.choice(self.serials)}"]])
        self.steps[at:at] = [[Command(words)]] * chance.choice([1, 1, 2])

    def _let_move(self, chance):
        """Shafts are commanded and watched; drawn apart, too."""
        if chance.random() < 0.6:
            return
        if chance.random() < 0.3:
            self._let_alone()
        for servo in self.scenario["servos"]:
            if chance.random() < 0.7:
                servo.setdefault("rom", {}).update(
                    speed_torque_control="on", timeout_time=chance.choice([1000, 1000, 200, 60]))
        for _ in range(chance.choice([1, 1, 2])):
            at = chance.randint(0, len(self.steps))
            beside = [Command(self._command(chance))] if chance.random() < 0.1 else []
            self.steps[at:at] = [[Command(self._motion(chance))] + beside]
        if chance.random() < 0.5:
            at = chance.randint(0, len(self.steps))
            target = chance.choice(["all", f"serial:{chance.choice(self.serials)}"])
            watch = Command(["monitor", "-n", target, "--duration", chance.choice(["1", "6"])])
            self.steps[at:at] = [[watch]]

    def _motion(self, chance):
        target = chance.choice([str(chance.choice(self.ids)),
                                f"serial:{chance.choice(self.serials)}"])
        words = ["command", chance.choice(["angle=30deg", "angle=-5.5deg", "angle=60deg",
                                           "speed=45rpm", "speed=-20rpm", "torque=30%",
                                           "--wiggle"]), "-n", target, "-y"]
        if chance.random() < 0.2:
            words += ["--duration", chance.choice(["0.05", "0.5", "5"])]
        if chance.random() < 0.15:
            words.append("--array")
        return words

    def _fleet(self, chance):
        """Entries for some servos, the IDs of each its own, or those of another of them."""
        serials = chance.sample(self.serials, chance.randint(1, len(self.serials)))
        places = [self.ids[self.serials.index(serial)] for serial in serials]
        places = chance.choice([[], [], places[1:] + places[:1], [64 + i for i in range(9)]])
        free = [name for name in SETTINGS
                if name not in ("servo_id", "static_node_id", "voltage_limit_high")]
        entries = []
        for index, serial in enumerate(serials):
            names = chance.sample(free, chance.randint(1, len(free)))
            wished = {name: chance.choice(SETTINGS[name]) for name in names}
            if places:
                wished["static_node_id"] = places[index]
            if chance.random() < 0.3:
                wished["servo_id"] = 111 + index
            entries.append({"name": f"servo {index}", "match": {"serial_number": serial},
                            "set": wished})
        return {"schema": "blactl-fleet/1", "servos": entries}

    def _apply(self, chance, fleet):
        words = ["apply", "fleet.json", "-y"]
        for option, probability in (("--no-save", 0.15), ("--trust-ram", 0.15),
                                    ("--fail-fast", 0.15), ("--dry-run", 0.1)):
            if chance.random() < probability:
                words.append(option)
        if chance.random() < 0.1:
            words += ["-n", f"serial:{chance.choice(self.serials)}"]
        if chance.random() < 0.1:
            words += ["--stagger", "0.5"]
        return Command(words, fleet=fleet)

    def _let_alone(self):
        """Nothing goes wrong."""
        self.scenario.update(wire={}, events=[])
        self.scenario.pop("foreign", None)
        for servo in self.scenario["servos"]:
            servo.pop("faults", None)
            servo.pop("sending", None)
        self.steps = [step for step in self.steps if len(step) == 1] or [
            [Command(["restart", "-n", "all", "-y"])]]

    def must_succeed(self, index):
        """Whether nothing is in the way of a step, not even what an earlier one has done: a tool
        that refused everything would never lie."""
        in_the_way = (self.scenario["wire"] or self.scenario["events"] or
                      "foreign" in self.scenario or
                      any("unique_id" in servo for servo in self.scenario["servos"]))
        if in_the_way or len(set(self.ids)) < len(self.ids) or any(
                "faults" in servo or "sending" in servo for servo in self.scenario["servos"]):
            return False
        return all(len(step) == 1 and not step[0].may_change_ids() for step in self.steps[:index]
                   ) and len(self.steps[index]) == 1 and self._is_right(self.steps[index][0], index)

    def _is_right(self, command, index):
        """Servos that had to ask first are not where they were drawn."""
        verb, *_ = command.words
        if verb in ("doctor", "undo", "command"):
            return False  # judged apart: there may be nothing to undo, or no room to move
        if verb == "apply" and self.asking:
            return False  # one that waits for an ID of its own may need more than one run
        is_numbered = verb != "alloc" and command.target().isdigit()
        has_given = index > 0 and self.steps[0][0].words[0] == "alloc"
        return command.is_right() and not (command.is_about_one() and len(self.ids) > 1) and (
            not self.asking or verb == "alloc" or (has_given and not is_numbered))

    def _stumble_once(self, chance):
        """One restart by itself between two requests of one command, and nothing else: among so
        many other faults it would hardly ever meet a command that succeeds."""
        self.scenario.update(wire={}, events=[])
        for servo in self.scenario["servos"]:
            servo.pop("sending", None)
            servo["faults"] = {}
            servo["behaviour"] = {"first_node_status": chance.choice(["50ms", "500ms", "1s", "1s"])}
        number = chance.choice([chance.randint(1, 12), chance.randint(1, 70)])
        self.scenario["servos"][0]["faults"] = {
            "restart_after_answer": [{"to": "any", "number": number}]}
        unsaved = Command(["set", "-n", "all", "smoothing=off", "timeout_time=500ms", "-y"])
        self.steps = [[unsaved]] * chance.choice([0, 1]) + [[Command(self._command(chance))]]

    def _spare_the_undecidable(self):
        """What no client can tell apart, whatever it asks, is left out."""
        for servo in self.scenario["servos"]:
            faults = servo.get("faults", {})
            # One that writes ROM and does not restart, and whose answer is lost, and one that has
            # heard nothing.
            if (self.scenario["wire"] or "sending" in servo or "behaviour" in servo
                    or "lose_opcode_answers" in faults or "lose_responses" in faults):
                faults.pop("stays", None)
            # One of two under a node ID whose answers are lost, and one that is alone.
            if self.ids.count(servo["node_id"]) > 1:
                for silence in ("mute", "lose_responses", "never_returns"):
                    faults.pop(silence, None)
                if self.scenario["wire"] or "sending" in servo:
                    faults.pop("no_node_status", None)

    def _servo(self, chance, index):
        servo = {"model": chance.choice(MODELS), "node_id": self.ids[index],
                 "serial_number": self.serials[index], "servo_id": index + 1}
        faults = self._faults(chance) if chance.random() < 0.5 else {}
        if faults:
            servo["faults"] = faults
        behaviour = {}
        if chance.random() < 0.5:
            behaviour["first_node_status"] = chance.choice(["50ms", "300ms", "700ms", "1s"])
        if chance.random() < 0.2:
            behaviour.update(
                out_of_range=chance.choice(["refuse", "clamp", "fail"]),
                answers_save_first=chance.random() < 0.5,
                failure_with_name=chance.random() < 0.5,
                rom_write_time=chance.choice(["50ms", "400ms"]))
        if behaviour:
            servo["behaviour"] = behaviour
        if chance.random() < 0.3:
            servo["sending"] = {
                "jitter": f"{chance.choice([0, 2, 10])}ms",
                "late_answers": chance.choice([0, 0.05, 0.2]),
                "late_by": f"{chance.choice([60, 250, 1500])}ms",
                "double_answers": chance.choice([0, 0.1])}
        return servo

    @staticmethod
    def _faults(chance):
        possible = [
            ("lose_responses", 0.2, chance.randint(1, 3)),
            ("lose_opcode_answers", 0.3, chance.randint(1, 3)),
            ("ignore_opcodes", 0.2, chance.randint(1, 3)),
            ("refuse_opcodes", 0.05, True),
            ("rom_write_fails", 0.1, True),
            ("stays", 0.1, True),
            ("never_returns", 0.05, True),
            ("mute", 0.03, True),
            ("no_node_status", 0.1, True),
            ("no_actuator_status", 0.1, True),
            ("restart_instead_of_answer", 0.1, chance.randint(1, 60)),
            ("restart_after_answer", 0.3, restarts(chance)),
            ("power_loss_in_save", 0.1, f"{chance.randint(0, 49)}ms"),
            ("return_delay", 0.2, f"{chance.choice([1, 3, 8])}s")]
        return {name: value for name, probability, value in possible
                if chance.random() < probability}

    @staticmethod
    def _wire(chance):
        wire = {}
        if chance.random() < 0.5:
            wire["loss"] = chance.choice([0, 0.001, 0.01, 0.05])
            wire["duplication"] = chance.choice([0, 0.01])
            wire["errors"] = chance.choice([0, 0.01])
            wire["bit_flips"] = chance.choice([0, 0.01])
        if chance.random() < 0.1:
            wire["burst_interval"] = "500ms"
            wire["burst_length"] = f"{chance.choice([1, 20, 100])}ms"
        return wire

    def _events(self, chance):
        events = []
        for serial in self.serials:
            if chance.random() < 0.25:
                events += trouble(chance, serial)
        if chance.random() < 0.05:
            at = chance.randint(100, 4000)
            events.append({"at": f"{at}ms", "clients": "cut"})
            events.append({"at": f"{at + chance.randint(10, 900)}ms", "clients": "joined"})
        if chance.random() < 0.03:
            events.append({"at": f"{chance.randint(100, 4000)}ms", "clients": "bus_off"})
        return events

    def _step(self, chance):
        """Commands that begin at once; mostly it is one."""
        at_once = 1 if chance.random() < 0.85 else chance.choice([2, 3])
        commands = [Command(self._command(chance)) for _ in range(at_once)]
        if at_once > 1 and chance.random() < 0.2:
            commands[0] = commands[0]._replace(killed_after_s=chance.uniform(0.005, 0.05))
        return commands

    def _command(self, chance):
        """The words of one."""
        target = chance.choice(["all", str(chance.choice(self.ids)),
                                f"serial:{chance.choice(self.serials)}"])
        verb = chance.choice(["set", "set", "set", "save", "save", "erase", "restart", "get"])
        if chance.random() < 0.06:
            verb = "characterize"
        command = [verb, "-n", target]
        if verb == "get":
            return command + ["--all"]
        if verb == "set":
            command += self._changes(chance)
        if verb == "set" and chance.random() < 0.4 or verb == "erase" and chance.random() < 0.6:
            command.append("--save")
        if verb == "erase" and chance.random() < 0.3:
            command.append("--keep-ids")
        if chance.random() < 0.2 and verb in ("save", "restart"):
            command += ["--stagger", "0.5"]
        return command + ["-y"]

    def _changes(self, chance):
        changes = []
        for name in chance.sample(list(SETTINGS), chance.randint(1, 4)):
            values = SETTINGS[name]
            if name == "static_node_id" and chance.random() < 0.3:
                values = [str(node_id) for node_id in self.ids]  # perhaps one that another has
            if name != "voltage_limit_high" or chance.random() < 0.2:
                changes.append(f"{name}={chance.choice(values)}")
        return changes or ["smoothing=on"]


def restarts(chance):
    """By itself, between any two requests."""
    kinds = ["any", "node_info", "read", "write", "write", "opcode"]
    numbers = [1, 1, 2, 3, chance.randint(4, 80)]
    return [{"to": chance.choice(kinds), "number": chance.choice(numbers)}
            for _ in range(chance.choice([1, 1, 2]))]


def trouble(chance, serial):
    """What befalls a servo from without."""
    at = chance.randint(100, 4000)
    back = at + chance.randint(1, 900)
    what = chance.choice(["dip", "plug", "power", "unplug", "clock_error", "watchdog_error",
                          "ram_error"])
    if what == "dip":
        changes = [(at, "world", {"voltage": "2V"}), (back, "world", {"voltage": "12V"})]
    elif what == "plug":
        changes = [(at, "world", {"plugged": "off"}), (back, "world", {"plugged": "on"})]
    elif what == "power":
        changes = [(at, "happens", "power_off"), (back, "happens", "power_on")]
    elif what == "unplug":
        changes = [(at, "world", {"plugged": "off"})]
    else:
        changes = [(at, "happens", what)]
    return [{"at": f"{time}ms", "servo": serial, key: value} for time, key, value in changes]


class Frozen:
    """An episode as it was written down."""

    def __init__(self, kept):
        self.scenario = kept["scenario"]
        for index, servo in enumerate(self.scenario["servos"]):
            servo.setdefault("serial_number", FIRST_SERIAL + index)
        self.steps = [[Command(**command) for command in step] for step in kept["steps"]]

    def must_succeed(self, _):
        return False

"""What an episode of the campaign consists of, all from its seed: servos, faults, commands."""

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


class Command(typing.NamedTuple):
    words: list
    killed_after_s: float | None = None  # of real time: the one thing that a seed does not repeat

    def __str__(self):
        return "blactl " + " ".join(self.words)


class Episode:
    def __init__(self, seed):
        self.seed = seed
        chance = random.Random(seed)
        count = chance.choice([1, 1, 2, 3, 4])
        ids = chance.sample(range(10, 60), count)
        if count > 1 and chance.random() < 0.05:
            ids[1] = ids[0]  # two servos under one node ID
        self.serials = [FIRST_SERIAL + i for i in range(count)]
        self.ids = ids
        self.scenario = {
            "schema": "blactl-scenario/1", "clock": "virtual", "seed": seed,
            "servos": [self._servo(chance, node_id, i) for i, node_id in enumerate(ids)],
            "wire": self._wire(chance),
            "events": self._events(chance),
        }
        self._spare_the_undecidable()
        if chance.random() < 0.2:
            self.scenario["foreign"] = [chance.choice([
                {"kind": "autopilot", "node_id": 100, "armed": True},
                {"kind": "autopilot", "node_id": 100, "allocates": True},
                {"kind": "autopilot", "node_id": 100, "commands": {
                    "servo_ids": [1, 2], "type": 1, "value": 0.1, "rate": 50}},
                {"kind": "gnss", "node_id": 101},
                {"kind": "esc", "node_id": 102},
                {"kind": "babbler", "node_id": 103, "priority": 0, "load": 0.5}])]
        self.steps = [self._step(chance) for _ in range(chance.randint(1, 5))]

    def _spare_the_undecidable(self):
        """A servo that writes ROM and does not restart, and whose answer is lost, cannot be told
        from one that has heard nothing."""
        for servo in self.scenario["servos"]:
            if (self.scenario["wire"] or "sending" in servo or "behaviour" in servo
                    or "lose_opcode_answers" in servo.get("faults", {})):
                servo.get("faults", {}).pop("stays", None)

    @staticmethod
    def _servo(chance, node_id, index):
        servo = {"model": chance.choice(MODELS), "node_id": node_id, "servo_id": index + 1}
        faults = {}
        if chance.random() < 0.4:
            for name, probability, value in [
                    ("lose_responses", 0.2, chance.randint(1, 3)),
                    ("lose_opcode_answers", 0.3, chance.randint(1, 3)),
                    ("ignore_opcodes", 0.2, chance.randint(1, 3)),
                    ("refuse_opcodes", 0.05, True),
                    ("rom_write_fails", 0.1, True),
                    ("stays", 0.1, True),
                    ("never_returns", 0.1, True),
                    ("mute", 0.03, True),
                    ("restart_instead_of_answer", 0.1, chance.randint(1, 60)),
                    ("power_loss_in_save", 0.1, f"{chance.randint(0, 49)}ms"),
                    ("return_delay", 0.2, f"{chance.choice([1, 3, 8])}s")]:
                if chance.random() < probability:
                    faults[name] = value
        if faults:
            servo["faults"] = faults
        if chance.random() < 0.2:
            servo["behaviour"] = {
                "out_of_range": chance.choice(["refuse", "clamp"]),
                "answers_save_first": chance.random() < 0.5,
                "failure_with_name": chance.random() < 0.5,
                "rom_write_time": chance.choice(["50ms", "400ms"])}
        if chance.random() < 0.3:
            servo["sending"] = {
                "jitter": f"{chance.choice([0, 2, 10])}ms",
                "late_answers": chance.choice([0, 0.05, 0.2]),
                "late_by": f"{chance.choice([60, 250, 1500])}ms",
                "double_answers": chance.choice([0, 0.1])}
        return servo

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
            if chance.random() < 0.15:
                at = chance.randint(100, 4000)
                what = chance.choice(["plug", "dip", "unplug"])
                change = {"voltage": "2V"} if what == "dip" else {"plugged": "off"}
                events.append({"at": f"{at}ms", "servo": serial, "world": change})
                if what != "unplug":
                    back = {"voltage": "12V"} if what == "dip" else {"plugged": "on"}
                    events.append({"at": f"{at + chance.randint(1, 900)}ms", "servo": serial,
                                   "world": back})
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
        command = [verb, "-n", target]
        if verb == "get":
            return command + ["--all"]
        if verb == "set":
            for name in chance.sample(list(SETTINGS), chance.randint(1, 3)):
                if name != "voltage_limit_high" or chance.random() < 0.2:
                    command.append(f"{name}={chance.choice(SETTINGS[name])}")
            if len(command) == 3:
                command.append("smoothing=on")
        if verb == "set" and chance.random() < 0.4 or verb == "erase" and chance.random() < 0.6:
            command.append("--save")
        if verb == "erase" and chance.random() < 0.3:
            command.append("--keep-ids")
        if chance.random() < 0.2 and verb in ("save", "restart"):
            command += ["--stagger", "0.5"]
        return command + ["-y"]

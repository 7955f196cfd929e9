"""What servos held and went through while commands ran, as whoever plays them tells it."""

# Between a frame in a servo's time and in a client's; less than the shortest start takes.
TOLERANCE_S = 0.03
OWN_NODE_IDS = {125, 126, 127}
SETTLED_S = 3.0  # after this a servo that has started has sent its first NodeStatus, and some more


class Step:
    """One step of an episode: `commands` at once. `before`, `after`: the state of every servo by its serial number;
    `events`: what happened to them between; `scenario`: what was to go wrong after `power_on`;
    `given`: what the allocation table may say of each servo that was given a node ID, before this
    step and after it: that ID, or one that a fleet file wished for it since, or that alloc has seen;
    `unsaved`: what commands had written before, in RAM only; `earlier`: what happened before."""

    def __init__(self, commands, before, events, after, scenario, power_on, given, unsaved,
                 earlier):
        self._commands = commands
        self.before, self.after = before, after
        self._events, self._scenario, self._power_on = events, scenario, power_on
        self.unsaved = unsaved
        self._earlier = earlier
        self.given_before = given
        self.given = {**given, **{serial: {node_id} for serial, node_id in self.allocated()}}
        for serial in self.made_static():
            self.given.pop(serial, None)  # the table has that one
        for serial, node_id in wished_ids(commands):
            if serial in self.given:
                self.given[serial] = self.given[serial] | {node_id}
        if any(command.words[0] == "alloc" for command in commands):
            for serial, node_ids in self.given.items():
                self.given[serial] = node_ids | {before[serial]["node_id"], after[serial]["node_id"]}

    def restarts(self, serial):
        """The times."""
        return [line["time"] for line in self._events
                if line["event"] == "restart" and line["serial_number"] == serial]

    def rom_writes(self, serial):
        return self.after[serial]["count"] - self.before[serial]["count"]

    def wrote_over_unread_rom(self, serial):
        """Whether ROM was written by a servo that had not read it, and had not started again."""
        lost = has_lost_rom(self.before[serial])
        for line in self._events:
            if line["serial_number"] == serial and lost:
                if line["event"] == "rom_write":
                    return True
                lost = line["event"] != "restart"
        return False

    def has_copy(self, serial):
        """Whether another unit has its unique ID."""
        return sum(state["unique_id"] == self.after[serial]["unique_id"]
                   for state in self.after.values()) > 1

    def is_one_of_several(self, serial):
        """Whether its unique ID does not tell it from others that were there all the time."""
        own = self.after[serial]["unique_id"]
        others = [other for other in self.after if other != serial and
                  self.after[other]["unique_id"] == own and self._is_quiet(other)]
        return self._is_quiet(serial) and (bool(others) or own in ("00" * 16, "ff" * 16))

    def _is_quiet(self, serial):
        """It was there under one ID, and nothing was to go wrong that concerns it."""
        same = self.before[serial]["node_id"] == self.after[serial]["node_id"] != 0
        servo = next(servo for servo in self._scenario["servos"]
                     if servo["serial_number"] == serial)
        return same and not (self._scenario.get("wire") or self._scenario.get("events") or
                             self.restarts(serial) or "faults" in servo or "sending" in servo)

    def node_ids(self, serial):
        """All that it had."""
        ids = {line["node_id"] for line in self._events if line["serial_number"] == serial}
        return (ids | {self.before[serial]["node_id"], self.after[serial]["node_id"]}) - {0}

    def had_no_node_id(self, serial):
        return (0 in (self.before[serial]["node_id"], self.after[serial]["node_id"])
                or any(serial == other for other, _ in self.allocated()) or self.restarts(serial))

    def holders(self, node_id):
        """How many nodes had it at some moment, those that are no servos too. Beside each other
        commands of ours may take an ID whose owner they have not heard yet."""
        others = [node.get("node_id") for node in self._scenario.get("foreign", [])]
        servos = sum(node_id in self.node_ids(serial) for serial in self.after)
        ours = len(self._commands) > 1 and node_id in OWN_NODE_IDS
        return servos + others.count(node_id) + ours

    def saved_addresses(self, serial):
        return self.after[serial]["rom"].keys()

    # Node IDs that servos get.

    def allocated(self):
        """The serial numbers and the IDs that they got, in the order of time."""
        return [(line["serial_number"], line["node_id"]) for line in self._events
                if line["event"] == "allocated"]

    def made_static(self):
        """Whose ROM got a node ID, or was to get it: the table promises it before that is saved."""
        return [serial for serial, state in self.after.items()
                if any(state[memory]["0x46"] not in (0, self.before[serial]["rom"]["0x46"])
                       for memory in ("rom", "ram"))]

    def has_other_allocator(self):
        return any(node.get("allocates") for node in self._scenario.get("foreign", []))

    def commanders(self):
        """The nodes that command servos."""
        ours = OWN_NODE_IDS if any(command.words[0] in ("characterize", "command")
                                   for command in self._commands) else set()
        return ours | {node["node_id"] for node in self._scenario.get("foreign", [])
                       if "commands" in node}

    def is_unhindered(self, serial):
        """Whether nothing was to go wrong that concerns a servo."""
        servo = next(servo for servo in self._scenario["servos"]
                     if servo["serial_number"] == serial)
        return not (self._scenario.get("wire") or self._scenario.get("events") or
                    "faults" in servo or "sending" in servo or "unique_id" in servo or
                    self._scenario.get("foreign"))

    # What a client can know.

    def restarted_unheard(self, serial, heard):
        """Whether it restarted when nothing of it was heard any more that could tell: of that no
        client knows, and what it had said before was true."""
        last = max(heard.times_of(self.node_ids(serial)), default=0.0)
        slack = TOLERANCE_S + self._lateness(serial)  # an answer from before it may come after it
        return any(time > last - slack for time in self.restarts(serial))

    def _lateness(self, serial):
        sending = next(servo.get("sending", {}) for servo in self._scenario["servos"]
                       if servo["serial_number"] == serial)
        return seconds(sending.get("late_by", "0s")) if sending.get("late_answers") else 0.0

    def ram_at_first_contact(self, serial, heard):
        """What was in RAM when the command first heard of the servo; None: initial values."""
        first = min(heard.times_of(self.node_ids(serial)), default=float("inf"))
        before = self.before[serial]
        if not any(time < first + TOLERANCE_S for time in self.restarts(serial)):
            return before["ram"]
        return None if has_lost_rom(before) else before["rom"]

    def moments(self, serial):
        """Every content that RAM had, if nobody wrote."""
        contents = [self.before[serial]["ram"], self.after[serial]["ram"]]
        if self.restarts(serial):
            known = self.before[serial]["ram"]
            contents.append({**known, **self.before[serial]["rom"]})
        return contents

    # Two servos under one node ID.

    def is_doubled(self, serial, heard):
        """Whether it shared its node ID with another for so long that a client can know."""
        return any(self._is_pair(serial, other, heard) for other in self.after if other != serial)

    def comes_to_another(self, first_change):
        """Whether one of two servos with one node ID was not there for so long before this moment
        that a client can know."""
        return any(self.after[one]["node_id"] == self.after[other]["node_id"] != 0 and
                   any(time + SETTLED_S > first_change for time in self._accidents(one))
                   for one in self.after for other in self.after if one != other)

    def _is_pair(self, one, other, heard):
        ended = self.after[one]["node_id"] == self.after[other]["node_id"] != 0
        if not ended:
            return False
        begun = self.before[one]["node_id"] == self.before[other]["node_id"] != 0
        accidents = self._accidents(one) + self._accidents(other)
        ordered = heard.changes() and (self.restarts(one) or self.restarts(other))
        if not begun and not ordered:
            accidents.append(self._start())  # it was still starting then
        return all(time + SETTLED_S < heard.end for time in accidents)

    def _start(self):
        return min(state["time"] for state in self.before.values())

    def _accidents(self, serial):
        """When it may have come or gone without the client, up to the end of the step; the step's
        restarts only if a fault may have caused them."""
        start = self._start()
        end = max(state["time"] for state in self.after.values())
        faults = self._faults(serial)
        delay = seconds(faults.get("return_delay", "0s"))
        times = [self._power_on + seconds(event["at"]) for event in self._scenario.get("events", [])
                 if event.get("servo") == serial]
        times = [time + delay for time in times if start - SETTLED_S - delay < time <= end]
        if any(name in faults for name in ("restart_after_answer", "restart_instead_of_answer",
                                           "power_loss_in_save", "return_delay")):
            times += [time + delay for time in self.restarts(serial)]
        if delay:  # it may be away from an earlier step on
            times += [line["time"] + delay for line in self._earlier
                      if line["event"] == "restart" and line["serial_number"] == serial and
                      line["time"] + delay > start]
        return times

    def _faults(self, serial):
        return next(servo.get("faults", {}) for servo in self._scenario["servos"]
                    if servo["serial_number"] == serial)


def wished_ids(commands):
    """(serial, node ID) of the fleet files of these commands."""
    return [(entry["match"]["serial_number"], entry["set"]["static_node_id"])
            for command in commands for entry in command.entries()
            if "static_node_id" in entry["set"]]


def has_lost_rom(state):
    """0x1A.15: what ROM holds could not be loaded, so RAM has the initial values."""
    return bool(state["ram"]["0x1A"] >> 15 & 1)


def seconds(text):
    """Of a scenario's time: "500ms", "3s", or microseconds."""
    if isinstance(text, int):
        return text / 1e6
    for unit, factor in (("ms", 1e-3), ("us", 1e-6), ("s", 1.0)):
        if text.endswith(unit):
            return float(text.removesuffix(unit)) * factor
    raise ValueError(text)

"""A servo on the bus, in real time, from the BLA specification (rev 1.11) alone."""

import hashlib
import random
import struct

from allocation import Allocatee
from faults import Faults
from memory import Memory
from transfer import (ACTUATOR_STATUS, ALLOCATION, ARRAY_COMMAND, NODE_STATUS, Head, Inbox,
                      split)
import requests

PRIORITY = 16
BOOT_S = (0.05, 0.5)  # unproven; a restart is over when it answers again
ANSWER_S = (0.0003, 0.004)
BLINK_S = 0.1  # how long the supply is gone when it fails while ROM is written
FAILURE = bytes(4)


def seconds(text):
    """Of a scenario's time: "500ms", "3s"."""
    return float(text[:-2]) / 1000 if text.endswith("ms") else float(text[:-1])


class Servo:
    """`world` has at(time, what), send(frames), tell(servo, event), now()."""

    def __init__(self, world, setup, seed):
        self._world = world
        self.chance = random.Random(f"{seed} {setup['serial_number']}")
        self.serial = setup["serial_number"]
        own = hashlib.sha256(str(self.serial).encode()).hexdigest()[:32]
        self.unique_id = bytes.fromhex(setup.get("unique_id", own))
        self.memory = Memory(setup, world.now)
        self.faults = Faults(setup.get("faults", {}))
        self._behaviour = setup.get("behaviour", {})
        self._life = 0  # what belongs to a former one does not happen any more
        self.phase = "off"  # boot, waiting (for an ID), running, saving, dead
        self.node_id, self.rom_writes, self._started = 0, 0, 0.0

    # Life.

    def power_on(self):
        if self.phase == "off":
            self._boot(0.0)

    def power_off(self):
        if self.phase in ("off", "dead"):
            return
        self._world.tell(self, "restart")
        self._end_life("off")

    def restart(self):
        self._world.tell(self, "restart")
        self._end_life("off")
        if self.faults.has("never_returns"):
            self.phase = "dead"
        else:
            self._boot(seconds(self.faults.value("return_delay", "0s")))

    def stumble(self):
        """Its processor restarts by itself."""
        if self.phase in ("running", "waiting"):
            self.restart()

    def _end_life(self, phase):
        self.memory.look()
        self._life += 1
        self.phase, self.node_id = phase, 0
        self.memory.load()

    def _boot(self, delay):
        self.phase = "boot"
        self.later(delay + self.chance.uniform(*BOOT_S), self._start)

    def _start(self):
        self._started = self._world.now()
        self._inbox, self._transfer_ids = Inbox(), {}
        self.memory.load_first()
        own = self.memory.rom[0x46]
        if own:
            self._join(own)
        else:
            self.phase, self._allocatee = "waiting", Allocatee(self, self._allocated)

    def _allocated(self, node_id):
        self._join(node_id)
        self._world.tell(self, "allocated")

    def _join(self, node_id):
        self.phase, self.node_id = "running", node_id
        if not self.faults.has("no_actuator_status"):
            self.later(0.0, self._send_status)
        if not self.faults.has("no_node_status"):
            first = self._behaviour.get("first_node_status")
            self.later(seconds(first) if first else self.chance.uniform(0, 1),
                       self._send_node_status)

    def later(self, delay, what):
        """In this life only."""
        life = self._life
        self._world.at(self._world.now() + delay, lambda: what() if life == self._life else None)

    # What it sends by itself.

    def status(self):
        """The 7 bytes of NodeStatus."""
        faults = self.memory.faults()
        health = 2 if faults[0x1B] else 1 if faults[0x1A] else 0
        return struct.pack("<IBH", int(self._world.now() - self._started), health << 6, 0)

    def _send_node_status(self):
        self.later(1.0, self._send_node_status)
        self._broadcast(NODE_STATUS, self.status())

    def _send_status(self):
        self.later(0.1, self._send_status)
        angle = self.memory.read(0x08) / 1000
        unused = float("nan")
        self._broadcast(ACTUATOR_STATUS, struct.pack("<BeeeB", self.memory.ram[0x45], angle, unused,
                                                     unused, 127))

    def _broadcast(self, data_type, payload):
        if self.phase == "running":
            transfer_id = self._transfer_ids.get(data_type, 0)
            self._transfer_ids[data_type] = (transfer_id + 1) % 32
            self._send(Head(PRIORITY, False, data_type, self.node_id), payload, transfer_id)

    def _send(self, head, payload, transfer_id):
        frames = split(head, payload, transfer_id)
        self._world.send(self, [(head.can_id(), data) for data in frames])

    def send_anonymous(self, can_id, payload):
        self._world.send(self, [(can_id, payload + b"\xC0")])

    # What it hears.

    def hear(self, head, data):
        if self.phase == "waiting" and not head.is_service and head.data_type == ALLOCATION:
            if head.source == 0:
                self._allocatee.hear(0, data[:-1])
            elif taken := self._inbox.take(head, data, self._world.now()):
                self._allocatee.hear(head.source, taken[0])
        elif (self.phase == "running" and head.is_service and head.is_request
              and head.destination == self.node_id and head.source
              and head.data_type in requests.SERVED):
            if taken := self._inbox.take(head, data, self._world.now()):
                self._serve(head, *taken)
        elif (self.phase == "running" and not head.is_service and head.source
              and head.data_type == ARRAY_COMMAND):
            if taken := self._inbox.take(head, data, self._world.now()):
                self._obey_array(taken[0])

    def _obey_array(self, payload):
        for address, value in requests.told_by_array(payload, self.memory.ram[0x45]):
            self.memory.write(address, value)

    def _serve(self, head, payload, transfer_id):
        request = requests.parse(head.data_type, payload)
        numbers = self.faults.count(request.kind)
        if self.faults.is_lost("request", numbers):
            return
        if self.faults.restarts_instead(numbers) or self.faults.is_lost("restart", numbers):
            self.restart()
            return
        if request.is_order and self.faults.take("ignore_opcodes"):
            return
        refused = request.is_order and self.faults.has("refuse_opcodes")
        answer = request.refusal() if refused else request.obey(self)
        order = None if refused else request.order
        lost = (self.faults.has("mute") or self.faults.is_lost("answer", numbers)
                or self.faults.take("lose_responses")
                or request.is_order and self.faults.take("lose_opcode_answers")
                or order == "save" and self._behaviour.get("answers_save_first") is False)
        back = Head(head.priority, True, head.data_type, self.node_id, False, head.source)
        head = None if lost else back
        self.later(self.chance.uniform(*ANSWER_S),
                   lambda: self._answer(head, answer, transfer_id, order, numbers))

    def _answer(self, head, payload, transfer_id, order, numbers):
        if self.phase != "running":
            return
        if head:
            self._send(head, payload, transfer_id)
        if self.faults.restarts_after(numbers):
            self.restart()
        elif order == "save":
            self._save()
        elif order == "restart" and not self.faults.has("stays"):
            self.restart()

    # ROM.

    def _save(self):
        """All communication stops, and a restart follows (4.11)."""
        self.phase = "saving"
        fails = self.faults.once("power_loss_in_save")
        if fails is not None:
            self.later(seconds(fails), self._fail_while_saving)
        else:
            self.later(seconds(self._behaviour.get("rom_write_time", "50ms")), self._saved)

    def _fail_while_saving(self):
        self.memory.lose_rom()
        self.power_off()
        self.later(BLINK_S, self.power_on)

    def _saved(self):
        if not self.faults.has("rom_write_fails"):
            self.memory.save()
        self.rom_writes += 1
        self._world.tell(self, "rom_write")
        if self.faults.has("stays"):
            self.phase = "running"
        else:
            self.restart()

    def erase(self):
        self.memory.erase()
        self._world.tell(self, "erase")

    def info(self):
        """The answer of GetNodeInfo (table 2-6); unproven what name real ones tell."""
        firmware, hardware = self.memory.ram[0x52], self.memory.ram[0x53]
        versions = bytes([firmware // 1000, firmware % 1000 // 10]) + bytes(13)
        versions += bytes([hardware // 1000, hardware % 1000 // 10])
        return self.status() + versions + self.unique_id + b"\0" + b"futaba.bla"

"""Servos on a multicast bus of their own, played by a thread; steered and questioned as the
campaign does it with `blactl sim`."""

import heapq
import itertools
import os
import random
import sys
import threading
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "net"))
import mcast_peer  # pylint: disable=wrong-import-position

from servo import Servo, seconds
from transfer import ALLOCATION, head_of

TICK_S = 0.02  # how long an order from the other thread may wait
SETTLE_S = 1.5
QUIET = ("running", "off", "dead", "waiting")


class World:
    def __init__(self, bus, scenario):
        self.interface = f"mcast:{bus}?if=lo"
        self._peer = mcast_peer.Peer(bus, "lo")
        self._lock = threading.RLock()
        self._due, self._order = [], itertools.count()
        self._events, self._fault = [], None
        self._chance = random.Random(scenario["seed"])
        self._wire = scenario.get("wire", {})
        self._servos = [Servo(self, setup, scenario["seed"]) for setup in scenario["servos"]]
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._play, daemon=True)
        for servo in self._servos:
            servo.power_on()
        self._thread.start()
        self._wait_until_quiet(time.monotonic() + 1.0)
        with self._lock:
            self._power_on = self.now()
            for event in scenario.get("events", []):
                self._plan(event)

    # For its servos.

    @staticmethod
    def now():
        return time.time()  # as in the records of the commands

    def at(self, when, what):
        with self._lock:
            heapq.heappush(self._due, (when, next(self._order), what))

    def send(self, sender, frames):
        for can_id, data in frames:
            if self._chance.random() < self._wire.get("loss", 0):
                continue
            for _ in range(1 + (self._chance.random() < self._wire.get("duplication", 0))):
                self._peer.send(can_id, data)
        can_id, data = frames[0]
        head = head_of(can_id)
        if not head.is_service and head.data_type == ALLOCATION:
            self._pass_on(head, data, sender)

    def tell(self, servo, event):
        self._events.append({"time": self.now(), "event": event, "serial_number": servo.serial,
                             "node_id": servo.node_id, "count": servo.rom_writes})

    # The bus.

    def _play(self):
        try:
            while not self._ended.is_set():
                with self._lock:
                    while self._due and self._due[0][0] <= self.now():
                        heapq.heappop(self._due)[2]()
                    wait = self._due[0][0] - self.now() if self._due else TICK_S
                received = self._peer.receive(time.monotonic() + min(max(wait, 0), TICK_S))
                if received:
                    with self._lock:
                        self._hear(*mcast_peer.decode(received[0]))
        except Exception as fault:  # told by the other thread
            self._fault = fault
            raise

    def _hear(self, can_id, data):
        if self._chance.random() >= self._wire.get("loss", 0):
            self._pass_on(head_of(can_id), data, None)

    def _pass_on(self, head, data, sender):
        for servo in self._servos:
            if servo is not sender:
                servo.hear(head, data)

    def _plan(self, event):
        servo = next(each for each in self._servos if each.serial == event["servo"])
        world = event.get("world", {})
        if event.get("happens") == "power_off" or world.get("plugged") == "off" or (
                world.get("voltage") == "2V"):  # below some 3 V it is as good as off
            what = servo.power_off
        elif event.get("happens", "power_on") != "power_on":
            what = servo.stumble
        else:
            what = servo.power_on
        self.at(self._power_on + seconds(event["at"]), what)

    # For the campaign.

    def hold(self, _):
        """Real time cannot be held."""

    def dump(self):
        with self._lock:
            if self._fault:
                raise RuntimeError(f"the servos have ended: {self._fault!r}")
            events, self._events = self._events, []
            return events, {servo.serial: self._state(servo) for servo in self._servos}

    def _state(self, servo):
        ram, rom = servo.memory.shown()
        return {"time": self.now(), "serial_number": servo.serial, "node_id": servo.node_id,
                "unique_id": servo.unique_id.hex(), "count": servo.rom_writes, "ram": ram,
                "rom": rom}

    def settle(self):
        """What was sent before a command broke off happens all the same."""
        self._wait_until_quiet(time.monotonic() + SETTLE_S)

    def _wait_until_quiet(self, end):
        time.sleep(3 * TICK_S)
        while time.monotonic() < end:
            with self._lock:
                if all(servo.phase in QUIET for servo in self._servos):
                    return
            time.sleep(TICK_S)

    def end(self):
        self._ended.set()
        self._thread.join()
        self._peer.close()
        if self._fault:
            raise RuntimeError(f"the servos have ended: {self._fault!r}")

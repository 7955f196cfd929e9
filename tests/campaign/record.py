"""What one command sent and heard: its candump log (--record), read without any help of blactl."""

import re
import typing

LINE = re.compile(r"\((\d+\.\d+)\) \S+ ([0-9A-F]{8})#([0-9A-F]*)")
OWN_IDS = (127, 126, 9)  # what blactl takes for itself
RESTART_NODE, EXECUTE_OPCODE, GET_SET, NODE_STATUS = 5, 10, 11, 341
ARRAY_COMMAND, ARMING_STATUS, FULLY_ARMED, EVERY_SERVO = 1010, 1100, 255, 255
INTEGER = 1  # the tag of a value that is to be written


class Frame(typing.NamedTuple):
    time: float
    can_id: int
    data: bytes

    @property
    def source(self):
        return self.can_id & 0x7F

    @property
    def is_service(self):
        return bool(self.can_id & 0x80)

    @property
    def is_request(self):
        return self.is_service and bool(self.can_id & 0x8000)

    @property
    def type(self):
        return self.can_id >> 16 & 0xFF if self.is_service else self.can_id >> 8 & 0xFFFF

    @property
    def starts(self):
        return bool(self.data[-1] & 0x80)


def is_change(frame):
    """A request that a servo may not be the same after."""
    if not (frame.is_request and frame.starts and frame.source in OWN_IDS):
        return False
    if frame.type in (RESTART_NODE, EXECUTE_OPCODE):
        return True
    # A write takes several frames, of which the first begins with two bytes of CRC.
    return frame.type == GET_SET and len(frame.data) == 8 and frame.data[3] & 7 == INTEGER


def is_telling(frame):
    """What a client can learn from whether a node has restarted: its answers, which it can follow
    with one more question, and its uptime. actuator.Status tells nothing of the kind."""
    return (frame.is_service and not frame.is_request or
            not frame.is_service and frame.type == NODE_STATUS)


class Record:
    def __init__(self, lines):
        self.frames = []
        for line in lines:
            match = LINE.match(line)
            if match:
                self.frames.append(Frame(float(match[1]), int(match[2], 16),
                                         bytes.fromhex(match[3])))

    def times_of(self, node_ids):
        """When the telling frames of these nodes were heard."""
        return [frame.time for frame in self.frames
                if frame.source in node_ids and is_telling(frame)]

    def changes(self):
        return [frame for frame in self.frames if is_change(frame)]

    def armed_at(self):
        """When the vehicle was first said to be armed."""
        return self._first(lambda frame: frame.type == ARMING_STATUS and
                           frame.data[0] == FULLY_ARMED)

    def driven_at(self):
        """When another node first commanded every servo."""
        return self._first(lambda frame: frame.type == ARRAY_COMMAND and frame.source not in OWN_IDS
                           and frame.starts and frame.data[0] == EVERY_SERVO)

    def _first(self, is_meant):
        return next((frame.time for frame in self.frames
                     if not frame.is_service and is_meant(frame)), float("inf"))

    def answers(self, registers):
        """(time, node ID, register, value) of every answer of GetSet about one of these that came
        whole. The CRC is not looked at: a frame that is missing or is another's breaks the toggles
        or the length."""
        found, parts = [], {}
        for frame in self.frames:
            if not frame.is_service or frame.is_request or frame.type != GET_SET:
                continue
            key, tail = frame.can_id & 0xFFFFFF, frame.data[-1]
            if frame.starts:
                parts[key] = [frame.data]
            elif key in parts and frame.data == parts[key][-1]:
                continue  # it came twice
            elif key in parts and (parts[key][-1][-1] ^ tail) & 0x3F == 0x20:  # only the toggle
                parts[key].append(frame.data)
            if tail & 0x40 and key in parts:
                payload = b"".join(data[:-1] for data in parts.pop(key))[2:]
                if len(payload) == 16 and payload[0] == INTEGER:
                    name = payload[12:].decode("ascii", "replace")
                    value = int.from_bytes(payload[1:9], "little", signed=True)
                    found.append((frame.time, frame.source, name, value))
        return [answer for answer in found if answer[2] in registers]

    @property
    def end(self):
        return self.frames[-1].time if self.frames else 0.0


def read(path):
    try:
        with open(path, encoding="ascii") as file:
            return Record(file)
    except FileNotFoundError:  # it never came to the bus
        return Record([])

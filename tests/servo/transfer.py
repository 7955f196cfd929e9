"""Transfers of DroneCAN (specification 4.1): frames to payloads and back."""

import os
import struct
import sys
import typing

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "net"))
from mcast_peer import crc  # pylint: disable=wrong-import-position

ALLOCATION, GET_NODE_INFO, RESTART_NODE, EXECUTE_OPCODE, GET_SET = 1, 1, 5, 10, 11
NODE_STATUS, ARRAY_COMMAND, ACTUATOR_STATUS = 341, 1010, 1011

# Of chapter 2.3 of the BLA specification, by (is it a service, data type ID).
SIGNATURES = {
    (True, GET_NODE_INFO): 0xEE468A8121C46A9E,
    (False, ALLOCATION): 0x0B2A812620A11D40,
    (True, RESTART_NODE): 0x569E05394A3017F0,
    (True, EXECUTE_OPCODE): 0x3B131AC5EB69D2CD,
    (True, GET_SET): 0xA7B622F939D1A4D5,
    (False, NODE_STATUS): 0x0F0868D0C1A7C6F1,
    (False, ARRAY_COMMAND): 0xD8A7486238EC3AF3,
    (False, ACTUATOR_STATUS): 0x5E9BBA44FAF1EA04,
}
TRANSFER_ID_TIMEOUT_S = 2.0


def base_crc(is_service, data_type):
    return crc(struct.pack("<Q", SIGNATURES[is_service, data_type]))


class Head(typing.NamedTuple):
    """What a CAN ID says."""
    priority: int
    is_service: bool
    data_type: int
    source: int
    is_request: bool = False
    destination: int = 0

    def can_id(self):
        if not self.is_service:
            return self.priority << 24 | self.data_type << 8 | self.source
        return (self.priority << 24 | self.data_type << 16 | self.is_request << 15 |
                self.destination << 8 | 1 << 7 | self.source)


def head_of(can_id):
    priority, source = can_id >> 24 & 31, can_id & 127
    if can_id & 1 << 7:
        return Head(priority, True, can_id >> 16 & 255, source, bool(can_id & 1 << 15),
                    can_id >> 8 & 127)
    data_type = can_id >> 8 & (0xFFFF if source else 3)  # anonymous: the rest tells nodes apart
    return Head(priority, False, data_type, source)


def split(head, payload, transfer_id):
    """The data of the frames of one transfer."""
    if len(payload) <= 7:
        return [payload + bytes([0xC0 | transfer_id])]
    rest = struct.pack("<H", crc(payload, base_crc(head.is_service, head.data_type))) + payload
    parts = [rest[i:i + 7] for i in range(0, len(rest), 7)]
    return [part + bytes([(i == 0) << 7 | (i == len(parts) - 1) << 6 | (i & 1) << 5 | transfer_id])
            for i, part in enumerate(parts)]


class Session:
    """Of one kind of transfer from one node. `expected`: the transfer ID that is due."""

    def __init__(self, expected, began):
        self.expected, self.began = expected, began
        self.toggle, self.collected = 0, b""


class Inbox:
    """The receiver of the specification, as strict as it is written: a transfer that repeats the
    last transfer ID within two seconds is the last one once more, and dropped."""

    def __init__(self):
        self._sessions = {}

    def take(self, head, data, now):
        """(payload, transfer ID) when a transfer is complete and whole; else None."""
        tail = data[-1]
        starts, ends, toggle, transfer_id = tail >> 7, tail >> 6 & 1, tail >> 5 & 1, tail & 31
        session = self._session(head, starts, transfer_id, now)
        if session is None or toggle != session.toggle or transfer_id != session.expected:
            return None
        if starts:
            session.began, session.collected = now, b""
        session.collected += data[:-1]
        session.toggle ^= 1
        if not ends:
            return None
        session.toggle, session.expected = 0, (transfer_id + 1) % 32
        payload = whole(head, session.collected, bool(starts))
        return None if payload is None else (payload, transfer_id)

    def _session(self, head, starts, transfer_id, now):
        key = (head.is_service, head.is_request, head.data_type, head.source)
        session = self._sessions.get(key)
        stale = session is None or now - session.began > TRANSFER_ID_TIMEOUT_S
        if stale or starts and (session.expected - transfer_id) % 32 > 1:
            session = Session(transfer_id if starts else (transfer_id + 1) % 32, now)
            self._sessions[key] = session
            return session if starts else None
        return session


def whole(head, collected, single):
    """The payload; None if the CRC is another."""
    if single:
        return collected
    expected, payload = struct.unpack_from("<H", collected)[0], collected[2:]
    return payload if crc(payload, base_crc(head.is_service, head.data_type)) == expected else None

"""What is asked of a servo, and its answers (2.3)."""

import math
import struct

from transfer import EXECUTE_OPCODE, GET_NODE_INFO, GET_SET, RESTART_NODE

SERVED = (GET_NODE_INFO, RESTART_NODE, EXECUTE_OPCODE, GET_SET)
MAGIC = (0xACCE551B1E).to_bytes(5, "little")
SAVE, ERASE = 0, 1
EMPTY, INTEGER = 0, 1
INITIALIZE, REBOOT, WRITE_ROM = 0x10, 0x11, 0x12
OK = b"\x80"
EVERY_SERVO = 255
ARRAY_KINDS = {0: (0x00, 1800), 1: (0x00, 1000), 2: (0x02, 1), 3: (0x01, 1)}


def parse(service, payload):
    return {GET_NODE_INFO: NodeInfo, RESTART_NODE: Restart, EXECUTE_OPCODE: Opcode,
            GET_SET: GetSet}[service](payload)


class NodeInfo:
    kind, is_order, order = "node_info", False, None

    def __init__(self, _):
        pass

    def obey(self, servo):
        return servo.info()


class Restart:
    kind = "restart"

    def __init__(self, payload):
        self.is_order = payload == MAGIC
        self.order = "restart" if self.is_order else None

    def refusal(self):
        return b"\0"

    def obey(self, _):
        return OK if self.is_order else self.refusal()


class Opcode:
    kind = "opcode"

    def __init__(self, payload):
        self._code = payload[0] if len(payload) == 7 else None
        self.is_order = self._code in (SAVE, ERASE)
        self.order = "save" if self._code == SAVE else None

    def refusal(self):
        return bytes(7)

    def obey(self, servo):
        if self._code == ERASE:
            servo.erase()
        return bytes(6) + OK if self.is_order else self.refusal()


class GetSet:
    def __init__(self, payload):
        index, tag = payload[0] | (payload[1] & 0xF8) << 5, payload[1] & 7
        self._tag, self._value, name = tag, 0, payload[2:]
        if tag == INTEGER:
            self._value, name = struct.unpack_from("<q", payload, 2)[0], payload[10:]
        self._address = address_of(name) if name else index
        self.kind = "read" if tag == EMPTY else "write"
        self.order = {REBOOT: "restart", WRITE_ROM: "save"}.get(self._ordered())
        self.is_order = self._ordered() is not None

    def _ordered(self):
        orders = self._tag == INTEGER and self._value == 1
        return self._address if orders and INITIALIZE <= self._address <= WRITE_ROM else None

    def refusal(self):
        return bytes(4)

    def obey(self, servo):
        if self._ordered() is not None:
            if self._ordered() == INITIALIZE:
                servo.erase()
            return self._answer(1)
        if self._tag == EMPTY:
            return self._answer(servo.memory.read(self._address))
        if self._tag == INTEGER:
            return self._answer(servo.memory.write(self._address, self._value))
        return self.refusal()

    def _answer(self, value):
        if value is None:
            return self.refusal()
        return (bytes([INTEGER]) + struct.pack("<q", value) + bytes(3) +
                f"0x{self._address:02X}".encode())


def told_by_array(payload, servo_id):
    """Of an ArrayCommand (tables 2-20, 2-21): (address, value) of what it tells this servo."""
    whole = len(payload) - len(payload) % 4
    for number, kind, value in struct.iter_unpack("<BBe", payload[:whole]):
        if number in (servo_id, EVERY_SERVO) and kind in ARRAY_KINDS and math.isfinite(value):
            address, scale = ARRAY_KINDS[kind]
            yield address, round(value * scale)


def address_of(name):
    """-1: no name of a register, which are "0x" and two upper-case digits."""
    digits = name[2:].decode("ascii", "replace")
    if len(name) == 4 and name[:2] == b"0x" and digits == digits.upper():
        try:
            return int(digits, 16)
        except ValueError:
            pass
    return -1

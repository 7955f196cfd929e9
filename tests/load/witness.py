"""A node on the bus of a running `blactl sim` that hears every frame, and fills what others leave.

It speaks the protocol of include/blactl/can/sim_wire.hpp, and shares no code with blactl.
"""

import socket
import struct
import threading

# kind, value, at, count, id, flags, size, data, reserved
MESSAGE = struct.Struct("=IIqQIBB8s2s")
HELLO, WELCOME, SEND = 0x4D534C42, 0x4D534C43, 0x4D534C46
RECEIVED, SENT, OVERFLOW = 0x4D534C48, 0x4D534C49, 0x4D534C4B
VERSION = 1
EXTENDED = 1

# A message of priority 31 and data type 20000 of node 77: its seven bytes of payload count.
COUNTER_ID = 31 << 24 | 20000 << 8 | 77
SINGLE_FRAME = 0xC0
IN_FLIGHT = 40  # its frames that the simulator has; it takes up to 64


class Witness:
    """Begins to listen at once. Call stop() before the lists are looked at."""

    def __init__(self, path, fills):
        self.frames = []  # all of the bus in their order: (microseconds, "1E0B8BFF#C0")
        self.lost = 0
        self.sent = 0
        self.echoed = 0
        self.socket = socket.socket(socket.AF_UNIX, socket.SOCK_SEQPACKET)
        self.socket.connect(path)
        self.socket.sendall(MESSAGE.pack(HELLO, VERSION, 0, 0, 0, 0, 0, b"", b""))
        if MESSAGE.unpack(self.socket.recv(64))[0] != WELCOME:
            raise AssertionError("the simulator does not greet")
        self.fills = fills
        self.thread = threading.Thread(target=self.listen)
        self.thread.start()

    def stop(self):
        self.socket.shutdown(socket.SHUT_RDWR)
        self.thread.join()
        self.socket.close()

    def fill(self):
        while self.fills and self.sent - self.echoed < IN_FLIGHT:
            payload = self.sent.to_bytes(7, "little") + bytes([SINGLE_FRAME | self.sent % 32])
            self.socket.sendall(
                MESSAGE.pack(SEND, 0, 0, 0, COUNTER_ID, EXTENDED, len(payload), payload, b""))
            self.sent += 1

    def listen(self):
        try:
            self.fill()
            while packet := self.socket.recv(64):
                kind, _, at, count, can_id, _, size, data, _ = MESSAGE.unpack(packet)
                if kind in (RECEIVED, SENT):
                    self.frames.append((at, f"{can_id:08X}#{data[:size].hex().upper()}"))
                elif kind == OVERFLOW:
                    self.lost = count
                if kind == SENT:
                    self.echoed += 1
                    self.fill()
        except OSError:
            pass


def counted(frame):
    """What a frame of the witness counts; None: it is not one of those."""
    can_id, data = frame.split("#")
    return int.from_bytes(bytes.fromhex(data[:14]), "little") if can_id == f"{COUNTER_ID:08X}" else None



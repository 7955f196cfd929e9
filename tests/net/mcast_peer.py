"""DroneCAN over UDP multicast once more, written from the specification (4.1, 4.2) and sharing
nothing with blactl: another node on the bus, and a witness of what is on it."""

import socket
import struct
import subprocess
import sys
import time

PORT = 57732
PATIENCE = 10  # seconds; only a failure takes that long

GET_NODE_INFO = 1
GET_SET = 11
BASE_CRC = {GET_NODE_INFO: 0xD9A7, GET_SET: 0xFB10}  # the CRC over the signature of the type


def crc(data, value=0xFFFF):
    """CRC-16/CCITT-FALSE, bit by bit."""
    for byte in data:
        value ^= byte << 8
        for _ in range(8):
            value = (value << 1) ^ 0x1021 if value & 0x8000 else value << 1
            value &= 0xFFFF
    return value


def encode(can_id, data, flags=0, magic=0x2934, extended=True):
    rest = struct.pack("<HI", flags, can_id | (1 << 31 if extended else 0)) + data
    return struct.pack("<HH", magic, crc(rest)) + rest


def decode(datagram):
    """(CAN ID, data) of an extended frame; what blactl sends must be nothing else."""
    magic, checksum, flags, can_id = struct.unpack_from("<HHHI", datagram)
    assert magic == 0x2934, datagram.hex()
    assert checksum == crc(datagram[4:]), datagram.hex()
    assert flags == 0, datagram.hex()
    assert can_id >> 29 == 0b100, datagram.hex()
    assert 1 <= len(datagram) - 10 <= 8, datagram.hex()
    return can_id & 0x1FFFFFFF, datagram[10:]


def service_id(service, destination, source, is_request, priority=30):
    return (priority << 24 | service << 16 | is_request << 15 | destination << 8 | 1 << 7 | source)


def frames_of(service, payload, transfer_id):
    """The data of the frames of one transfer."""
    if len(payload) <= 7:
        return [payload + bytes([0xC0 | transfer_id])]
    rest = struct.pack("<H", crc(payload, BASE_CRC[service])) + payload
    frames = []
    while rest:
        part, rest = rest[:7], rest[7:]
        tail = (0x80 if not frames else 0) | (0 if rest else 0x40) | (len(frames) & 1) << 5
        frames.append(part + bytes([tail | transfer_id]))
    return frames


class Peer:
    """One node. `port`: the one its datagrams come from; 0: whatever the kernel gives."""

    def __init__(self, bus, interface, port=0, node_id=100):
        group = socket.inet_aton(f"239.65.82.{bus}")
        member = struct.pack("4s4si", group, bytes(4), socket.if_nametoindex(interface))
        self.node_id = node_id
        self.group = (socket.inet_ntoa(group), PORT)
        self.inward = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.inward.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        self.inward.bind(self.group)
        self.inward.setsockopt(socket.IPPROTO_IP, socket.IP_ADD_MEMBERSHIP, member)
        self.outward = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.outward.setsockopt(socket.IPPROTO_IP, socket.IP_MULTICAST_IF, member)
        self.outward.bind(("", port))
        self.outward.connect(self.group)

    def close(self):
        self.inward.close()
        self.outward.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def send_bytes(self, datagram):
        self.outward.send(datagram)

    def send(self, can_id, data):
        self.send_bytes(encode(can_id, data))

    def receive(self, until):
        """(datagram, the port it came from) of somebody else; None: nothing before `until`."""
        while True:
            self.inward.settimeout(max(until - time.monotonic(), 0.0001))
            try:
                datagram, sender = self.inward.recvfrom(2000)
            except (socket.timeout, BlockingIOError):
                return None
            if sender != self.outward.getsockname():
                return datagram, sender[1]

    def ask(self, node, service, payload):
        """The payload of a node's answer; a servo that has just started does not answer at once."""
        end = time.monotonic() + PATIENCE
        for transfer_id in range(32):
            self.send(service_id(service, node, self.node_id, True),
                      frames_of(service, payload, transfer_id)[0])
            answer = self.assemble(node, service, transfer_id, time.monotonic() + 1)
            if answer is not None:
                return answer
            assert time.monotonic() < end, f"node {node} does not answer"
        raise AssertionError(f"node {node} never answers")

    def assemble(self, node, service, transfer_id, until):
        """The payload of one answer, checked; None: it did not come."""
        answer_id = service_id(service, self.node_id, node, False)
        collected = b""
        toggle = 0
        while received := self.receive(until):
            can_id, data = decode(received[0])
            tail = data[-1]
            # Priorities may differ; they are no part of what an answer is.
            if can_id & 0xFFFFFF != answer_id & 0xFFFFFF or tail & 0x1F != transfer_id:
                continue
            assert bool(tail & 0x80) == (collected == b""), "a start where none belongs"
            assert tail >> 5 & 1 == toggle, "a toggle that does not alternate"
            toggle ^= 1
            collected += data[:-1]
            if tail & 0xC0 == 0xC0:
                return collected
            if tail & 0x40:
                checksum = crc(collected[2:], BASE_CRC[service])
                assert struct.unpack_from("<H", collected)[0] == checksum, collected.hex()
                return collected[2:]
        return None

    def answer(self, service, node, payload, transfer_id):
        for data in frames_of(service, payload, transfer_id):
            self.send(service_id(service, node, self.node_id, False), data)


def node_status(node_id, uptime=1, priority=16):
    """A NodeStatus message: operational, well."""
    return priority << 24 | 341 << 8 | node_id, struct.pack("<IBH", uptime, 0, 0) + b"\xC0"


class Servo(Peer):
    """Answers like a BLA21-12U-AB with these registers."""

    registers = {"0x50": 61, "0x51": 240999999, "0x52": 1400, "0x53": 12050, "0x45": 9,
                 "0x38": 1234}

    def serve_once(self, until):
        """Answers one request; the datagram it came in, or None."""
        received = self.receive(until)
        if not received:
            return None
        can_id, data = decode(received[0])
        client, transfer_id = can_id & 0x7F, data[-1] & 0x1F
        for service, make in ((GET_NODE_INFO, self.info), (GET_SET, self.value)):
            if can_id & 0xFFFFFF == service_id(service, self.node_id, client, True) & 0xFFFFFF:
                self.answer(service, client, make(data[:-1]), transfer_id)
                return received[0]
        return b""

    def info(self, _):
        versions = struct.pack("<BBBIQ", 1, 40, 0, 0, 0) + bytes([12, 5])
        return struct.pack("<IBH", 5, 0, 0) + versions + bytes(range(16)) + b"\0" + b"a.peer"

    def value(self, request):
        name = request[2:].decode()
        if name not in self.registers:
            return bytes(4)
        return b"\x01" + struct.pack("<q", self.registers[name]) + bytes(3) + name.encode()


def main():
    """The register 0x38 of a node, asked from a network of its own: mcast_peer.py INTERFACE ADDRESS
    PORT NODE. Says that it is there, and waits for a line: then the interface is there, too."""
    interface, address, port, node = sys.argv[1:]
    print("there", flush=True)
    sys.stdin.readline()
    for command in (f"ip addr add {address}/24 dev {interface}", f"ip link set {interface} up"):
        subprocess.run(command.split(), check=True)
    with Peer(0, interface, int(port)) as peer:
        print(peer.ask(int(node), GET_SET, b"\0\0" + b"0x38").hex())


if __name__ == "__main__":
    main()

#!/usr/bin/env python3
"""The built blactl on buses over UDP multicast: namespace.sh mcast_test.py BLACTL. The other end
and the witness of what is on the bus is mcast_peer.py."""

import json
import os
import signal
import subprocess
import sys
import threading
import time
import unittest

import mcast_peer
from mcast_peer import PATIENCE, Peer, Servo

if "BLACTL_NET_OF_ITS_OWN" not in os.environ:
    sys.exit("mcast_test.py: start it with tests/net/namespace.sh")

BLACTL = sys.argv.pop(1)


def ip(command):
    subprocess.run(["ip"] + command.split(), check=True)


def run(*arguments):
    """Status, stdout and stderr of blactl."""
    done = subprocess.run([BLACTL, *arguments], capture_output=True, text=True, timeout=120,
                          stdin=subprocess.DEVNULL)
    return done.returncode, done.stdout, done.stderr


class Simulator:
    """blactl sim on a bus: nodes 11, 12 and 13."""

    def __init__(self, interface):
        self.process = subprocess.Popen([BLACTL, "-q", "sim", "-i", interface], text=True,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        assert self.process.stdout.readline() == "ready\n", self.process.stderr.read()

    def __enter__(self):
        return self.process

    def __exit__(self, *_):
        self.process.send_signal(signal.SIGTERM)
        self.process.communicate(timeout=60)


class Cable:
    """A cable of Ethernet between two interfaces: net0 with an address, net1 without."""

    def __enter__(self):
        ip("link add net0 type veth peer name net1")
        ip("addr add 10.82.0.1/24 dev net0")
        ip("link set net0 up")
        ip("link set net1 up")

    def __exit__(self, *_):
        subprocess.run(["ip", "link", "del", "net0"], check=False, stderr=subprocess.DEVNULL)


class OnLoopback(unittest.TestCase):
    def test_a_peer_reads_a_simulated_servo_by_bytes_made_by_hand(self):
        with Simulator("mcast:0?if=lo"), Peer(0, "lo") as peer:
            info = peer.ask(11, mcast_peer.GET_NODE_INFO, b"")
            self.assertTrue(info.endswith(b"jp.co.futaba.bla21"), info)
            value = peer.ask(11, mcast_peer.GET_SET, b"\0\0" + b"0x38")
            self.assertEqual(value, b"\x01" + (1799).to_bytes(8, "little") + bytes(3) + b"0x38")
            nobody = peer.ask(12, mcast_peer.GET_SET, b"\0\0" + b"0x60")
            self.assertEqual(nobody[-4:], bytes(4))  # no value, no name

    def test_blactl_reads_a_servo_of_another_implementation_and_sends_these_bytes(self):
        requests = []
        with Servo(5, "lo", node_id=10) as servo:
            ended = threading.Event()

            def serve():
                while not ended.is_set():
                    request = servo.serve_once(time.monotonic() + 0.1)
                    if request is not None:
                        requests.append(request)
            service = threading.Thread(target=serve)
            service.start()
            status, out, err = run("-i", "mcast:5?if=lo", "get", "-n", "10", "0x38", "-j")
            ended.set()
            service.join()
        self.assertEqual(status, 0, err)
        document = json.loads(out)
        self.assertEqual(document["interface"], "mcast:5?if=lo")
        self.assertEqual(document["nodes"][0]["serial_number"], 240999999)
        self.assertEqual(document["nodes"][0]["params"][0]["raw"], 1234)
        # GetNodeInfo and the register, node 127 to node 10 with priority 30, magic and CRC first.
        self.assertEqual(requests[0].hex(), "34296acb0000ff8a019ec0")
        read = next(request for request in requests if request[-5:-1] == b"0x38")
        self.assertEqual(read[4:-1].hex(), "0000ff8a0b9e" + "0000" + b"0x38".hex())
        self.assertEqual(read[:2].hex(), "3429")
        # In the end it is asked once more who answered.
        self.assertEqual(requests[-1][4:-1].hex(), requests[0][4:-1].hex())

    def test_several_processes_on_one_bus_and_none_on_another(self):
        with Simulator("mcast:0?if=lo"):
            self.assertEqual(run("-i", "mcast:0?if=lo", "scan", "--expect", "3")[0], 0)
            status, _, err = run("-i", "mcast:0?if=lo", "set", "-n", "12", "angle_limit_cw=90deg")
            self.assertEqual(status, 0, err)
            status, out, err = run("-i", "mcast:?if=lo", "get", "-n", "12", "angle_limit_cw", "-j")
            self.assertEqual(status, 0, err)
            self.assertEqual(json.loads(out)["nodes"][0]["params"][0]["raw"], 900)
            status, _, err = run("-i", "mcast:1?if=lo", "scan")
            self.assertEqual(status, 4)
            self.assertIn("[not_found]", err)

    def test_own_frames_are_not_heard(self):
        with Peer(2, "lo") as witness:
            status, _, err = run("-i", "mcast:2?if=lo", "scan")
            self.assertEqual(status, 4, err)
            self.assertNotIn("duplicate_node_id", err)
            count = 0
            while received := witness.receive(time.monotonic() + 0.2):
                self.assertEqual(mcast_peer.decode(received[0])[0] & 0x7F, 127)
                count += 1
            self.assertGreater(count, 100)  # it did ask every ID

    def test_garbage_is_passed_over_and_told(self):
        can_id, data = mcast_peer.node_status(50)
        whole = mcast_peer.encode(can_id, data)
        garbage = [b"", b"\0", whole[:9], whole[:-1], b"\0" + whole[1:], whole + bytes(60),
                   mcast_peer.encode(can_id, bytes(64)), mcast_peer.encode(can_id, data, flags=1),
                   mcast_peer.encode(can_id, bytes(64), flags=1), bytes(1400)]
        with Peer(3, "lo") as peer:
            process = subprocess.Popen([BLACTL, "-i", "mcast:3?if=lo", "scan", "--listen", "2"],
                                       stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            self.assertIsNotNone(peer.receive(time.monotonic() + PATIENCE))  # it is there
            for datagram in garbage:
                peer.send_bytes(datagram)
            _, err = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 4, err)
        self.assertIn(f"no frames of classic CAN (CAN FD, or damaged): {len(garbage)}", err)

    def test_an_interface_that_goes_down_ends_who_sends_and_who_listens(self):
        with Simulator("mcast:4?if=lo") as simulator:
            listener = subprocess.Popen([BLACTL, "-i", "mcast:9?if=lo", "scan", "--listen-only",
                                         "--listen", "60"], stdout=subprocess.DEVNULL,
                                        stderr=subprocess.PIPE, text=True)
            time.sleep(0.5)  # earlier is as good: then it cannot be opened, which is 3 as well
            ip("link set lo down")
            try:
                _, said = simulator.communicate(timeout=60)
                _, heard = listener.communicate(timeout=60)
            finally:
                ip("link set lo up")
        self.assertEqual((simulator.returncode, listener.returncode), (3, 3), said + heard)
        for err in (said, heard):
            self.assertIn("[interface] interface lo is down", err)
            self.assertIn("`sudo ip link set lo up`", err)


class Interfaces(unittest.TestCase):
    def test_the_interface_that_is_named_is_the_only_one(self):
        with Cable(), Simulator("mcast:0?if=net0"):
            status, _, err = run("-i", "mcast:0?if=net0", "scan", "--expect", "3")
            self.assertEqual((status, err), (0, ""))
            with Peer(0, "net0"):  # of whose membership blactl on lo must hear nothing
                self.assertEqual(run("-i", "mcast:0?if=lo", "scan")[0], 4)

    def test_membership_and_sending_follow_the_route_together(self):
        # The trap: by this route the kernel joins on lo, and sends from net0's address by net0.
        with Cable():
            ip("route add 239.0.0.0/8 dev lo")
            with Simulator("mcast:0"), Peer(0, "lo") as witness:
                self.assertIsNotNone(witness.receive(time.monotonic() + PATIENCE))
                status, _, err = run("-i", "mcast:0", "scan", "--expect", "3")
            ip("route del 239.0.0.0/8 dev lo")
            self.assertEqual(status, 0, err)
            self.assertIn("using mcast:0?if=lo", err)
            ip("route add default dev net0")
            with Simulator("mcast:0"), Peer(0, "net0") as witness:
                self.assertIsNotNone(witness.receive(time.monotonic() + PATIENCE))
                status, _, err = run("-i", "mcast:0", "scan", "--expect", "3")
            self.assertEqual(status, 0, err)
            self.assertIn("using mcast:0?if=net0", err)

    def test_without_a_route_it_is_loopback_and_that_is_said(self):
        with Simulator("mcast:0?if=lo"):
            status, _, err = run("-i", "mcast:0", "scan", "--expect", "3")
        self.assertEqual(status, 0, err)
        self.assertIn("using mcast:0?if=lo", err)

    def test_another_host_is_heard_although_its_port_is_ours(self):
        with Cable(), Simulator("mcast:0?if=net0"), Peer(0, "net0") as witness:
            _, port = witness.receive(time.monotonic() + PATIENCE)  # of the simulator
            other = subprocess.Popen(
                ["unshare", "--net", sys.executable, mcast_peer.__file__, "net1",
                 "10.82.0.2", str(port), "11"],
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
            self.assertEqual(other.stdout.readline(), "there\n")
            ip(f"link set net1 netns {other.pid}")
            out, err = other.communicate("now\n", timeout=60)
        self.assertEqual(other.returncode, 0, err)
        self.assertEqual(out.strip(), "01" + (1799).to_bytes(8, "little").hex() + "000000" +
                         b"0x38".hex())

    def test_interfaces_that_cannot_be_used_are_refused_with_what_to_do(self):
        with Cable():
            ip("link set net1 down")
            for name, reason, remedy in (
                    ("eth7", "there is no interface eth7", "lo, "),
                    ("net1", "interface net1 is down", "`sudo ip link set net1 up`")):
                status, _, err = run("-i", f"mcast:0?if={name}", "scan")
                self.assertEqual(status, 3)
                self.assertIn(f"[interface] {reason}", err)
                self.assertIn(remedy, err)
            ip("link set net1 up")
            status, _, err = run("-i", "mcast:0?if=net1", "scan")
            self.assertEqual(status, 3)
            self.assertIn("interface net1 has no IPv4 address", err)
            self.assertIn("`sudo ip addr add ", err)

    def test_an_interface_that_is_taken_away_is_gone(self):
        with Cable(), Simulator("mcast:0?if=net0") as simulator:
            ip("link del net0")
            _, err = simulator.communicate(timeout=60)
            self.assertEqual(simulator.returncode, 3, err)
            self.assertIn("[interface] interface net0 is", err)


if __name__ == "__main__":
    unittest.main()

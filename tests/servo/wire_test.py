#!/usr/bin/env python3
"""The servo of these tests against bytes and numbers of the specifications, without a network."""

import struct
import unittest

import memory
import requests
from transfer import (ALLOCATION, EXECUTE_OPCODE, GET_NODE_INFO, GET_SET, NODE_STATUS, RESTART_NODE,
                      Head, Inbox, base_crc, head_of, split)

REQUEST = {"source": 127, "is_request": True, "destination": 10}


def service(data_type):
    return Head(30, True, data_type, **REQUEST)


def text(head, payload, transfer_id=0):
    """As a candump log has the frames of a transfer."""
    return [f"{head.can_id():08X}#{data.hex().upper()}"
            for data in split(head, payload, transfer_id)]


class Wire(unittest.TestCase):
    def test_the_log_of_the_standard(self):
        unique_id = bytes.fromhex("44C08B635E05F4BC1096DF11A8BA5447")
        head = Head(30, False, ALLOCATION, 1)
        self.assertEqual(text(head, b"\0" + unique_id[:12], 1), [
            "1E000101#05B00044C08B6381", "1E000101#5E05F4BC1096DF21", "1E000101#1141"])
        self.assertEqual(text(head, bytes([125 << 1]) + unique_id, 2), [
            "1E000101#29BAFA44C08B6382", "1E000101#5E05F4BC1096DF22", "1E000101#11A8BA544742"])

    def test_requests(self):
        self.assertEqual(text(service(GET_NODE_INFO), b""), ["1E018AFF#C0"])
        self.assertEqual(text(service(EXECUTE_OPCODE), bytes(7)), ["1E0A8AFF#00000000000000C0"])
        self.assertEqual(text(service(RESTART_NODE), requests.MAGIC), ["1E058AFF#1E1B55CEACC0"])
        self.assertEqual(text(service(GET_SET), b"\0\1" + struct.pack("<q", 1500) + b"ABC"), [
            "1E0B8AFF#19B40001DC050080", "1E0B8AFF#0000000000414220", "1E0B8AFF#4340"])

    def test_ids_there_and_back(self):
        for head in (service(GET_SET), Head(16, False, NODE_STATUS, 42)):
            self.assertEqual(head_of(head.can_id()), head)
        self.assertEqual(base_crc(False, NODE_STATUS), 0xBE5F)


class Receiving(unittest.TestCase):
    write = b"\0\1" + struct.pack("<q", -5) + b"0x39"

    def take(self, inbox, frames, now=0.0):
        taken = [inbox.take(service(GET_SET), data, now) for data in frames]
        return [each for each in taken if each]

    def test_a_transfer_is_taken_once_in_two_seconds(self):
        inbox = Inbox()
        frames = split(service(GET_SET), self.write, 7)
        self.assertEqual(self.take(inbox, frames), [(self.write, 7)])
        self.assertEqual(self.take(inbox, frames, 1.9), [])
        self.assertEqual(self.take(inbox, frames, 2.1), [(self.write, 7)])

    def test_every_frame_twice_is_one_transfer(self):
        frames = split(service(GET_SET), self.write, 7)
        doubled = [data for data in frames for _ in range(2)]
        self.assertEqual(self.take(Inbox(), doubled), [(self.write, 7)])

    def test_a_lost_frame_loses_the_transfer_and_not_the_next(self):
        inbox = Inbox()
        frames = split(service(GET_SET), self.write, 7)
        self.assertEqual(self.take(inbox, [frames[0], frames[2]]), [])
        self.assertEqual(self.take(inbox, split(service(GET_SET), self.write, 8)),
                         [(self.write, 8)])

    def test_a_wrong_crc_loses_the_transfer(self):
        frames = split(service(GET_SET), self.write, 7)
        frames[1] = b"\1" + frames[1][1:]
        self.assertEqual(self.take(Inbox(), frames), [])


class Registers(unittest.TestCase):
    def setUp(self):
        self.memory = memory.Memory({"model": "BLA21-12U-A0", "serial_number": 240900001,
                                     "node_id": 11, "servo_id": 3})

    def get_set(self, payload):
        class Owner:  # what a request needs of a servo
            memory = self.memory
        return requests.parse(GET_SET, payload).obey(Owner)

    def write(self, value, name):
        return self.get_set(b"\0\1" + struct.pack("<q", value) + name)

    def test_a_read_and_a_write_answer_the_present_value(self):
        self.assertEqual(self.get_set(b"\0\0" + b"0x39"),
                         b"\1" + struct.pack("<q", -1800) + bytes(3) + b"0x39")
        self.assertEqual(self.write(-5, b"0x39"),
                         b"\1" + struct.pack("<q", -5) + bytes(3) + b"0x39")
        self.assertEqual(self.memory.rom[0x39], -1800)

    def test_an_index_is_an_address(self):
        self.assertEqual(self.get_set(b"\x45\0")[1], 3)

    def test_what_is_not_there_is_a_failure(self):
        for name in (b"0x28", b"0x3a", b"0x60", b"0x10", b"0x49", b"38", b"0x3G"):
            self.assertEqual(self.get_set(b"\0\0" + name), bytes(4), name)
        for name in (b"0x51", b"0x08", b"0x1A"):
            self.assertEqual(self.write(1, name), bytes(4), name)

    def test_out_of_range(self):
        for policy, answered in (("refuse", 300), ("clamp", 0), ("fail", None)):
            self.memory.out_of_range = policy
            answer = self.write(-1, b"0x3A")
            self.assertEqual(answer[1:9], struct.pack("<q", answered) if answered is not None
                             else b"\0\0\0")

    def test_one_command_at_a_time(self):
        self.memory.write(0x25, 1)
        self.memory.write(0x01, 50)
        self.assertEqual([self.memory.read(address) for address in memory.COMMANDS],
                         [memory.NOT_ACTIVE, 50, memory.NOT_ACTIVE])

    def test_the_own_numbers_of_every_model(self):
        self.assertEqual(memory.registers_of("BLA34-28U-AB")[0x33].default, 680)
        self.assertEqual(memory.registers_of("BLA21-06U-AB")[0x36].most, 3600)
        self.assertEqual(memory.registers_of("BLA15-12U-A0")[0x3A].most, 300)
        self.assertEqual(memory.registers_of("BLA21-06U-A0")[0x34].most, 0)

    def test_a_lost_rom_is_initial_values_and_a_warning_until_it_is_saved(self):
        self.memory.lose_rom()
        self.memory.load()
        self.assertEqual(self.memory.read(0x1A), memory.ROM_LOST)
        self.assertEqual(self.memory.read(0x45), 0)
        self.memory.save()
        self.memory.load()
        self.assertEqual(self.memory.read(0x1A), 0)


class Shaft(unittest.TestCase):
    def setUp(self):
        self.time = 0.0
        self.memory = memory.Memory(
            {"model": "BLA21-12U-A0", "serial_number": 240900001, "node_id": 11,
             "rom": {"speed_torque_control": "on"}}, lambda: self.time)

    def after(self, seconds):
        self.time += seconds
        return [self.memory.read(address) for address in (0x08, 0x09)]

    def test_an_angle_is_gone_to_and_held(self):
        self.memory.write(0x00, 900)
        self.assertEqual(self.after(0.1), [360, 60])
        self.assertEqual(self.after(0.2), [900, 0])

    def test_a_limit_is_where_an_angle_ends(self):
        self.memory.write(0x38, 300)
        self.memory.write(0x00, 900)
        self.assertEqual(self.after(0.5), [300, 0])

    def test_a_speed_turns_it_round_until_the_timeout(self):
        self.memory.write(0x01, 30)
        self.assertEqual(self.after(0.9), [1620, 30])
        self.assertEqual(self.after(0.6), [-1800, 0])

    def test_hold_has_no_timeout(self):
        self.memory.write(0x24, 1)
        self.memory.write(0x26, 0)
        self.memory.write(0x01, -30)
        self.assertEqual(self.after(4.0), [-7200, -30])

    def test_output_off_and_on_forgets_the_command(self):
        self.memory.write(0x01, 30)
        self.after(0.5)
        self.memory.write(0x20, 1)
        self.memory.write(0x20, 0)
        self.assertEqual(self.after(0.5), [900, 0])

    def test_reverse_turns_the_angle_over(self):
        self.memory.write(0x00, 90)
        self.after(0.1)
        self.memory.write(0x23, 1)
        self.assertEqual(self.memory.read(0x08), -90)

    def test_what_an_array_command_tells(self):
        payload = struct.pack("<BBeBBeBBe", 3, 1, 0.045, 4, 3, 10.0, 255, 2, -20.0)
        self.assertEqual(list(requests.told_by_array(payload, 3)), [(0x00, 45), (0x02, -20)])


if __name__ == "__main__":
    unittest.main()

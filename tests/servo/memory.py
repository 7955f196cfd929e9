"""The registers of a servo: RAM, ROM and what a write does to them (chapters 3 and 4)."""

import csv
import os
import time
import typing

import shaft
from shaft import COMMANDS, NOT_ACTIVE, OUTPUT

SPEC = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "data", "spec")
NAMES = {"speed_torque_control": shaft.SPEED_TORQUE, "timeout_time": shaft.TIMEOUT,
         "timeout_action": shaft.TIMEOUT_ACTION}
WORDS = {"off": 0, "on": 1}
ROM_LOST = 1 << 15  # of 0x1A


class Register(typing.NamedTuple):
    access: str
    default: int
    least: int
    most: int
    saved: bool


def rows(name):
    with open(os.path.join(SPEC, name), encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


def registers_of(model):
    """By address: of the tables 3-1 to 3-11, and of table 3-12 what is the model's own."""
    series, variant, suffix = model.split("-")
    own = {row["address"]: row for row in rows("model_parameters.csv")
           if row["series"] == series and row["variant"] in ("*", variant)
           and row["suffix"] in ("*", suffix)}
    found = {}
    for row in rows("parameters.csv"):
        if row["access"] == "-":
            continue
        numbers = own.get(row["address"], row)
        found[int(row["address"], 16)] = Register(
            row["access"], *(int(numbers[key] or 0) for key in ("default", "min", "max")),
            row["persisted"] == "yes" and row["access"] == "RW")
    return found


def product(setup, registers):
    """What a unit has from its birth: 0x50 to 0x5C."""
    newest = 1500 if setup["model"].startswith("BLA34") else 1400
    return {0x50: registers[0x50].default, 0x51: setup["serial_number"], 0x52: newest,
            0x53: registers[0x53].default, 0x58: 2024, 0x59: 11, 0x5A: 30, 0x5B: 8, 0x5C: 5}


class Memory:
    def __init__(self, setup, now=time.time):
        self.registers = registers_of(setup["model"])
        self.out_of_range = setup.get("behaviour", {}).get("out_of_range", "refuse")
        self.has_pwm = setup["model"].endswith("AB")
        self._product = product(setup, self.registers)
        self.rom = {address: register.default for address, register in self.registers.items()
                    if register.saved}
        self.rom.update({0x45: setup.get("servo_id", 0), 0x46: setup["node_id"]})
        self.rom.update({NAMES[name]: WORDS.get(value, value)
                         for name, value in setup.get("rom", {}).items()})
        self.rom_is_lost = False
        self.shaft = shaft.Shaft(now)
        self._keeps_turning = setup.get("faults", {}).get("keeps_turning")
        self._once = {int(name, 16): value for name, value in setup.get("ram", {}).items()}
        self.load()

    def load(self):
        """As at power-on."""
        self.ram = {address: register.default for address, register in self.registers.items()
                    if register.access == "RW"}
        voltage = (self.registers[0x40].least + self.registers[0x41].most) // 2
        self.ram.update({0x0B: 25, 0x0C: voltage})
        self.ram.update(self._product)
        self.ram.update(self.rom)
        self.shaft.start()
        self.ram[0x00] = self.shaft.angle(self.ram)  # unproven (errata E10)
        self.look()
        self._started_without_rom = self.rom_is_lost

    def load_first(self):
        """As at the first power-on: with what somebody wrote and did not save ("ram")."""
        self.load()
        self.ram.update(self._once)
        self._once = {}

    def look(self):
        """0x08 to 0x0A are of this moment. To be called before anything that moves the shaft."""
        self.ram.update(self.shaft.look(self.ram))

    def save(self):
        self.rom = {address: self.ram[address] for address in self.rom}
        self.rom_is_lost = False

    def lose_rom(self):
        """The supply failed while it was written: at the next start initial values are loaded."""
        self.rom = {address: self.registers[address].default for address in self.rom}
        self.rom_is_lost = True

    def erase(self):
        self.look()
        for address, register in self.registers.items():
            if register.access == "RW":
                self.ram[address] = register.default

    def faults(self):
        """0x18 to 0x1B (4.12)."""
        ram = self.ram
        notice = (
            (ram[0x08] >= ram[0x38]) << 8 | (ram[0x08] <= ram[0x39]) << 9 |
            (ram[0x09] >= ram[0x3A]) << 10 | (ram[0x09] <= ram[0x3B]) << 11 |
            (ram[0x0A] >= ram[0x3C]) << 12 | (ram[0x0A] <= ram[0x3D]) << 13 |
            self.has_pwm << 20)
        warning = (
            (ram[0x0B] >= ram[0x3E]) << 8 | (ram[0x0B] <= ram[0x3F]) << 9 |
            (ram[0x0C] >= ram[0x40]) << 10 | (ram[0x0C] <= ram[0x41]) << 11 |
            (ROM_LOST if self._started_without_rom else 0))
        summary = sum(bool(bits >> group & 255) << group + level
                      for level, bits in enumerate((notice, warning, 0))
                      for group in (0, 8, 16, 24))
        return {0x18: summary, 0x19: notice, 0x1A: warning, 0x1B: 0}

    def read(self, address):
        """None: there is nothing to read."""
        register = self.registers.get(address)
        if register is None or "R" not in register.access:
            return None
        self.look()
        return {**self.ram, **self.faults()}[address]

    def write(self, address, value):
        """The value to answer; None: the failure of table 2-16."""
        register = self.registers.get(address)
        if register is None or register.access != "RW":
            return None
        if not register.least <= value <= register.most:
            if self.out_of_range == "fail":
                return None
            if self.out_of_range == "refuse":
                return self.ram[address]
            value = min(max(value, register.least), register.most)
        if address in (0x01, 0x02) and not self.ram[0x25]:
            return self.ram[address]
        if self._keeps_turning and address in COMMANDS[1:] and not value:
            return value  # and does not take it
        self.look()
        if address in (*COMMANDS, OUTPUT):
            self.shaft.command()
        if address in COMMANDS:
            self.ram.update({command: NOT_ACTIVE for command in COMMANDS})
        elif address == OUTPUT and self.ram[OUTPUT] and not value:
            self._stay()
        self.ram[address] = value
        return value

    def _stay(self):
        """Output comes back: what was commanded before is discarded (4.13)."""
        stays = {0x00: self.ram[0x08], 0x01: 0, 0x02: 0}
        self.ram.update({command: stays[command] for command in COMMANDS
                         if self.ram[command] != NOT_ACTIVE})

    @staticmethod
    def _named(values):
        return {f"0x{address:02X}": value for address, value in values.items()}

    def shown(self):
        """As the judge of the campaign wants them: RAM with all that can be read, and ROM."""
        self.look()
        return self._named({**self.ram, **self.faults()}), self._named(self.rom)

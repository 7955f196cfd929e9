#!/usr/bin/env python3
"""The commands of blactl-tuning(7) do what they say, and are taken back, on a simulated servo.

Usage: tuning_page_test.py SOURCE_DIRECTORY BLACTL.
"""

import json
import os
import pathlib
import re
import shlex
import subprocess
import sys
import tempfile

SERVO = {"model": "BLA21-12U-AB", "node_id": 11, "serial_number": 240900558}


def blocks(page):
    return [block.replace("\\\\\n", "").splitlines()
            for block in re.findall(r"^```\n(.*?)^```$", page, re.DOTALL | re.MULTILINE)]


class Bus:
    """A simulated servo that lives on between the commands."""

    def __init__(self, binary, folder):
        self.binary = binary
        self.environment = {"PATH": os.environ["PATH"], "LC_ALL": "C.UTF-8",
                            "XDG_RUNTIME_DIR": str(folder),
                            "BLACTL_STATE_DIR": str(folder / "state")}
        scenario = folder / "scenario.json"
        scenario.write_text(json.dumps({"schema": "blactl-scenario/1", "servos": [SERVO]}),
                            encoding="utf-8")
        self.simulator = subprocess.Popen([binary, "sim", str(scenario)], env=self.environment,
                                          stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
                                          text=True)
        while self.simulator.stdout.readline().strip() != "ready":
            pass

    def run(self, *arguments):
        return subprocess.run([self.binary, "-i", "sim:", *arguments], env=self.environment,
                              stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                              check=False)

    def settings(self):
        document = json.loads(self.run("get", "-n", "11", "--group", "config,control,pwm,limit",
                                       "--json").stdout)
        return {param["name"]: param["raw"] for param in document["nodes"][0]["params"]}

    def end(self):
        self.simulator.terminate()
        self.simulator.wait()


def judge(bus, commands):
    """What is wrong with a block: commands, the last of which takes them back."""
    faults = []
    before = bus.settings()
    for line in commands:
        done = bus.run(*shlex.split(line)[1:], "--yes")
        if done.returncode != 0 or "have no effect" in done.stderr:
            faults.append(f"{line}: exit status {done.returncode}\n{done.stderr}")
        if line == commands[-2] and bus.settings() == before:
            faults.append(f"{line}: changes nothing")
    if bus.settings() != before:
        faults.append(f"{commands[-1]}: not all is as before {commands[0]}")
    return faults


def main():
    source, binary = pathlib.Path(sys.argv[1]).resolve(), str(pathlib.Path(sys.argv[2]).resolve())
    page = (source / "man/blactl-tuning.7.scd").read_text(encoding="utf-8")
    models = json.loads(subprocess.run([binary, "models", "--json"], stdout=subprocess.PIPE,
                                       check=True).stdout)["models"]
    names = {entry["name"]: entry["address"][2:] for model in models
             for entry in model["parameters"]}
    faults = [f"{name} is not 0x{address}" for name, address in
              re.findall(r"\*([a-z_]+)\* \(0x([0-9A-F]{2})\)", page.replace("\\_", "_"))
              if names.get(name) != address]
    found = blocks(page)
    if len(found) < 5:
        faults.append(f"only {len(found)} blocks of commands")
    with tempfile.TemporaryDirectory() as folder:
        bus = Bus(binary, pathlib.Path(folder))
        try:
            for commands in found:
                faults += judge(bus, commands)
        finally:
            bus.end()
    for fault in faults:
        print(f"FAILED: {fault}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())

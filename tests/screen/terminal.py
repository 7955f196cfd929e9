"""A terminal of tmux in which blactl runs, on a simulated bus of its own."""

import json
import os
import shutil
import subprocess
import tempfile
import time

PATIENCE_S = 20
# A terminal that closes ends a process whose leaks are looked for at its end; that then waits for
# ever for a helper of its own.
NO_LEAK_CHECK = {"ASAN_OPTIONS": "detect_leaks=0"}


class Terminal:
    """A shell in a terminal of this size. Use as a context: in the end nothing is left of it."""

    def __init__(self, blactl, servos, width, height, events=()):
        self.blactl = os.path.abspath(blactl)
        self.folder = tempfile.TemporaryDirectory(prefix="blactl-screen-")
        self.socket = os.path.join(self.folder.name, "tmux")
        scenario = {"schema": "blactl-scenario/1", "clock": "real", "servos": servos,
                    "events": list(events)}
        path = os.path.join(self.folder.name, "scene.json")
        with open(path, "w", encoding="utf-8") as file:
            json.dump(scenario, file)
        self.environment = {**os.environ, **NO_LEAK_CHECK, "XDG_RUNTIME_DIR": self.folder.name,
                            "XDG_STATE_HOME": self.folder.name, "LANG": "C.UTF-8", "LC_ALL": "",
                            "PS1": "$ "}
        self.scenario = path
        self.start_simulator()
        self.tmux("-f", "/dev/null", "new-session", "-d", "-x", str(width), "-y", str(height),
                  "sh")

    def __enter__(self):
        return self

    def __exit__(self, *_):
        try:
            left = self.processes()
        except subprocess.CalledProcessError:  # the test has closed it
            left = []
        subprocess.run(["tmux", "-S", self.socket, "kill-server"], capture_output=True, check=False)
        self.stop_simulator()
        self.folder.cleanup()
        end = time.monotonic() + PATIENCE_S
        while any(os.path.exists(f"/proc/{pid}") for pid in left):
            if time.monotonic() > end:
                raise AssertionError(f"a process is left: {left}")
            time.sleep(0.1)

    def start_simulator(self):
        self.simulator = subprocess.Popen([self.blactl, "sim", self.scenario, "--json"],
                                          stdout=subprocess.PIPE, env=self.environment, text=True)
        self.simulator.stdout.readline()  # ready

    def stop_simulator(self):
        self.simulator.terminate()
        self.simulator.wait(PATIENCE_S)
        self.simulator.stdout.close()

    def tmux(self, *arguments):
        return subprocess.run(["tmux", "-S", self.socket, *arguments], capture_output=True,
                              text=True, check=True, env=self.environment).stdout

    def type(self, *keys):
        self.tmux("send-keys", *keys)

    def shell(self, line):
        """Types a line at the prompt: what is typed before it stands in front of it."""
        self.wait_for(lambda lines: "".join(lines).rstrip()[-1:] in ("$", "#"), "no prompt")
        self.type(line, "Enter")

    def run(self, *words):
        """Types a command of blactl."""
        self.shell(" ".join([self.blactl, "-i", "sim:", *words]))

    def lines(self):
        return self.tmux("capture-pane", "-p").split("\n")[:-1]

    def wait_for(self, holds, what):
        """The first screen for which `holds`."""
        end = time.monotonic() + PATIENCE_S
        while time.monotonic() < end:
            lines = self.lines()
            if holds(lines):
                return lines
            time.sleep(0.1)
        raise AssertionError(f"{what}, but the screen is\n" + "\n".join(self.lines()))

    def shows(self, text):
        return self.wait_for(lambda lines: any(text in line for line in lines), f"not shown: {text}")

    def shows_no_more(self, text):
        return self.wait_for(lambda lines: not any(text in line for line in lines),
                             f"still shown: {text}")

    def processes(self):
        """The process IDs of blactl in the terminal."""
        pane = self.tmux("display-message", "-p", "#{pane_pid}").strip()
        found = subprocess.run(["pgrep", "-P", pane], capture_output=True, text=True, check=False)
        return [int(pid) for pid in found.stdout.split()]


def run_tests(tests, blactl):
    """Exit status."""
    if not shutil.which("tmux"):
        print("skipped: tmux is missing")
        return 77
    for test in tests:
        test(blactl)
        print(f"{test.__name__}: ok", flush=True)
    return 0


def fleet(count):
    return [{"model": "BLA21-12U-AB", "node_id": 1 + i, "serial_number": 1 + i}
            for i in range(count)]

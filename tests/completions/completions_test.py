#!/usr/bin/env python3
"""Presses Tab in a real shell and looks at what it offers.

Usage: completions_test.py SHELL SOURCE_DIRECTORY. Exit status 77, with a word about it, where this
machine has no such shell.
"""

import fcntl
import os
import pathlib
import pty
import re
import select
import shutil
import struct
import subprocess
import sys
import tempfile
import termios
import time

SKIPPED = 77
PATIENCE = 60  # seconds: a busy machine is no failure

# What is typed, what must be offered, what must not.
OFFERS = [
    ("blactl ", ["scan", "get", "set", "restart", "models"], ["angle_limit_cw", "dump-cli"]),
    ("blactl get --", ["--group", "--changed", "--interface"], ["--dry-run", "--dump-cli"]),
    ("blactl set --", ["--dry-run", "--stagger", "--yes"], ["--group"]),
    ("blactl get angle_", ["angle_limit_cw", "angle_dead_band"], ["write_rom", "torque_output"]),
    ("blactl -i sim: -n 11 get angle_l", ["angle_limit_cw", "angle_limit_ccw"], ["angle_boost"]),
    ("blactl set t", ["torque_output", "timeout_action"], ["temperature"]),
    ("blactl set torque_output=", ["on", "off", "brake"], ["hold", "angle_limit"]),
    ("blactl get --group ", ["pwm", "limit", "production"], ["angle_limit_cw"]),
    ("blactl scan --color ", ["auto", "always", "never"], ["BLA21"]),
    ("blactl trace --kind message,re", ["request", "response"], ["stats"]),
    ("blactl models BLA21", ["BLA21-12U-AB", "BLA21-28U-A0"], ["BLA15"]),
    ("blactl models BLA21-12U-AB angle_l", ["angle_limit_cw", "angle_limit_ccw"], ["BLA34"]),
    ("blactl get -n model:BLA34", ["BLA34-12U-AB", "BLA34-28U-AB"], ["BLA15"]),
    ("blactl get -n ", ["all", "serial:", "model:"], ["angle_limit_cw"]),
    ("blactl -i ", ["sim:", "mcast:0", "replay:", "file:"], ["eth0", "scan"]),
    ("blactl pwm-config --mode ", ["angle", "speed"], ["preset"]),
    ("blactl alloc --forget ", ["absent", "all"], ["list"]),
    ("blactl trace --type NodeStatus,Get", ["GetNodeInfo", "GetSet"], ["esc.Status"]),
    ("blactl trace --type A", ["ArrayCommand", "Allocation"], ["GetSet"]),
    ("blactl apply wing.json --entry ", ["rudder", "aileron"], ["not", "blactl-fleet/1"]),
    ("blactl trace b", ["bus.log", "bench.json"], ["stats"]),
    ("blactl trace -i replay:b", ["bus.log", "bench.json"], ["stats"]),
    ("blactl get -i file:b", ["bus.log", "bench.json"], ["stats"]),
]

# What is typed, and what the command then gets after one Tab.
COMPLETED = [
    ("blactl sca", ["scan"]),
    ("blactl get torque_o", ["get", "torque_output"]),
    ("blactl get 0x38 rev", ["get", "0x38", "reverse"]),
    ("blactl set torque_output=of", ["set", "torque_output=off"]),
    ("blactl -jn 12 get --chan", ["-jn", "12", "get", "--changed"]),
    ("blactl get --group statu", ["get", "--group", "status"]),
    ("blactl -n 12,model:BLA34-12", ["-n", "12,model:BLA34-12U-AB"]),
    ("blactl alloc --forget abs", ["alloc", "--forget", "absent"]),
    ("blactl apply wing.json --entry le", ["apply", "wing.json", "--entry", "left aileron"]),
    ("blactl trace bus", ["trace", "bus.log"]),
    ("blactl -i replay:bus", ["-i", "replay:bus.log"]),
    ("blactl sim --clock=vir", ["sim", "--clock=virtual"]),
]

SETUP = {
    "bash": """
PS1='READY> '
bind 'set enable-bracketed-paste off'
bind 'set show-all-if-ambiguous on'; bind 'set completion-query-items 0'
bind 'set page-completions off'
source "$SOURCE/completions/blactl.bash"
""",
    "zsh": """
PS1='READY> '; bindkey -e; setopt nolistambiguous nobeep; unsetopt prompt_sp; LISTMAX=100000
fpath=("$SOURCE/completions" $fpath); autoload -Uz compinit; compinit -u -D
""",
}

COMMAND = {"bash": ["bash", "--norc", "--noprofile", "-i"], "zsh": ["zsh", "-f", "-i"]}


class Terminal:
    """A shell on a terminal large enough to list everything at once."""

    def __init__(self, shell, source, folder):
        self.marks = 0
        self.pid, self.descriptor = pty.fork()
        if self.pid == 0:
            os.chdir(folder)
            environment = {"PATH": os.environ["PATH"], "HOME": str(folder), "TERM": "xterm",
                           "LC_ALL": "C.UTF-8", "SOURCE": str(source)}
            os.execvpe(COMMAND[shell][0], COMMAND[shell], environment)
        fcntl.ioctl(self.descriptor, termios.TIOCSWINSZ, struct.pack("HHHH", 400, 200, 0, 0))
        (folder / "setup").write_text(
            SETUP[shell] + "blactl() { printf '[%s]' \"$@\"; echo; }\n", encoding="utf-8")
        self.ask(". ./setup\n")

    def ask(self, keys):
        """What the screen shows for these keys, up to a mark that is typed after them."""
        self.marks += 1
        # Control-U clears what a completion left on the line.
        self.send(f"{keys}\x15echo MARK''{self.marks}.\n")
        # With the prompt the shell takes keys again; before, the terminal would swallow some.
        return self.read_until(f"MARK{self.marks}\\.[^$]*READY> ")

    def send(self, keys):
        os.write(self.descriptor, keys.encode())

    def read_until(self, mark):
        screen = ""
        end = time.monotonic() + PATIENCE
        while not re.search(mark, screen):
            ready, _, _ = select.select([self.descriptor], [], [], end - time.monotonic())
            if not ready:
                raise SystemExit(f"no {mark} after {PATIENCE} s: {screen!r}")
            text = os.read(self.descriptor, 65536).decode(errors="replace")
            screen += re.sub(r"\x1b\[[0-9;?]*[A-Za-z]|\x1b[=>]|[\x00\x07\x08]", " ", text)
        return screen

    def close(self):
        os.close(self.descriptor)
        os.waitpid(self.pid, 0)


class Tester:
    def __init__(self):
        self.checks = 0
        self.failures = 0

    def check(self, fine, text):
        self.checks += 1
        if not fine:
            self.failures += 1
            print(f"FAILED: {text}")


def words_of(screen):
    return re.findall(r"[^\s\[\]]+", screen)


def offers(screen, word):
    """Whether a word stands there, alone or behind what it continues."""
    return any(each == word or each.endswith(("=" + word, ":" + word, "," + word)) or
               each == word + "=" for each in words_of(screen))


def test_terminal(shell, source, folder, tester):
    terminal = Terminal(shell, source, folder)
    for typed, present, absent in OFFERS:
        screen = terminal.ask(typed + "\t")
        screen = screen.replace("\r", "").replace(typed, " ", 1)
        for word in present:
            tester.check(offers(screen, word), f"{typed!r} does not offer {word}: {screen!r}")
        for word in absent:
            tester.check(not offers(screen, word), f"{typed!r} offers {word}: {screen!r}")
    for typed, arguments in COMPLETED:
        screen = terminal.ask(typed + "\t\n")
        wanted = "".join(f"[{argument}]" for argument in arguments)
        tester.check(wanted in screen, f"{typed!r} does not become {wanted}: {screen!r}")
    terminal.close()


def fish(source, folder, line, *arguments):
    done = subprocess.run(
        ["fish", "--no-config", "-c", f"source {source}/completions/blactl.fish; {line}",
         *arguments], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
        env={"PATH": os.environ["PATH"], "HOME": str(folder), "LC_ALL": "C.UTF-8"}, check=False)
    return done.stdout


def test_fish(source, folder, tester):
    def complete(typed):
        lines = fish(source, folder, "complete -C $argv[1]", typed).splitlines()
        return [line.split("\t")[0] for line in lines]

    for typed, present, absent in OFFERS:
        offered = complete(typed)
        for word in present:
            tester.check(any(offers(each, word) for each in offered),
                         f"{typed!r} does not offer {word}: {offered}")
        for word in absent:
            tester.check(not any(offers(each, word) for each in offered),
                         f"{typed!r} offers {word}: {offered}")
    for typed, arguments in COMPLETED:
        offered = complete(typed)
        tester.check(offered == [arguments[-1]],
                     f"{typed!r} does not become {arguments[-1]}: {offered}")


def test_interfaces(shell, source, folder, tester):
    """The interfaces of a machine that has two of type CAN and two serial adapters."""
    for name, kind in (("can0", 280), ("eth0", 1), ("slcan1", 280)):
        (folder / "net" / name).mkdir(parents=True)
        (folder / "net" / name / "type").write_text(f"{kind}\n", encoding="ascii")
    (folder / "by-id").mkdir()
    for name in ("usb-FTDI_1", "usb-FTDI_2"):
        (folder / "by-id" / name).touch()
    prefix = {"fish": "__blactl", "bash": "_blactl", "zsh": "_blactl"}[shell]
    call = f"{prefix}_can_interfaces {folder}/net; {prefix}_serial_adapters {folder}/by-id"
    if shell == "fish":
        printed = fish(source, folder, call)
    else:
        begin = {"bash": f". {source}/completions/blactl.bash",
                 "zsh": "autoload -Uz compinit; compinit -u -D; "
                        f". {source}/completions/_blactl"}[shell]
        flags = {"bash": ["--norc"], "zsh": ["-f"]}[shell]
        printed = subprocess.run([shell, *flags, "-c", f"{begin}; {call}"], text=True,
                                 stdout=subprocess.PIPE, check=False).stdout
    wanted = ["can0", "slcan1", f"slcan:{folder}/by-id/usb-FTDI_1",
              f"slcan:{folder}/by-id/usb-FTDI_2"]
    tester.check(printed.split() == wanted, f"interfaces: {printed!r}, not {wanted}")


def main():
    shell, source = sys.argv[1], pathlib.Path(sys.argv[2]).resolve()
    if shutil.which(shell) is None:
        print(f"SKIPPED: this machine has no {shell}: sudo apt-get install {shell}")
        return SKIPPED
    tester = Tester()
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name).resolve()
        for file in ("bus.log", "bench.json"):
            (folder / file).touch()
        (folder / "wing.json").write_text(
            '{"schema": "blactl-fleet/1", "servos": [{"name": "left aileron"},\n'
            ' {"name" : "rudder", "about": {"model": "not"}}]}', encoding="utf-8")
        if shell == "fish":
            test_fish(source, folder, tester)
        else:
            test_terminal(shell, source, folder, tester)
        test_interfaces(shell, source, folder, tester)
    print(f"{shell}: {tester.checks} checks, {tester.failures} failed")
    return 1 if tester.failures else 0


if __name__ == "__main__":
    sys.exit(main())

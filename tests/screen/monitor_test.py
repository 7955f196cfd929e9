"""blactl monitor on terminals of tmux: what a person sees.

  monitor_test.py BLACTL
"""

import os
import signal
import subprocess
import sys
import time

from terminal import Terminal, fleet, run_tests


def require(truth, what, lines=()):
    if not truth:
        raise AssertionError(what + "\n" + "\n".join(lines))


LOW_VOLTAGE = "Voltage lower limit"


def rows_of(lines):
    """The lines of servos."""
    return [line for line in lines if " BLA21-12U-AB" in line]


def sizes(blactl):
    for width, height in ((80, 24), (200, 50)):
        for count in (1, 12, 120):
            with Terminal(blactl, fleet(count), width, height) as terminal:
                terminal.run("monitor")
                shown = min(count, height - 3)
                lines = terminal.wait_for(
                    lambda lines, shown=shown: len(rows_of(lines)) == shown,
                    f"{width}x{height}, {count} servos: not {shown} rows")
                require(f"servos: {count}" in lines[0], "the title", lines)
                require("degC" in lines[1] and "STATE" in lines[1], "the header", lines)
                require("q quit" in lines[-1], "the keys", lines)
                require((f"of {count}" in lines[0]) == (count > shown), "which rows", lines)
                require(all(len(line) <= width for line in lines), "too wide", lines)
                terminal.type("q")
                terminal.shows_no_more("STATE")


def keys(blactl):
    with Terminal(blactl, fleet(40), 80, 24) as terminal:
        terminal.run("monitor")
        terminal.wait_for(lambda lines: len(rows_of(lines)) == 21, "no full table")
        terminal.type("End")
        terminal.wait_for(lambda lines: lines[-2].split()[:1] == ["40"], "End does not go there")
        terminal.type("Home", "?")
        terminal.shows("this help")
        terminal.type("Escape")
        terminal.type("s")
        terminal.shows("by state")
        terminal.type("p")
        terminal.shows("paused")
        terminal.type("p")
        terminal.shows_no_more("paused")
        terminal.type("Enter")
        lines = terminal.shows("last 60 s")
        require("NODE 1 " in lines[0], "graphs of another servo", lines)
        terminal.type("Escape")
        terminal.shows("STATE")


def resizing(blactl):
    with Terminal(blactl, fleet(12), 80, 24) as terminal:
        terminal.run("monitor")
        terminal.wait_for(lambda lines: len(rows_of(lines)) == 12, "no table")
        terminal.tmux("resize-window", "-x", "60", "-y", "10")
        lines = terminal.wait_for(lambda lines: len(rows_of(lines)) == 7, "not 7 rows")
        require("q quit" in lines[-1], "the keys", lines)
        terminal.tmux("resize-window", "-x", "120", "-y", "30")
        terminal.wait_for(lambda lines: len(rows_of(lines)) == 12, "not 12 rows again")


def what_happens(blactl):
    events = [{"at": "5s", "servo": 1, "happens": "power_off"},
              {"at": "11s", "servo": 1, "happens": "power_on"},
              {"at": "13s", "servo": 2, "world": {"voltage": "3.5V"}},
              {"at": "20s", "servo": 2, "world": {"voltage": "12V"}}]
    with Terminal(blactl, fleet(2), 100, 24, events) as terminal:
        terminal.run("monitor")
        terminal.wait_for(lambda lines: len(rows_of(lines)) == 2, "no table")
        terminal.shows("not heard for")
        terminal.shows_no_more("not heard for")
        terminal.shows("restarts: 1")
        terminal.shows(LOW_VOLTAGE)
        terminal.shows_no_more(LOW_VOLTAGE)


def coming_back(blactl):
    with Terminal(blactl, fleet(3), 100, 24) as terminal:
        terminal.run("monitor")
        terminal.wait_for(lambda lines: len(rows_of(lines)) == 3, "no table")
        terminal.stop_simulator()
        terminal.shows("interface gone: waiting")
        terminal.shows("not heard for 4 s")
        terminal.start_simulator()
        terminal.shows_no_more("interface gone")
        lines = terminal.shows_no_more("not heard for")
        require(len(rows_of(lines)) == 3, "other rows", lines)
        terminal.stop_simulator()
        terminal.shows("interface gone: waiting")
        terminal.type("q")
        terminal.shows("[interface]")
        terminal.start_simulator()


def identifying(blactl):
    events = [{"at": "8s", "servo": 40, "world": {"hand": "30deg"}},
              {"at": "10s", "servo": 2, "world": {"hand": "-30deg"}}]
    with Terminal(blactl, fleet(40), 100, 24, events) as terminal:
        terminal.run("monitor", "--identify")
        terminal.shows("Go on? [y/N]")
        terminal.type("y", "Enter")
        terminal.shows("turn a horn by hand")
        lines = terminal.shows("<< TURNED")  # which is beyond the screen, until it turns
        require(any(line.split()[:1] == ["40"] and "TURNED" in line for line in lines),
                "another row", lines)
        terminal.wait_for(
            lambda lines: any(line.split()[:1] == ["2"] and "TURNED" in line for line in lines),
            "the second one")
        terminal.type("q")
        terminal.shows("Hands off. Enter:")
        terminal.type("Enter")
        terminal.shows("torque is as it was before")
        terminal.run("get", "torque_output", "-n", "1,40", "--csv", "|", "grep", "-c", ",on,")
        terminal.wait_for(lambda lines: "2" in lines, "torque is not on")


def playing(blactl):
    with Terminal(blactl, fleet(2), 120, 24) as terminal:
        log = os.path.join(terminal.folder.name, "bus.log")
        terminal.run("monitor", "--duration", "8", "--record", log)
        terminal.wait_for(lambda lines: len(rows_of(lines)) == 2, "no table")
        terminal.shows_no_more("STATE")
        begin = time.monotonic()
        terminal.shell(f"{terminal.blactl} -i replay:{log} monitor")
        terminal.shows("log: 2 s")
        require(time.monotonic() - begin > 1, "too fast")
        terminal.type("p")
        lines = terminal.shows("paused")
        time.sleep(1.5)
        require(terminal.lines() == lines, "it goes on", terminal.lines())
        terminal.type("p", "+")
        terminal.shows("2 times faster")
        terminal.type("-", "-")
        terminal.shows("2 times slower")
        terminal.type("+", "+", "+")
        terminal.shows("4 times faster")
        lines = terminal.shows("end of the log")
        require(len(rows_of(lines)) == 2 and "12.0" in rows_of(lines)[0], "the last values", lines)
        terminal.type("Enter")
        terminal.shows("last 60 s")
        terminal.type("q")
        terminal.shows_no_more("last 60 s")


def ends(blactl):
    for end in ("TERM", "INT", "quit"):
        with Terminal(blactl, fleet(1), 80, 24) as terminal:
            terminal.shell("stty -a | cksum")
            before = terminal.wait_for(lambda lines: any(line[:1].isdigit() for line in lines),
                                       "no checksum")
            checksum = next(line for line in before if line[:1].isdigit())
            terminal.run("monitor")
            terminal.shows("STATE")
            if end == "quit":
                terminal.type("q")
            else:
                for pid in terminal.processes():
                    os.kill(pid, getattr(signal, f"SIG{end}"))
            terminal.shows_no_more("STATE")
            terminal.shell("clear; stty -a | cksum")
            terminal.shows(checksum)


def stopping(blactl):
    with Terminal(blactl, fleet(1), 80, 24) as terminal:
        terminal.shell("set -m")
        terminal.run("monitor")
        terminal.shows("STATE")
        terminal.type("C-z")
        terminal.shows_no_more("STATE")
        terminal.type("echo still $((1 + 1))", "Enter")
        terminal.shows("still 2")
        terminal.type("fg", "Enter")
        terminal.shows("STATE")
        terminal.type("q")
        terminal.shows_no_more("STATE")


def closed_terminal(blactl):
    with Terminal(blactl, fleet(2), 80, 24) as terminal:
        terminal.run("monitor", "--identify", "-y")
        terminal.shows("STATE")
        processes = terminal.processes()
        require(processes, "no process")
        terminal.tmux("kill-session")
        end = time.monotonic() + 20
        while time.monotonic() < end and any(os.path.exists(f"/proc/{pid}") for pid in processes):
            time.sleep(0.1)
        require(not any(os.path.exists(f"/proc/{pid}") for pid in processes), "a process is left")
        outputs = subprocess.run([blactl, "-i", "sim:", "get", "torque_output", "--csv"],
                                 capture_output=True, text=True, check=True,
                                 env=terminal.environment).stdout
        require(outputs.count(",on,") == 2, "torque did not come back", outputs.split("\n"))


def other_terminals(blactl):
    with Terminal(blactl, fleet(1), 100, 24) as terminal:
        terminal.shell("export TERM=dumb; clear")
        terminal.run("monitor", "--count", "2")
        terminal.shows("needs that: lines instead")
        terminal.shows("TIME           NODE")


TESTS = (sizes, keys, resizing, what_happens, coming_back, identifying, playing, ends,
         stopping, closed_terminal, other_terminals)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(run_tests(TESTS, sys.argv[1]))

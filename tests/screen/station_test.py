"""blactl provision on terminals of tmux: what an operator sees and types.

  station_test.py BLACTL
"""

import json
import os
import sys
import time

from terminal import Terminal, run_tests

SERVOS = [{"model": "BLA21-12U-AB", "serial_number": 101, "node_id": 5}]
RECIPE = {"schema": "blactl-recipe/1", "name": "aileron", "model": "BLA21-12U-AB",
          "set": {"servo_id": {"first": 1, "last": 8}, "angle_limit_cw": "45.0deg"}}


def require(truth, what, lines=()):
    if not truth:
        raise AssertionError(what + "\n" + "\n".join(lines))


def provision(terminal, *more):
    path = os.path.join(terminal.folder.name, "recipe.json")
    with open(path, "w", encoding="utf-8") as file:
        json.dump(RECIPE, file)
    terminal.run("provision", path, "-y", *more)


def verdicts(blactl):
    for width, height in ((80, 24), (53, 16)):
        with Terminal(blactl, SERVOS, width, height) as terminal:
            provision(terminal, "--station", "A")
            lines = terminal.shows("101")
            terminal.shows("TAKE IT OFF")
            lines = terminal.shows("pass 1")
            require("station A" in lines[0] and "aileron" in lines[0], "the title", lines)
            require("first pass 100.0%" in lines[1], "the totals", lines)
            require("外して下さい" in "".join(lines[2:7]), "what goes is told at the top", lines)
            terminal.type("C-c")
            terminal.shows_no_more("TAKE IT OFF")
            lines = terminal.shows("pass 1 fail 0 error 0 skip 0 first pass")  # they stay
            require("recipe aileron" not in "".join(lines), "the screen is still there", lines)


def places(blactl):
    """What has to come is told at the bottom, above the notes."""
    for width, height in ((80, 24), (53, 16)):
        with Terminal(blactl, [], width, height) as terminal:
            provision(terminal, "--station", "A")
            lines = terminal.shows("CONNECT A SERVO")
            require("CONNECT A SERVO" in "".join(lines[-6:]), "the place", lines)
            require("接続して下さい" in "".join(lines[-6:]), "no Japanese", lines)
            terminal.type("C-c")
            terminal.shows_no_more("CONNECT A SERVO")


def stopped(blactl):
    """Ctrl-C in the middle of the work: the present servo comes to its end, and that is a sign."""
    slow = [{**SERVOS[0], "faults": {"return_delay": "2500ms"}}]
    with Terminal(blactl, slow, 53, 16) as terminal:
        provision(terminal)
        terminal.shows("DO NOT TAKE IT OFF")
        time.sleep(1)  # it restarts by now
        terminal.type("C-c")
        terminal.wait_for(lambda _: "\x1b[33m" in terminal.tmux("capture-pane", "-e", "-p"),
                          "no sign")
        terminal.shows("DO NOT TAKE IT OFF")
        lines = terminal.shows("error 1 skip 0")
        text = "\n".join(lines)
        require("must come back: 101" in text, "nobody knows what is owed", lines)
        require("ERROR" in text, "the last result is not on the terminal", lines)


def labels(blactl):
    """Typed ones are shown, can be corrected, and end with Ctrl-D."""
    with Terminal(blactl, SERVOS, 80, 24) as terminal:
        provision(terminal, "--label", "-")
        terminal.shows("SCAN A LABEL")
        terminal.type("102")
        terminal.shows("label 102")
        terminal.type("BSpace", "1", "Enter")
        lines = terminal.shows("label 101")
        lines = terminal.shows("pass 1")
        terminal.type("hello", "Enter")  # while the one before is still there
        terminal.shows("X  hello")
        terminal.type("102", "Enter", "10")
        terminal.shows_no_more("hello")
        terminal.shows("label 10   +1")
        terminal.type("3", "Enter")
        terminal.shows("+2")
        require("fail 0" in lines[1], "the label was not corrected", lines)
        terminal.type("C-c")
        terminal.shows_no_more("TAKE IT OFF")
    with Terminal(blactl, SERVOS, 80, 24) as terminal:
        provision(terminal, "--label", "-", "; echo status $?")
        terminal.shows("SCAN A LABEL")
        terminal.type("C-d")
        terminal.shows("status 0")


def taken_off(blactl):
    """With labels the next thing to do on an empty bench is a scan; then a servo is to come."""
    off = [{"at": "12s", "servo": 101, "happens": "power_off"}]
    with Terminal(blactl, SERVOS, 53, 16, events=off) as terminal:
        provision(terminal, "--label", "-")
        terminal.shows("SCAN A LABEL")
        terminal.type("101", "Enter")
        terminal.shows("TAKE IT OFF")
        seen = []
        terminal.wait_for(lambda lines: seen.append("".join(lines)) or "SCAN" in seen[-1], "no scan")
        require(not any("CONNECT" in each for each in seen), "a servo was asked for before its label")
        require("101" in seen[-1], "the last result is gone", seen[-1:])
        terminal.type("102", "Enter")
        terminal.shows("CONNECT A SERVO")


TESTS = (verdicts, places, stopped, labels, taken_off)


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(run_tests(TESTS, sys.argv[1]))

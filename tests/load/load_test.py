"""A simulated bus at 100 % load in real time: nothing that was delivered is lost, and no word false.

  load_test.py BLACTL

What was delivered is told by a witness that shares no code with blactl. Only counts are compared,
so that the test holds on a busy machine too.
"""

import json
import os
import pty
import re
import signal
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor

from witness import Witness, counted

NOT_FOUND = 4  # of the contract's exit statuses
PATIENCE_S = 30
SECONDS = 4

# What a sample of these servos may say; null: not asked yet.
TRUTH = {"angle_deg": 0, "speed_rpm": 0, "torque_pct": 0, "temperature_c": 25, "voltage_v": 12,
         "mode": "operational", "health": "ok", "fault_summary": 1 << 16, "stale": False}


def require(truth, what):
    if not truth:
        raise AssertionError(what)


class Bus:
    """`blactl sim` with servos and a node that babbles. In the end nothing is left of it."""

    def __init__(self, blactl, load, priority, servos=8):
        self.blactl = os.path.abspath(blactl)
        self.folder = tempfile.TemporaryDirectory(prefix="blactl-load-")
        self.environment = {**os.environ, "XDG_RUNTIME_DIR": self.folder.name,
                            "XDG_STATE_HOME": self.folder.name, "LC_ALL": "C.UTF-8"}
        self.clients = []
        servos = [{"model": "BLA21-12U-AB", "node_id": i, "serial_number": i}
                  for i in range(1, servos + 1)]
        babbler = {"kind": "babbler", "node_id": 40, "load": load, "priority": priority}
        scenario = {"schema": "blactl-scenario/1", "servos": servos, "foreign": [babbler]}
        with open(self.path("scene.json"), "w", encoding="utf-8") as file:
            json.dump(scenario, file)
        with open(self.path("sim.err"), "w", encoding="utf-8") as errors:
            self.simulator = subprocess.Popen(
                [self.blactl, "sim", "--json", "--clock", "real", self.path("scene.json")],
                stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=errors,
                env=self.environment, text=True)
        self.simulator.stdout.readline()  # ready

    def __enter__(self):
        return self

    def __exit__(self, *_):
        for process in [*self.clients, self.simulator]:
            if process.poll() is None:
                process.kill()
                process.wait()
        self.simulator.stdin.close()
        self.simulator.stdout.close()
        self.folder.cleanup()

    def path(self, name):
        return os.path.join(self.folder.name, name)

    def text(self, name):
        with open(self.path(name), encoding="utf-8") as file:
            return file.read()

    def witness(self, fills=False):
        return Witness(os.path.join(self.folder.name, "blactl", "sim"), fills)

    def start(self, name, *words, terminal=None):
        """Its output goes to NAME.out and NAME.err, or both to `terminal`."""
        with open(self.path(name + ".out"), "w", encoding="utf-8") as out, \
                open(self.path(name + ".err"), "w", encoding="utf-8") as err:
            process = subprocess.Popen(
                [self.blactl, "-i", "sim:", *words], env=self.environment, stdin=terminal,
                stdout=out if terminal is None else terminal,
                stderr=err if terminal is None else terminal)
        self.clients.append(process)
        return process

    def lines(self, name):
        return [json.loads(line) for line in self.text(name + ".out").splitlines()]

    def wire(self):
        """What the simulator has counted, over all its time."""
        self.simulator.stdin.write("dump\n")
        self.simulator.stdin.flush()
        for line in self.simulator.stdout:
            event = json.loads(line)
            if event["event"] == "dumped":
                return event
        raise AssertionError("the simulator has ended")


def pause(process, seconds):
    process.send_signal(signal.SIGSTOP)
    time.sleep(seconds)
    process.send_signal(signal.SIGCONT)


def ends_well(process, what, status=0):
    require(process.wait(PATIENCE_S) == status, f"{what}: exit status {process.returncode}")


def read_all(terminal):
    seen = b""
    while True:
        try:
            seen += os.read(terminal, 1 << 16)
        except OSError:  # its other end is closed
            os.close(terminal)
            return seen


def log_of(text):
    """A candump log: the frames, and the seconds from the first to the last."""
    lines = [line.split() for line in text.splitlines()]
    times = [float(line[0].strip("()")) for line in lines]
    require(times == sorted(times), "the times of a log run backwards")
    return [line[2] for line in lines], times[-1] - times[0]


def require_piece(log, witnessed, name):
    """All that the witness heard between the first frame of the log and its last is in it."""
    first = next(i for i, frame in enumerate(log) if counted(frame) is not None)
    start = witnessed.index(log[first]) - first
    piece = witnessed[max(start, 0):start + len(log)]
    for i, (recorded, heard) in enumerate(zip(log, piece)):
        require(recorded == heard,
                f"{name}: frame {i} of {len(log)} is {recorded}, the witness heard {heard}")
    require(len(piece) == len(log), f"{name}: longer than what was on the bus")


def complete_transfers(log):
    """By the tail bytes: how many begin and end in the log."""
    begun, complete = set(), 0
    for frame in log:
        can_id, data = frame.split("#")
        tail = int(data[-2:], 16)
        if tail & 0x80:
            begun.add(can_id)
        if tail & 0x40 and can_id in begun:
            begun.remove(can_id)
            complete += 1
    return complete


def begun_before(log):
    """How many transfers had begun before the log: their start is missing."""
    tails = {}
    for frame in log:
        can_id, data = frame.split("#")
        tails.setdefault(can_id, int(data[-2:], 16))
    return sum(1 for tail in tails.values() if not tail & 0x80)


def require_truth(samples):
    for sample in samples:
        for key, value in TRUTH.items():
            require(sample[key] in (None, value), f"node {sample['node_id']}: {key} {sample[key]}")
        require(sample["serial_number"] in (None, sample["node_id"]), "another servo's number")


def full(blactl, pauses):
    """Servos, a babbler of 90 %, three clients that record, and a node that fills the rest.

    With `pauses` processes are not run for a while, as on a machine that is busy otherwise.
    """
    duration = ["--json", "--duration", str(SECONDS)]
    with Bus(blactl, load=0.9, priority=20) as bus:
        witness = bus.witness(fills=True)
        clients = {name: bus.start(name, *words, *duration, "--record", bus.path(name + ".log"))
                   for name, words in {"trace": ["trace"], "stats": ["trace", "--stats"],
                                       "monitor": ["monitor"]}.items()}
        if pauses:
            time.sleep(1)
            pause(bus.simulator, 0.5)
            pause(clients["stats"], 0.5)
            pause(clients["monitor"], 0.5)
            pause(clients["trace"], 0.5)
        for name, client in clients.items():
            ends_well(client, name)
        witness.stop()
        wire = bus.wire()
        witnessed = [frame for _, frame in witness.frames]
        require(witness.lost == 0, f"the witness lost {witness.lost} frames")
        numbers = [number for number in map(counted, witnessed) if number is not None]
        require(numbers == list(range(len(numbers))), "the witness missed frames of its own")
        require(wire["frames"] >= len(witnessed), "more was heard than was on the bus")
        logs = {}
        for name in clients:
            logs[name], span = log_of(bus.text(name + ".log"))
            require_piece(logs[name], witnessed, name)
            require(span > SECONDS - 0.2, f"{name}: its log ends after {span} s")
            require(bus.text(name + ".err") == "", f"{name} says: " + bus.text(name + ".err"))
        *shown, trace = bus.lines("trace")
        # The recording may hold one frame more, which came after the end.
        require(0 <= len(logs["trace"]) - trace["counts"]["frames"] <= 1, f"trace: {trace}")
        counts = trace["counts"]
        require(counts["lost"] == 0 and counts["errors"] <= begun_before(logs["trace"]),
                f"trace: {trace}")
        require(0 <= complete_transfers(logs["trace"]) - len(shown) <= 1, f"shown: {len(shown)}")
        require(trace["counts"]["transfers"] == len(shown), f"trace: {trace}")
        stats = json.loads(bus.text("stats.out"))
        ours = next(row for row in stats["types"] if row["source"] == 77)
        require((ours["lost"], ours["jumps"], ours["errors"]) == (0, 0, 0), f"stats: {ours}")
        counts = stats["counts"]
        require(counts["lost"] == 0 and counts["errors"] <= begun_before(logs["stats"]) and
                counts["errors"] == stats["errors_by_kind"]["missing_start"], f"stats: {stats}")
        *samples, monitor = bus.lines("monitor")
        require(monitor["counts"]["nodes"] == 8, f"monitor: {monitor}")
        require_truth(samples)
        print(f"full bus: {len(witnessed)} frames, load {wire['bus_load']}, "
              f"recorded {[len(log) for log in logs.values()]}, nothing lost")


def late(blactl):
    """Whoever reads late takes nothing for late or lost that only waited to be read.

    The bus is quiet: all that comes in the meantime is in the socket.
    """
    with Bus(blactl, load=0, priority=20, servos=4) as bus:
        lines = bus.start("lines", "trace", "--json", "--duration", str(SECONDS), "--record",
                          bus.path("lines.log"))
        master, slave = pty.openpty()
        screen = bus.start("screen", "trace", "--stats", "--duration", str(SECONDS), terminal=slave)
        os.close(slave)
        time.sleep(1)
        # An unfinished transfer times out after 2 s. The last pause goes beyond the end.
        for seconds in (2.3, 1.5):
            for client in lines, screen:
                client.send_signal(signal.SIGSTOP)
            time.sleep(seconds)
            for client in lines, screen:
                client.send_signal(signal.SIGCONT)
            time.sleep(0.2)
        seen = read_all(master)
        ends_well(lines, "trace")
        ends_well(screen, "trace --stats")
        counts = bus.lines("lines")[-1]["counts"]
        require(counts["errors"] == 0 and counts["lost"] == 0, f"late: {counts}")
        log, span = log_of(bus.text("lines.log"))
        require(SECONDS - 0.2 < span and len(log) - counts["frames"] <= 1, f"{counts} in {span} s")
        loads = re.findall(rb"load ([\d.]+|-) ?%?, busiest second ([\d.]+|-)", seen)
        require(loads, f"no load on the screen: {seen[-2000:]!r}")
        mean, most = loads[-1]
        require(b"-" not in (mean, most) and float(most) < 2 * float(mean),
                f"late: load {mean}, busiest second {most}")


def starved(blactl):
    """Where a node of the highest priority takes all of the bus, nobody knows anything of servos."""
    with Bus(blactl, load=1, priority=0) as bus:
        duration = ["--json", "--duration", "2"]
        clients = {"all": bus.start("all", "monitor", *duration),
                   "one": bus.start("one", "monitor", *duration, "-n", "3")}
        for name, client in clients.items():
            ends_well(client, name, NOT_FOUND)
            *samples, end = bus.lines(name)
            require(samples == [], f"{name}: {samples}")
            require([error["code"] for error in end["errors"]] == ["not_found"], f"{name}: {end}")
            require(end["counts"]["samples"] == 4, f"{name}: {end}")


def slow(blactl):
    """A simulator that did not run says that its bus is late."""
    with Bus(blactl, load=0.1, priority=20) as bus:
        pause(bus.simulator, 1.5)
        bus.wire()
        require("simulated bus is 1 s late" in bus.text("sim.err"), "the simulator says nothing")


def main():
    blactl = sys.argv[1]
    full(blactl, pauses=False)
    full(blactl, pauses=True)
    with ThreadPoolExecutor() as together:
        for test in [together.submit(test, blactl) for test in (late, starved, slow)]:
            test.result()


if __name__ == "__main__":
    main()

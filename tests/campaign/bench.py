"""Runs a simulator on the virtual clock and commands beside it, in a folder of their own."""

import json
import os
import queue
import subprocess
import threading
import time

import record

PATIENCE_S = 120  # of real time: beyond it a process hangs


class Hang(Exception):
    pass


class Simulator:
    """`blactl sim`, steered and questioned by its standard input and output."""

    interface = "sim:"

    def __init__(self, blactl, folder, scenario):
        self._blactl, self._folder = blactl, folder
        path = os.path.join(folder, "scenario.json")
        with open(path, "w", encoding="utf-8") as file:
            json.dump(scenario, file)
        self.process = subprocess.Popen(
            [blactl, "-q", "sim", "--json", path], text=True, env=environment(folder),
            stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.PIPE)
        self._lines = queue.Queue()
        self._reader = threading.Thread(target=self._read, daemon=True)
        self._reader.start()
        self._until("ready")

    def _read(self):
        for line in self.process.stdout:
            self._lines.put(json.loads(line))
        self._lines.put(None)

    def _until(self, event):
        """The events up to this one, which is left out."""
        events = []
        while True:
            try:
                line = self._lines.get(timeout=PATIENCE_S)
            except queue.Empty:
                raise Hang("the simulator says nothing") from None
            if line is None:
                raise RuntimeError("the simulator has ended: " + self.process.stderr.read())
            if line.get("event") == event:
                return events
            events.append(line)

    def order(self, text):
        self.process.stdin.write(text + "\n")
        self.process.stdin.flush()

    def hold(self, commands):
        """Time stands until so many commands are on the bus."""
        self.order(f"hold {commands}")

    def dump(self):
        """What has happened since the last dump, and the state of every servo by its serial."""
        self.order("dump")
        events = self._until("dumped")
        states = {line["serial_number"]: line for line in events if line["event"] == "state"}
        return [line for line in events if line["event"] != "state"], states

    def settle(self):
        """What was sent before a command broke off happens all the same: lets time pass."""
        self.hold(1)
        passing = start(self._blactl, self._folder, self.interface, ["scan", "--listen", "2"])
        passing.communicate(timeout=PATIENCE_S)
        self.hold(0)

    def end(self):
        self.process.terminate()
        status = self.process.wait(timeout=PATIENCE_S)
        self._reader.join(timeout=PATIENCE_S)
        for stream in (self.process.stdin, self.process.stdout, self.process.stderr):
            stream.close()
        if status != 143:
            raise RuntimeError(f"the simulator ended with {status}")


class Outcome:
    def __init__(self, command, status, out, err, heard):
        self.command, self.status, self.out, self.err = command, status, out, err
        self.record = heard

    @property
    def document(self):
        """The one that it printed, or the last line of a stream."""
        try:
            return json.loads(self.out)
        except ValueError:
            return json.loads((self.out.splitlines() or [""])[-1])

    def __str__(self):
        return f"$ {self.command}\nexit status {self.status}\n{brief(self.out)}\n{self.err}"


def brief(out):
    """A document on one line, a parameter of `get` as its address and number only."""
    try:
        document = json.loads(out)
    except ValueError:
        return out
    for node in document.get("nodes", []):
        if "params" in node:
            node["params"] = " ".join(f"{p['address']}={p['raw']}" for p in node["params"])
    return json.dumps(document)


def environment(folder):
    env = {key: value for key, value in os.environ.items() if not key.startswith("BLACTL_")}
    env.update(XDG_RUNTIME_DIR=folder, HOME=folder, XDG_STATE_HOME=folder, LC_ALL="C.UTF-8")
    return env


def start(blactl, folder, interface, words):
    """Files that the words name are in the folder."""
    return subprocess.Popen([os.path.abspath(blactl), "-i", interface, *words], text=True,
                            env=environment(folder), cwd=folder, stdin=subprocess.DEVNULL,
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE)


def run_at_once(blactl, folder, world, commands, options):
    """The outcomes of commands that begin at the same moment of the world's time."""
    world.hold(len(commands))
    logs = [os.path.join(folder, f"record{i}.log") for i in range(len(commands))]
    for log in logs:
        if os.path.exists(log):
            os.remove(log)
    for command in commands:
        if command.fleet:
            with open(os.path.join(folder, command.words[1]), "w", encoding="utf-8") as file:
                json.dump(command.fleet, file)
    running = [start(blactl, folder, world.interface,
                     [*options, *command.words, "--record", log])
               for command, log in zip(commands, logs)]
    outputs = [None] * len(running)

    def wait(index):
        if commands[index].killed_after_s:
            time.sleep(commands[index].killed_after_s)
            running[index].kill()
        outputs[index] = running[index].communicate(timeout=PATIENCE_S)
        world.hold(0)  # one that never came to the bus must not keep the others

    waiting = [threading.Thread(target=wait, args=(i,)) for i in range(len(running))]
    for thread in waiting:
        thread.start()
    for thread in waiting:
        thread.join()
    for process, output in zip(running, outputs):
        if output is None:
            for other in running:
                other.kill()
            raise Hang("a command hangs: " + " ".join(process.args))
    return [Outcome(command, process.returncode, *output, record.read(log))
            for command, process, output, log in zip(commands, running, outputs, logs)]

#!/usr/bin/env python3
"""A part of the campaign in real time, with servos that share nothing with blactl's simulator:

  tests/net/namespace.sh tests/servo/servo_test.py BLACTL [--runs N] [--seed S] [--jobs N]
  tests/net/namespace.sh tests/servo/servo_test.py BLACTL --cases [FILE...]

What one of the two is too kind to do, the other may. Without --cases: all of cases/, then random
episodes. Real time repeats nothing exactly: of a difference the whole episode is printed. The judge
is that of the campaign. Exit status 1 if there was a difference."""

import argparse
import collections
import concurrent.futures
import glob
import itertools
import json
import os
import sys
import threading

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "..", "campaign"))

import campaign  # pylint: disable=wrong-import-position
import scenario  # pylint: disable=wrong-import-position
import story  # pylint: disable=wrong-import-position
from world import World  # pylint: disable=wrong-import-position

MOST_STEPS = 3
LONGEST_RETURN = "1s"
SHORTEST_TIMEOUT_MS = 500  # a busy machine is late now and then


class RealEpisode(scenario.Episode):
    """What of an episode can be played on UDP, and in a short time."""

    statuses = None

    def __init__(self, seed):
        super().__init__(seed)
        self.scenario.pop("foreign", None)
        self.scenario["clock"] = "real"
        wire = self.scenario["wire"]
        self.scenario["wire"] = {key: wire[key] for key in ("loss", "duplication") if key in wire}
        self.scenario["events"] = [event for event in self.scenario["events"] if "servo" in event]
        for servo in self.scenario["servos"]:
            servo.pop("sending", None)
            if "return_delay" in servo.get("faults", {}):
                servo["faults"]["return_delay"] = LONGEST_RETURN
            if "rom" in servo:
                rom = servo["rom"]
                rom["timeout_time"] = max(rom["timeout_time"], SHORTEST_TIMEOUT_MS)
        self.steps = [[command._replace(killed_after_s=None) for command in step]
                      for step in self.steps[:MOST_STEPS]]

    def _let_ask(self, chance):
        pass  # to see that nobody asks takes long in real time

    def _let_start_unread(self, chance):
        pass  # it asks for a node ID then

    def must_succeed(self, _):
        return False  # a busy machine is in the way of real time


class Case(scenario.Frozen):
    """A scripted episode. "status": what its commands may end with, if that is certain. "sweep":
    the servo restarts after one of these answers, each in an episode of its own."""

    def __init__(self, path, number=None):
        with open(path, encoding="utf-8") as file:
            self._given = json.load(file)
        super().__init__(self._given)
        self.name, self.statuses = os.path.basename(path), self._given.get("status")
        if number is not None:
            self.name += f" {number}"
            faults = self.scenario["servos"][0].setdefault("faults", {})
            faults["restart_after_answer"] = [{"to": self._given["sweep"]["to"], "number": number}]

    def numbers(self):
        return self._given.get("sweep", {}).get("numbers", [None])


class OnMulticast(campaign.Campaign):
    """Episodes on one bus, one after the other."""

    def __init__(self, bus, *given):
        super().__init__(*given)
        self.bus, self.statuses = bus, None

    def open_world(self, folder, episode):
        return World(self.bus, episode.scenario)

    def episode(self, name, episode):
        self.name, self.statuses = name, episode.statuses
        found = self.differences
        try:
            self.play(episode, ["--json"], self.check)
        except campaign.FAULTS as fault:
            self.differ(fault)
        if self.differences > found:
            print(json.dumps({"scenario": episode.scenario, "steps": [
                [command._asdict() for command in step] for step in episode.steps]}), flush=True)

    def check(self, outcomes, step):
        super().check(outcomes, step)
        for outcome in outcomes:
            if self.statuses and outcome.status not in self.statuses:
                self.differ(story.Lie(f"exit status {outcome.status}, not one of {self.statuses}"),
                            outcome)


class Buses:
    """Several at once: in real time nearly all of it is waiting."""

    def __init__(self, given):
        defaults = campaign.defaults_of(given.blactl)
        self.all = [OnMulticast(bus, given.blactl, given.verbose, defaults)
                    for bus in range(given.jobs)]

    def play(self, works):
        """`works`: each is called with a bus that is free."""
        works, turn = iter(works), threading.Lock()
        def serve(bus):
            while True:
                with turn:
                    work = next(works, None)
                if work is None:
                    return
                work(bus)
        with concurrent.futures.ThreadPoolExecutor(len(self.all)) as pool:
            for done in [pool.submit(serve, bus) for bus in self.all]:
                done.result()

    @property
    def ends(self):
        return sum((bus.ends for bus in self.all), collections.Counter())

    @property
    def runs(self):
        return sum(bus.runs for bus in self.all)

    @property
    def differences(self):
        return sum(bus.differences for bus in self.all)


def cases(paths):
    """Of every file, and of every number of its sweep."""
    for path in paths or sorted(glob.glob(os.path.join(HERE, "cases", "*.json"))):
        for number in Case(path).numbers():
            case = Case(path, number)
            yield lambda bus, case=case: bus.episode(case.name, case)


def episodes(first, runs):
    for seed in itertools.count(first):
        if runs <= 0:
            return
        episode = RealEpisode(seed)
        runs -= sum(len(step) for step in episode.steps)
        yield lambda bus, episode=episode: bus.episode(f"episode {episode.seed}", episode)


def arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("blactl")
    parser.add_argument("--runs", type=int, default=40)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--jobs", type=int, default=12)
    parser.add_argument("--cases", nargs="*", metavar="FILE")
    parser.add_argument("-v", "--verbose", action="store_true")
    return parser.parse_args()


def main():
    if "BLACTL_NET_OF_ITS_OWN" not in os.environ:
        sys.exit("servo_test.py: start it with tests/net/namespace.sh")
    given = arguments()
    buses = Buses(given)
    random_runs = given.runs if given.cases is None else 0
    buses.play(itertools.chain(cases(given.cases), episodes(given.seed, random_runs)))
    print(f"{buses.runs} runs, differences: {buses.differences}; exit statuses with their errors:")
    for end, count in buses.ends.most_common():
        print(f"{count:7}  {end}")
    return 1 if buses.differences else 0


if __name__ == "__main__":
    sys.exit(main())

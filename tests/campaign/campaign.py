"""Seeded random runs of every command that writes, and of doctor, against everything that can go
wrong; afterwards the memory of the simulated servos, the exit status, JSON and text must tell the
same story.

  campaign.py BLACTL [--runs N] [--seed S] [--verbose]
  campaign.py BLACTL --frozen [FILE...]
  campaign.py BLACTL --same-as CAMPAIGN [--runs N] [--seed S]

A run is one command. Every difference is printed with the seed of its episode: `--seed S --runs 1`
repeats it. Exit status 1 if there was one.

With --same-as the episodes are those that CAMPAIGN plays in its own process, and judges by itself:
this is the second opinion, on the built binary. Episodes with another tool that writes are left to
that program, and so are the words of commands of which no judge here knows.

Episodes that have found a fault are kept in frozen/ as the generator of their day made them: from
the same seed a later one makes others.
"""

import argparse
import collections
import glob
import json
import os
import re
import subprocess
import sys
import tempfile

import alloc_story
import apply_story
import bench
import command_story
import doctor_story
import monitor_story
import scenario
import story
import truth
import unnamed_story


FROZEN = os.path.join(os.path.dirname(os.path.abspath(__file__)), "frozen")
FAULTS = (story.Lie, bench.Hang, RuntimeError, ValueError, KeyError)


def defaults_of(blactl):
    """The default of every saved register, by model and address."""
    models = json.loads(subprocess.run([blactl, "models", "--json"], check=True, text=True,
                                       capture_output=True).stdout)["models"]
    defaults = {}
    for model in models:
        one = json.loads(subprocess.run([blactl, "models", model["model"], "--json"], check=True,
                                        text=True, capture_output=True).stdout)["models"][0]
        defaults[one["model"]] = {p["address"]: p["default"] for p in one["parameters"]
                                  if p["saved"] and p["default"] is not None}
    return defaults


class Unknown:
    """The judge of commands that no judge knows."""

    @staticmethod
    def check(outcome, step, defaults, alone):
        pass


def is_known(outcome):
    words = outcome.command.words
    return words[0] not in ("export", "faults") and "--static" not in words


def judge_of(outcome):
    if not is_known(outcome):
        return Unknown
    judges = (alloc_story, apply_story, command_story, doctor_story, monitor_story)
    return next((judge for judge in judges if judge.is_meant(outcome)), story)


def codes_of(outcome):
    """The kinds of errors that stderr names."""
    return set(re.findall(r"^blactl: \[(\w+)\]", outcome.err, re.MULTILINE))


class Campaign:
    def __init__(self, blactl, verbose, defaults):
        self.blactl, self.verbose, self.defaults = blactl, verbose, defaults
        self.runs = 0
        self.ends = collections.Counter()
        self.differences, self.unhindered = 0, 0
        self.name = ""

    def episode(self, name, episode):
        self.name = name
        try:
            told = self.play(episode, ["--json"], self.check)
            if all(len(step) == 1 for step in episode.steps):
                self.compare(told, self.play(episode, [], None))
        except FAULTS as fault:
            self.differ(fault)

    def differ(self, fault, outcome=""):
        self.differences += 1
        print(f"{self.name}: {type(fault).__name__}: {fault}\n{outcome}", flush=True)

    def open_world(self, folder, episode):
        return bench.Simulator(self.blactl, folder, episode.scenario)

    def play(self, episode, options, check):
        """The outcomes of all steps, each checked if that is possible."""
        outcomes = []
        with tempfile.TemporaryDirectory(prefix="blactl-campaign-") as folder:
            world = self.open_world(folder, episode)
            try:
                before = begun(world.dump()[1])
                power_on = min(state["time"] for state in before.values())
                given, unsaved, earlier = {}, {}, []
                for index, commands in enumerate(episode.steps):
                    told = bench.run_at_once(self.blactl, folder, world, commands, options)
                    events, after = world.dump()
                    step = truth.Step(commands, before, events, after, episode.scenario, power_on,
                                      given, unsaved, earlier)
                    given = step.given
                    earlier = earlier + events
                    if check:
                        check(told, step)
                        self.check_use(told, episode.must_succeed(index))
                    unsaved = unnamed_story.unsaved_after(told, step)
                    outcomes += told
                    if any(outcome.status != 0 for outcome in told):
                        world.settle()
                    before = world.dump()[1]
            finally:
                world.end()
        return outcomes

    def check(self, outcomes, step):
        for outcome in outcomes:
            self.runs += 1
            self.ends[f"{outcome.status} {' '.join(sorted(codes_of(outcome)))}".strip()] += 1
            if self.verbose:
                print(outcome)
            try:
                is_alone = len(outcomes) == 1
                judge_of(outcome).check(outcome, step, self.defaults, is_alone)
                if is_alone and is_known(outcome) and outcome.status != story.KILLED:
                    unnamed_story.check(outcome, step)
            except FAULTS as fault:
                self.differ(fault, outcome)

    def check_use(self, outcomes, must_succeed):
        if must_succeed:
            self.unhindered += 1
            for outcome in outcomes:
                if outcome.status != 0:
                    self.differ(story.Lie("nothing was in its way"), outcome)

    @staticmethod
    def compare(with_json, with_text):
        """The same episode again as text: the same frames, so the same end."""
        for told, said in zip(with_json, with_text):
            document = told.document
            codes = re.findall(r"^blactl: \[(\w+)\]", said.err, re.MULTILINE)
            if told.status != said.status or codes != [e["code"] for e in document["errors"]]:
                raise story.Lie(f"JSON and text differ:\n{told}{said}")
            if apply_story.is_meant(told):
                continue  # its lines are counted at the end of its text
            saved = sum(1 for node in document.get("nodes", []) if node.get("saved") is True)
            for word, count in (("done", document["counts"].get("done", 0) + saved),
                                ("written", document["counts"].get("written", 0))):
                shown = len(re.findall(rf"^  {word}[:,]|  {word}$", said.out, re.MULTILINE))
                if shown != count:
                    raise story.Lie(f"{count} {word} in JSON, {shown} in text:\n{told}{said}")


def begun(states):
    """The states at power-on: nobody is on the bus yet, but will be under the ID in ROM."""
    return {serial: {**state, "node_id": state["rom"]["0x46"]} for serial, state in states.items()}


def arguments():
    parser = argparse.ArgumentParser()
    parser.add_argument("blactl")
    parser.add_argument("--runs", type=int, default=5000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--frozen", nargs="*", metavar="FILE")
    parser.add_argument("--same-as", metavar="CAMPAIGN")
    parser.add_argument("-v", "--verbose", action="store_true")
    return parser.parse_args()


def read(path):
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def play_frozen(campaign, files):
    for path in files or sorted(glob.glob(os.path.join(FROZEN, "*.json"))):
        campaign.episode(path, scenario.Frozen(read(path)))
    return "frozen episodes"


def play_same(campaign, program, first, runs):
    seed = first
    while campaign.runs < runs:
        printed = subprocess.run([program, "--frozen", "--seed", str(seed), "--episodes", "50"],
                                 check=True, text=True, capture_output=True)
        for line in printed.stdout.splitlines():
            episode = scenario.Frozen(json.loads(line))
            others = episode.scenario.get("foreign", [])
            if campaign.runs < runs and not any("orders" in other for other in others):
                campaign.episode(f"episode {seed} of {program}", episode)
            seed += 1
    return f"episodes {first} to {seed - 1} of {program}"


def play_random(campaign, first, runs):
    seed = first
    while campaign.runs < runs:
        campaign.episode(f"episode {seed}", scenario.Episode(seed))
        seed += 1
    return f"episodes {first} to {seed - 1}"


def main():
    given = arguments()
    campaign = Campaign(given.blactl, given.verbose, defaults_of(given.blactl))
    if given.frozen is not None:
        played = play_frozen(campaign, given.frozen)
    elif given.same_as:
        played = play_same(campaign, given.same_as, given.seed, given.runs)
    else:
        played = play_random(campaign, given.seed, given.runs)
    print(f"{campaign.runs} runs, {campaign.unhindered} of them unhindered, {played}, "
          f"differences: {campaign.differences}; exit statuses with their errors:")
    for end, count in campaign.ends.most_common():
        print(f"{count:7}  {end}")
    return 1 if campaign.differences else 0


if __name__ == "__main__":
    sys.exit(main())

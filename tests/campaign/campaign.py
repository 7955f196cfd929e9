"""Seeded random runs of every command that writes, against everything that can go wrong; afterwards
the memory of the simulated servos, the exit status, JSON and text must tell the same story.

  campaign.py BLACTL [--runs N] [--seed S] [--verbose]

A run is one command. Every difference is printed with the seed of its episode: `--seed S --runs 1`
repeats it. Exit status 1 if there was one.
"""

import argparse
import collections
import json
import re
import subprocess
import sys
import tempfile

import bench
import scenario
import story


PASS_TIME = scenario.Command(["scan", "--listen", "2"])


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


def codes_of(outcome):
    """The kinds of errors that stderr names."""
    return set(re.findall(r"^blactl: \[(\w+)\]", outcome.err, re.MULTILINE))


class Campaign:
    def __init__(self, blactl, verbose):
        self.blactl, self.verbose = blactl, verbose
        self.defaults = defaults_of(blactl)
        self.runs = 0
        self.ends = collections.Counter()
        self.differences = 0

    def episode(self, seed):
        episode = scenario.Episode(seed)
        try:
            told = self.play(episode, ["--json"], self.check)
            if all(len(step) == 1 for step in episode.steps):
                self.compare(told, self.play(episode, [], None))
        except (story.Lie, bench.Hang, RuntimeError, ValueError, KeyError) as difference:
            self.differences += 1
            print(f"episode {seed}: {type(difference).__name__}: {difference}")

    def play(self, episode, options, check):
        """The outcomes of all steps, each checked if that is possible."""
        outcomes = []
        with tempfile.TemporaryDirectory(prefix="blactl-campaign-") as folder:
            simulator = bench.Simulator(self.blactl, folder, episode.scenario)
            try:
                _, before = simulator.dump()
                for commands in episode.steps:
                    outcomes += bench.run_at_once(self.blactl, folder, simulator, commands, options)
                    if any(outcome.status != 0 for outcome in outcomes[-len(commands):]):
                        # What was sent before a command broke off happens all the same.
                        bench.run_at_once(self.blactl, folder, simulator, [PASS_TIME], options)
                    events, after = simulator.dump()
                    if check:
                        check(outcomes[-len(commands):], story.Step(before, events, after))
                    before = after
            finally:
                status = simulator.end()
        if status != 143:
            raise RuntimeError(f"the simulator ended with {status}")
        return outcomes

    def check(self, outcomes, step):
        for outcome in outcomes:
            self.runs += 1
            self.ends[f"{outcome.status} {' '.join(sorted(codes_of(outcome)))}".strip()] += 1
            if self.verbose:
                print(outcome)
            try:
                story.check(outcome, step, self.defaults, len(outcomes) == 1)
            except (story.Lie, ValueError, KeyError):
                print(outcome)
                raise

    @staticmethod
    def compare(with_json, with_text):
        """The same episode again as text: the same frames, so the same end."""
        for told, said in zip(with_json, with_text):
            document = json.loads(told.out)
            codes = re.findall(r"^blactl: \[(\w+)\]", said.err, re.MULTILINE)
            if told.status != said.status or codes != [e["code"] for e in document["errors"]]:
                raise story.Lie(f"JSON and text differ:\n{told}{said}")
            saved = sum(1 for node in document.get("nodes", []) if node.get("saved") is True)
            for word, count in (("done", document["counts"].get("done", 0) + saved),
                                ("written", document["counts"].get("written", 0))):
                shown = len(re.findall(rf"^  {word}[:,]|  {word}$", said.out, re.MULTILINE))
                if shown != count:
                    raise story.Lie(f"{count} {word} in JSON, {shown} in text:\n{told}{said}")


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("blactl")
    parser.add_argument("--runs", type=int, default=5000)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("-v", "--verbose", action="store_true")
    given = parser.parse_args()
    campaign = Campaign(given.blactl, given.verbose)
    seed = given.seed
    while campaign.runs < given.runs:
        campaign.episode(seed)
        seed += 1
    print(f"{campaign.runs} runs, episodes {given.seed} to {seed - 1}, "
          f"differences: {campaign.differences}; exit statuses with their errors:")
    for end, count in campaign.ends.most_common():
        print(f"{count:7}  {end}")
    return 1 if campaign.differences else 0


if __name__ == "__main__":
    sys.exit(main())

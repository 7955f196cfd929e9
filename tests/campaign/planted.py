#!/usr/bin/env python3
"""Bugs planted in a copy of the sources, each of which the campaign must find.

  planted.py --check
  planted.py FOLDER [NAME...] [--sweep N] [--episodes N] [--lines N] [--seed S] [--jobs N]
             [--list FILE] [--results FILE]

FOLDER gets the copy and its build. Every bug of planted.json is a place in the sources: what stands
there, which must be found just once, and what stands there instead while the bug is switched on: one
build holds them all. An entry without "instead" switches its statement off; one that a second check
would find out has that in "and": users meet the bug only without both. For each bug a few random
episodes are played, then every N-th single fault of each command, then the other episodes, until
something is found; for those that are found "by" lines, production lines are played, then every
N-th single fault of a calm one.
Exit status 1: a bug was not found. --check only looks whether each has its place in the sources.
"""

import argparse
import concurrent.futures
import json
import os
import pathlib
import re
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
FIRST_EPISODES = 300  # most bugs are found by them, in seconds
SWITCH = """#pragma once
#include <cstdlib>
#include <cstring>
/// Whether this bug is switched on.
inline bool planted(const char* name) {
  static const char* const on = std::getenv("PLANTED");
  return on != nullptr && std::strcmp(on, name) == 0;
}
"""


def fail(text):
    sys.exit(f"planted.py: {text}")


def planted(text, bug):
    """The source with the bug and its switch."""
    found = bug["found"]
    if text.count(found) != 1:
        fail(f"{bug['name']}: {text.count(found)} times in {bug['file']}: {found}")
    on = f"planted(\"{bug['name']}\")"
    if found.rstrip().endswith((";", "}")):
        instead = bug.get("instead", "")
        switched = f"if ({on}) {{ {instead} }} else {{ {found} }}"
    else:
        switched = f"({on} ? ({bug['instead']}) : ({found}))"
    return text.replace(found, switched)


def places(bugs):
    """Every place of every bug."""
    for bug in bugs:
        for place in [bug, *bug.get("and", [])]:
            yield {**place, "name": bug["name"]}


def make_sources(folder, bugs):
    """A copy of the tree; files that did not change keep their times, so that little is built."""
    listed = subprocess.run(["git", "-C", ROOT, "ls-files", "--cached", "--others",
                             "--exclude-standard"], capture_output=True, text=True, check=True)
    by_file = {}
    for place in places(bugs):
        by_file.setdefault(place["file"], []).append(place)
    for name in listed.stdout.splitlines():
        source, target = ROOT / name, folder / name
        if not source.is_file():
            continue
        content = source.read_bytes()
        if name in by_file:
            text = content.decode()
            for bug in by_file.pop(name):
                text = planted(text, bug)
            content = text.encode()
        if not target.exists() or target.read_bytes() != content:
            target.parent.mkdir(parents=True, exist_ok=True)
            target.write_bytes(content)
            target.chmod(source.stat().st_mode)
    if by_file:
        fail(f"no such files: {', '.join(by_file)}")
    switch = folder / "planted.hpp"
    if not switch.exists() or switch.read_text() != SWITCH:
        switch.write_text(SWITCH)


def build(folder):
    """One of several statements of a declaration cannot be switched: the compiler says so."""
    commands = (["cmake", "--preset", "ci", f"-DCMAKE_CXX_FLAGS=-include {folder}/planted.hpp",
                 "-DBLACTL_WERROR=OFF"],
                ["cmake", "--build", "--preset", "ci", "--target", "campaign"])
    for command in commands:
        ran = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False)
        if ran.returncode != 0:
            fail(ran.stdout[-8000:] + ran.stderr[-2000:])


def play(folder, bug, words):
    """(runs, what was found or None)"""
    ran = subprocess.run([folder / "build/ci/tests/campaign", "--until-found", *words],
                         capture_output=True, text=True, check=False,
                         env={**os.environ, "PLANTED": bug["name"]})
    runs = re.search(r"^(\d+) runs", ran.stdout, re.MULTILINE)
    what = re.search(r"^(?:(?:episode|line) \d+[^:]*|case [^:]*): (.*)", ran.stdout + ran.stderr, re.MULTILINE)
    found = what[1] if what else None
    if ran.returncode not in (0, 1):
        found = f"ended with {ran.returncode}" + (f": {found}" if found else "")
    return int(runs[1]) if runs else 0, found


def search(folder, bug, given):
    """(bug, runs until something was found, what or None, seconds)"""
    begin = time.monotonic()
    seed, each = ["--seed", str(given.seed)], ["--sweep", str(given.sweep)]
    if bug.get("by") == "lines":
        ways = [[*seed, "--lines", str(given.lines)], [*seed, "--lines", "2", *each]]
    else:
        ways = [[*seed, "--episodes", str(min(given.episodes, FIRST_EPISODES))], each,
                [*seed, "--episodes", str(given.episodes)]]
    runs, what = 0, None
    for words in ways:
        if what is None:
            more, what = play(folder, bug, words)
            runs += more
    return bug, runs, what, time.monotonic() - begin


def table(results):
    lines = ["| Planted bug | Found after | What was found |", "|---|---:|---|"]
    for bug, runs, what, _ in results:
        after = "**not found**" if what is None else f"{runs} runs"
        lines.append(f"| {bug['what']} | {after} | {(what or '').replace('|', '/')} |")
    return "\n".join(lines) + "\n"


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("folder", type=pathlib.Path, nargs="?")
    parser.add_argument("names", nargs="*")
    parser.add_argument("--episodes", type=int, default=10000)
    parser.add_argument("--lines", type=int, default=400)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--sweep", type=int, default=40)
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--list", type=pathlib.Path, default=HERE / "planted.json")
    parser.add_argument("--check", action="store_true")
    parser.add_argument("--results", type=pathlib.Path)
    given = parser.parse_args()
    bugs = json.loads(given.list.read_text())
    if given.check:
        for place in places(bugs):
            planted((ROOT / place["file"]).read_text(), place)
        return 0
    if given.folder is None:
        parser.error("no FOLDER")
    folder = given.folder.resolve()
    folder.mkdir(parents=True, exist_ok=True)
    make_sources(folder, bugs)
    build(folder)
    chosen = [bug for bug in bugs if not given.names or bug["name"] in given.names]
    with concurrent.futures.ThreadPoolExecutor(given.jobs) as pool:
        results = []
        for result in pool.map(lambda bug: search(folder, bug, given), chosen):
            results.append(result)
            bug, runs, what, seconds = result
            print(f"{bug['name']}: {what or 'NOT FOUND'} ({runs} runs, {seconds:.0f} s)", flush=True)
    if given.results:
        given.results.write_text(table(results))
    lost = [bug["name"] for bug, _, what, _ in results if what is None]
    print(f"{len(results) - len(lost)} of {len(results)} found")
    return 1 if lost else 0


if __name__ == "__main__":
    sys.exit(main())

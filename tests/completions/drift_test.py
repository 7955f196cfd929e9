#!/usr/bin/env python3
"""scripts/generate --check must see when completions or manual no longer fit the command table.

Usage: drift_test.py SOURCE_DIRECTORY BLACTL. Each change is made to a copy of the table.
"""

import copy
import json
import pathlib
import subprocess
import sys
import tempfile

COMPLETIONS = ["completions/blactl.bash", "completions/_blactl", "completions/blactl.fish"]
MANUAL = ["man/blactl.1.scd"]


def remove_option(cli):
    """get loses --changed."""
    get = next(command for command in cli["commands"] if command["name"] == "get")
    get["options"] = [option for option in get["options"] if option["name"] != "--changed"]


def add_option(cli):
    """scan gains --fast."""
    option = copy.deepcopy(cli["options"][-1])
    option.update(name="--fast", letter=None)
    cli["commands"][0]["options"].append(option)


def remove_shared_option(cli):
    """--while-driven goes."""
    cli["options"] = [each for each in cli["options"] if each["name"] != "--while-driven"]


def change_cross_check(cli):
    """A cross-check gets another reason."""
    cli["cross_checks"][0]["help_en"] = "another"


def change_words(cli):
    """--color learns a word."""
    next(each for each in cli["options"] if each["name"] == "--color")["words"].append("sometimes")


def change_help(cli):
    """The text of an option changes."""
    cli["options"][0]["help_en"] = "something else"


CHANGES = [
    (remove_option, COMPLETIONS + MANUAL),
    (add_option, COMPLETIONS + MANUAL),
    (remove_shared_option, COMPLETIONS + MANUAL),
    (change_words, COMPLETIONS + MANUAL),
    (change_cross_check, MANUAL),
    (change_help, ["completions/_blactl", "completions/blactl.fish"] + MANUAL),
]


def main():
    source, binary = pathlib.Path(sys.argv[1]), sys.argv[2]
    cli = json.loads(subprocess.run([binary, "--dump-cli"], stdout=subprocess.PIPE,
                                    check=True).stdout)
    failures = 0
    for change, stale in CHANGES:
        changed = copy.deepcopy(cli)
        change(changed)
        assert changed != cli, change.__doc__
        with tempfile.NamedTemporaryFile("w", suffix=".json", encoding="utf-8") as file:
            json.dump(changed, file)
            file.flush()
            done = subprocess.run([source / "scripts/generate", "--check", "--blactl", binary,
                                   "--cli", file.name], stdout=subprocess.PIPE, text=True,
                                  check=False)
        missing = [name for name in stale if name not in done.stdout]
        if done.returncode != 1 or missing:
            failures += 1
            print(f"FAILED: {change.__doc__} exit status {done.returncode}, "
                  f"not noticed: {missing}\n{done.stdout}")
    print(f"{len(CHANGES)} changes, {failures} failed")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())

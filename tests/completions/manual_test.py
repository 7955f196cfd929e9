#!/usr/bin/env python3
"""The pages render without a warning, and blactl(1) names every command and option.

Usage: manual_test.py SOURCE_DIRECTORY BLACTL. Exit status 77, with a word about it, where this
machine has no man.
"""

import json
import os
import pathlib
import shutil
import subprocess
import sys

SKIPPED = 77
SECTIONS = ["NAME", "SYNOPSIS", "DESCRIPTION", "OPTIONS", "COMMANDS", "VALUES", "EXIT STATUS",
            "ENVIRONMENT", "FILES", "SEE ALSO"]


def rendered(page, environment):
    """Its lines, and what is wrong with it."""
    done = subprocess.run(["man", "--warnings", "-P", "cat", page], stdout=subprocess.PIPE,
                          stderr=subprocess.PIPE, text=True, env=environment, check=False)
    faults = []
    if done.returncode != 0 or done.stderr:
        faults.append(f"man: exit status {done.returncode}, {done.stderr}")
    lines = done.stdout.splitlines()
    faults += [f"wider than 80 columns: {line}" for line in lines if len(line) > 80]
    return lines, faults


def main():
    source, binary = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2]
    if shutil.which("man") is None:
        print("SKIPPED: this machine has no man: sudo apt-get install man-db")
        return SKIPPED
    environment = {"PATH": os.environ["PATH"], "LC_ALL": "C.UTF-8", "MANWIDTH": "80",
                   "MAN_KEEP_FORMATTING": ""}
    lines, faults = rendered(source / "man/blactl.1", environment)
    page = "\n".join(lines)
    faults += [f"no section {name}" for name in SECTIONS if name not in lines]
    for other in ("blactl-fleet.5", "blactl-recipe.5", "blactl-tuning.7"):
        faults += rendered(source / "man" / other, environment)[1]
    cli = json.loads(subprocess.run([binary, "--dump-cli"], stdout=subprocess.PIPE,
                                    check=True).stdout)
    for command in cli["commands"]:
        heading = f"   blactl {command['name']}"
        if heading not in lines:
            faults.append(f"no section for {command['name']}")
            continue
        rest = lines[lines.index(heading) + 1:]
        ends = (i for i, line in enumerate(rest) if line and not line.startswith("     "))
        section = "\n".join(rest[:next(ends, len(rest))])
        examples = [line.split() for line in section.splitlines() if "blactl " in line]
        if not any(command["name"] in words for words in examples):
            faults.append(f"no example of {command['name']}")
        faults += [f"{command['name']}: no {option['name']}" for option in command["options"]
                   if option["name"] not in section]
    faults += [f"no {option['name']}" for option in cli["options"] if option["name"] not in page]
    for fault in faults:
        print(f"FAILED: {fault}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())

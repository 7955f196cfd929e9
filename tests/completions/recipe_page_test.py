#!/usr/bin/env python3
"""The examples of blactl-recipe(5) are what they show: their schema takes them, and two servos pass.

Usage: recipe_page_test.py SOURCE_DIRECTORY BLACTL. Exit status 77, with a word about it, where this
machine has no jsonschema.
"""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

SKIPPED = 77
EXPECTED = [[(0, 0), (0, 0)], [(1, 11), (2, 12)], [(0, 0), (0, 0)]]  # the IDs of two servos


def examples(page):
    blocks = re.findall(r"^```\n(.*?)^```$", page, re.DOTALL | re.MULTILINE)
    return [block for block in blocks if block.startswith("{")]


def scenario():
    servos = [{"model": "BLA21-12U-AB", "serial_number": serial} for serial in (101, 102)]
    events = [{"servo": 102, "happens": "power_off", "at": 0},
              {"servo": 101, "happens": "power_off", "at": "40s"},
              {"servo": 102, "happens": "power_on", "at": "50s"}]
    return {"schema": "blactl-scenario/1", "clock": "virtual", "servos": servos, "events": events}


def provision(binary, folder, text):
    (folder / "scenario.json").write_text(json.dumps(scenario()), encoding="utf-8")
    (folder / "recipe.json").write_text(text, encoding="utf-8")
    environment = {"PATH": os.environ["PATH"], "LC_ALL": "C.UTF-8",
                   "BLACTL_STATE_DIR": str(folder / "state")}
    done = subprocess.run([binary, "-i", f"sim:{folder}/scenario.json", "provision",
                           folder / "recipe.json", "--count", "2", "--yes", "--json"],
                          stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          env=environment, check=False)
    return done, [json.loads(line) for line in done.stdout.splitlines()][:-1]


def main():
    source, binary = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2]
    try:
        import jsonschema
    except ImportError:
        print("SKIPPED: this machine has no jsonschema: sudo apt-get install python3-jsonschema")
        return SKIPPED
    schema = json.loads((source / "schemas/recipe.schema.json").read_text(encoding="utf-8"))
    page = (source / "man/blactl-recipe.5.scd").read_text(encoding="utf-8")
    found = examples(page)
    faults = [] if len(found) == len(EXPECTED) else [f"{len(found)} examples"]
    for number, (text, expected) in enumerate(zip(found, EXPECTED), 1):
        try:
            jsonschema.validate(json.loads(text), schema)
        except jsonschema.ValidationError as error:
            faults.append(f"example {number}: {error.message}")
        with tempfile.TemporaryDirectory() as folder:
            done, records = provision(binary, pathlib.Path(folder), text)
        ids = [(record["servo_id"], record["static_node_id"]) for record in records]
        verdicts = {record["verdict"] for record in records}
        if done.returncode != 0 or ids != expected or verdicts != {"pass"}:
            faults.append(f"example {number}: exit status {done.returncode}, {ids}\n{done.stderr}")
    keys = [*schema["properties"], *schema["$defs"]["counter"]["properties"]]
    told = page.replace("\\_", "_")
    faults += [f"no word about {key}" for key in keys if f"*{key}*" not in told]
    for fault in faults:
        print(f"FAILED: {fault}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""The examples of blactl-fleet(5) are what they show: their schema takes them, and so does apply.

Usage: fleet_page_test.py SOURCE_DIRECTORY BLACTL. Exit status 77, with a word about it, where this
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
SERVOS = [{"model": "BLA21-12U-AB", "node_id": 11, "serial_number": 240900558,
           "unique_id": "88ace781674b4cac255e706b7426bd30"},
          {"model": "BLA21-12U-AB", "node_id": 12, "serial_number": 240900559}]
MEANT = [2, 2, 1]  # the servos of each example


def examples(page):
    blocks = re.findall(r"^```\n(.*?)^```$", page, re.DOTALL | re.MULTILINE)
    return [block for block in blocks if block.startswith("{")]


def apply(binary, folder, text):
    scenario = folder / "scenario.json"
    scenario.write_text(json.dumps({"schema": "blactl-scenario/1", "clock": "virtual",
                                    "servos": SERVOS}), encoding="utf-8")
    environment = {"PATH": os.environ["PATH"], "LC_ALL": "C.UTF-8",
                   "BLACTL_STATE_DIR": str(folder / "state")}
    return subprocess.run([binary, "-i", f"sim:{scenario}", "apply", "-", "--yes", "--json"],
                          input=text, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
                          env=environment, check=False)


def main():
    source, binary = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2]
    try:
        import jsonschema
    except ImportError:
        print("SKIPPED: this machine has no jsonschema: sudo apt-get install python3-jsonschema")
        return SKIPPED
    schema = (source / "schemas/fleet.schema.json").read_text(encoding="utf-8")
    page = (source / "man/blactl-fleet.5.scd").read_text(encoding="utf-8")
    faults = []
    found = examples(page)
    if len(found) != len(MEANT):
        faults.append(f"{len(found)} examples instead of {len(MEANT)}")
    for number, (text, meant) in enumerate(zip(found, MEANT), 1):
        try:
            jsonschema.validate(json.loads(text), json.loads(schema))
        except jsonschema.ValidationError as error:
            faults.append(f"example {number}: {error.message}")
        with tempfile.TemporaryDirectory() as folder:
            done = apply(binary, pathlib.Path(folder), text)
        changed = [node for node in json.loads(done.stdout)["nodes"]
                   if node["status"] == "changed" and node["verified_after_restart"]]
        if done.returncode != 0 or len(changed) != meant:
            faults.append(f"example {number}: exit status {done.returncode}, {len(changed)} servos "
                          f"changed\n{done.stderr}")
    keys = set(re.findall(r"^ *\"([a-z$_]+)\": \{", schema, re.MULTILINE))
    told = set(re.findall(r"\*([a-z$_]+)\*", page.replace("\\_", "_")))
    structure = {"properties", "additionalProperties", "propertyNames", "entry", "id", "$defs"}
    faults += [f"no word about {key}" for key in sorted(keys - structure - told)]
    for fault in faults:
        print(f"FAILED: {fault}")
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Validates profiles/*.json with profiles/profile.schema.json, and the schema with bad profiles.

Usage: schema_test.py PROFILES_DIRECTORY. Without python3-jsonschema it fails: a check that did not
run must not look like one that passed.
"""

import copy
import json
import pathlib
import sys

try:
    import jsonschema
except ImportError:
    sys.exit("schema_test.py needs jsonschema: sudo apt-get install python3-jsonschema")


def load(path):
    return json.loads(path.read_text(encoding="utf-8"))


def change(profile, place, value):
    """The profile with one member set, or removed by None."""
    changed = copy.deepcopy(profile)
    *way, last = place
    target = changed
    for key in way:
        target = target[key]
    if value is None:
        del target[last]
    else:
        target[last] = value
    return changed


# What the schema must refuse: file, place, value.
BAD = [
    ("BLA.json", ["schema"], "blactl-profile/2"),
    ("BLA.json", ["family"], "OTHER"),
    ("BLA.json", ["fault_bits"], None),
    ("BLA.json", ["extra"], 1),
    ("BLA.json", ["parameters", "0x60"], {}),
    ("BLA.json", ["parameters", "0x00", "name"], "Command Angle"),
    ("BLA.json", ["parameters", "0x00", "name_ja"], ""),
    ("BLA.json", ["parameters", "0x00", "unit"], "rad"),
    ("BLA.json", ["parameters", "0x00", "width"], None),
    ("BLA.json", ["parameters", "0x00", "max"], None),
    ("BLA.json", ["parameters", "0x00", "max"], 1.5),
    ("BLA.json", ["parameters", "0x01", "default"], 0),
    ("BLA.json", ["parameters", "0x20", "choices", 0, "word"], "On"),
    ("BLA.json", ["fault_bits", 0, "bit"], 32),
    ("BLA.json", ["fault_bits", 0, "action_en"], None),
    ("BLA.json", ["firmware", 0, "shipments", 0, "from"], "2021-13"),
    ("BLA21.json", ["model_number"], 256),
    ("BLA21.json", ["parameters", "0x53"], {"default": 6010}),
    ("BLA21.json", ["parameters", "0x2C", "max"], None),
    ("BLA21.json", ["voltage_classes", "12-U"], {}),
    ("BLA21.json", ["suffixes", "A0", "pwm"], "no"),
    ("BLA21.json", ["models", 0, "hardware_version"], None),
]


def main(directory):
    schema = load(directory / "profile.schema.json")
    validator_class = jsonschema.validators.validator_for(schema)
    validator_class.check_schema(schema)
    validator = validator_class(schema)
    profiles = {path.name: load(path) for path in sorted(directory.glob("BLA*.json"))}
    faults = []
    if sorted(profiles) != ["BLA.json", "BLA15.json", "BLA21.json", "BLA34.json"]:
        faults.append(f"unexpected files: {', '.join(profiles)}")
    for name, profile in profiles.items():
        for error in validator.iter_errors(profile):
            faults.append(f"{name}: {error.json_path}: {error.message}")
    for name, place, value in BAD:
        if validator.is_valid(change(profiles[name], place, value)):
            faults.append(f"{name}: {place} = {value!r} should be refused")
    for fault in faults:
        print(fault, file=sys.stderr)
    print(f"{len(profiles)} profiles valid, {len(BAD)} bad ones refused" if not faults else "failed")
    return 1 if faults else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main(pathlib.Path(sys.argv[1])))

#!/usr/bin/env python3
"""Validates the files that come with blactl with their schemas, and the schemas with bad files.

Usage: schema_test.py SOURCE_DIRECTORY BLACTL. Profiles are checked with their schema alone; of
scenarios and facts the schema and the reader in the binary BLACTL must say the same. Without
python3-jsonschema it fails: a check that did not run must not look like one that passed.
"""

import copy
import json
import os
import pathlib
import subprocess
import sys
import tempfile

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


OWN_REGISTER = {"name": "own", "group": "option", "name_en": "Own", "name_ja": "独自", "access": "RW",
                "width": "uint8", "default": 1, "min": 0, "max": 9, "saved": True}

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
    ("BLA21.json", ["parameters", "0x47"], {"name": "half_described", "saved": True}),
    ("BLA21.json", ["suffixes", "A0", "parameters", "0x47"], OWN_REGISTER),
]
GOOD = [("BLA21.json", ["parameters", "0x47"], OWN_REGISTER)]



# What schema and reader must both take, and what both must refuse: place, value. The document
# around it is the one of EXAMPLES that has everything.
FULL = "rough_bench.json"
SERVO = ["servos", 0]
BEHAVIOUR = [*SERVO, "behaviour"]
WORLD = ["events", 0, "world"]


def foreign(kind, **more):
    return [{"kind": kind, "node_id": 40, **more}]


GOOD_SCENARIOS = [
    (["$schema"], "anything"),
    (["clock"], None),
    (["clock"], "real"),
    (["seed"], 0),
    (["foreign"], []),
    ([*SERVO, "node_id"], 0),
    ([*SERVO, "servo_id"], 254),
    ([*SERVO, "answer_delay"], 500),
    ([*SERVO, "answer_delay"], "500"),
    ([*SERVO, "answer_delay"], "10s"),
    ([*SERVO, "rom"], {"ANGLE-LIMIT-CW": "90.0deg", "0x2A": 50}),
    ([*BEHAVIOUR, "rom_write_time"], "0ms"),
    ([*SERVO, "faults", "return_delay"], "600s"),
    ([*SERVO, "sending", "late_answers"], 1),
    (["wire", "burst_interval"], 3600000000),
    (["foreign"], foreign("node")),
    (["foreign"], foreign("node", armed=True, commands={"servo_ids": [255]})),
    (["foreign"], foreign("gnss", rate=12.5)),
    (["foreign"], foreign("gnss", armed=False, serves_get_set=True, name="x")),
    (["foreign"], foreign("esc", index=31, rate=1000, unique_id="00" * 16)),
    (["foreign"], foreign("autopilot", allocates=True)),
    (["foreign"], foreign("autopilot", commands={"servo_ids": [1], "value": -1.5, "rate": 400})),
    (["foreign"], foreign("babbler", priority=0, load=1)),
    (["foreign"], foreign("babbler")),
    (["events", 0, "at"], None),
    (["events", 0, "world"], {}),
    ([*WORLD, "hand"], "free"),
    ([*WORLD, "hand"], "-45.5deg"),
    ([*WORLD, "pulse"], "none"),
    ([*WORLD, "pulse"], 1520),
    ([*WORLD, "temperature"], "-20degC"),
    ([*WORLD, "voltage"], "55raw"),
    (["events", 1, "clients"], "bus_off"),
    (["events", 0, "happens"], "power_off"),
    (["events", 4, "happens"], "ram_error"),
    ([*SERVO, "model"], "BLA21-12U-AB2"),
    ([*SERVO, "firmware_version"], 1010),
    ([*BEHAVIOUR, "out_of_range"], "fail"),
    ([*BEHAVIOUR, "first_node_status"], 1000000),
    ([*BEHAVIOUR, "answer_delay"], "10s"),
    ([*BEHAVIOUR, "boot_time"], "0ms"),
    ([*SERVO, "faults", "restart_after_answer"], [{"to": "restart", "number": 4294967295}]),
    ([*SERVO, "faults", "restart_after_answer"], []),
]

BAD_SCENARIOS = [
    (["schema"], "blactl-scenario/2"),
    (["schema"], None),
    (["extra"], 1),
    (["clock"], "fast"),
    (["seed"], -1),
    (["servos"], {}),
    ([*SERVO, "model"], None),
    ([*SERVO, "model"], ""),
    ([*SERVO, "colour"], "red"),
    ([*SERVO, "node_id"], 128),
    ([*SERVO, "node_id"], "11"),
    ([*SERVO, "servo_id"], 255),
    ([*SERVO, "serial_number"], 4294967296),
    ([*SERVO, "firmware_version"], 1.4),
    ([*SERVO, "unique_id"], "0011"),
    ([*SERVO, "name"], ""),
    ([*SERVO, "name"], "x" * 81),
    ([*SERVO, "answer_delay"], "2min"),
    ([*SERVO, "answer_delay"], "-1ms"),
    ([*SERVO, "answer_delay"], 10000001),
    ([*SERVO, "answer_delay"], True),
    ([*SERVO, "rom"], {"angle_limit_cw": None}),
    ([*SERVO, "rom"], {"angle limit": 1}),
    ([*BEHAVIOUR, "out_of_range"], "wrap"),
    ([*BEHAVIOUR, "reserved_reads"], "one"),
    ([*BEHAVIOUR, "failures_latch"], 1),
    ([*BEHAVIOUR, "rom_write_time"], "1h"),
    ([*BEHAVIOUR, "mood"], "good"),
    ([*SERVO, "faults", "mute"], "yes"),
    ([*SERVO, "faults", "lose_responses"], -1),
    ([*SERVO, "faults", "return_delay"], 600000001),
    ([*SERVO, "sending", "jitter"], -1),
    ([*SERVO, "sending", "double_answers"], 1.1),
    (["wire", "loss"], -0.1),
    (["wire", "noise"], 1),
    (["foreign"], [{"kind": "node"}]),
    (["foreign"], [{"node_id": 1}]),
    (["foreign"], foreign("radio")),
    (["foreign"], [{"kind": "node", "node_id": 0}]),
    (["foreign"], foreign("node", rate=5)),
    (["foreign"], foreign("node", load=0.5)),
    (["foreign"], foreign("gnss", rate=51)),
    (["foreign"], foreign("gnss", index=1)),
    (["foreign"], foreign("esc", index=32)),
    (["foreign"], foreign("esc", rate=0)),
    (["foreign"], foreign("esc", allocates=True)),
    (["foreign"], foreign("autopilot", allocates=1)),
    (["foreign"], foreign("autopilot", priority=1)),
    (["foreign"], foreign("babbler", priority=32)),
    (["foreign"], foreign("babbler", load=1.5)),
    (["foreign"], foreign("babbler", rate=5)),
    (["foreign"], foreign("node", commands={"servo_ids": []})),
    (["foreign"], foreign("node", commands={"servo_ids": [1] * 16})),
    (["foreign"], foreign("node", commands={"servo_ids": [256]})),
    (["foreign"], foreign("node", commands={"servo_ids": [1], "value": 1e5})),
    (["foreign"], foreign("node", commands={"servo_ids": [1], "mode": 1})),
    (["events", 0, "world"], None),
    (["events", 0, "servo"], None),
    (["events", 0, "servo"], 0),
    (["events", 0, "clients"], "cut"),
    (["events", 1, "clients"], None),
    (["events", 1, "clients"], "gone"),
    (["events", 1, "at"], "soon"),
    (["events", 1, "happens"], "power_off"),
    (["events", 4, "happens"], None),
    (["events", 4, "happens"], "fire"),
    (["events", 4, "servo"], None),
    ([*BEHAVIOUR, "first_node_status"], 1000001),
    ([*BEHAVIOUR, "start_angle"], 0),
    ([*BEHAVIOUR, "beyond_unitless"], "wrap"),
    ([*SERVO, "faults", "restart_after_answer"], {"to": "any"}),
    ([*SERVO, "faults", "restart_after_answer"], [{"to": "save"}]),
    ([*SERVO, "faults", "restart_after_answer"], [{"number": 0}]),
    ([*SERVO, "faults", "restart_after_answer"], [{"nth": 1}]),
    ([*SERVO, "faults", "no_node_status"], 1),
    ([*WORLD, "voltage"], "5"),
    ([*WORLD, "voltage"], 5),
    ([*WORLD, "load"], "1.5%"),
    ([*WORLD, "temperature"], 201),
    ([*WORLD, "hand"], 45),
    ([*WORLD, "magnet"], "off"),
    ([*WORLD, "stuck"], True),
    ([*WORLD, "weather"], "fine"),
]

GOOD_FACTS = [
    (["behaviour"], {}),
    (["behaviour", "slow_speed"], "turns_slowest"),
    (["$schema"], None),
]

BAD_FACTS = [
    (["schema"], "blactl-scenario/1"),
    (["behaviour"], None),
    (["behaviour", "out_of_range"], "wrap"),
    (["behaviour", "rom_write_time"], 10000001),
    (["servos"], []),
]


ENTRY = ["entries", 0]

GOOD_ALLOCATIONS = [
    (["$schema"], None),
    (["entries"], []),
    ([*ENTRY, "time"], None),
    ([*ENTRY, "node_id"], 1),
]

BAD_ALLOCATIONS = [
    (["schema"], "blactl-facts/1"),
    (["entries"], None),
    (["entries"], {}),
    (["range"], "1-125"),
    ([*ENTRY, "unique_id"], None),
    ([*ENTRY, "unique_id"], "00"),
    ([*ENTRY, "unique_id"], "uid:00112233445566778899aabbccddee"),
    ([*ENTRY, "node_id"], None),
    ([*ENTRY, "node_id"], 0),
    ([*ENTRY, "node_id"], 126),
    ([*ENTRY, "node_id"], "21"),
    ([*ENTRY, "time"], 5),
    ([*ENTRY, "name"], "x"),
]


def validator_of(directory, name):
    """For schemas that refer to each other by their file names."""
    schemas = {path.name: load(path) for path in directory.glob("*.schema.json")}
    schema = schemas[name]
    validator_class = jsonschema.validators.validator_for(schema)
    validator_class.check_schema(schema)
    resolver = jsonschema.RefResolver("", schema, store=schemas)
    return validator_class(schema, resolver=resolver)


def check_profiles(directory, faults):
    validator = validator_of(directory, "profile.schema.json")
    profiles = {path.name: load(path) for path in sorted(directory.glob("BLA*.json"))}
    if sorted(profiles) != ["BLA.json", "BLA15.json", "BLA21.json", "BLA34.json"]:
        faults.append(f"unexpected files: {', '.join(profiles)}")
    for name, profile in profiles.items():
        for error in validator.iter_errors(profile):
            faults.append(f"{name}: {error.json_path}: {error.message}")
    for right, cases in ((False, BAD), (True, GOOD)):
        for name, place, value in cases:
            if validator.is_valid(change(profiles[name], place, value)) != right:
                faults.append(f"{name}: {place} = {value!r} should be {'taken' if right else 'refused'}")
    return f"{len(profiles)} profiles valid, {len(BAD)} bad ones refused"


GOOD_FLEETS = [
    (["common"], None), (["servos"], []), ([*SERVO, "about"], None), ([*SERVO, "set"], None),
    ([*SERVO, "set", "angle_limit_cw"], "900raw"), ([*SERVO, "set", "0x39"], -450),
    ([*SERVO, "name"], "links"),
]
BAD_FLEETS = [
    (["schema"], "blactl-fleet/2"), (["servos"], None), (["servos"], {}), (["extra"], 1),
    (["common"], []), ([*SERVO, "name"], None), ([*SERVO, "name"], ""), ([*SERVO, "name"], 5),
    ([*SERVO, "match"], None), ([*SERVO, "match"], {}), ([*SERVO, "match", "serial_number"], "1"),
    ([*SERVO, "match", "serial_number"], -1), ([*SERVO, "match", "node_id"], 0),
    ([*SERVO, "match", "node_id"], 128), ([*SERVO, "match", "servo_id"], 256),
    ([*SERVO, "match", "unique_id"], "12"), ([*SERVO, "match", "colour"], "red"),
    ([*SERVO, "set"], []), ([*SERVO, "set", "smoothing"], True), ([*SERVO, "set", "0x60"], 1),
    ([*SERVO, "about", "firmware_version"], "1.400"), ([*SERVO, "about", "weight"], 1),
    ([*SERVO, "extra"], 1),
]


def read(blactl, folder, document, *arguments):
    """What the binary says of a document: "" if it takes it. No simulator runs for that: a log,
    which takes no frames, is refused after the file was read."""
    errors = errors_of([blactl, "-i", "replay:none", "--json", "sim", *arguments], folder, document)
    bad = [error["message"] for error in errors if error["code"] == "bad_file"]
    if not bad and [error["code"] for error in errors] != ["usage"]:
        raise RuntimeError(f"unexpected: {errors}")
    return "".join(bad)


def read_allocations(blactl, folder, document, *arguments):
    """The same of an allocation table, each for an empty one."""
    with tempfile.TemporaryDirectory(dir=folder) as state:
        errors = errors_of([blactl, "--json", "alloc", *arguments], state, document)
    if any(error["code"] != "bad_file" for error in errors):
        raise RuntimeError(f"unexpected: {errors}")
    return "".join(error["message"] for error in errors)


def read_fleet(blactl, folder, document):
    """The same of a fleet file, which is compared with an empty one."""
    empty = pathlib.Path(folder) / "empty.json"
    empty.write_text('{"schema": "blactl-fleet/1", "servos": []}', encoding="utf-8")
    errors = errors_of([blactl, "--json", "diff", str(empty)], folder, document)
    if any(error["code"] != "bad_file" for error in errors):
        raise RuntimeError(f"unexpected: {errors}")
    return "".join(error["message"] for error in errors)


def exported(blactl, folder, *form):
    """What `export` writes of one servo of each model, one file for all and one for each."""
    models = json.loads(subprocess.run([blactl, "models", "--json"], capture_output=True, text=True,
                                       check=True).stdout)["models"]
    servos = [{"model": model["model"], "node_id": index, "servo_id": index}
              for index, model in enumerate(models, 1)]
    scenario = pathlib.Path(folder) / "scenario.json"
    scenario.write_text(json.dumps({"schema": "blactl-scenario/1", "clock": "virtual",
                                    "servos": servos}), encoding="utf-8")
    documents = {}
    for node in [*(() if form else ("all",)), *range(1, len(models) + 1)]:
        done = subprocess.run([blactl, "-i", f"sim:{scenario}", "export", "-n", str(node), *form],
                              capture_output=True, text=True, timeout=60, check=True,
                              env={**os.environ, "XDG_RUNTIME_DIR": str(folder),
                                   "BLACTL_STATE_DIR": str(folder)})
        documents[f"export -n {node}"] = json.loads(done.stdout)
    told = ([document["model"] for document in documents.values()] if form else
            [servo["about"]["model"] for servo in documents["export -n all"]["servos"]])
    if sorted(told) != sorted(model["model"] for model in models):
        raise RuntimeError("export leaves models out")
    return documents


def check_exported(source, blactl, faults):
    """The strict schema and the reader take what export writes."""
    validator = validator_of(source / "schemas", "fleet.schema.json")
    with tempfile.TemporaryDirectory() as folder:
        documents = [(name, document, True) for name, document in exported(blactl, folder).items()]
    return check_read_files("exported files", validator, documents,
                            lambda folder, document: read_fleet(blactl, folder, document), faults)


def check_recipes(source, blactl, faults):
    """The schema takes the examples, and what export writes for a line."""
    validator = validator_of(source / "schemas", "recipe.schema.json")
    recipes = {path.name: load(path) for path in (source / "tests/data/recipes").glob("*.json")}
    with tempfile.TemporaryDirectory() as folder:
        recipes |= exported(blactl, folder, "--recipe")
    faults += [f"recipes: the schema refuses {name}: {error.json_path}: {error.message}"
               for name, recipe in recipes.items() for error in validator.iter_errors(recipe)]
    return f"{len(recipes)} recipes taken by the schema"


def errors_of(words, folder, document):
    file = pathlib.Path(folder) / "document.json"
    file.write_text(json.dumps(document), encoding="utf-8")
    done = subprocess.run([*words, str(file)], capture_output=True, text=True, timeout=60,
                          check=False, env={**os.environ, "XDG_RUNTIME_DIR": str(folder),
                                            "BLACTL_STATE_DIR": str(folder)})
    is_stream = done.stdout.startswith('{"')
    return json.loads(done.stdout.splitlines()[-1] if is_stream else done.stdout)["errors"]


def check_read_files(kind, validator, documents, read_with, faults):
    """`documents`: (name, document, whether it is right); `read_with`: of folder and document."""
    with tempfile.TemporaryDirectory() as folder:
        for name, document, right in documents:
            told = [f"{error.json_path}: {error.message}" for error in
                    validator.iter_errors(document)]
            if bool(told) == right:
                faults.append(f"{kind}: the schema {'refuses' if right else 'takes'} {name}: {told}")
            told = read_with(folder, document)
            if bool(told) == right:
                faults.append(f"{kind}: the reader {'refuses' if right else 'takes'} {name}: {told}")
    right = sum(1 for document in documents if document[2])
    return f"{right} {kind} taken, {len(documents) - right} refused, by schema and reader"


def documents_of(examples, full, good, bad):
    documents = [(name, document, True) for name, document in examples.items()]
    for places, right in ((good, True), (bad, False)):
        for place, value in places:
            documents.append((f"{place} = {value!r}", change(examples[full], place, value), right))
    return documents


def main(source, blactl):
    faults = []
    said = [check_profiles(source / "profiles", faults)]
    data = source / "tests" / "data"
    for kind, schema, full, good, bad, reader, arguments in (
            ("scenarios", "scenario", FULL, GOOD_SCENARIOS, BAD_SCENARIOS, read, []),
            ("facts", "facts", "bench.json", GOOD_FACTS, BAD_FACTS, read, ["--facts"]),
            ("allocations", "allocations", "table.json", GOOD_ALLOCATIONS, BAD_ALLOCATIONS,
             read_allocations, ["--import"]),
            ("fleets", "fleet", "wing.json", GOOD_FLEETS, BAD_FLEETS, read_fleet, [])):
        examples = {path.name: load(path) for path in sorted((data / kind).glob("*.json"))}

        def read_with(folder, document, reader=reader, arguments=arguments):
            return reader(blactl, folder, document, *arguments)

        said.append(check_read_files(kind, validator_of(source / "schemas", f"{schema}.schema.json"),
                                     documents_of(examples, full, good, bad), read_with, faults))
    said.append(check_exported(source, blactl, faults))
    said.append(check_recipes(source, blactl, faults))
    for fault in faults:
        print(fault, file=sys.stderr)
    print("; ".join(said) if not faults else "failed")
    return 1 if faults else 0


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    sys.exit(main(pathlib.Path(sys.argv[1]), sys.argv[2]))

#!/usr/bin/env python3
"""Which conditions of the decisions about changes no test shows to matter by itself (MC/DC).

  mcdc.py FOLDER [--sweep N] [--list FILE]

FOLDER gets a build with clang 19 that counts conditions (-fcoverage-mcdc). The unit tests of src/fleet
and every N-th single fault of the sweep run together. Each condition of FILES that never
decided the outcome by itself is printed, unless mcdc.json explains it. Exit status 1: there is one without an explanation,
or an explanation without a condition."""

import argparse
import json
import os
import pathlib
import signal
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
LLVM = pathlib.Path("/usr/lib/llvm-19/bin")
SOURCES = ROOT / "src/fleet/change"
FILES = ("plan", "guard", "change", "change_job", "change_readings", "change_verdict", "write_job",
         "write_job_restarts", "carry_out_change")


def hear_signals():
    """What runs in the background of a shell would ignore the signals that tests send."""
    for one in (signal.SIGHUP, signal.SIGINT):
        signal.signal(one, signal.SIG_DFL)


def run(*words, **more):
    ran = subprocess.run(words, check=False, text=True, capture_output=True,
                         preexec_fn=hear_signals, **more)
    if ran.returncode != 0:
        sys.exit(f"mcdc.py: {' '.join(map(str, words[:3]))}: {ran.stdout[-3000:]}{ran.stderr[-3000:]}")
    return ran.stdout


def build(folder):
    counts = "-O1 -g0 -fprofile-instr-generate -fcoverage-mapping -fcoverage-mcdc"
    run("cmake", "-S", ROOT, "-B", folder, "-G", "Ninja", "-DCMAKE_CXX_COMPILER=clang++-19",
        "-DCMAKE_BUILD_TYPE=Debug", f"-DCMAKE_CXX_FLAGS_DEBUG={counts}", "-DBLACTL_UNITY=ON")
    run("cmake", "--build", folder, "--target", "unit-fleet", "campaign")


def coverage(folder, sweep):
    """The export of llvm-cov: a record for each decision, with each of its conditions."""
    programs = [folder / "tests/unit-fleet", folder / "tests/campaign"]
    profiles = [folder / f"{program.name}.profraw" for program in programs]
    for program, profile, words in zip(programs, profiles, ([], ["--sweep", str(sweep)])):
        run(program, *words, env={**os.environ, "LLVM_PROFILE_FILE": str(profile)})
    run(LLVM / "llvm-profdata", "merge", "-o", folder / "all.profdata", *profiles)
    told = run(LLVM / "llvm-cov", "export", programs[0], "-object", programs[1],
               "-instr-profile", folder / "all.profdata", "-skip-functions",
               "-sources", *(SOURCES / f"{name}.cpp" for name in FILES))
    return json.loads(told)["data"][0]["files"]


def text_of(lines, region):
    """A region of a source, in one line."""
    first, begin, last, end = region
    taken = lines[first - 1:last]
    taken[-1] = taken[-1][:end - 1]
    taken[0] = taken[0][begin - 1:]
    return " ".join(" ".join(taken).split())


def conditions(file, lines):
    """Of each decision: (line, text of the decision, text of the condition, whether it decided)."""
    branches = sorted({tuple(branch[:4]) for branch in file["branches"]})
    for record in file["mcdc_records"]:
        begin, end, decided = tuple(record[:2]), tuple(record[2:4]), record[-1]
        inside = [each for each in branches if each[:2] >= begin and each[2:] <= end]
        texts = [text_of(lines, each) for each in inside]
        if len(texts) != len(decided):  # one of them has decisions of its own inside
            texts = [f"number {i + 1}" for i in range(len(decided))]
        for text, has_decided in zip(texts, decided):
            yield record[0], text_of(lines, record[:4]), text, has_decided


def main():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--sweep", type=int, default=60)
    parser.add_argument("--list", type=pathlib.Path, default=HERE / "mcdc.json")
    given = parser.parse_args()
    folder = given.folder.resolve()
    build(folder)
    explained = {(each["file"], each["decision"], each["condition"]): each["why"]
                 for each in json.loads(given.list.read_text())}
    counted, open_ones = 0, []
    for file in coverage(folder, given.sweep):
        name = pathlib.Path(file["filename"]).name
        lines = (SOURCES / name).read_text().splitlines()
        for line, decision, condition, has_decided in conditions(file, lines):
            counted += 1
            is_explained = explained.pop((name, decision, condition), None) is not None
            if not has_decided and not is_explained:
                open_ones.append(f"{name}:{line}: {condition}\n    in {decision}")
    print("\n".join(open_ones))
    for name, _, condition in explained:
        print(f"{name}: explained, and not there: {condition}")
    print(f"{counted} conditions, {len(open_ones)} without a test that they decide")
    return 1 if open_ones or explained else 0


if __name__ == "__main__":
    sys.exit(main())

#!/usr/bin/env python3
"""Defects are planted in a small source tree, and scripts/tidy must find each of them.

Usage: tidy_test.py ROOT. Exit status 77: clang-tidy or git is not installed; the test did not run.
"""

import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

SOURCES = {
    "src/base/bare.cpp": "namespace base {\n\nint bare(int a) {\n  if (a > 1)\n    return 2;\n"
                         "  return a;\n}\n\n} // namespace base\n",
    "src/base/freed.cpp": "#include <stdlib.h>\n\nnamespace base {\n\nint freed() {\n"
                          "  int* p = static_cast<int*>(malloc(sizeof(int)));\n"
                          "  if (p == nullptr) {\n    return 0;\n  }\n  *p = 1;\n  free(p);\n"
                          "  return *p;\n}\n\n} // namespace base\n",
    "src/base/null.cpp": "namespace base {\n\nint null(int a) {\n  int* p = nullptr;\n"
                         "  if (a > 3) {\n    p = &a;\n  }\n  return *p;\n}\n\n} // namespace base\n",
    # Another file of the folder has a use for the same name.
    "src/base/unused.cpp": '#include "base/names.hpp"\n\nnamespace base {\n\nusing names::Name;\n\n'
                           "int unused() {\n  return 1;\n}\n\n} // namespace base\n",
    "src/base/used.cpp": '#include "base/names.hpp"\n\nnamespace base {\n\nusing names::Name;\n\n'
                         "Name used() {\n  return {};\n}\n\n} // namespace base\n",
    "src/base/names.hpp": "#pragma once\n\nnamespace names {\n\nstruct Name {\n  int* p = 0;\n};\n\n"
                          "} // namespace names\n",
    "src/base/twice.cpp": '#include "base/names.hpp"\n#include "base/names.hpp"\n\n'
                          "namespace base {\n\nint twice() {\n  return 2;\n}\n\n} // namespace base\n",
}
# As clang-tidy tells them: the place, the check.
NOT_OF_THE_ANALYZER = [
    ("src/base/bare.cpp:4:", "readability-braces-around-statements"),
    ("src/base/names.hpp:6:", "modernize-use-nullptr"),
    ("src/base/twice.cpp:2:", "readability-duplicate-include"),
]
OF_THE_ANALYZER = [
    ("src/base/freed.cpp:12:", "clang-analyzer-unix.Malloc"),
    ("src/base/null.cpp:8:", "clang-analyzer-core.NullDereference"),
    ("src/base/unused.cpp:5:", "misc-unused-using-decls"),
]
SAME_NAME = "namespace {FOLDER} {{\nnamespace {{\n\nconstexpr int same = {NUMBER};\n\n}}\n" \
            "\nint get_{NUMBER}() {{\n  return same;\n}}\n\n}} // namespace {FOLDER}\n"


class Tree:
    """A source tree with the script and the checks of this one."""

    def __init__(self, origin, folder, sources):
        self.origin = origin
        self.root = pathlib.Path(folder).resolve()
        shutil.copy(origin / ".clang-tidy", self.root)
        (self.root / ".gitignore").write_text("/build/\n")
        for name, text in sources.items():
            self.write(name, text)

    def write(self, name, text):
        file = self.root / name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)

    def git(self, *arguments):
        subprocess.run(["git", "-C", str(self.root), "-c", "user.name=T", "-c", "user.email=t@t",
                        *arguments], check=True, capture_output=True)

    def tidy(self, *arguments):
        """(exit status, what was printed, the findings (place, check) in it)"""
        commands = [{"directory": str(self.root), "file": str(file),
                     "command": f"clang++ -std=c++20 -I{self.root}/src -o x.o -c {file}"}
                    for file in (self.root / "src").rglob("*.cpp")]
        self.write("build/tidy/compile_commands.json", json.dumps(commands))
        ran = subprocess.run([str(self.origin / "scripts/tidy"), "--root", str(self.root),
                              *arguments], capture_output=True, text=True, check=False)
        lines = re.findall(rf"^{re.escape(str(self.root))}/(\S+?:\d+:)\d+: error: .*\[([^],]+)",
                           ran.stdout, re.MULTILINE)
        return ran.returncode, ran.stdout + ran.stderr, sorted(lines)


def expect(ran, status, findings, *said):
    got_status, output, got = ran
    problems = [f"it did not say: {text}" for text in said if text not in output]
    if (got_status, got) != (status, sorted(findings)):
        problems.append(f"expected {status} {sorted(findings)}, got {got_status} {got}")
    if problems:
        sys.exit("\n".join(problems) + "\n--- it said\n" + output)


def planted_defects(origin, folder):
    tree = Tree(origin, folder, SOURCES)
    everything = NOT_OF_THE_ANALYZER + OF_THE_ANALYZER
    expect(tree.tidy("--all"), 1, everything, "6 of 6 files: all\n", "analyzer: 6 files\n")
    expect(tree.tidy(), 1, everything, "nothing tells what changed")

    tree.git("init", "-q")
    tree.git("add", ".")
    tree.git("commit", "-qm", "all")
    expect(tree.tidy("--since", "HEAD"), 0, [], "looks at 0 of 6 files")
    tree.write("src/base/null.cpp", SOURCES["src/base/null.cpp"] + "\n")
    expect(tree.tidy("--since", "HEAD"), 1, OF_THE_ANALYZER[1:2], "looks at 1 of 6 files")
    tree.write("src/base/names.hpp", SOURCES["src/base/names.hpp"] + "\n")
    changed = NOT_OF_THE_ANALYZER[1:] + OF_THE_ANALYZER[1:]
    expect(tree.tidy("--since", "HEAD"), 1, changed, "looks at 4 of 6 files", "analyzer: 4 files")
    tree.git("commit", "-qam", "two of them")
    expect(tree.tidy(), 1, changed, "looks at 4 of 6 files: what changed since")
    expect(tree.tidy("--since", "nothing"), 1, [], "git does not know the commit nothing")
    checks = (tree.root / ".clang-tidy").read_text()
    tree.write(".clang-tidy", checks.replace("-*,\n", "-*,\n  misc-include-cleaner,\n", 1))
    expect(tree.tidy("--since", "HEAD"), 1, [], "misc-include-cleaner finds nothing")


def many_files(origin, folder):
    """Of a large change not more is analyzed than there is time for, and that is told."""
    tree = Tree(origin, folder, {f"src/base/f{number}.cpp": "" for number in range(30)})
    expect(tree.tidy(), 0, [], "looks at 30 of 30", "analyzer: 8 files; 22 are left for")
    tree.git("init", "-q")
    tree.git("add", ".")
    tree.git("commit", "-qm", "all")
    tree.write("src/base/f29.cpp", SOURCES["src/base/null.cpp"])
    tree.write(".clang-tidy", (tree.root / ".clang-tidy").read_text() + "\n")
    expect(tree.tidy("--since", "HEAD"), 1,
           [("src/base/f29.cpp:8:", "clang-analyzer-core.NullDereference")],
           "30 of 30 files: the checks changed", "analyzer: 8 files; 22")


def clashes(origin, folder):
    """A name in two files of a folder is told, but not in two folders."""
    tree = Tree(origin, folder, {
        f"src/{name}/{number}.cpp": SAME_NAME.format(FOLDER=name, NUMBER=number)
        for name, number in (("base", 1), ("sim", 2), ("sim", 3))})
    expect(tree.tidy("--all"), 1,
           [("src/sim/3.cpp:4:", "clang-diagnostic-error")], "must be unique")


def main():
    if not shutil.which("clang-tidy-19") or not shutil.which("git"):
        print("skipped: clang-tidy-19 or git is missing")
        return 77
    for test in (planted_defects, many_files, clashes):
        with tempfile.TemporaryDirectory() as folder:
            test(pathlib.Path(sys.argv[1]).resolve(), folder)
    print("all planted defects were found")
    return 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main())

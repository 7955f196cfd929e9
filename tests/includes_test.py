#!/usr/bin/env python3
"""Which folder of the source may include which; README.md, "Source tree", draws it. Also that
cli names no register's address: what is true of servos lives below it.

Usage: includes_test.py ROOT. First every include of ROOT is looked at, then, in a copy, an include
is planted for every arrow that must not be, to see that it is found.
"""

import pathlib
import re
import shutil
import sys
import tempfile

# A folder and all that it may include. Nothing else may include sim: not even fleet, which must
# not know whether a servo is real.
MAY_INCLUDE = {
    "base": set(),
    "can": {"base"},
    "dronecan": {"can", "base"},
    "bla": {"base"},
    "state": {"dronecan", "can", "base"},
    "fleet": {"state", "dronecan", "can", "bla", "base"},
    "sim": {"dronecan", "can", "bla", "base"},
    "cli": {"fleet", "state", "sim", "dronecan", "can", "bla", "base"},
}
INCLUDE = re.compile(r"^[ \t]*#[ \t]*include\b[ \t]*(.*)$", re.MULTILINE)
NAME = re.compile(r'(["<])([^">]+)[">]')
REGISTER = re.compile(r"\baddress::\w+|\bAddress[({]\s*0x\w*")


def folder_of(path, root):
    """(folder, whether it is public) of a file of ours; folder None: it is in no folder."""
    parts = path.relative_to(root).parts
    public = parts[:2] == ("include", "blactl")
    below = parts[2:] if public else parts[1:]
    return (below[0] if len(below) > 1 else None), public


def included_file(name, quoted, source, root):
    """The file of ours that an include means, as the compiler would find it; None: not ours."""
    places = [source.parent] if quoted else []
    for place in places + [root / "include", root / "src"]:
        path = (place / name).resolve()
        if path.is_file() and path.is_relative_to(root):
            return path
    return None


def fault_of(source, target, root):
    """What is wrong with an include of `target` in `source`; None: nothing."""
    source_folder, source_public = folder_of(source, root)
    target_folder, target_public = folder_of(target, root)
    if source_folder not in MAY_INCLUDE:
        return f"{source_folder or 'the top'} is no folder that MAY_INCLUDE knows"
    if target.relative_to(root).parts[0] not in ("include", "src"):
        return "is outside of include/ and src/"
    if not target_public and (source_public or source_folder != target_folder):
        return f"a private header of {target_folder}"
    if target_folder not in MAY_INCLUDE[source_folder] | {source_folder}:
        return f"{source_folder} must not know {target_folder}"
    return None


def faults_in(source, root):
    text = source.read_text(encoding="utf-8")
    if folder_of(source, root)[0] == "cli":
        for match in REGISTER.finditer(text):
            yield f"{source.relative_to(root)}: {match[0]}: cli knows no register"
    for match in INCLUDE.finditer(text):
        name = NAME.match(match[1])
        if not name:
            yield f"{source.relative_to(root)}: {match[0].strip()}: no name to be seen"
            continue
        target = included_file(name[2], name[1] == '"', source, root)
        fault = fault_of(source, target, root) if target else None
        if not target and name[1] == '"':
            fault = "there is no such file"
        if fault:
            yield f"{source.relative_to(root)}: {name[2]}: {fault}"


def faults(root):
    root = root.resolve()
    sources = [path for folder in ("include", "src") for path in sorted((root / folder).rglob("*"))
               if path.suffix in (".cpp", ".hpp")]
    seen = {folder_of(source, root)[0] for source in sources}
    for folder in MAY_INCLUDE.keys() - seen:
        yield f"{folder}: there is no such folder"
    for source in sources:
        yield from faults_in(source, root)


def is_found(root, source, line, look):
    """Whether `look` sees one fault when `line` is added to `source`."""
    text = source.read_text(encoding="utf-8")
    source.write_text(line + "\n" + text, encoding="utf-8")
    found = list(look())
    source.write_text(text, encoding="utf-8")
    return len(found) == 1


def plants(root):
    """(source, line) of every include that must be found."""
    def public(folder):
        return next((root / "include/blactl" / folder).glob("*.hpp"))

    def private(folder):
        return next((root / "src" / folder).rglob("*.hpp"), None)

    for folder, may_include in MAY_INCLUDE.items():
        source = next((root / "src" / folder).rglob("*.cpp"))
        for other in MAY_INCLUDE.keys() - {folder}:
            if other != "cli" and other not in may_include:
                yield source, f'#include "blactl/{other}/{public(other).name}"'
                yield source, f"#  include <blactl/{other}/{public(other).name}>"
            if private(other):
                yield source, f'#include "{private(other).relative_to(root / "src")}"'
        if folder != "cli" and private(folder):
            yield public(folder), f'#include "{private(folder).relative_to(root / "src")}"'
    yield source, "static_assert(bla::address::torque_output == bla::Address());"
    yield source, "constexpr auto reg = bla::Address(0x20);"
    yield source, "#include SOME_MACRO"
    yield source, '#include "no/such/file.hpp"'
    yield source, '#include "../../tests/catch.hpp"'


def blind_spots(root):
    """The planted includes that are not found, in a copy of the source."""
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder).resolve()
        for part in ("include", "src"):
            shutil.copytree(root / part, copy / part)
        (copy / "tests").mkdir()
        shutil.copy(root / "tests/catch.hpp", copy / "tests")
        for index, (source, line) in enumerate(list(plants(copy))):
            # All of the source is looked at for the first one only: that takes its time.
            look = (lambda: faults_in(source, copy)) if index else (lambda: faults(copy))
            if not is_found(copy, source, line, look):
                yield f"{source.relative_to(copy)}: a planted {line} is not found"


def main():
    root = pathlib.Path(sys.argv[1])
    found = list(faults(root)) or list(blind_spots(root))
    print("\n".join(found) or "includes point down only")
    return 1 if found else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main())

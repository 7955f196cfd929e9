#!/usr/bin/env python3
"""Which floor of the source may include which, and which room of a floor; CONTRIBUTING.md, "The map
of the house", draws it. Also that cli names no register's address: what is true of servos lives
below it; and that no folder of src/ has too many files.

Usage: includes_test.py ROOT. First every include of ROOT is looked at, then, in a copy, an include
is planted for every arrow that must not be, to see that it is found.
"""

import pathlib
import re
import shutil
import sys
import tempfile

# A floor and all that it may include. Nothing else may include sim: not even fleet, which must not
# know whether a servo is real.
FLOORS = {
    "base": set(),
    "can": {"base"},
    "dronecan": {"can", "base"},
    "bla": {"base"},
    "state": {"dronecan", "can", "base"},
    "fleet": {"state", "dronecan", "can", "bla", "base"},
    "sim": {"dronecan", "can", "bla", "base"},
    "cli": {"fleet", "state", "sim", "dronecan", "can", "bla", "base"},
}
# A floor that has rooms, and of each room all that it may include of its own floor. Every file of
# such a floor stands in one of them.
ROOMS = {
    "fleet": {
        "bus": set(),
        "files": {"bus"},
        "change": {"files", "bus"},
        "motion": {"change", "files", "bus"},
        "live": {"change", "files", "bus"},
        "statistics": {"change", "files", "bus"},
        "line": {"change", "files", "bus"},
        "characterize": {"change", "files", "bus"},
        # An exception: the header that says who is on the bus, findings.hpp, stands in characterize.
        "doctor": {"characterize", "change", "files", "bus"},
    },
    "sim": {
        "node": set(),
        "servo": {"node"},
        "scenario": {"servo", "node"},
        "bus": {"scenario", "servo", "node"},
    },
}
# A floor whose folders are no rooms: they may include one another.
ROOMLESS = {"can", "cli"}
# More files than that, side by side in a folder of src/, nobody finds his way through.
MOST_FILES = 45

INCLUDE = re.compile(r"^[ \t]*#[ \t]*include\b[ \t]*(.*)$", re.MULTILINE)
NAME = re.compile(r'(["<])([^">]+)[">]')
REGISTER = re.compile(r"\baddress::\w+|\bAddress[({]\s*0x\w*")


def place_of(path, root):
    """(floor, room, whether it is public) of a file of ours; None: it is on no floor, in no room."""
    parts = path.relative_to(root).parts
    public = parts[:2] == ("include", "blactl")
    *folders, _ = parts[2:] if public else parts[1:]
    return *(folders + [None, None])[:2], public


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
    floor, room, public = place_of(source, root)
    target_floor, target_room, target_public = place_of(target, root)
    if target.relative_to(root).parts[0] not in ("include", "src"):
        return "is outside of include/ and src/"
    if not target_public and (public or floor != target_floor):
        return f"a private header of {target_floor}"
    if target_floor not in FLOORS[floor] | {floor}:
        return f"{floor} must not know {target_floor}"
    rooms = ROOMS.get(floor)
    if rooms and floor == target_floor and target_room not in rooms[room] | {room}:
        return f"{floor}/{room} must not know {floor}/{target_room}"
    return None


def fault_of_place(source, root):
    """What is wrong with where a file stands; None: nothing."""
    floor, room, _ = place_of(source, root)
    if floor not in FLOORS:
        return f"{floor or 'the top'} is no floor that FLOORS knows"
    if floor not in ROOMLESS and room not in ROOMS.get(floor, {None}):
        return f"{floor}/{room or ''} is no room that ROOMS knows"
    return None


def faults_in(source, root):
    place = fault_of_place(source, root)
    if place:
        yield f"{source.relative_to(root)}: {place}"
        return
    text = source.read_text(encoding="utf-8")
    if place_of(source, root)[0] == "cli":
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


def missing_places(sources, root):
    """Floors and rooms that the tables know and the source does not have."""
    known = {(floor, None) for floor in FLOORS}
    known |= {(floor, room) for floor, rooms in ROOMS.items() for room in rooms}
    places = {place_of(source, root)[:2] for source in sources}
    for floor, room in known - places - {(floor, None) for floor, _ in places}:
        yield f"{floor}/{room or ''}: there is no such folder"


def crowds(root):
    """Folders of src/ with too many files side by side."""
    for folder in sorted({path.parent for path in (root / "src").rglob("*")}):
        count = sum(path.is_file() for path in folder.iterdir())
        if count > MOST_FILES:
            yield f"{folder.relative_to(root)}: {count} files, more than {MOST_FILES}"


def faults(root):
    root = root.resolve()
    yield from crowds(root)
    sources = [path for folder in ("include", "src") for path in sorted((root / folder).rglob("*"))
               if path.suffix in (".cpp", ".hpp")]
    yield from missing_places(sources, root)
    for source in sources:
        yield from faults_in(source, root)


def is_found(source, line, look):
    """Whether `look` sees one fault when `line` is added to `source`, which need not be there."""
    text = source.read_text(encoding="utf-8") if source.exists() else None
    source.parent.mkdir(exist_ok=True)
    source.write_text(line + "\n" + (text or ""), encoding="utf-8")
    found = list(look())
    if text is None:
        source.unlink()
    else:
        source.write_text(text, encoding="utf-8")
    return len(found) == 1


def first(folder, pattern):
    return next(iter(sorted(folder.rglob(pattern))), None)


def public_header(root, *place):
    return first((root / "include/blactl").joinpath(*place), "*.hpp")


def private_header(root, *place):
    return first((root / "src").joinpath(*place), "*.hpp")


def floor_plants(root):
    for floor, may_include in FLOORS.items():
        source = first(root / "src" / floor, "*.cpp")
        public = public_header(root, floor)
        for other in FLOORS.keys() - {floor}:
            header = public_header(root, other)
            if header and other not in may_include:
                name = header.relative_to(root / "include")
                yield source, f'#include "{name}"'
                yield source, f"#  include <{name}>"
            header = private_header(root, other)
            if header:
                yield source, f'#include "{header.relative_to(root / "src")}"'
        header = private_header(root, floor)
        if public and header:
            yield public, f'#include "{header.relative_to(root / "src")}"'


def room_plants(root):
    for floor, rooms in ROOMS.items():
        for room, may_include in rooms.items():
            for source in (first(root / "src" / floor / room, "*.cpp"),
                           public_header(root, floor, room), private_header(root, floor, room)):
                for other in rooms.keys() - may_include - {room} if source else ():
                    header = public_header(root, floor, other)
                    if header:
                        yield source, f'#include "{header.relative_to(root / "include")}"'
                    header = private_header(root, floor, other)
                    if header and not source.is_relative_to(root / "include"):
                        yield source, f'#include "{header.relative_to(root / "src")}"'
        yield root / "src" / floor / "in_no_room.cpp", ""
        yield root / "src" / floor / "attic" / "in_no_room_that_is_known.cpp", ""


def plants(root):
    """(source, line) of every include that must be found, and of files that stand where none may."""
    yield from floor_plants(root)
    yield from room_plants(root)
    source = first(root / "src/cli", "*.cpp")
    yield source, "static_assert(bla::address::torque_output == bla::Address());"
    yield source, "constexpr auto reg = bla::Address(0x20);"
    yield source, "#include SOME_MACRO"
    yield source, '#include "no/such/file.hpp"'
    yield source, '#include "../../tests/catch.hpp"'
    yield root / "src/on_no_floor.cpp", ""
    roomless = next(floor for floor in FLOORS if floor not in ROOMS.keys() | ROOMLESS)
    yield root / "src" / roomless / "room" / "of_a_floor_without.cpp", ""


def blind_spots(root):
    """What is planted and not found, in a copy of the source."""
    with tempfile.TemporaryDirectory() as folder:
        copy = pathlib.Path(folder).resolve()
        for part in ("include", "src"):
            shutil.copytree(root / part, copy / part)
        (copy / "tests").mkdir()
        shutil.copy(root / "tests/catch.hpp", copy / "tests")
        for index, (source, line) in enumerate(list(plants(copy))):
            # All of the source is looked at for the first one only: that takes its time.
            look = (lambda: faults_in(source, copy)) if index else (lambda: faults(copy))
            if not is_found(source, line, look):
                yield f"{source.relative_to(copy)}: {line or 'that it stands there'}: not found"
        folder = copy / "src/base"
        for index in range(MOST_FILES - sum(path.is_file() for path in folder.iterdir())):
            (folder / f"one_more_{index}.txt").touch()
        if list(crowds(copy)) or not is_found(folder / "too_many.cpp", "", lambda: crowds(copy)):
            yield f"{folder.relative_to(copy)}: {MOST_FILES} files, and one more: not told apart"


def main():
    root = pathlib.Path(sys.argv[1])
    found = list(faults(root)) or list(blind_spots(root))
    print("\n".join(found) or "includes point down only")
    return 1 if found else 0


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    sys.exit(main())

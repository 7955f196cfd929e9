"""The command table, and what the models add to it."""

import dataclasses

NOTICE = "Made by scripts/generate from the command table: do not edit."

# What grep finds of an entry in a fleet file.
ENTRY_NAME = r'"name" *: *"[^"\\]*"'


@dataclasses.dataclass(frozen=True)
class Option:
    """An option, or an argument that goes by its place."""

    name: str
    letter: str | None
    value: str
    kind: str
    repeats: bool
    words: tuple[str, ...]
    help: str

    @property
    def is_flag(self):
        return self.kind == "flag"

    @property
    def names(self):
        """As people type it: -n, --node."""
        return [f"-{self.letter}", self.name] if self.letter else [self.name]


@dataclasses.dataclass(frozen=True)
class Command:
    name: str
    help: str
    options: tuple[Option, ...]
    arguments: tuple[Option, ...]


@dataclasses.dataclass(frozen=True)
class Scheme:
    """A kind of interface: what stands before the colon, and what is completed behind it."""

    name: str
    operand: str
    example: str


@dataclasses.dataclass(frozen=True)
class CrossCheck:
    code: str
    kind: str
    parameters: tuple[str, ...]
    reason: str


@dataclasses.dataclass(frozen=True)
class Parameter:
    address: str
    name: str
    help: str
    unit: str
    readable: bool
    settable: bool
    is_setting: bool  # a fleet file holds it
    words: tuple[str, ...]


def _option(entry):
    return Option(entry["name"], entry["letter"], entry["value"], entry["kind"],
                  entry["repeat"] == "list", tuple(entry["words"]), entry["help_en"])


def _options(entries):
    return tuple(_option(entry) for entry in entries)


def _parameter(entry):
    # The opcodes are written by erase, restart and save, never by set.
    settable = "W" in entry["access"] and entry["group"] != "operation"
    return Parameter(entry["address"], entry["name"], entry["name_en"], entry["unit"], "R" in entry["access"], settable,
                     entry["saved"] and entry["access"] == "RW",
                     tuple(choice["word"] for choice in entry["enumeration"]))


class Table:
    """Everything that completions and manual are made from."""

    def __init__(self, cli, models):
        self.version = cli["version"]
        self.shared = _options(cli["options"])
        self.commands = tuple(
            Command(entry["name"], entry["help_en"], _options(entry["options"]),
                    _options(entry["arguments"])) for entry in cli["commands"])
        # Two of one name are completed alike.
        self.schemes = tuple({entry["name"]: Scheme(entry["name"], entry["operand"], entry["example"])
                              for entry in reversed(cli["interfaces"])}.values())[::-1]
        self.models = sorted(model["model"] for model in models["models"])
        by_address = {}
        for model in models["models"]:
            for entry in model["parameters"]:
                known = by_address.setdefault(entry["address"], _parameter(entry))
                if len(entry["enumeration"]) > len(known.words):
                    by_address[entry["address"]] = _parameter(entry)
        self.parameters = [by_address[address] for address in sorted(by_address)]
        self.cross_checks = tuple(
            CrossCheck(entry["code"], entry["kind"],
                       tuple(by_address[address].name for address in entry["addresses"]),
                       entry["help_en"]) for entry in cli["cross_checks"])

    def schemes_with(self, operand):
        """Their names."""
        return [scheme.name for scheme in self.schemes if scheme.operand == operand]

    def interface_words(self):
        """What is offered before anything is typed, besides what the machine has."""
        return ([scheme.example for scheme in self.schemes if scheme.operand == "other"] +
                [f"{name}:" for name in self.schemes_with("file")])

    def readable(self):
        return [parameter for parameter in self.parameters if parameter.readable]

    def settable(self):
        return [parameter for parameter in self.parameters if parameter.settable]

    def settings(self):
        return [parameter for parameter in self.parameters if parameter.is_setting]

    def with_words(self):
        return [parameter for parameter in self.settable() if parameter.words]

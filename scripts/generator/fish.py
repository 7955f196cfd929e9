"""completions/blactl.fish."""

from generator.table import ENTRY_NAME, NOTICE

FIXED = """\
# fish completion of blactl. {notice}
# Nothing here asks the bus.

# The command, and its arguments so far.
function __blactl_words
    set -l words (commandline -opc)
    set -l value no
    for word in $words[2..]
        if test $value = yes
            set value no
        else if string match -qr -- '{with_value}' $word
            set value yes
        else if not string match -q -- '-*' $word
            echo $word
        end
    end
end

function __blactl_needs_command
    test (count (__blactl_words)) -eq 0
end

function __blactl_in
    set -l words (__blactl_words)
    test (count $words) -gt 0; and test $words[1] = $argv[1]
end

# __blactl_argument COMMAND PLACE
function __blactl_argument
    set -l words (__blactl_words)
    __blactl_in $argv[1]; and test (count $words) -eq $argv[2]
end

# The CAN interfaces in a folder such as /sys/class/net: those of type 280.
function __blactl_can_interfaces
    for entry in $argv[1]/*
        if test -r $entry/type; and test (cat $entry/type) = 280
            echo (basename $entry)
        end
    end
end

# The serial ports in a folder such as /dev/serial/by-id.
function __blactl_serial_adapters
    for entry in $argv[1]/*
{serial_ports}
    end
end

# Without the option that a value may be glued to: --interface=sim
function __blactl_token
    string replace -r -- '^--[a-z-]+=' '' (commandline -ct)
end

# __blactl_files PREFIX: files behind a prefix such as "replay:".
function __blactl_files
    set -l typed (string replace -- $argv[1] '' (__blactl_token))
    printf "$argv[1]%s\\n" (__fish_complete_path $typed)
end

function __blactl_interface
    switch (__blactl_token)
{file_cases}
        case '*'
            __blactl_can_interfaces /sys/class/net
            __blactl_serial_adapters /dev/serial/by-id
            printf '%s\\n' {interface_words}
    end
end

# __blactl_list WORDS…: one or several with commas.
function __blactl_list
    set -l before (string match -r -- '^.*,' (__blactl_token))
    printf "$before%s\\n" $argv
end

# The names of the entries in the fleet files of the line, after them.
function __blactl_entries
    for file in (commandline -opc)
        if string match -q -- '*.json' $file; and test -r $file
            grep -o '{entry_name}' $file | sed 's/^"name" *: *"//; s/"$//'
        end
    end
end

function __blactl_nodes
    if string match -qr -- '(^|,)model:[^,]*$' (__blactl_token)
        __blactl_list model:(__blactl_models)
    else
        __blactl_list all uid: serial: servo: model:
    end
end
"""


def _quoted(text):
    return "'" + text.replace("\\", "\\\\").replace("'", "\\'") + "'"


def _short(text):
    """fish repeats the text of an option beside each of its values."""
    head = text.split(": ")[0]
    return text if "(" in head else head


def _values(option):
    """The arguments of `complete` for what a value may be."""
    words = " ".join(option.words)
    offers = {
        "word": _quoted(words),
        "words": _quoted(f"(__blactl_list {words})"),
        "beginning": _quoted(words),
        "suggested": _quoted(words),
        "data_types": _quoted(f"(__blactl_list {words})"),
        "entry": "'(__blactl_entries)'",
        "group": _quoted(words),
        "parameter": "'(__blactl_parameters)'",
        "assignment": "'(__blactl_assignments)'",
        "model": "'(__blactl_models)'",
        "model_or_parameter": "'(__blactl_models; __blactl_parameters)'",
        "nodes": "'(__blactl_nodes)'",
        "interface": "'(__blactl_interface)'",
        "folder": "'(__fish_complete_directories (__blactl_token))'",
    }
    if option.kind == "file":
        return ["-F"]
    return ["-f", "-a", offers[option.kind]] if option.kind in offers else ["-f"]


def _option_line(option, condition=()):
    parts = ["complete", "-c", "blactl", *condition]
    if option.letter:
        parts += ["-s", option.letter]
    parts += ["-l", option.name.removeprefix("--")]
    if not option.is_flag:
        parts += ["-r", *_values(option)]
    return " ".join([*parts, "-d", _quoted(_short(option.help))])


def _argument_line(command, place, argument):
    condition = (f"__blactl_in {command.name}" if argument.repeats
                 else f"__blactl_argument {command.name} {place + 1}")
    return " ".join(["complete", "-c", "blactl", "-n", _quoted(condition), *_values(argument)])


def _printer(function, lines):
    return ["", f"function {function}", "    printf '%s\\n' \\",
            *[f"        {line} \\" for line in lines[:-1]], f"        {lines[-1]}", "end"]


def _described(parameters, mark=""):
    return [f"{parameter.name}{mark}\\t{_quoted(parameter.help)}" for parameter in parameters]


def _assignments(table):
    lines = ["", "function __blactl_assignments", "    switch (commandline -ct)"]
    for parameter in table.with_words():
        words = " ".join(parameter.words)
        lines += [f"        case '{parameter.name}=*'",
                  f"            printf '{parameter.name}=%s\\n' {words}"]
    return lines + ["        case '*=*'", "        case '*'", "            __blactl_settable",
                    "    end", "end"]


def _with_value(table):
    """What matches an option whose value is the next word."""
    options = [*table.shared, *(o for command in table.commands for o in command.options)]
    names = sorted({option.name.removeprefix("--") for option in options if not option.is_flag})
    flags = "".join(option.letter for option in table.shared if option.is_flag and option.letter)
    letters = "".join(o.letter for o in table.shared if not o.is_flag and o.letter)
    return f"^(--({'|'.join(names)})|-[{flags}]*[{letters}])$"


def completion(table):
    """The text of the file."""
    lines = [
        *_printer("__blactl_models", table.models),
        *_printer("__blactl_parameters", _described(table.readable())),
        *_printer("__blactl_settable", _described(table.settable(), "=")),
        *_assignments(table),
        "",
        "complete -c blactl -f",
    ]
    for command in table.commands:
        lines.append(f"complete -c blactl -n __blactl_needs_command -a {command.name} "
                     f"-d {_quoted(command.help)}")
    lines += [_option_line(option) for option in table.shared]
    for command in table.commands:
        lines.append("")
        condition = ("-n", _quoted(f"__blactl_in {command.name}"))
        lines += [_option_line(option, condition) for option in command.options]
        lines += [_argument_line(command, place, argument)
                  for place, argument in enumerate(command.arguments)]
    fixed = FIXED.format(
        notice=NOTICE, entry_name=ENTRY_NAME, with_value=_with_value(table),
        serial_ports="\n".join(f"        echo {name}:$entry"
                               for name in table.schemes_with("serial_port")),
        file_cases="\n".join(f"        case '{name}:*'\n            __blactl_files {name}:"
                             for name in table.schemes_with("file")),
        interface_words=" ".join(table.interface_words()))
    return fixed + "\n".join(lines) + "\n"

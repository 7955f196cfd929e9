"""completions/_blactl, for zsh."""

from generator.table import ENTRY_NAME, NOTICE

FIXED = """\
#compdef blactl
# zsh completion of blactl. {notice}
# Nothing here asks the bus.

# The CAN interfaces in a folder such as /sys/class/net: those of type 280.
_blactl_can_interfaces() {{
  local entry
  for entry in $1/*(N); do
    if [[ -r $entry/type && $(<$entry/type) == 280 ]]; then
      print -r -- ${{entry:t}}
    fi
  done
}}

# The serial ports in a folder such as /dev/serial/by-id.
_blactl_serial_adapters() {{
  local entry
  for entry in $1/*(N); do
{serial_ports}
  done
}}

_blactl_interface() {{
  if {file_prefixes}; then
    _files
  else
    compadd -- $(_blactl_can_interfaces /sys/class/net) \
      $(_blactl_serial_adapters /dev/serial/by-id) {whole_words}
    compadd -S '' -- {beginnings}
  fi
}}

_blactl_nodes() {{
  compset -P '*,'
  if compset -P 'model:'; then
    _blactl_model
  else
    compadd -S '' -- all uid: serial: servo: model:
  fi
}}

# The names of the entries in the fleet files of the line, after them.
_blactl_entry() {{
  local file
  local -a names
  for file in $words; do
    if [[ $file == *.json && -r $file ]]; then
      names+=(${{(f)"$(grep -o '{entry_name}' $file | sed 's/^"name" *: *"//; s/"$//')"}})
    fi
  done
  compadd -a names
}}

# _blactl_word_list WORDS…: one or several with commas.
_blactl_word_list() {{
  compset -P '*,'
  compadd -S '' -- "$@"
}}
"""


def _quoted(text):
    return "'" + text.replace("'", "'\\''") + "'"


def _escaped(text):
    """For what stands in brackets, or between colons."""
    for mark in "\\[]:":
        text = text.replace(mark, "\\" + mark)
    return text


def _action(option):
    actions = {
        "word": f"({' '.join(option.words)})",
        "words": f"_blactl_word_list {' '.join(option.words)}",
        "beginning": f"compadd -S '' -- {' '.join(option.words)}",
        "suggested": f"({' '.join(option.words)})",
        "data_types": f"_blactl_word_list {' '.join(option.words)}",
        "entry": "_blactl_entry",
        "group": f"({' '.join(option.words)})",
        "parameter": "_blactl_parameter",
        "assignment": "_blactl_assignment",
        "model": "_blactl_model",
        "model_or_parameter": "_blactl_model_or_parameter",
        "nodes": "_blactl_nodes",
        "interface": "_blactl_interface",
        "file": "_files",
        "folder": "_files -/",
    }
    return actions.get(option.kind, " ")


def _option_spec(option):
    """One or two arguments of _arguments."""
    tail = f"[{_escaped(option.help)}]"
    if not option.is_flag:
        tail += f":{_escaped(option.value)}:{_action(option)}"
    names = option.names
    if option.repeats or option.name == "--verbose":
        before = "*"
    else:
        before = f"({' '.join(names)})" if len(names) > 1 else ""

    def takes_value(name):
        """How _arguments says that the value may be glued to it: -n11, --node=11."""
        if option.is_flag:
            return ""
        return "=" if name.startswith("--") else "+"

    return [_quoted(before + name + takes_value(name) + tail) for name in names]


def _argument_spec(place, argument):
    where = "*" if argument.repeats else str(place + 1)
    return _quoted(f"{where}:{_escaped(argument.name)}:{_action(argument)}")


def _described(names):
    return [f"    {_quoted(name.replace(':', chr(92) + ':') + ':' + text)}" for name, text in names]


def _describer(function, title, names, options=""):
    """A function that offers words with a text each."""
    return ["", f"{function}() {{", "  local -a words=(", *_described(names), "  )",
            f"  _describe {title} words{options}", "}"]


def _assignments(table):
    lines = ["", "_blactl_assignment() {", "  if compset -P '*='; then", "    case $IPREFIX in"]
    for parameter in table.with_words():
        lines.append(f"      {parameter.name}=) compadd -- {' '.join(parameter.words)} ;;")
    return lines + ["    esac", "  else", "    _blactl_settable", "  fi", "}"]


def _command_cases(table):
    lines = []
    for command in table.commands:
        specs = [spec for option in command.options for spec in _option_spec(option)]
        specs += [_argument_spec(place, argument)
                  for place, argument in enumerate(command.arguments)]
        lines.append(f"    {command.name})")
        lines.append("      specs=(")
        lines += [f"        {spec}" for spec in specs]
        lines += ["      )", "      ;;"]
    return lines


def completion(table):
    """The text of the file."""
    shared = [f"    {spec}" for option in table.shared for spec in _option_spec(option)]
    lines = [
        "",
        "_blactl_model() {",
        f"  compadd -- {' '.join(table.models)}",
        "}",
        *_describer("_blactl_parameter", "parameter",
                    [(parameter.name, parameter.help) for parameter in table.readable()]),
        "",
        "_blactl_model_or_parameter() {",
        "  _alternative models:model:_blactl_model parameters:parameter:_blactl_parameter",
        "}",
        *_describer("_blactl_settable", "parameter",
                    [(parameter.name, parameter.help) for parameter in table.settable()],
                    " -S = -q"),
        *_assignments(table),
        *_describer("_blactl_command", "command",
                    [(command.name, command.help) for command in table.commands]),
        "",
        "_blactl() {",
        "  local curcontext=$curcontext state line",
        "  typeset -A opt_args",
        "  local -a specs shared=(",
        *shared,
        "  )",
        "  _arguments -C -s -S $shared '1: :_blactl_command' '*:: :->arguments' && return",
        "  if [[ $state != arguments ]]; then",
        "    return 1",
        "  fi",
        "  case $words[1] in",
        *_command_cases(table),
        "    *) return 1 ;;",
        "  esac",
        "  _arguments -s -S $shared $specs",
        "}",
        "",
        "# As an autoloaded function it is to complete at once; where it is sourced, to be known.",
        "if [[ $funcstack[1] == _blactl ]]; then",
        "  _blactl \"$@\"",
        "else",
        "  compdef _blactl blactl",
        "fi",
    ]
    words = table.interface_words()
    fixed = FIXED.format(
        notice=NOTICE, entry_name=ENTRY_NAME,
        serial_ports="\n".join(f"    print -r -- {name}:$entry"
                               for name in table.schemes_with("serial_port")),
        file_prefixes=" || ".join(f"compset -P '{name}:'" for name in table.schemes_with("file")),
        whole_words=" ".join(word for word in words if not word.endswith(":")),
        beginnings=" ".join(word for word in words if word.endswith(":")))
    return fixed + "\n".join(lines) + "\n"

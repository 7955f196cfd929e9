"""completions/blactl.bash."""

from generator.table import ENTRY_NAME, NOTICE

# The kinds of values whose words are all in the table, and what completes the others.
FIXED = """\
# bash completion of blactl. {notice}
# Works without the package bash-completion. Nothing here asks the bus.

# The CAN interfaces in a folder such as /sys/class/net: those of type 280.
_blactl_can_interfaces() {{
  local entry
  for entry in "$1"/*; do
    if [[ -r $entry/type && $(<"$entry/type") == 280 ]]; then
      printf '%s\\n' "${{entry##*/}}"
    fi
  done
}}

# The serial ports in a folder such as /dev/serial/by-id.
_blactl_serial_adapters() {{
  local entry
  for entry in "$1"/*; do
    if [[ -e $entry ]]; then
{serial_ports}
    fi
  done
}}

# _blactl_offer WORDS: those that begin as the current word does.
_blactl_offer() {{
  mapfile -t COMPREPLY < <(compgen -W "$1" -- "$cur")
}}

# _blactl_offer_files PREFIX [compgen OPTION]: files behind a prefix such as "replay:".
_blactl_offer_files() {{
  compopt -o filenames 2>/dev/null
  mapfile -t COMPREPLY < <(compgen "${{2:--f}}" -P "$1" -- "${{cur#"$1"}}")
}}

# _blactl_offer_list WORDS: the same for the last item of a list with commas.
_blactl_offer_list() {{
  local before=
  if [[ $cur == *,* ]]; then
    before=${{cur%,*}},
  fi
  mapfile -t COMPREPLY < <(compgen -W "$1" -P "$before" -- "${{cur##*,}}")
}}

_blactl_offer_interface() {{
  case $cur in
{file_cases}
    *)
      _blactl_offer "$(_blactl_can_interfaces /sys/class/net)
        $(_blactl_serial_adapters /dev/serial/by-id) {interface_words}"
      if [[ ${{COMPREPLY[*]}} == *: ]]; then
        compopt -o nospace 2>/dev/null
      fi
      ;;
  esac
}}

# The names of the entries in the fleet files of the line, after them.
_blactl_offer_entries() {{
  local file name
  for file in "${{words[@]}}"; do
    if [[ $file == *.json && -r $file ]]; then
      while IFS= read -r name; do
        if [[ $name == "$cur"* ]]; then
          COMPREPLY+=("$(printf '%q' "$name")")
        fi
      done < <(grep -o '{entry_name}' "$file" | sed 's/^"name" *: *"//; s/"$//')
    fi
  done
}}

_blactl_offer_nodes() {{
  if [[ ${{cur##*,}} == model:* ]]; then
    _blactl_offer_list "model:${{_blactl_models// / model:}}"
  else
    _blactl_offer_list 'all uid: serial: servo: model:'
    if [[ ${{COMPREPLY[*]}} == *: ]]; then
      compopt -o nospace 2>/dev/null
    fi
  fi
}}
"""

MAIN = """
# _blactl_offer_value KIND [WORDS]
_blactl_offer_value() {
  case $1 in
    word | group | suggested) _blactl_offer "$2" ;;
    words | data_types) _blactl_offer_list "$2" ;;
    beginning)
      _blactl_offer "$2"
      compopt -o nospace 2>/dev/null
      ;;
    parameter) _blactl_offer "$_blactl_parameters" ;;
    assignment) _blactl_offer_assignment ;;
    model) _blactl_offer "$_blactl_models" ;;
    model_or_parameter) _blactl_offer "$_blactl_models $_blactl_parameters" ;;
    nodes) _blactl_offer_nodes ;;
    interface) _blactl_offer_interface ;;
    file) _blactl_offer_files '' ;;
    folder) _blactl_offer_files '' -d ;;
    entry) _blactl_offer_entries ;;
  esac
}

# Readline replaces only what follows the last = or : of the word, if these break words.
_blactl_trim() {
  local breaks=${COMP_WORDBREAKS//[^=:]/} head
  if [[ -n $breaks && $cur == *["$breaks"]* ]]; then
    head=${cur%"${cur##*["$breaks"]}"}
    COMPREPLY=("${COMPREPLY[@]#"$head"}")
  fi
}

_blactl() {
  # The words of bash are broken at = and :, those of blactl are not.
  local line=${COMP_LINE:0:COMP_POINT} words cur='' word command='' kind='' value_words=''
  local -i place=0 i
  COMPREPLY=()
  read -ra words <<<"$line"
  if [[ $line != *[[:space:]] ]]; then
    cur=${words[-1]}
    unset 'words[-1]'
  fi
  for ((i = 1; i < ${#words[@]}; i++)); do
    word=${words[i]}
    if [[ -n $kind ]]; then
      kind='' # this word is the value of the option before it
    elif [[ $word == --*=* ]]; then
      continue
    elif [[ $word == -?* ]]; then
      _blactl_option "$command" "$word"
    elif [[ -z $command ]]; then
      command=$word
    else
      place+=1
    fi
  done
  if [[ -z $kind && $cur == --*=* ]]; then
    local option=${cur%%=*}
    _blactl_option "$command" "$option"
    if [[ -n $kind ]]; then
      cur=${cur#*=}
      _blactl_offer_value "$kind" "$value_words"
      if [[ $COMP_WORDBREAKS != *=* ]]; then
        COMPREPLY=("${COMPREPLY[@]/#/$option=}")
      fi
      return
    fi
  fi
  if [[ -n $kind ]]; then
    _blactl_offer_value "$kind" "$value_words"
  elif [[ $cur == -* ]]; then
    _blactl_offer "$(_blactl_options "$command")"
  elif [[ -z $command ]]; then
    _blactl_offer "$_blactl_commands"
  else
    _blactl_argument "$command" "$place"
    _blactl_offer_value "$kind" "$value_words"
  fi
  _blactl_trim
}

complete -F _blactl blactl
"""


def _assign(kind, words):
    text = f"kind='{kind}'"
    return f"{text} value_words='{' '.join(words)}'" if words else text


def _option_cases(table):
    """Sets kind and value_words where the option of a command takes a value."""
    lines = ["", "# _blactl_option COMMAND OPTION: sets `kind` if the option takes a value, and",
             "# `value_words`.", "_blactl_option() {", "  case $1:$2 in"]
    for option in table.shared:
        if not option.is_flag:
            # Short flags may stand before it: -jn.
            patterns = [f"*:{option.name}"]
            if option.letter:
                flags = "".join(flag.letter for flag in table.shared
                                if flag.is_flag and flag.letter)
                patterns += [f"*:-{option.letter}", f"*:-[{flags}]{option.letter}",
                             f"*:-[{flags}][{flags}]{option.letter}"]
            lines.append(f"    {' | '.join(patterns)}) {_assign(option.kind, option.words)} ;;")
    for command in table.commands:
        for option in command.options:
            if not option.is_flag:
                lines.append(f"    {command.name}:{option.name}) "
                             f"{_assign(option.kind, option.words)} ;;")
    return lines + ["  esac", "}"]


def _argument_cases(table):
    lines = ["", "# _blactl_argument COMMAND PLACE: the same for an argument.",
             "_blactl_argument() {", "  case $1:$2 in"]
    for command in table.commands:
        for place, argument in enumerate(command.arguments):
            where = "*" if argument.repeats else place
            lines.append(f"    {command.name}:{where}) "
                         f"{_assign(argument.kind, argument.words)} ;;")
    return lines + ["  esac", "}"]


def _option_lists(table):
    def names(options):
        return " ".join(name for option in options for name in option.names)

    lines = ["", "_blactl_options() {", f"  echo '{names(table.shared)}'", "  case $1 in"]
    for command in table.commands:
        if command.options:
            lines.append(f"    {command.name}) echo '{names(command.options)}' ;;")
    return lines + ["  esac", "}"]


def _assignments(table):
    lines = ["", "_blactl_offer_assignment() {", "  case $cur in"]
    for parameter in table.with_words():
        values = " ".join(f"{parameter.name}={word}" for word in parameter.words)
        lines.append(f"    {parameter.name}=*) _blactl_offer '{values}' ;;")
    return lines + [
        "    *=*) ;;",
        "    *)",
        "      _blactl_offer \"$_blactl_settable\"",
        "      compopt -o nospace 2>/dev/null",
        "      ;;",
        "  esac",
        "}",
    ]


def completion(table):
    """The text of the file."""
    parameters = " ".join(parameter.name for parameter in table.readable())
    settable = " ".join(f"{parameter.name}=" for parameter in table.settable())
    lines = [
        "",
        f"_blactl_commands='{' '.join(command.name for command in table.commands)}'",
        f"_blactl_models='{' '.join(table.models)}'",
        f"_blactl_parameters='{parameters}'",
        f"_blactl_settable='{settable}'",
        *_option_cases(table),
        *_argument_cases(table),
        *_option_lists(table),
        *_assignments(table),
    ]
    files = table.schemes_with("file")
    fixed = FIXED.format(
        notice=NOTICE, entry_name=ENTRY_NAME,
        serial_ports="\n".join(f"      printf '{name}:%s\\n' \"$entry\""
                               for name in table.schemes_with("serial_port")),
        file_cases="\n".join(f"    {name}:*) _blactl_offer_files {name}: ;;" for name in files),
        interface_words=" ".join(table.interface_words()))
    return fixed + "\n".join(lines) + "\n" + MAIN

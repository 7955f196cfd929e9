# bash completion of blactl. Made by scripts/generate from the command table: do not edit.
# Works without the package bash-completion. Nothing here asks the bus.

# The CAN interfaces in a folder such as /sys/class/net: those of type 280.
_blactl_can_interfaces() {
  local entry
  for entry in "$1"/*; do
    if [[ -r $entry/type && $(<"$entry/type") == 280 ]]; then
      printf '%s\n' "${entry##*/}"
    fi
  done
}

# The serial ports in a folder such as /dev/serial/by-id.
_blactl_serial_adapters() {
  local entry
  for entry in "$1"/*; do
    if [[ -e $entry ]]; then
      printf 'slcan:%s\n' "$entry"
    fi
  done
}

# _blactl_offer WORDS: those that begin as the current word does.
_blactl_offer() {
  mapfile -t COMPREPLY < <(compgen -W "$1" -- "$cur")
}

# _blactl_offer_files PREFIX [compgen OPTION]: files behind a prefix such as "replay:".
_blactl_offer_files() {
  compopt -o filenames 2>/dev/null
  mapfile -t COMPREPLY < <(compgen "${2:--f}" -P "$1" -- "${cur#"$1"}")
}

# _blactl_offer_list WORDS: the same for the last item of a list with commas.
_blactl_offer_list() {
  local before=
  if [[ $cur == *,* ]]; then
    before=${cur%,*},
  fi
  mapfile -t COMPREPLY < <(compgen -W "$1" -P "$before" -- "${cur##*,}")
}

_blactl_offer_interface() {
  case $cur in
    sim:*) _blactl_offer_files sim: ;;
    replay:*) _blactl_offer_files replay: ;;
    file:*) _blactl_offer_files file: ;;
    *)
      _blactl_offer "$(_blactl_can_interfaces /sys/class/net)
        $(_blactl_serial_adapters /dev/serial/by-id) mcast:0 sim: replay: file:"
      if [[ ${COMPREPLY[*]} == *: ]]; then
        compopt -o nospace 2>/dev/null
      fi
      ;;
  esac
}

# The names of the entries in the fleet files of the line, after them.
_blactl_offer_entries() {
  local file name
  for file in "${words[@]}"; do
    if [[ $file == *.json && -r $file ]]; then
      while IFS= read -r name; do
        if [[ $name == "$cur"* ]]; then
          COMPREPLY+=("$(printf '%q' "$name")")
        fi
      done < <(grep -o '"name" *: *"[^"\\]*"' "$file" | sed 's/^"name" *: *"//; s/"$//')
    fi
  done
}

_blactl_offer_nodes() {
  if [[ ${cur##*,} == model:* ]]; then
    _blactl_offer_list "model:${_blactl_models// / model:}"
  else
    _blactl_offer_list 'all uid: serial: servo: model:'
    if [[ ${COMPREPLY[*]} == *: ]]; then
      compopt -o nospace 2>/dev/null
    fi
  fi
}

_blactl_commands='scan alloc get set save erase restart wait faults pwm-config export diff apply replace undo provision ledger monitor command trace doctor characterize models sim'
_blactl_models='BLA15-06U-A0 BLA15-12U-A0 BLA21-06U-A0 BLA21-06U-AB BLA21-12U-A0 BLA21-12U-AB BLA21-28U-A0 BLA21-28U-AB BLA34-12U-AB BLA34-28U-AB'
_blactl_parameters='command_angle command_speed command_torque current_angle current_speed current_torque current_temperature current_voltage fault_summary fault_notice fault_warning fault_failure torque_output soft_start smoothing reverse extended_angle speed_torque_control timeout_action timeout_time overcurrent_limit angle_p_gain angle_d_gain angle_dead_band angle_boost speed_p_gain speed_i_gain speed_dead_band speed_i_limit pwm_neutral pwm_range pwm_output_range pwm_mode angle_limit_cw angle_limit_ccw speed_limit_cw speed_limit_ccw torque_limit_cw torque_limit_ccw temperature_limit_high temperature_limit_low voltage_limit_high voltage_limit_low origin servo_id static_node_id model_number serial_number firmware_version hardware_version production_year production_month production_day production_hour production_minute'
_blactl_settable='command_angle= command_speed= command_torque= torque_output= soft_start= smoothing= reverse= extended_angle= speed_torque_control= timeout_action= timeout_time= overcurrent_limit= angle_p_gain= angle_d_gain= angle_dead_band= angle_boost= speed_p_gain= speed_i_gain= speed_dead_band= speed_i_limit= pwm_neutral= pwm_range= pwm_output_range= pwm_mode= angle_limit_cw= angle_limit_ccw= speed_limit_cw= speed_limit_ccw= torque_limit_cw= torque_limit_ccw= temperature_limit_high= temperature_limit_low= voltage_limit_high= voltage_limit_low= origin= servo_id= static_node_id= bootloader='

# _blactl_option COMMAND OPTION: sets `kind` if the option takes a value, and
# `value_words`.
_blactl_option() {
  case $1:$2 in
    *:--interface | *:-i | *:-[jqvyhV]i | *:-[jqvyhV][jqvyhV]i) kind='interface' ;;
    *:--node | *:-n | *:-[jqvyhV]n | *:-[jqvyhV][jqvyhV]n) kind='nodes' ;;
    *:--color) kind='word' value_words='auto always never' ;;
    *:--lang) kind='word' value_words='en ja' ;;
    *:--timeout) kind='seconds' ;;
    *:--retries) kind='whole' ;;
    *:--local-node-id) kind='whole' ;;
    *:--profile-dir) kind='folder' ;;
    *:--profile) kind='model' ;;
    *:--record) kind='file' ;;
    scan:--listen) kind='seconds' ;;
    scan:--expect) kind='whole' ;;
    alloc:--count) kind='whole' ;;
    alloc:--wait) kind='seconds' ;;
    alloc:--range) kind='text' ;;
    alloc:--assign) kind='text' ;;
    alloc:--id) kind='whole' ;;
    alloc:--forget) kind='suggested' value_words='absent all' ;;
    alloc:--export) kind='file' ;;
    alloc:--import) kind='file' ;;
    get:--group) kind='group' value_words='command status operation fault config control pwm limit option product production' ;;
    set:--wait) kind='seconds' ;;
    set:--stagger) kind='seconds' ;;
    save:--wait) kind='seconds' ;;
    save:--stagger) kind='seconds' ;;
    erase:--wait) kind='seconds' ;;
    erase:--stagger) kind='seconds' ;;
    restart:--wait) kind='seconds' ;;
    restart:--stagger) kind='seconds' ;;
    wait:--wait) kind='seconds' ;;
    faults:--level) kind='word' value_words='notice warning failure' ;;
    pwm-config:--neutral) kind='text' ;;
    pwm-config:--range) kind='text' ;;
    pwm-config:--output) kind='text' ;;
    pwm-config:--mode) kind='suggested' value_words='angle speed' ;;
    pwm-config:--endpoints) kind='text' ;;
    pwm-config:--preset) kind='whole' ;;
    pwm-config:--svg) kind='file' ;;
    pwm-config:--wait) kind='seconds' ;;
    pwm-config:--stagger) kind='seconds' ;;
    apply:--entry) kind='entry' ;;
    apply:--events) kind='file' ;;
    apply:--wait) kind='seconds' ;;
    apply:--stagger) kind='seconds' ;;
    replace:--wait) kind='seconds' ;;
    undo:--to) kind='whole' ;;
    undo:--wait) kind='seconds' ;;
    undo:--stagger) kind='seconds' ;;
    provision:--label) kind='text' ;;
    provision:--range) kind='text' ;;
    provision:--count) kind='whole' ;;
    provision:--idle-timeout) kind='seconds' ;;
    provision:--station) kind='text' ;;
    provision:--operator) kind='text' ;;
    provision:--work-order) kind='text' ;;
    provision:--reason) kind='text' ;;
    provision:--max-attempts) kind='whole' ;;
    provision:--stop-after) kind='whole' ;;
    provision:--events) kind='file' ;;
    provision:--logs) kind='folder' ;;
    ledger:--since) kind='text' ;;
    ledger:--until) kind='text' ;;
    ledger:--serial) kind='whole' ;;
    ledger:--verdict) kind='word' value_words='pass fail error skip scrap' ;;
    ledger:--work-order) kind='text' ;;
    ledger:--station) kind='text' ;;
    ledger:--scrap) kind='text' ;;
    ledger:--reason) kind='text' ;;
    ledger:--backup) kind='file' ;;
    monitor:--rate) kind='seconds' ;;
    monitor:--fields) kind='words' value_words='time angle_deg speed_rpm torque_pct temperature_c voltage_v mode health fault_summary stale moved' ;;
    monitor:--duration) kind='seconds' ;;
    monitor:--count) kind='whole' ;;
    command:--duration) kind='seconds' ;;
    command:--svg) kind='file' ;;
    trace:--type) kind='data_types' value_words='AccessCommandShell Allocation AngleOfAttack AngularCommand AppendEntries ArmingStatus ArrayCommand Auxiliary BatteryInfo BeepCommand Begin BeginFirmwareUpdate Broadcast Call CanStats CircuitStatus Command Delete Discovery ExecuteOpcode Fix Fix2 FlexDebug FuelTankStatus GEOPOICommand GetDataTypeInfo GetDirectoryEntryInfo GetInfo GetNodeInfo GetSet GetTransportStats GlobalNavigationSolution GlobalTime GlobalTimeSync Hygrometer IndicatedAirspeed Indication KeyValue LightsCommand LogMessage MagneticFieldStrength MagneticFieldStrength2 MagneticFieldStrengthHiRes Measurement NodeStatus Panic PrimaryPowerSupplyStatus RCInput RPM RPMCommand RTCMStream RawAirData RawCommand RawIMU Read RequestVote RestartNode SecureCommand SerialConfig Sideslip Solution StaticPressure StaticTemperature Stats StatusExtended Targetted Temperature TrueAirspeed Write actuator.Status camera_gimbal.Status esc.Status hardpoint.Status reciprocating.Status' ;;
    trace:--kind) kind='words' value_words='message request response' ;;
    trace:--duration) kind='seconds' ;;
    trace:--count) kind='whole' ;;
    doctor:--report) kind='file' ;;
    models:--group) kind='group' value_words='command status operation fault config control pwm limit option product production' ;;
    models:--search) kind='text' ;;
    sim:--facts) kind='file' ;;
    sim:--seed) kind='whole' ;;
    sim:--clock) kind='word' value_words='real virtual' ;;
  esac
}

# _blactl_argument COMMAND PLACE: the same for an argument.
_blactl_argument() {
  case $1:$2 in
    get:*) kind='parameter' ;;
    set:*) kind='assignment' ;;
    export:0) kind='file' ;;
    diff:*) kind='file' ;;
    apply:0) kind='file' ;;
    replace:0) kind='file' ;;
    replace:1) kind='entry' ;;
    provision:0) kind='file' ;;
    command:0) kind='beginning' value_words='angle= speed= torque=' ;;
    trace:0) kind='file' ;;
    characterize:0) kind='file' ;;
    models:*) kind='model_or_parameter' ;;
    sim:0) kind='file' ;;
  esac
}

_blactl_options() {
  echo '-i --interface -n --node -j --json --csv -q --quiet -v --verbose --color --lang -y --yes --timeout --retries --listen-only --local-node-id --while-driven --overwrite-rom --profile-dir --profile --record -h --help -V --version'
  case $1 in
    scan) echo '--listen --expect' ;;
    alloc) echo '--once --count --wait --range --assign --static --id --list --forget --export --import' ;;
    get) echo '--group --all --changed' ;;
    set) echo '--save --dry-run --wait --stagger' ;;
    save) echo '--wait --stagger' ;;
    erase) echo '--save --keep-ids --wait --stagger' ;;
    restart) echo '--wait --stagger' ;;
    wait) echo '--wait' ;;
    faults) echo '--level --watch' ;;
    pwm-config) echo '--neutral --range --output --mode --endpoints --preset --svg --save --dry-run --wait --stagger' ;;
    export) echo '--recipe --params' ;;
    apply) echo '--dry-run --plan --entry --no-save --trust-ram --fail-fast --events --no-snapshot --check --wait --stagger' ;;
    replace) echo '--dry-run --no-snapshot --wait' ;;
    undo) echo '--list --to --dry-run --no-save --wait --stagger' ;;
    provision) echo '--label --range --count --idle-timeout --station --operator --work-order --redo --reason --max-attempts --stop-after --events --logs' ;;
    ledger) echo '--since --until --serial --verdict --work-order --station --scrap --reason --check --backup' ;;
    monitor) echo '--rate --fields --duration --count --identify' ;;
    command) echo '--duration --wiggle --array --svg' ;;
    trace) echo '--type --kind --duration --count --stats --absolute' ;;
    doctor) echo '--fix --report' ;;
    models) echo '--group --search' ;;
    sim) echo '--facts --seed --clock' ;;
  esac
}

_blactl_offer_assignment() {
  case $cur in
    torque_output=*) _blactl_offer 'torque_output=on torque_output=off torque_output=brake' ;;
    soft_start=*) _blactl_offer 'soft_start=off soft_start=on' ;;
    smoothing=*) _blactl_offer 'smoothing=off smoothing=on' ;;
    reverse=*) _blactl_offer 'reverse=off reverse=on' ;;
    extended_angle=*) _blactl_offer 'extended_angle=off extended_angle=on' ;;
    speed_torque_control=*) _blactl_offer 'speed_torque_control=off speed_torque_control=on' ;;
    timeout_action=*) _blactl_offer 'timeout_action=hold timeout_action=off timeout_action=brake' ;;
    pwm_mode=*) _blactl_offer 'pwm_mode=angle pwm_mode=speed' ;;
    *=*) ;;
    *)
      _blactl_offer "$_blactl_settable"
      compopt -o nospace 2>/dev/null
      ;;
  esac
}

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

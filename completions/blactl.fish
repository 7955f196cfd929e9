# fish completion of blactl. Made by scripts/generate from the command table: do not edit.
# Nothing here asks the bus.

# The command, and its arguments so far.
function __blactl_words
    set -l words (commandline -opc)
    set -l value no
    for word in $words[2..]
        if test $value = yes
            set value no
        else if string match -qr -- '^(--(assign|backup|clock|color|count|duration|endpoints|entry|events|expect|export|facts|fields|forget|group|id|idle-timeout|import|interface|kind|label|lang|level|listen|local-node-id|logs|max-attempts|mode|neutral|node|operator|output|preset|profile|profile-dir|range|rate|reason|record|report|retries|scrap|search|seed|serial|since|stagger|station|stop-after|svg|timeout|to|type|until|verdict|wait|work-order)|-[jqvyhV]*[in])$' $word
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
        echo slcan:$entry
    end
end

# Without the option that a value may be glued to: --interface=sim
function __blactl_token
    string replace -r -- '^--[a-z-]+=' '' (commandline -ct)
end

# __blactl_files PREFIX: files behind a prefix such as "replay:".
function __blactl_files
    set -l typed (string replace -- $argv[1] '' (__blactl_token))
    printf "$argv[1]%s\n" (__fish_complete_path $typed)
end

function __blactl_interface
    switch (__blactl_token)
        case 'sim:*'
            __blactl_files sim:
        case 'replay:*'
            __blactl_files replay:
        case 'file:*'
            __blactl_files file:
        case '*'
            __blactl_can_interfaces /sys/class/net
            __blactl_serial_adapters /dev/serial/by-id
            printf '%s\n' mcast:0 sim: replay: file:
    end
end

# __blactl_list WORDS…: one or several with commas.
function __blactl_list
    set -l before (string match -r -- '^.*,' (__blactl_token))
    printf "$before%s\n" $argv
end

# The names of the entries in the fleet files of the line, after them.
function __blactl_entries
    for file in (commandline -opc)
        if string match -q -- '*.json' $file; and test -r $file
            grep -o '"name" *: *"[^"\\]*"' $file | sed 's/^"name" *: *"//; s/"$//'
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

function __blactl_models
    printf '%s\n' \
        BLA15-06U-A0 \
        BLA15-12U-A0 \
        BLA21-06U-A0 \
        BLA21-06U-AB \
        BLA21-12U-A0 \
        BLA21-12U-AB \
        BLA21-28U-A0 \
        BLA21-28U-AB \
        BLA34-12U-AB \
        BLA34-28U-AB
end

function __blactl_parameters
    printf '%s\n' \
        command_angle\t'Command Angle' \
        command_speed\t'Command Speed' \
        command_torque\t'Command Torque' \
        current_angle\t'Current Angle' \
        current_speed\t'Current Speed' \
        current_torque\t'Current Torque' \
        current_temperature\t'Current Temperature' \
        current_voltage\t'Current Voltage' \
        fault_summary\t'Occurrence Overview' \
        fault_notice\t'Notification Level Information' \
        fault_warning\t'Warning Level Information' \
        fault_failure\t'Failure Level Information' \
        torque_output\t'Torque ON/OFF' \
        soft_start\t'Soft Start ON/OFF' \
        smoothing\t'Smoothing ON/OFF' \
        reverse\t'Reverse ON/OFF' \
        extended_angle\t'Extended Angle Calculation ON/OFF' \
        speed_torque_control\t'Speed/Torque Control ON/OFF' \
        timeout_action\t'Timeout Operation' \
        timeout_time\t'Timeout detection time' \
        overcurrent_limit\t'Overcurrent protection Current value' \
        angle_p_gain\t'Angle Control Proportional Gain' \
        angle_d_gain\t'Angle Control Derivative Gain' \
        angle_dead_band\t'Angle Control Dead Band' \
        angle_boost\t'Angle control Boost' \
        speed_p_gain\t'Speed Control Proportional Gain' \
        speed_i_gain\t'Speed Control Integral Gain' \
        speed_dead_band\t'Speed Control Dead Band' \
        speed_i_limit\t'Speed Control Integral Limit' \
        pwm_neutral\t'Neutral Pulse Width' \
        pwm_range\t'Pulse width input range' \
        pwm_output_range\t'Command value output range (angle/speed)' \
        pwm_mode\t'Operation Mode' \
        angle_limit_cw\t'Operation Angle Limit CW' \
        angle_limit_ccw\t'Operation Angle Limit CCW' \
        speed_limit_cw\t'Operation Speed Limit CW' \
        speed_limit_ccw\t'Operation Speed Limit CCW' \
        torque_limit_cw\t'Operation Torque Limit CW' \
        torque_limit_ccw\t'Operation Torque Limit CCW' \
        temperature_limit_high\t'Operation Temperature Upper Limit' \
        temperature_limit_low\t'Operation Temperature Lower Limit' \
        voltage_limit_high\t'Operation Voltage Upper Limit' \
        voltage_limit_low\t'Operation Voltage Lower Limit' \
        origin\t'The Origin Point' \
        servo_id\t'Servo ID' \
        static_node_id\t'UAVCAN Node ID' \
        model_number\t'Model Number' \
        serial_number\t'Product Number' \
        firmware_version\t'Firmware version' \
        hardware_version\t'Hardware version' \
        production_year\t'Production year' \
        production_month\t'Production month' \
        production_day\t'Production day' \
        production_hour\t'Production hour' \
        production_minute\t'Production minute'
end

function __blactl_settable
    printf '%s\n' \
        command_angle=\t'Command Angle' \
        command_speed=\t'Command Speed' \
        command_torque=\t'Command Torque' \
        torque_output=\t'Torque ON/OFF' \
        soft_start=\t'Soft Start ON/OFF' \
        smoothing=\t'Smoothing ON/OFF' \
        reverse=\t'Reverse ON/OFF' \
        extended_angle=\t'Extended Angle Calculation ON/OFF' \
        speed_torque_control=\t'Speed/Torque Control ON/OFF' \
        timeout_action=\t'Timeout Operation' \
        timeout_time=\t'Timeout detection time' \
        overcurrent_limit=\t'Overcurrent protection Current value' \
        angle_p_gain=\t'Angle Control Proportional Gain' \
        angle_d_gain=\t'Angle Control Derivative Gain' \
        angle_dead_band=\t'Angle Control Dead Band' \
        angle_boost=\t'Angle control Boost' \
        speed_p_gain=\t'Speed Control Proportional Gain' \
        speed_i_gain=\t'Speed Control Integral Gain' \
        speed_dead_band=\t'Speed Control Dead Band' \
        speed_i_limit=\t'Speed Control Integral Limit' \
        pwm_neutral=\t'Neutral Pulse Width' \
        pwm_range=\t'Pulse width input range' \
        pwm_output_range=\t'Command value output range (angle/speed)' \
        pwm_mode=\t'Operation Mode' \
        angle_limit_cw=\t'Operation Angle Limit CW' \
        angle_limit_ccw=\t'Operation Angle Limit CCW' \
        speed_limit_cw=\t'Operation Speed Limit CW' \
        speed_limit_ccw=\t'Operation Speed Limit CCW' \
        torque_limit_cw=\t'Operation Torque Limit CW' \
        torque_limit_ccw=\t'Operation Torque Limit CCW' \
        temperature_limit_high=\t'Operation Temperature Upper Limit' \
        temperature_limit_low=\t'Operation Temperature Lower Limit' \
        voltage_limit_high=\t'Operation Voltage Upper Limit' \
        voltage_limit_low=\t'Operation Voltage Lower Limit' \
        origin=\t'The Origin Point' \
        servo_id=\t'Servo ID' \
        static_node_id=\t'UAVCAN Node ID' \
        bootloader=\t'Boot loader'
end

function __blactl_assignments
    switch (commandline -ct)
        case 'torque_output=*'
            printf 'torque_output=%s\n' on off brake
        case 'soft_start=*'
            printf 'soft_start=%s\n' off on
        case 'smoothing=*'
            printf 'smoothing=%s\n' off on
        case 'reverse=*'
            printf 'reverse=%s\n' off on
        case 'extended_angle=*'
            printf 'extended_angle=%s\n' off on
        case 'speed_torque_control=*'
            printf 'speed_torque_control=%s\n' off on
        case 'timeout_action=*'
            printf 'timeout_action=%s\n' hold off brake
        case 'pwm_mode=*'
            printf 'pwm_mode=%s\n' angle speed
        case '*=*'
        case '*'
            __blactl_settable
    end
end

complete -c blactl -f
complete -c blactl -n __blactl_needs_command -a scan -d 'find every node and identify BLA servos'
complete -c blactl -n __blactl_needs_command -a alloc -d 'give node IDs to servos that ask for one'
complete -c blactl -n __blactl_needs_command -a get -d 'read parameters'
complete -c blactl -n __blactl_needs_command -a set -d 'check against the servo\'s model, write, read back'
complete -c blactl -n __blactl_needs_command -a save -d 'RAM to ROM: restarts the servo, and reads again'
complete -c blactl -n __blactl_needs_command -a erase -d 'RAM to factory defaults, IDs included (ROM only with --save)'
complete -c blactl -n __blactl_needs_command -a restart -d 'restart: RAM from ROM'
complete -c blactl -n __blactl_needs_command -a wait -d 'until the servos are there and operational'
complete -c blactl -n __blactl_needs_command -a faults -d 'what is wrong with servos, and what to do'
complete -c blactl -n __blactl_needs_command -a pwm-config -d 'how PWM pulses become commands: show, plot, change'
complete -c blactl -n __blactl_needs_command -a export -d 'the configuration of servos as a file for apply'
complete -c blactl -n __blactl_needs_command -a diff -d 'servos against a fleet file, or file against file'
complete -c blactl -n __blactl_needs_command -a apply -d 'bring servos to a fleet file, proven after a restart'
complete -c blactl -n __blactl_needs_command -a replace -d 'give a new servo the place of a broken one, and name it in the fleet file'
complete -c blactl -n __blactl_needs_command -a undo -d 'back to what servos held before the last change'
complete -c blactl -n __blactl_needs_command -a provision -d 'a production line: check, number, configure, prove and record each servo'
complete -c blactl -n __blactl_needs_command -a ledger -d 'the records of a production line'
complete -c blactl -n __blactl_needs_command -a monitor -d 'live values of servos: a table, graphs, or a stream'
complete -c blactl -n __blactl_needs_command -a command -d 'moves one servo for a bounded time, and shows how it follows'
complete -c blactl -n __blactl_needs_command -a trace -d 'every DroneCAN transfer decoded, live or from a log; sends nothing'
complete -c blactl -n __blactl_needs_command -a doctor -d 'problems of interface, bus and nodes, and how to fix them'
complete -c blactl -n __blactl_needs_command -a characterize -d 'measures on one servo what the specification leaves open, and restores it'
complete -c blactl -n __blactl_needs_command -a models -d 'what the profiles know, without any servo'
complete -c blactl -n __blactl_needs_command -a sim -d 'simulated servos: serves the sim: bus, or joins a real interface with -i'
complete -c blactl -s i -l interface -r -f -a '(__blactl_interface)' -d 'can0, slcan:DEV, mcast:N, sim:, sim:SCENARIO.json, replay:FILE, file:FLEET.json (default: the only CAN interface that is up)'
complete -c blactl -s n -l node -r -f -a '(__blactl_nodes)' -d 'servos'
complete -c blactl -s j -l json -d 'output as one JSON document; streams'
complete -c blactl -l csv -d 'output as CSV (scan, get, monitor, command)'
complete -c blactl -s q -l quiet -d 'no notes on stderr'
complete -c blactl -s v -l verbose -d 'on stderr'
complete -c blactl -l color -r -f -a 'auto always never' -d 'colour of states, warnings and errors'
complete -c blactl -l lang -r -f -a 'en ja' -d 'language of messages (default: of the locale)'
complete -c blactl -s y -l yes -d 'agree to questions beforehand'
complete -c blactl -l timeout -r -f -d 'how long an answer may take (default 0.5)'
complete -c blactl -l retries -r -f -d 'how often a request is repeated (default 2)'
complete -c blactl -l listen-only -d 'send nothing, take no node ID'
complete -c blactl -l local-node-id -r -f -d 'own node ID (default 127, else 126)'
complete -c blactl -l while-driven -d 'even while another node drives the servo'
complete -c blactl -l overwrite-rom -d 'save although the servo could not read its ROM'
complete -c blactl -l profile-dir -r -f -a '(__fish_complete_directories (__blactl_token))' -d 'further model profiles'
complete -c blactl -l profile -r -f -a '(__blactl_models)' -d 'read as this model if no profile fits'
complete -c blactl -l record -r -F -d 'write every frame to a candump log'
complete -c blactl -s h -l help -d 'this text, and the options of a command'
complete -c blactl -s V -l version -d 'name and version'

complete -c blactl -n '__blactl_in scan' -l listen -r -f -d 'how long to listen (default 1.2)'
complete -c blactl -n '__blactl_in scan' -l expect -r -f -d 'fail unless this many servos are found'

complete -c blactl -n '__blactl_in alloc' -l once -d 'end when no unit asks any more'
complete -c blactl -n '__blactl_in alloc' -l count -r -f -d 'end when this many units have their node ID'
complete -c blactl -n '__blactl_in alloc' -l wait -r -f -d 'with --once'
complete -c blactl -n '__blactl_in alloc' -l range -r -f -d 'take new node IDs from these (default 1-125, from the top); with --static: bring all into it, by serial number'
complete -c blactl -n '__blactl_in alloc' -l assign -r -f -d 'this servo (uid:, serial:, servo:) gets this node ID from now on'
complete -c blactl -n '__blactl_in alloc' -l static -d 'make the node IDs of the servos behind -n permanent, or those that --id or --assign say (save, restart, proof)'
complete -c blactl -n '__blactl_in alloc' -l id -r -f -d 'with --static and one servo'
complete -c blactl -n '__blactl_in alloc' -l list -d 'show the table, without a bus'
complete -c blactl -n '__blactl_in alloc' -l forget -r -f -a 'absent all' -d 'drop from the table'
complete -c blactl -n '__blactl_in alloc' -l export -r -F -d 'write the table to a file, - for stdout'
complete -c blactl -n '__blactl_in alloc' -l import -r -F -d 'take over the entries of such a file'

complete -c blactl -n '__blactl_in get' -l group -r -f -a 'command status operation fault config control pwm limit option product production' -d 'all of a group'
complete -c blactl -n '__blactl_in get' -l all -d 'every parameter (as without PARAM)'
complete -c blactl -n '__blactl_in get' -l changed -d 'only what differs from the model\'s default'
complete -c blactl -n '__blactl_in get' -f -a '(__blactl_parameters)'

complete -c blactl -n '__blactl_in set' -l save -d 'then RAM to ROM'
complete -c blactl -n '__blactl_in set' -l dry-run -d 'change nothing; exit status 8 when something would change'
complete -c blactl -n '__blactl_in set' -l wait -r -f -d 'how long a servo may take to come back (default 5, and 2 for each that asks for a node ID)'
complete -c blactl -n '__blactl_in set' -l stagger -r -f -d 'pause between two servos (default 0)'
complete -c blactl -n '__blactl_in set' -f -a '(__blactl_assignments)'

complete -c blactl -n '__blactl_in save' -l wait -r -f -d 'how long a servo may take to come back (default 5, and 2 for each that asks for a node ID)'
complete -c blactl -n '__blactl_in save' -l stagger -r -f -d 'pause between two servos (default 0)'

complete -c blactl -n '__blactl_in erase' -l save -d 'then RAM to ROM'
complete -c blactl -n '__blactl_in erase' -l keep-ids -d 'servo_id and static_node_id stay'
complete -c blactl -n '__blactl_in erase' -l wait -r -f -d 'how long a servo may take to come back (default 5, and 2 for each that asks for a node ID)'
complete -c blactl -n '__blactl_in erase' -l stagger -r -f -d 'pause between two servos (default 0)'

complete -c blactl -n '__blactl_in restart' -l wait -r -f -d 'how long a servo may take to come back (default 5, and 2 for each that asks for a node ID)'
complete -c blactl -n '__blactl_in restart' -l stagger -r -f -d 'pause between two servos (default 0)'

complete -c blactl -n '__blactl_in wait' -l wait -r -f -d 'how long to wait (default 10)'

complete -c blactl -n '__blactl_in faults' -l level -r -f -a 'notice warning failure' -d 'only faults of this level and above; they make the exit status 8 (default: all are shown, warning and above make it 8)'
complete -c blactl -n '__blactl_in faults' -l watch -d 'goes on until Ctrl-C'

complete -c blactl -n '__blactl_in pwm-config' -l neutral -r -f -d 'the pulse that gives 0'
complete -c blactl -n '__blactl_in pwm-config' -l range -r -f -d 'how far pulses go to either side'
complete -c blactl -n '__blactl_in pwm-config' -l output -r -f -d 'what the ends of the range give, to either side'
complete -c blactl -n '__blactl_in pwm-config' -l mode -r -f -a 'angle speed' -d 'angle or speed (0x37), with --output in deg or rpm'
complete -c blactl -n '__blactl_in pwm-config' -l endpoints -r -f -d 'neutral, range, output and mode from two points'
complete -c blactl -n '__blactl_in pwm-config' -l preset -r -f -d 'all four by an example of the specification'
complete -c blactl -n '__blactl_in pwm-config' -l svg -r -F -d 'draws the mapping of one servo into FILE, for a browser or a printer'
complete -c blactl -n '__blactl_in pwm-config' -l save -d 'then RAM to ROM'
complete -c blactl -n '__blactl_in pwm-config' -l dry-run -d 'change nothing, show the mapping before and after; exit status 8 when something would change'
complete -c blactl -n '__blactl_in pwm-config' -l wait -r -f -d 'how long a servo may take to come back (default 5, and 2 for each that asks for a node ID)'
complete -c blactl -n '__blactl_in pwm-config' -l stagger -r -f -d 'pause between two servos (default 0)'

complete -c blactl -n '__blactl_in export' -l recipe -d 'of one servo, for others of its model'
complete -c blactl -n '__blactl_in export' -l params -d 'of one servo, as the parameter file that the DroneCAN GUI Tool and Mission Planner load'
complete -c blactl -n '__blactl_argument export 1' -F

complete -c blactl -n '__blactl_in diff' -F

complete -c blactl -n '__blactl_in apply' -l dry-run -d 'change nothing; exit status 8 when something would be done'
complete -c blactl -n '__blactl_in apply' -l plan -d 'FILE is what `apply --dry-run --json` printed'
complete -c blactl -n '__blactl_in apply' -l entry -r -f -a '(__blactl_entries)' -d 'give this entry to the servo behind -n, whatever it matches'
complete -c blactl -n '__blactl_in apply' -l no-save -d 'RAM only'
complete -c blactl -n '__blactl_in apply' -l trust-ram -d 'if RAM is as wished, do not restart to check ROM'
complete -c blactl -n '__blactl_in apply' -l fail-fast -d 'once one servo is known to have failed, no other is saved any more'
complete -c blactl -n '__blactl_in apply' -l events -r -F -d 'write a line of JSON to FILE for each servo and stage'
complete -c blactl -n '__blactl_in apply' -l no-snapshot -d 'go on even if the settings of servos cannot be recorded for `undo`'
complete -c blactl -n '__blactl_in apply' -l check -d 'only check FILE against the models, without a bus'
complete -c blactl -n '__blactl_in apply' -l wait -r -f -d 'how long a servo may take to come back (default 5, and 2 for each that asks for a node ID)'
complete -c blactl -n '__blactl_in apply' -l stagger -r -f -d 'pause between two servos (default 0)'
complete -c blactl -n '__blactl_argument apply 1' -F

complete -c blactl -n '__blactl_in replace' -l dry-run -d 'change nothing; exit status 8 when something would be done'
complete -c blactl -n '__blactl_in replace' -l no-snapshot -d 'go on even if the settings of the servo cannot be recorded for `undo`'
complete -c blactl -n '__blactl_in replace' -l wait -r -f -d 'how long a servo may take to come back (default 5, and 2 for each that asks for a node ID)'
complete -c blactl -n '__blactl_argument replace 1' -F
complete -c blactl -n '__blactl_argument replace 2' -f -a '(__blactl_entries)'

complete -c blactl -n '__blactl_in undo' -l list -d 'show the changes that are recorded, without a bus'
complete -c blactl -n '__blactl_in undo' -l to -r -f -d 'before the command with this number of --list'
complete -c blactl -n '__blactl_in undo' -l dry-run -d 'change nothing; exit status 8 when something would be done'
complete -c blactl -n '__blactl_in undo' -l no-save -d 'RAM only, also where the change was saved'
complete -c blactl -n '__blactl_in undo' -l wait -r -f -d 'how long a servo may take to come back (default 5, and 2 for each that asks for a node ID)'
complete -c blactl -n '__blactl_in undo' -l stagger -r -f -d 'pause between two servos (default 0)'

complete -c blactl -n '__blactl_in provision' -l label -r -f -d 'read a line for each servo'
complete -c blactl -n '__blactl_in provision' -l range -r -f -d 'node IDs lent to servos that ask for one (default 100-124)'
complete -c blactl -n '__blactl_in provision' -l count -r -f -d 'end after this many servos'
complete -c blactl -n '__blactl_in provision' -l idle-timeout -r -f -d 'end when no servo comes for this long'
complete -c blactl -n '__blactl_in provision' -l station -r -f -d 'for the records (default: the name of this machine)'
complete -c blactl -n '__blactl_in provision' -l operator -r -f -d 'for the records'
complete -c blactl -n '__blactl_in provision' -l work-order -r -f -d 'for the records'
complete -c blactl -n '__blactl_in provision' -l redo -d 'do finished servos anew, with the IDs they have'
complete -c blactl -n '__blactl_in provision' -l reason -r -f -d 'with --redo'
complete -c blactl -n '__blactl_in provision' -l max-attempts -r -f -d 'how often a servo may fail (default 3)'
complete -c blactl -n '__blactl_in provision' -l stop-after -r -f -d 'end when this many fail in a row'
complete -c blactl -n '__blactl_in provision' -l events -r -F -d 'write what happens to a file or a pipe, for a lamp or a controller'
complete -c blactl -n '__blactl_in provision' -l logs -r -f -a '(__fish_complete_directories (__blactl_token))' -d 'keep the frames of every servo that did not pass, named by its record_id'
complete -c blactl -n '__blactl_argument provision 1' -F

complete -c blactl -n '__blactl_in ledger' -l since -r -f -d 'records that ended at this time or later (RFC 3339)'
complete -c blactl -n '__blactl_in ledger' -l until -r -f -d 'records that ended before this time'
complete -c blactl -n '__blactl_in ledger' -l serial -r -f -d 'records of this serial number'
complete -c blactl -n '__blactl_in ledger' -l verdict -r -f -a 'pass fail error skip scrap' -d 'records with this verdict'
complete -c blactl -n '__blactl_in ledger' -l work-order -r -f -d 'records of this work order'
complete -c blactl -n '__blactl_in ledger' -l station -r -f -d 'records of this station; with --scrap'
complete -c blactl -n '__blactl_in ledger' -l scrap -r -f -d 'take the servo of this record_id out, and free its IDs'
complete -c blactl -n '__blactl_in ledger' -l reason -r -f -d 'with --scrap'
complete -c blactl -n '__blactl_in ledger' -l check -d 'look for damage, missing records, and work that has not ended'
complete -c blactl -n '__blactl_in ledger' -l backup -r -F -d 'copy the ledger into a new file, and the IDs that were given into FILE.counters'

complete -c blactl -n '__blactl_in monitor' -l rate -r -f -d 'samples of each servo a second (default 2)'
complete -c blactl -n '__blactl_in monitor' -l fields -r -f -a '(__blactl_list time angle_deg speed_rpm torque_pct temperature_c voltage_v mode health fault_summary stale moved)' -d 'only these; what is not shown is not asked for'
complete -c blactl -n '__blactl_in monitor' -l duration -r -f -d 'end after this time'
complete -c blactl -n '__blactl_in monitor' -l count -r -f -d 'end after this many samples'
complete -c blactl -n '__blactl_in monitor' -l identify -d 'takes torque off, after a yes'

complete -c blactl -n '__blactl_in command' -l duration -r -f -d 'for how long it is commanded (default 2)'
complete -c blactl -n '__blactl_in command' -l wiggle -d 'to and fro by 5 deg, to show which servo it is'
complete -c blactl -n '__blactl_in command' -l array -d 'by ArrayCommand to its servo ID, as an autopilot does; only if no other servo has that ID'
complete -c blactl -n '__blactl_in command' -l svg -r -F -d 'draws command, angle, speed, torque and limits into FILE, for a browser or a printer'
complete -c blactl -n '__blactl_argument command 1' -f -a 'angle= speed= torque='

complete -c blactl -n '__blactl_in trace' -l type -r -f -a '(__blactl_list AccessCommandShell Allocation AngleOfAttack AngularCommand AppendEntries ArmingStatus ArrayCommand Auxiliary BatteryInfo BeepCommand Begin BeginFirmwareUpdate Broadcast Call CanStats CircuitStatus Command Delete Discovery ExecuteOpcode Fix Fix2 FlexDebug FuelTankStatus GEOPOICommand GetDataTypeInfo GetDirectoryEntryInfo GetInfo GetNodeInfo GetSet GetTransportStats GlobalNavigationSolution GlobalTime GlobalTimeSync Hygrometer IndicatedAirspeed Indication KeyValue LightsCommand LogMessage MagneticFieldStrength MagneticFieldStrength2 MagneticFieldStrengthHiRes Measurement NodeStatus Panic PrimaryPowerSupplyStatus RCInput RPM RPMCommand RTCMStream RawAirData RawCommand RawIMU Read RequestVote RestartNode SecureCommand SerialConfig Sideslip Solution StaticPressure StaticTemperature Stats StatusExtended Targetted Temperature TrueAirspeed Write actuator.Status camera_gimbal.Status esc.Status hardpoint.Status reciprocating.Status)' -d 'only these data types'
complete -c blactl -n '__blactl_in trace' -l kind -r -f -a '(__blactl_list message request response)' -d 'only these kinds'
complete -c blactl -n '__blactl_in trace' -l duration -r -f -d 'how long to listen; of a log its first seconds'
complete -c blactl -n '__blactl_in trace' -l count -r -f -d 'end after this many transfers'
complete -c blactl -n '__blactl_in trace' -l stats -d 'instead of the transfers'
complete -c blactl -n '__blactl_in trace' -l absolute -d 'the time of day instead of seconds since the first frame'
complete -c blactl -n '__blactl_argument trace 1' -F

complete -c blactl -n '__blactl_in doctor' -l fix -d 'set up the CAN interface and bring it up, if something about it is wrong, after a question'
complete -c blactl -n '__blactl_in doctor' -l report -r -F -d 'write all of it to one file for the support'

complete -c blactl -n '__blactl_argument characterize 1' -F

complete -c blactl -n '__blactl_in models' -l group -r -f -a 'command status operation fault config control pwm limit option product production' -d 'the parameters of these groups only'
complete -c blactl -n '__blactl_in models' -l search -r -f -d 'the parameters with this in their name or explanation, English or Japanese'
complete -c blactl -n '__blactl_in models' -f -a '(__blactl_models; __blactl_parameters)'

complete -c blactl -n '__blactl_in sim' -l facts -r -F -d 'how servos behave, as measured on real ones'
complete -c blactl -n '__blactl_in sim' -l seed -r -f -d 'the seed of everything random'
complete -c blactl -n '__blactl_in sim' -l clock -r -f -a 'real virtual' -d 'the clock (default: as the scenario says)'
complete -c blactl -n '__blactl_argument sim 1' -F

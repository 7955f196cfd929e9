# shellcheck shell=bash
# For tests that run a program on vcan0 under uml.sh: `. "$(dirname "$0")/lib.sh"`.
# The first expectation that does not hold ends the script with status 1 and says where and why.

status=0
out=''
err=''
command_line=''
witness=''
witness_log=''
witness_interface=''

# note TEXT: what the lines that follow are about.
note() {
  echo "-- $*"
}

# fail TEXT: ends the test, naming the line of the test script, and what the last command said.
fail() {
  local depth=0
  while [ "${BASH_SOURCE[depth]}" = "${BASH_SOURCE[0]}" ]; do
    depth=$((depth + 1))
  done
  echo "FAILED ${BASH_SOURCE[depth]}:${BASH_LINENO[depth - 1]}: $*"
  if [ -n "$command_line" ]; then
    printf 'command: %s\nstatus: %s\nstdout: %s\nstderr: %s\n' \
      "$command_line" "$status" "$out" "$err"
  fi
  exit 1
}

# run COMMAND...: sets $status, $out and $err.
run() {
  local errors
  errors=$(mktemp)
  command_line=$*
  out=$("$@" 2>"$errors")
  status=$?
  err=$(cat "$errors")
  rm -f "$errors"
}

# expect_status N: the exit status of the last run.
expect_status() {
  [ "$status" -eq "$1" ] || fail "expected exit status $1, got $status"
}

# expect_out TEXT, expect_err TEXT: the last run printed TEXT on stdout, on stderr.
expect_out() {
  case $out in *"$1"*) ;; *) fail "expected on stdout: $1" ;; esac
}

expect_err() {
  case $err in *"$1"*) ;; *) fail "expected on stderr: $1" ;; esac
}

# wait_for SECONDS COMMAND...: until COMMAND succeeds; fails the test when it does not in time.
wait_for() {
  local end=$((SECONDS + $1))
  shift
  until "$@" >/dev/null 2>&1; do
    [ $SECONDS -lt $end ] || fail "waited in vain for: $*"
    sleep 0.05
  done
}

# mark DATA: until the witness has seen a frame of standard ID 7FF with these two hex digits.
# Frames stay in order, so it then has seen all that came before; DroneCAN never uses such IDs.
mark() {
  cansend "$witness_interface" "7FF#$1" && sleep 0.05 && grep -q " 7FF#$1" "$witness_log"
}

# witness_start [INTERFACE]: from now on candump writes every frame to $witness_log, error frames
# included, as "(seconds) vcan0 1401552A#D2040000".
witness_start() {
  witness_interface=${1:-vcan0}
  witness_log=$(mktemp)
  candump -r 8388608 -L "$witness_interface,0:0,#FFFFFFFF" >"$witness_log" &
  witness=$!
  wait_for 10 mark 00
}

# witness_stop: the log is complete up to now.
witness_stop() {
  wait_for 10 mark FF
  kill "$witness"
  wait "$witness" 2>/dev/null
  witness=''
}

# frames_with ID-PATTERN: how many frames of the log have an ID that agrees with this extended
# regular expression as a whole: frames_with '..01551F'.
frames_with() {
  awk -v pattern="^($1)#" '$3 ~ pattern { ++n } END { print n + 0 }' "$witness_log"
}

# expect_frames N ID-PATTERN: that many of them.
expect_frames() {
  local count
  count=$(frames_with "$2")
  [ "$count" -eq "$1" ] || fail "expected $1 frames with ID $2, the witness saw $count"
}

# expect_answered N REQUESTS RESPONSES: at least that many requests of one frame each, and as many
# responses, whose frames have the other ID.
expect_answered() {
  local requests responses
  requests=$(frames_with "$2")
  [ "$requests" -ge "$1" ] || fail "expected $1 requests with ID $2, the witness saw $requests"
  responses=$(awk -v pattern="^($3)#.*[89A-F].$" '$3 ~ pattern { ++n } END { print n + 0 }' "$witness_log")
  [ "$responses" -eq "$requests" ] || fail "of $requests requests with ID $2 $responses were answered"
}

# codes LIST: those of "findings" or "fixed" in the document of the last run, in its order.
codes() {
  echo "$out" | awk -v list="\"$1\": [" -F '"' '
    index($0, list) { inside = 1 }
    inside && $2 == "code" { printf "%s%s", between, $4; between = " " }
    /\]/ { inside = 0 }'
}

# expect_codes LIST CODE...: just these.
expect_codes() {
  [ "$(codes "$1")" = "${*:2}" ] || fail "expected in $1: ${*:2}; got $(codes "$1")"
}

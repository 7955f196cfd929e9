#!/bin/bash
# The same seeds give the same words, byte for byte, in one process or several: repeatable.sh CAMPAIGN
set -euo pipefail

words() {
  "$1" --seed 77 --episodes 40 --verbose "${@:2}"
}

first=$(words "$1")
second=$(words "$1")
[[ -n $first ]]
diff <(echo "$first") <(echo "$second")
# Jobs print side by side; what they counted is the same.
diff <(grep -A 99 ' runs in ' <<<"$first") <(words "$1" --jobs 3 | grep -A 99 ' runs in ')

# shellcheck shell=bash disable=SC2034
# For the scripts beside it: packages, texts, timed steps. All of them work in the top folder.

cd "$(dirname "${BASH_SOURCE[0]}")/.." || exit
root=$PWD
CMAKE_BUILD_PARALLEL_LEVEL=$(nproc)
export CMAKE_BUILD_PARALLEL_LEVEL

bold='' dim='' red='' plain=''
if [[ -t 1 && -z ${NO_COLOR:-} ]]; then
  bold=$'\e[1m' dim=$'\e[2m' red=$'\e[31m' plain=$'\e[0m'
fi

build_packages=(g++ cmake ninja-build pkg-config
                libcli11-dev nlohmann-json3-dev libfmt-dev libnl-route-3-dev
                libsqlite3-dev zlib1g-dev libmd-dev libncurses-dev)

say() {
  printf '%s\n' "$*"
}

die() {
  printf '%s: %s\n' "${0##*/}" "$*" >&2
  exit 1
}

## Packages

missing_packages() {
  local have package
  have=$(dpkg-query -W -f '${Package} ${db:Status-Status}\n' "$@" 2>/dev/null) || true
  for package; do
    grep -qxF "$package installed" <<<"$have" || echo "$package"
  done
}

# as_root COMMAND…: without a terminal nobody can type a password, so sudo must not ask for one.
as_root() {
  if ((EUID == 0)); then
    "$@"
  elif [[ -t 0 ]]; then
    sudo "$@"
  else
    sudo -n "$@"
  fi
}

apt_get() {
  local log
  log=$(mktemp)
  if ! as_root env DEBIAN_FRONTEND=noninteractive apt-get -qq -o Acquire::Retries=3 \
       -o DPkg::Lock::Timeout=120 "$@" >"$log" 2>&1; then
    cat "$log" >&2
    rm -f "$log"
    die "'apt-get $*' failed"
  fi
  rm -f "$log"
}

lists_are_fresh=''
refresh_lists() {
  if ((EUID != 0)) && ! command -v sudo >/dev/null; then
    die "needs root or sudo to install what is missing; as root: apt-get install $*"
  fi
  if [[ -z $lists_are_fresh ]]; then
    apt_get update
    lists_are_fresh=yes
  fi
}

# install_missing PACKAGES…: asks apt-get for nothing that is there already.
install_missing() {
  if ! command -v dpkg-query >/dev/null || ! command -v apt-get >/dev/null; then
    die "installs packages on Debian 12 and its relatives only; this system has no apt-get." \
        "By their Debian names it needs: $*"
  fi
  local missing
  mapfile -t missing < <(missing_packages "$@")
  if ((${#missing[@]})); then
    say "== installing ${missing[*]}"
    refresh_lists "${missing[@]}"
    apt_get install -y --no-install-recommends "${missing[@]}"
  fi
}

# install_available PACKAGES…: the same, without those that this distribution does not have.
install_available() {
  local missing package available=()
  mapfile -t missing < <(missing_packages "$@")
  if ((${#missing[@]})); then
    refresh_lists "${missing[@]}"
    for package in "${missing[@]}"; do
      if apt-cache show "$package" >/dev/null 2>&1; then
        available+=("$package")
      fi
    done
    install_missing "${available[@]}"
  fi
}

## Steps

logs=$root/build/log
failed_steps=()

# step NAME COMMAND…: one line with the outcome and the duration; all output when it fails.
step() {
  local name=$1 begin=$SECONDS status=0
  local log=$logs/${name// /-}.log line="== $1 ... "
  shift
  mkdir -p "$logs"
  printf '%s' "$line"
  if [[ -t 1 ]]; then
    "$@" 2>&1 </dev/null | tee "$log" | show_progress || status=${PIPESTATUS[0]}
    printf '\r%s\e[K' "$line"
  else
    "$@" >"$log" 2>&1 </dev/null || status=$?
  fi
  if ((status == 0)); then
    say "ok, $((SECONDS - begin)) s"
  else
    say "${red}failed${plain} (exit status $status), $((SECONDS - begin)) s"
    cat "$log"
    failed_steps+=("$name")
  fi
  return "$status"
}

# The counters of ninja, ctest and clang-tidy, in place.
show_progress() {
  local output
  while IFS= read -r output; do
    if [[ $output =~ ^\[?\ *[0-9]+/[0-9]+ ]]; then
      printf '\r%s%s]\e[K' "$line" "[${BASH_REMATCH[0]#[}"
    fi
  done
}

# build PRESET [OPTIONS…]
build() {
  cmake --preset "$1" && cmake --build --preset "$@"
}

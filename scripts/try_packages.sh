#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tries the packages as a stranger would: in roots of other distributions, with no compiler and nothing of this
# checkout. Each runs `crossnav demo` from the wheel, then from the .deb.
#   scripts/try_packages.sh NAME|ROOT...      e.g. bookworm trixie noble; Debian 12, 13 and Ubuntu 24.04
# NAME is made by debootstrap in build/roots, where it is not there yet; ROOT is a folder with python3-venv.
# Wheels come from build/portable, the package from build/release. Needs to be root, for chroot.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
mapfile -t pip_settings < <(env | grep '^PIP_' || true)
seconds() { printf '%s s: %s\n' "$SECONDS" "$*"; }

# make_root NAME FOLDER: Ubuntu's suites have one script, and python3-venv is in its `universe`.
make_root() {
  local options=(--variant=minbase --include=python3,python3-venv,ca-certificates) script=()
  case $1 in
    jammy | noble)
      options+=(--components=main,universe)
      [[ -e /usr/share/keyrings/ubuntu-archive-keyring.gpg ]] || options+=(--no-check-gpg)
      script=("" /usr/share/debootstrap/scripts/gutsy) ;;
  esac
  rm -rf "$2.part"
  mkdir -p "$(dirname "$2")"
  debootstrap "${options[@]}" "$1" "$2.part" "${script[@]}" >"$2.log" 2>&1 || {
    tail -n 3 "$2.log" >&2
    echo "try_packages: no root of $1" >&2
    return 1
  }
  mv "$2.part" "$2"
}

inside() {
  chroot "$target" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 \
    "${pip_settings[@]}" PIP_FIND_LINKS= "$@"
}

# Copies this machine's settings of pip and the packages into the root.
furnish() {
  rm -rf "$target/try" && mkdir "$target/try"
  cp "$root"/build/portable/*.whl "$target/try/"
  cp "$root"/build/release/*.deb "$target/try/"
  cp /etc/resolv.conf "$target/etc/resolv.conf"
  [[ ! -e /etc/ssl/certs/ca-certificates.crt ]] ||
    cp /etc/ssl/certs/ca-certificates.crt "$target/etc/ssl/certs/"
  [[ ! -e /etc/pip.conf ]] || cp /etc/pip.conf "$target/etc/pip.conf"
}

try_wheel() {
  inside python3 -m venv /try/venv
  wheel=$(inside sh -c 'cd /try; /try/venv/bin/pip download -q --no-deps --no-index -d /try/fits --find-links /try crossnav >&2; ls fits/*.whl')
  inside /try/venv/bin/pip install -q "/try/$wheel[gym,openvino]"
  seconds "installed $wheel"
  inside sh -c 'cd /try && venv/bin/crossnav demo --quiet --out wheel-demo | tail -n 12'
  seconds "crossnav demo from the wheel"
  inside /try/venv/bin/crossnav networks check crossnav_small
  inside /try/venv/bin/python -c 'import gymnasium
env = gymnasium.make("crossnav.gym:crossnav/CrossFloorNav-v0", config={"sensor.width_px": 64, "sensor.height_px": 64})
print("gymnasium:", sorted(env.reset(seed=1)[0]))'
}

try_deb() {
  inside sh -c 'dpkg -i /try/*.deb >/dev/null && cd /try && crossnav demo --quiet --out deb-demo | tail -n 3'
  inside sh -c 'CROSSNAV_OPENVINO=$(echo /try/venv/lib/python3*/site-packages/openvino/libs) crossnav networks check crossnav_small'
  inside sh -c 'crossnav networks list | grep openvino; dpkg -r crossnav >/dev/null'
  seconds "crossnav demo from the .deb"
}

# In a shell of its own, so that /proc is left as it was found whatever happens.
try_root() (
  target=$(cd "$1" && pwd)
  SECONDS=0
  furnish
  mountpoint -q "$target/proc" || { mount -t proc proc "$target/proc"; trap 'umount "$target/proc"' EXIT; }
  inside sh -c '. /etc/os-release; echo "$PRETTY_NAME, $(python3 --version)"; ! command -v g++ gcc cc c++'
  try_wheel
  try_deb
)

[[ $# -gt 0 ]] || { echo "try_packages: name a root, e.g. trixie" >&2; exit 2; }
for name in "$@"; do
  folder=$name
  if [[ ! -d $folder ]]; then
    folder=$root/build/roots/$name
    [[ -d $folder ]] || make_root "$name" "$folder"
  fi
  try_root "$folder"
done

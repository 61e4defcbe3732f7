#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Tries the packages as a stranger would: in a root of a distribution, with nothing of this checkout.
#   scripts/try_packages.sh ROOT            runs `crossnav demo` from the wheel, then from the .deb
# ROOT has python3 and python3-venv, e.g. made by
#   debootstrap --variant=minbase --include=python3,python3-venv,ca-certificates trixie ROOT
# Wheels come from build/portable, the package from build/release. Needs to be root, for chroot.
set -euo pipefail

root=$(cd "$(dirname "${BASH_SOURCE[0]}")/.." && pwd)
target=$(cd "$1" && pwd)
mapfile -t pip_settings < <(env | grep '^PIP_' || true)
inside() {
  chroot "$target" env -i HOME=/root PATH=/usr/sbin:/usr/bin:/sbin:/bin LC_ALL=C.UTF-8 \
    "${pip_settings[@]}" PIP_FIND_LINKS= "$@"
}
seconds() { printf '%s s: %s\n' "$SECONDS" "$*"; }

rm -rf "$target/try" && mkdir "$target/try"
cp "$root"/build/portable/*.whl "$target/try/"
cp "$root"/build/release/*.deb "$target/try/" 2>/dev/null || true
cp /etc/resolv.conf "$target/etc/resolv.conf"
[[ ! -e /etc/ssl/certs/ca-certificates.crt ]] ||
  cp /etc/ssl/certs/ca-certificates.crt "$target/etc/ssl/certs/"
[[ ! -e /etc/pip.conf ]] || cp /etc/pip.conf "$target/etc/pip.conf"
mountpoint -q "$target/proc" || mount -t proc proc "$target/proc"
trap 'umount "$target/proc"' EXIT

inside sh -c '. /etc/os-release; echo "$PRETTY_NAME, $(python3 --version)"; ! command -v g++ gcc cc c++'
inside python3 -m venv /try/venv
wheel=$(inside sh -c 'cd /try; /try/venv/bin/pip download -q --no-deps --no-index -d /try/fits --find-links /try crossnav >&2; ls fits/*.whl')
inside /try/venv/bin/pip install -q "/try/$wheel[gym,openvino]"
seconds "installed $wheel"
inside sh -c 'cd /try && venv/bin/crossnav demo --out wheel-demo | tail -n 12'
seconds "crossnav demo from the wheel"
inside /try/venv/bin/crossnav networks check crossnav_small
inside /try/venv/bin/python -c 'import gymnasium
env = gymnasium.make("crossnav.gym:crossnav/CrossFloorNav-v0", config={"sensor.width_px": 64, "sensor.height_px": 64})
print("gymnasium:", sorted(env.reset(seed=1)[0]))'
if compgen -G "$target/try/*.deb" >/dev/null; then
  inside sh -c 'dpkg -i /try/*.deb >/dev/null && cd /try && crossnav demo --out deb-demo | tail -n 3'
  inside sh -c 'CROSSNAV_OPENVINO=$(echo /try/venv/lib/python3*/site-packages/openvino/libs) crossnav networks check crossnav_small'
  inside sh -c 'crossnav networks list | grep openvino; dpkg -r crossnav >/dev/null'
  seconds "crossnav demo from the .deb"
fi

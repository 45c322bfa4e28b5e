#!/usr/bin/env bash
# try-packages.sh FOLDER: do the packages of FOLDER suffice? Puts them into a fresh Debian root, where neither compiler nor source is, and lets a machine
# move its axes from there; upgrades beneath it; then takes them away and looks for what stayed. As root; needs debootstrap and the mirror of this computer's apt.
set -euo pipefail
folder=$(cd "$1" && pwd)
[[ $EUID -eq 0 ]] || { echo "try-packages: needs root" >&2 && exit 1; }
[[ -n ${TRY_PACKAGES_ALONE:-} ]] || TRY_PACKAGES_ALONE=1 exec unshare --mount --pid --fork --kill-child "$0" "$@"

root=$(mktemp -d) && chmod 755 "$root"
trap 'umount -R "$root/proc" "$root/dev" 2>/dev/null; rm -rf --one-file-system "$root"' EXIT
step() { printf '%-72s' "$1"; }
ok() { echo "ok"; }
fail() { echo "FAILED: $*" >&2; exit 1; }
clean=(env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive)
inside() { chroot "$root" "${clean[@]}" "$@"; }
stay_inside() { exec chroot "$root" "${clean[@]}" "$@"; } # for the background: its process is the command, which gets the signals

step "a Debian 12 root"
# shellcheck disable=SC2016 # apt's own
mirror=$(apt-get indextargets --format '$(SITE)' 'Created-By: Packages' | head -1)
debootstrap --variant=minbase bookworm "$root" "$mirror" >"$root.log" 2>&1 || { tail -5 "$root.log" >&2; fail "debootstrap"; }
rm -f "$root.log"
cp -a /etc/resolv.conf "$root/etc/" 2>/dev/null || true
cp -a /etc/apt/apt.conf.d/. "$root/etc/apt/apt.conf.d/"
mount -t proc proc "$root/proc"
mount --rbind /dev "$root/dev"
ok

step "installed, with what they depend on"
mkdir "$root/packages" && cp "$folder"/*.deb "$root/packages/"
inside apt-get update -q >"$root/log" 2>&1 || { cat "$root/log" >&2; fail "apt-get update"; }
inside find / -xdev \( -path /proc -o -path /dev -o -path /packages -o -path /var/cache -o -path /var/lib/apt -o -path /log \) -prune -o -print | sort >"$folder/before.txt"
inside sh -c 'apt-get install -q -y --no-install-recommends /packages/taktwerk_*.deb /packages/taktwerk-hmi_*.deb' >"$root/log" 2>&1 || { tail -20 "$root/log" >&2; fail "install"; }
ok

step "a user of its own, and a folder for machine files"
inside id taktwerk >/dev/null || fail "no user taktwerk"
inside id -nG taktwerk-hmi | grep -qw taktwerk || fail "the page's user is not in the group"
[[ -d $root/etc/taktwerk ]] || fail "no /etc/taktwerk"
ok

step "no compiler and no node came along"
! inside sh -c 'command -v g++ || command -v node' || fail "one did"
ok

step "the demo machine is well-formed"
inside taktwerk check /usr/share/taktwerk/machines/demo.yaml >"$root/log" || { cat "$root/log" >&2; fail "check"; }
ok

step "its axes move, in virtual time"
inside taktwerk run /usr/share/taktwerk/machines/demo.yaml --virtual-time --duration 20s --quiet --trace /log.csv || fail "run"
moved=$(awk -F, 'NR == 1 { for (i = 1; i <= NF; i++) if (index($i, "x.actual_position") == 1) c = i; next } c { if (NR == 2 || $c < low) low = $c; if (NR == 2 || $c > high) high = $c } END { print (high - low > 100) ? "yes" : "no: " low " to " high }' "$root/log.csv")
[[ $moved == yes ]] || fail "x: $moved"
ok

step "as a service's user, in real time: ready, well, and ended in order"
inside sh -c 'install -d -o taktwerk -g taktwerk /run/taktwerk && cp /usr/share/taktwerk/machines/demo.yaml /usr/share/taktwerk/machines/demo-cell.svg /etc/taktwerk/'
stay_inside setpriv --reuid taktwerk --regid taktwerk --init-groups --no-new-privs taktwerk run /etc/taktwerk/demo.yaml --simulate --no-events >"$root/run.log" 2>&1 &
run=$!
for ((i = 0; i < 300; i++)); do ! inside taktwerk status >"$root/log" 2>&1 || break; sleep 0.1; done
inside taktwerk status --json | grep -q '"well":true' || { cat "$root/log" "$root/run.log" >&2; fail "status"; }
ok

step "the page is served"
stay_inside setpriv --reuid taktwerk-hmi --regid taktwerk-hmi --init-groups taktwerk hmi --listen 127.0.0.1:18080 --audit /tmp/audit.jsonl >"$root/hmi.log" 2>&1 &
hmi=$!
page=''
for ((i = 0; i < 100; i++)); do
    page=$({ exec 3<>/dev/tcp/127.0.0.1/18080 && printf 'GET / HTTP/1.0\r\nHost: 127.0.0.1:18080\r\n\r\n' >&3 && cat <&3; } 2>/dev/null) || true
    [[ $page != *"200 OK"* ]] || break
    sleep 0.1
done
[[ $page == *"200 OK"*"<html"* ]] || { cat "$root/hmi.log" >&2; fail "$page"; }
ok

step "an upgrade leaves what runs alone"
before=$(inside taktwerk status --json | sed 's/.*"pid":\([0-9]*\).*/\1/')
inside sh -c 'apt-get install -q -y --reinstall /packages/taktwerk_*.deb /packages/taktwerk-hmi_*.deb' >"$root/log" 2>&1 || { tail -20 "$root/log" >&2; fail "reinstall"; }
[[ $(inside taktwerk status --json | sed 's/.*"pid":\([0-9]*\).*/\1/') == "$before" ]] || fail "another process"
ok

step "ended in order"
inside taktwerk shutdown >/dev/null || fail "shutdown"
wait "$run" || { cat "$root/run.log" >&2; fail "run"; }
kill "$hmi"
wait "$hmi" || fail "the page: $?"
ok

step "a program is built against taktwerk-dev"
inside sh -c 'apt-get install -q -y --no-install-recommends make /packages/taktwerk-dev_*.deb' >"$root/log" 2>&1 || { tail -20 "$root/log" >&2; fail "install"; }
mkdir "$root/program"
cat >"$root/program/CMakeLists.txt" <<'TEXT'
cmake_minimum_required(VERSION 3.25)
project(program CXX)
find_package(Taktwerk REQUIRED)
taktwerk_add_program(minimal minimal.cpp)
TEXT
cp "$(dirname "$0")/../programs/examples/minimal.cpp" "$root/program/"
inside sh -c 'cmake -S /program -B /program/build && cmake --build /program/build' >"$root/log" 2>&1 || { tail -20 "$root/log" >&2; fail "build"; }
ok

step "purged: no file is left"
rm -rf "$root/program" "$root"/*.log "$root/log.csv" "$root"/etc/taktwerk/demo* "$root/tmp/audit.jsonl"
inside sh -c 'apt-get purge -q -y taktwerk taktwerk-hmi taktwerk-dev && apt-get autoremove --purge -q -y' >"$root/log" 2>&1 || { tail -20 "$root/log" >&2; fail "purge"; }
left=$(inside find / -xdev \( -path /proc -o -path /dev -o -path /packages -o -path /var/cache -o -path /var/lib/apt -o -path /log \) -prune -o -print | sort | comm -13 "$folder/before.txt" - | grep -i taktwerk || true)
rm -f "$folder/before.txt"
[[ -z $left ]] || fail "$left"
ok

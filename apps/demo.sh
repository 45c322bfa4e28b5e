#!/usr/bin/env bash
# The demo machine in real time on simulated drives, with a second hand on the command line: ./dev demo.
#
#   apps/demo.sh BUILD_DIR [--no-hmi] [OUT_DIR]      leaves demo.csv, demo.svg and run.log in OUT_DIR (default demo-out)
#
# Then the machine starts once more and its page is served until Ctrl-C: where somebody sits at a terminal. In a script or CI the page is asked for once.
#
# What happens to the machine from outside (start button, emergency stop, drive fault) stands in config/machines/demo.yaml under
# `simulation: events:`; what the operator does is here. Both go by the time since the start.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

taktwerk=$1/taktwerk
shift
hmi=yes
[[ ${1:-} != --no-hmi ]] || { hmi= && shift; }
out=${1:-demo-out}
log=$out/run.log
runtime=
shown=0

say() { printf '\n\033[1m== %s\033[0m\n' "$*"; }
note() { printf '   %s\n' "$*"; }

# What the runtime has said since the last time, without the details of the bus.
heard() {
    local lines
    lines=$(wc -l <"$log")
    tail -n "+$((shown + 1))" "$log" | head -n "$((lines - shown))" | grep -v -e ' s  bus ' -e '^$' | sed 's/^/   | /' || true
    shown=$lines
}

fail() {
    printf '\n\033[1;31mdemo: %s\033[0m\n' "$*" >&2
    printf 'The runtime said last (%s):\n' "$log" >&2
    tail -n 25 "$log" >&2 || true
    exit 1
}

finish() {
    local code=$?
    if [[ -n $runtime ]] && kill -0 "$runtime" 2>/dev/null; then
        kill -TERM "$runtime" 2>/dev/null || true
        for _ in {1..50}; do
            kill -0 "$runtime" 2>/dev/null || break
            sleep 0.1
        done
        kill -KILL "$runtime" 2>/dev/null || true
    fi
    exit "$code"
}
trap finish EXIT
trap 'exit 130' INT TERM

operate() {
    printf '   $ taktwerk %s\n' "$*"
    local said
    said=$("$taktwerk" "$@" -s demo 2>&1) || fail "'taktwerk $*' failed: $said"
    note "  $said"
}

# `present PATTERN...`: the monitor's picture, in which every pattern must occur. The runtime began a little after this script, and may have been
# held up: what is to come may take a while.
present() {
    local picture pattern line missing patience=$(($(now_ms) + 5000))
    while :; do
        picture=$("$taktwerk" monitor --once -s demo 2>&1) || fail "the monitor failed: $picture"
        missing=
        for pattern in "$@"; do
            grep -qE -- "$pattern" <<<"$picture" || missing=$pattern
        done
        [[ -n $missing ]] || break
        (($(now_ms) < patience)) || break
        sleep 0.1
    done
    printf '   $ taktwerk monitor --once\n'
    while IFS= read -r line; do note "$line"; done <<<"$picture"
    [[ -z $missing ]] || fail "expected to see '$missing'"
}

# Sleeps until $1 milliseconds after the start.
begin=0
now_ms() { echo $((${EPOCHREALTIME/[.,]/} / 1000)); }
at() {
    local left=$(($1 - ($(now_ms) - begin)))
    ((left <= 0)) || sleep "$(printf '%d.%03d' $((left / 1000)) $((left % 1000)))"
    kill -0 "$runtime" 2>/dev/null || fail "the runtime has ended too early"
}

[[ -x $taktwerk ]] || { echo "demo: there is no $taktwerk; run ./dev demo" >&2 && exit 1; }
mkdir -p "$out"

say "A three-axis pick-and-place machine on simulated drives, in real time"
note "x and y: Sinsegye SV33-E; z: SE-808X; one I/O terminal. The frames are real EtherCAT frames, the slaves are simulated."
note "The machine: config/machines/demo.yaml. Its program: programs/examples/pick_and_place.cpp."
begin=$(now_ms)
"$taktwerk" run config/machines/demo.yaml --simulate --trace "$out/demo.csv" >"$log" 2>&1 &
runtime=$!
until "$taktwerk" monitor --once -s demo >/dev/null 2>&1; do
    kill -0 "$runtime" 2>/dev/null || fail "the runtime did not start"
    (($(now_ms) - begin < 15000)) || fail "the machine was not up within 15 s"
    sleep 0.25
done
heard

say "1 s: somebody presses start. Power on, home all axes, then pick and place"
at 5200
heard
present 'z +Standstill|z +DiscreteMotion' 'program pick_and_place running'

say "8 s: the operator takes over: manual mode, jog x from the command line"
at 8300
heard
operate mode manual
operate enable x --wait
operate jog x --velocity 60 --for 800ms
operate mode automatic
operate start pick_and_place
heard

say "11 s: start pressed again, the program goes on"
at 12500
heard
present 'x +(DiscreteMotion|Standstill) +on hm'

say "13 s: emergency stop. The axes stop along their ramps, then power goes off"
at 13700
heard
present 'EMERGENCY STOP' 'x +ErrorStop'
note "14 s: the button is released; nothing moves before somebody resets"
at 14300
present 'estop_ok=1' >/dev/null
operate reset --wait
heard

say "15 s: start pressed, the loop goes on"
at 17500
heard

say "18 s: the drive of y loses a mains phase and falls into fault"
at 18300
heard
present 'y +ErrorStop' '3130'
operate reset y --wait
heard

say "19.5 s: start pressed, the loop goes on after the fault"
at 25400
heard
present 'y +(DiscreteMotion|Standstill) +on hm' 'pieces=[1-9]'

say "The end: axes stop along their ramps, power off, bus down"
operate shutdown
code=0
wait "$runtime" || code=$?
runtime=
heard
((code == 0)) || fail "the runtime ended with exit code $code"

say "What happened"
"$taktwerk" plot "$out/demo.csv" -o "$out/demo.svg" --title "Demo machine: power, home, pick and place, jog, emergency stop, drive fault" >/dev/null ||
    fail "the plot failed"
note "the picture: $out/demo.svg      every cycle: $out/demo.csv      the log: $log"
note "next: docs/commissioning.md"
[[ -n $hmi ]] || exit 0

# GET / of the address $1, without a tool: the first line of the answer.
first_line_of_page() {
    local host=${1#http://} line
    host=${host%/}
    exec 3<>"/dev/tcp/${host%:*}/${host##*:}" || return 1
    printf 'GET / HTTP/1.1\r\nHost: %s\r\nConnection: close\r\n\r\n' "$host" >&3
    IFS= read -r -t 5 line <&3
    exec 3>&-
    printf '%s' "${line%$'\r'}"
}

say "The page: the same machine, for a browser"
log=$out/page.log shown=0
"$taktwerk" run config/machines/demo.yaml --simulate --no-events --hmi >"$log" 2>&1 &
runtime=$!
address='' begin=$(now_ms)
until [[ -n $address ]] && "$taktwerk" monitor --once -s demo >/dev/null 2>&1; do
    kill -0 "$runtime" 2>/dev/null || fail "the machine did not start"
    address=$(sed -n 's!.*the page: \(http://[^ ]*\).*!\1!p' "$log")
    if grep -q "the page's server is gone" "$log"; then
        note "$(grep -m 1 -e 'web\.' -e 'no index.html' "$log" || echo "the page's server did not start: $log")"
        exit 0
    fi
    (($(now_ms) - begin < 15000)) || fail "the machine was not up within 15 s"
    sleep 0.1
done
note "open $address      the log: $log"
if [[ -t 0 && -t 1 && -z ${CI:-} ]]; then
    trap 'exit 0' INT TERM
    note "Ctrl-C ends the machine and the page"
    wait "$runtime" || true
    exit 0
fi
answer=$(first_line_of_page "$address") || fail "nobody answers at $address"
[[ $answer == *' 200 '* ]] || fail "the page's server answers '$answer'"
note "nobody sits at a terminal: asked once, it answers \"$answer\""
operate shutdown
code=0
wait "$runtime" || code=$?
runtime=
((code == 0)) || fail "the machine ended with exit code $code"

#!/usr/bin/env bash
# run.sh BUILD [ARGS]: the page's figures, in a network namespace of their own. As root, since the cycle wants a real-time priority.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../../.."
build=$PWD/$1
shift
[[ -f $build/hmi_page/tests/figures.mjs ]] || { echo "the page is not built: ./dev setup page" >&2 && exit 1; }
alone=(unshare --net)
[[ $EUID -eq 0 ]] || { alone=(unshare --user --map-root-user --net) && echo "not root: without a real-time priority the cycle's figures are the scheduler's" >&2; }
# The cycle has the last CPU for itself (figures.ts); TAKTWERK_PIN=0: nobody has.
[[ ${TAKTWERK_PIN:-1} == 0 || $(nproc) -lt 2 ]] || alone=(taskset -c "0-$(($(nproc) - 2))" "${alone[@]}")
export TAKTWERK_BUILD=$build TAKTWERK_SOURCE=$PWD
# shellcheck disable=SC2016 # $@ is the inner shell's
exec "${alone[@]}" bash -c 'ip link set lo up && ip link set lo multicast on && ip route add 224.0.0.0/4 dev lo && exec "$@"' run \
    node --expose-gc "$build/hmi_page/tests/figures.mjs" "$@"

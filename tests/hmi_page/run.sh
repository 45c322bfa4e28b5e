#!/usr/bin/env bash
# run.sh unit|browser BUILD SOURCE: the page's tests of a kind. What cannot be tried here is skipped, and said.
# run.sh pictures BUILD SOURCE FOLDER: pictures of the pages.
set -euo pipefail
kind=$1 build=$2 source=$3
report=${GTEST_OUTPUT:-}
report=${report#xml:}
export TAKTWERK_REPORT=${report:+${report%/}/hmi_page_$kind.xml} TAKTWERK_BUILD=$build TAKTWERK_SOURCE=$source

skip() {
    echo "skipped: $1"
    [[ -z $TAKTWERK_REPORT ]] || printf '<testsuites tests="1" failures="0" errors="0" disabled="0"><testcase name="hmi_page" result="skipped"><skipped message="%s"/></testcase></testsuites>\n' \
        "$1" | sed 's/<testsuites/\n&/; s/<testcase/\n&/; s/<skipped/\n&/' >"$TAKTWERK_REPORT"
    exit 0
}

command -v node >/dev/null || skip "the page: no node (Debian package nodejs, ./dev setup page)"
major=$(node -p 'process.versions.node.split(".")[0]')
((major >= 18)) || skip "the page: node $major is too old, 18 is the oldest (Debian package nodejs, ./dev setup page)"
[[ -f $build/hmi_page/page/page.js ]] || skip "the page is not built (no npm, or TAKTWERK_PAGE=OFF)"

start=()
if [[ $kind != unit ]]; then
    [[ -x /usr/bin/chromium ]] || skip "the page in a browser: no chromium (Debian package chromium, ./dev setup browser)"
    unshare --user --map-root-user --net true 2>/dev/null || skip "the page in a browser: no network namespaces here (unshare --user --net)"
    # shellcheck disable=SC2016 # $@ is the inner shell's
    start=(unshare --user --map-root-user --net bash -c 'ip link set lo up && exec "$@"' run)
fi
[[ $kind != pictures ]] || exec "${start[@]}" node "$build/hmi_page/tests/pictures.mjs" "$4"
"${start[@]}" node --test --test-concurrency=1 --test-reporter=spec --test-reporter-destination=stdout \
    --test-reporter="$source/tests/hmi_page/gtest_report.mjs" --test-reporter-destination="${TAKTWERK_REPORT:-/dev/null}" \
    "$build/hmi_page/tests/"*"_$kind.mjs"

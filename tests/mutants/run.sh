#!/usr/bin/env bash
# Puts one mistake after the other into a copy of the tree and looks whether the tests notice. `./dev mutants [NAME...]`.
# A mutant of mutants.txt is killed when one of its test binaries fails or does not end in time, or a static_assert does. One that does
# not build otherwise, or whose `from` does not stand exactly once in its file, is an error of the list.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
copy=$root/build/mutants/tree
log=$root/build/mutants/log
patience=300 # seconds of computing for one test binary: not of the clock, or a busy computer would kill mutants that nothing notices

mkdir -p "$copy" "$log"
# Only what differs, so that a second run builds little. Dates of unchanged files stay.
git -C "$root" ls-files -z --cached --others --exclude-standard | while IFS= read -r -d '' file; do
    [[ ! -f $root/$file ]] || cmp -s "$root/$file" "$copy/$file" || install -D -m "$(stat -c %a "$root/$file")" "$root/$file" "$copy/$file"
done
cmake -S "$copy" --preset dev --log-level=WARNING >/dev/null

built=
prepare() { # the tests must pass before they may fail
    local test
    for test in "$@"; do
        [[ " $built " != *" $test "* ]] || continue
        cmake --build "$copy/build/dev" --target "$test" >"$log/$test" 2>&1 || { echo "error: $test does not build: see $log/$test" >&2 && exit 2; }
        "$(find "$copy/build/dev" -type f -name "$test")" --gtest_brief=1 >"$log/$test" 2>&1 || { echo "error: $test fails without a mutant: see $log/$test" >&2 && exit 2; }
        built="$built $test"
    done
}

# killed, or survived
fate() {
    local name=$1 test && shift
    for test in "$@"; do
        cmake --build "$copy/build/dev" --target "$test" >"$log/$name" 2>&1 || {
            grep -q 'static assertion failed' "$log/$name" && echo "killed by a static_assert" || echo "does not build"
            return
        }
        (ulimit -t "$patience" && exec timeout $((20 * patience)) "$(find "$copy/build/dev" -type f -name "$test")" --gtest_brief=1 --gtest_fail_fast) >"$log/$name" 2>&1 ||
            { echo "killed by $(sed -n 's/^\[  FAILED  \] \([A-Za-z_0-9./]*\).*/\1/p' "$log/$name" | head -n 1) ($test)" && return; }
    done
    echo survived
}

killed=0 all=0 survivors=
mutate() {
    local name=$1 file=$2 from=$3 to=$4 text result && shift 4
    text=$(cat "$copy/$file" && printf x)
    text=${text%x}
    local rest=${text#*"$from"}
    [[ $rest != "$text" && ${rest#*"$from"} == "$rest" ]] || { echo "error: $name: its text does not stand exactly once in $file" >&2 && exit 2; }
    prepare "$@"
    printf '%s' "${text%%"$from"*}$to$rest" >"$copy/$file"
    result=$(fate "$name" "$@")
    printf '%s' "$text" >"$copy/$file"
    [[ $result != "does not build" ]] || { echo "error: $name does not build: see $log/$name" >&2 && exit 2; }
    all=$((all + 1))
    if [[ $result == survived ]]; then survivors="$survivors $name"; else killed=$((killed + 1)); fi
    printf '%-34s %-38s %s\n' "$name" "$file" "$result"
}

name='' file='' from='' to=''
wanted=" $* "
while IFS= read -r line || [[ -n $line ]]; do
    value=${line#* }
    case $line in
        mutant\ *) name=$value ;;
        file\ *) file=$value ;;
        from\ *) from=$value ;;
        to\ *) to=$value ;;
        to) to='' ;;
        tests\ *)
            read -ra tests <<<"$value"
            [[ $# -gt 0 && $wanted != *" $name "* ]] || mutate "$name" "$file" "$from" "$to" "${tests[@]}"
            ;;
    esac
done <"$root/tests/mutants/mutants.txt"

[[ $all -gt 0 ]] || { echo "error: no mutant of that name" >&2 && exit 2; }
echo "$killed of $all killed ($((100 * killed / all)) %)${survivors:+; survived:$survivors}"
((100 * killed >= 95 * all))

#!/usr/bin/env bash
# check-units.sh DEB...: what systemd itself says of the units in these packages: whether they are well-formed, and how exposed they are. Where there is no
# systemd-analyze that is said, and nothing else.
set -euo pipefail
command -v systemd-analyze >/dev/null || { echo "check-units: no systemd-analyze here: not looked at" && exit 0; }
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
for package in "$@"; do dpkg-deb --extract "$package" "$folder"; done
cd "$folder/usr/lib/systemd/system"
cp taktwerk@.service taktwerk@cell.service
# The command and its documentation lie in the package and not on this computer.
sed -i "s#/usr/bin/taktwerk#$folder/usr/bin/taktwerk#; /^Documentation=/d" ./*.service
# And one from its bundle: it has to be tried more often than a new version has starts, or the version before never has its turn.
cp taktwerk@.service taktwerk@bundled.service
mkdir taktwerk@bundled.service.d && sed "s#/usr/bin/taktwerk#$folder/usr/bin/taktwerk#" "$folder/usr/share/taktwerk/systemd/bundle.conf" >taktwerk@bundled.service.d/bundle.conf
tries=$(sed -n 's/^StartLimitBurst=//p' taktwerk@bundled.service.d/bundle.conf)
[[ $tries -gt 3 ]] || { echo "check-units: StartLimitBurst=$tries of bundle.conf lets no version come back" >&2 && exit 1; }
for unit in taktwerk@cell taktwerk@bundled taktwerk-hmi; do
    systemd-analyze verify "$PWD/$unit.service"
    systemd-analyze security --offline=true "$PWD/$unit.service" | sed -n 's/.*Overall exposure/exposure/p'
done

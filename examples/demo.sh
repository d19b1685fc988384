#!/bin/sh
# The main job, from a specification to a proved policy, in a folder of its own. Started by `make demo`.
set -eu
here=$(cd "$(dirname "$0")" && pwd)
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT INT TERM
cp "$here/amr.tum" "$folder/"
cd "$folder"
PATH="$BIN:$PATH"

show() {
    printf '\n$ %s\n' "$*"
    "$@"
}

cat <<'TEXT'
An autonomous mobile robot (AMR) brings workpieces from workstation 1 to workstation 2 and must keep its battery
charged. One rule: its conveyor must be off in the corridor and at the charger. Loading may fail, driving may fail;
whatever happens, the robot must know what to do next, and must not break the rule.
TEXT
show tumato-sym check amr.tum
show tumato-sym synth amr.tum
printf '\nWhat does the robot do with a workpiece and a low battery, in the corridor?\n'
show tumato-sym decide policy.json S_Location=corridor S_Battery=low S_Load=loaded S_Conveyor=off
printf '\nSomebody else may not trust us. The verifier trusts nobody:\n'
show tumato-sym verify policy.json amr.tum

printf '\nNext: docs/tutorial.md writes a specification from scratch; examples/ has more of them.\n'

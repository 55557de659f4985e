#!/usr/bin/env bash
# Runs all ```sh blocks of a page, in order, in one shell and an empty folder, as a reader would.
# The first command that fails ends it.
#
#   run_commands.sh PAGE.md FOLDER_OF_SUNDER [FILE...]
#
# FILEs are copied into the folder first: what the reader has downloaded.
set -euo pipefail
page=$(realpath "$1")
PATH="$(realpath "$2"):$PATH"
shift 2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
for file in "$@"; do cp "$file" "$folder"; done
chmod -R u+w "$folder"
commands="$folder/.commands"
awk '/^```sh$/ { inside = 1; next } /^```$/ { inside = 0 } inside' "$page" > "$commands"
[ -s "$commands" ] || { echo "$page has no commands" >&2; exit 1; }
cd "$folder"
# Files that a page writes between commands: ```json NAME
awk '/^```json [a-z_]+\.json$/ { name = $2; next } /^```$/ { name = "" } name != "" { print > name }' "$page"
bash -euxo pipefail "$commands"
# Every output that a command names is there.
grep -oE '(-o|--report|--picture|--save-log) +[a-z0-9_./]+\.(glb|png|json|html)' "$commands" | awk '{ print $2 }' |
  while read -r output; do [ -s "$output" ] || { echo "$output was not written" >&2; exit 1; }; done

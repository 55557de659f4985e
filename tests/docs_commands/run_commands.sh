#!/usr/bin/env bash
# Runs all ```sh blocks of a page, in order, in one shell and an empty folder, as a reader would.
# The first command that fails ends it.
#
#   run_commands.sh PAGE.md FOLDER_OF_SUNDER [FILE...]
#
# FILEs are copied into the folder first: what the reader has downloaded. Exit code 77 if one of them or Python is
# absent.
set -euo pipefail
page=$(realpath "$1")
PATH="$(realpath "$2"):$PATH"
shift 2
command -v python3 >/dev/null || { echo "python3 is not installed" >&2; exit 77; }
for file in "$@"; do [ -e "$file" ] || { echo "$file is absent" >&2; exit 77; }; done
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
for file in "$@"; do cp "$file" "$folder"; done
chmod -R u+w "$folder"
commands="$folder/.commands"
awk '/^```sh$/ { inside = 1; next } /^```$/ { inside = 0 } inside' "$page" > "$commands"
[ -s "$commands" ] || { echo "$page has no commands" >&2; exit 1; }
cd "$folder"
bash -euxo pipefail "$commands"
# Every output that a command names is there.
grep -oE '(-o|--report|--picture|--save-log) +[a-z0-9_./]+\.(glb|png|json|html)' "$commands" | awk '{ print $2 }' |
  while read -r output; do [ -s "$output" ] || { echo "$output was not written" >&2; exit 1; }; done

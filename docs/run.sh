#!/usr/bin/env bash
# Runs what the pages tell a reader to type: every block of ```sh of the given pages, each page in an empty folder of its
# own, command by command until one fails. The programs come from the build folder.
#   docs/run.sh BUILD FOLDER PAGE.md...
set -euo pipefail
build=$(realpath "$1") folder=$2
shift 2
export PATH=$build/bin:/usr/bin:$PATH PYTHONPATH=$build/python PYTHONDONTWRITEBYTECODE=1
failed=0
for page in "$@"; do
  name=$(basename "$page" .md)
  rm -rf "${folder:?}/$name"
  mkdir -p "$folder/$name"
  awk '/^```sh$/ {on = 1; next} /^```/ {on = 0} on' "$page" >"$folder/$name.sh"
  [[ -s $folder/$name.sh ]] || { printf 'docs: %s: found no block of sh, expected some\n' "$page" >&2; failed=1; continue; }
  if (cd "$folder/$name" && bash -euxo pipefail "../$name.sh") >"$folder/$name.log" 2>&1; then
    printf '%s: %s commands\n' "$page" "$(grep -c '^+ ' "$folder/$name.log")"
  else
    tail -n 20 "$folder/$name.log" >&2
    printf 'docs: %s: a command failed; all it said is in %s\n' "$page" "$folder/$name.log" >&2
    failed=1
  fi
done
exit $failed

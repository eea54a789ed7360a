#!/usr/bin/env bash
# Builds the site in BUILD/docs/site: the pages of docs/, pictures of the samples, and reference made from the program's
# help, the C library's header and the Python module's docstrings. Reads nothing from any network.
#   docs/site.sh BUILD
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
build=$1 out=$1/docs
rm -rf "$out/src" "$out/site"
mkdir -p "$out/src/reference" "$out/src/pictures"
cp docs/mkdocs.yml "$out/mkdocs.yml"
cp -r docs/*.md docs/tutorials docs/howto "$out/src/"
for picture in samples/*/picture.png; do cp "$picture" "$out/src/pictures/$(basename "$(dirname "$picture")").png"; done
cp samples/bottles/before.png "$out/src/pictures/before.png"

# A page of what a command prints: heading by heading, as it stands.
fenced() { printf '\n## %s\n\n```text\n' "$1"; shift; "$@"; printf '```\n'; }
{
  printf '# The program\n\nWhat `pellucid VERB --help` and `pellucid help TOPIC` print.\n'
  verbs=$("$build/bin/pellucid" --help | awk '/^Verbs$/ {on = 1; next} /^$/ {on = 0} on && /^  [a-z]/ {print $1}')
  for verb in $verbs; do fenced "$verb" "$build/bin/pellucid" "$verb" --help; done
  for topic in methods weights precision set spaces presets; do fenced "help $topic" "$build/bin/pellucid" help "$topic"; done
} >"$out/src/reference/program.md"
{
  printf '# The C library\n\nThe header `pellucid/pellucid.h`, whole.\n\n```c\n'
  cat engine_bridge/include/pellucid/pellucid.h
  printf '```\n'
} >"$out/src/reference/c.md"
PYTHONPATH=$build/python PYTHONDONTWRITEBYTECODE=1 /usr/bin/python3 docs/python_reference.py >"$out/src/reference/python.md"
mkdocs build --quiet --strict --config-file "$out/mkdocs.yml"

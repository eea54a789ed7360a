"""Runs the program, and understands what it says."""

import json
import subprocess

from . import flags
from .trouble import Trouble


def _messages(text):
    """(level, sentence) of each line; a line that is no JSON object is told as it is."""
    for line in text.splitlines():
        try:
            message = json.loads(line)
            frame = f"Frame {message['frame']}: " if "frame" in message else ""
            yield message["level"], frame + message["message"]
        except (ValueError, KeyError, TypeError):
            if line.strip():
                yield "info", line


def _ending(code):
    if code < 0:
        return f"It was ended by signal {-code}."
    meaning = flags.exit_meaning(code)
    return f"Exit code {code}: {meaning}" if meaning else f"Exit code {code}, which pellucid does not use."


def check(program):
    """Raises Trouble where it cannot be run, before anything is rendered for it. Returns notes."""
    found = _run(program, ["--version"]).stdout.strip()
    if found == flags.VERSION:
        return []
    return [f"{program} says that it is {found[:40]!r}; the add-on was packed for {flags.VERSION}."]


def run(program, words):
    """Runs it to its end. Returns the notes it gave; raises Trouble with its error and what its exit code means."""
    return [sentence for level, sentence in _messages(_run(program, words).stderr) if level != "error"]


def _run(program, words):
    try:
        ended = subprocess.run([program, *words], stdin=subprocess.DEVNULL, capture_output=True, text=True,
                               encoding="utf-8", errors="replace", check=False)
    except OSError as error:
        raise Trouble(f"{program}: cannot be run: {error.strerror}; expected the program pellucid, whose place the "
                      "preferences of this add-on name.") from error
    if ended.returncode != 0:
        told = list(_messages(ended.stderr))
        errors = [sentence for level, sentence in told if level == "error"]
        said = ". ".join(errors or [sentence for _, sentence in told[-1:]] or [f"{program} failed without a word"])
        raise Trouble(f"{said.rstrip('.')}. {_ending(ended.returncode)}")
    return ended

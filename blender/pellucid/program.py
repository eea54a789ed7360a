"""Runs the program, and understands what it says."""

import json
import os
import subprocess
import tempfile

from . import flags
from .trouble import Trouble

_REFUSED = 2  # the exit code of flags that cannot be honoured


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


def check(program, words, output):
    """Raises Trouble where it cannot be run or refuses the flags, before anything is rendered for it. Returns notes.

    What contradicts itself is refused before a file is opened, so that files which are not there do for this.
    """
    found = _told(_ended(program, ["--version"])).stdout.strip()
    missing = [os.path.join(os.path.dirname(output), name) for name in ("not-yet.exr", "not-yet.glb")]
    refusal = _ended(program, ["composite", *missing, "--output", output.replace("####", "0"), "--log-json", *words])
    if refusal.returncode == _REFUSED:
        _told(refusal)
    if found == flags.VERSION:
        return []
    return [f"{program} says that it is {found[:40]!r}; the add-on was packed for {flags.VERSION}."]


class Running:
    """The program at its work, while Blender goes on with its own. What it says waits in files, so that it never waits
    for somebody to read it. Raises Trouble where it cannot be run."""

    def __init__(self, program, words):
        self._said = tempfile.TemporaryFile()
        self._answered = tempfile.TemporaryFile()
        try:
            self._process = subprocess.Popen([program, *words], stdin=subprocess.DEVNULL, stdout=self._answered,
                                             stderr=self._said)
        except OSError as error:
            raise Trouble(f"{program}: cannot be run: {error.strerror}; expected the program pellucid, whose place the "
                          "preferences of this add-on name.") from error

    def ended(self):
        """Whether it has come to its end."""
        return self._process.poll() is not None

    def stop(self):
        """Ends it: it leaves no half of a picture."""
        self._process.terminate()
        self._process.wait()

    def wait(self):
        """What it was to do, once it has ended, as subprocess.run gives it."""
        code = self._process.wait()
        said, answered = _read(self._said), _read(self._answered)
        return subprocess.CompletedProcess(self._process.args, code, answered, said)

    def notes(self):
        """Those it gave, once it has ended; raises Trouble with its error and what its exit code means."""
        return [sentence for level, sentence in _messages(_told(self.wait()).stderr) if level != "error"]


def _read(file):
    file.seek(0)
    return file.read().decode("utf-8", errors="replace")


def run(program, words):
    """Runs it to its end. Returns the notes it gave; raises Trouble with its error and what its exit code means."""
    return Running(program, words).notes()


def _ended(program, words):
    return Running(program, words).wait()


def _told(ended):
    """The same where it ended well; else raises Trouble."""
    if ended.returncode != 0:
        told = list(_messages(ended.stderr))
        errors = [sentence for level, sentence in told if level == "error"]
        last = [sentence for _, sentence in told[-1:]] or [f"{ended.args[0]} failed without a word"]
        said = ". ".join(errors or last)
        raise Trouble(f"{said.rstrip('.')}. {_ending(ended.returncode)}")
    return ended

"""Keywords as the words of the program's command line, by its own table of flags."""

import functools
import numbers
import os

from . import _pellucid


def options(verb="composite"):
    """The keywords of a verb, by name.

    verb: composite, accumulate, resolve, flatten, compare or study.

    Returns a dict of dicts with the keys ``flag`` (of the program), ``group`` and ``help`` (as ``--help`` has them),
    ``default`` (text, "" for none), ``value`` (what is expected, such as ``NEAR:FAR``), ``type`` (with the choices or
    the range), ``switch`` (True: the keyword takes True) and ``many`` (True: it takes a list). Raises UsageError for
    another verb.
    """
    return {row["name"]: {key: row[key] for key in row if key != "name"} for row in _pellucid.options(verb)}


_table = functools.lru_cache(maxsize=None)(options)


def _refuse(verb, name, found, expected):
    raise _pellucid.UsageError(f"{verb}: {name}: found {found}, expected {expected}")


def _number(value):
    """The shortest text that reads back as the same number."""
    if isinstance(value, numbers.Integral):
        return str(int(value))
    return repr(float(value))


def _text(value, separator):
    """One value as the program reads it; the parts of a sequence between separators."""
    if isinstance(value, (str, os.PathLike)):
        return os.fspath(value)
    if _is_bool(value):
        return "true" if value else "false"
    if isinstance(value, numbers.Real):
        return _number(value)
    return separator.join(_text(part, separator) for part in value)


def _is_bool(value):
    return isinstance(value, bool) or type(value).__name__ == "bool_"


def _pairs(value, separator):
    """A dict as texts of KEY=VALUE, inner dicts as OUTER.KEY=VALUE."""
    for key, part in value.items():
        if isinstance(part, dict):
            yield from (f"{key}.{text}" for text in _pairs(part, separator))
        else:
            yield f"{key}={_text(part, separator)}"


def _texts(row, value):
    """The values of one flag, a text for each time that it is given."""
    within = ":" if ":" in row["value"] else "x" if row["value"] == "WIDTHxHEIGHT" else ","
    if isinstance(value, dict) and row["flag"] == "--camera":
        return [";".join(_pairs(value, ","))]
    if isinstance(value, dict):
        texts = list(_pairs(value, ":"))
        return texts if row["many"] else [",".join(texts)]
    if _is_bool(value):
        return ["on" if value else "off"] if "on,off" in row["type"] or "off,on" in row["type"] else [_text(value, "")]
    if row["many"] and not isinstance(value, (str, os.PathLike, numbers.Number)):
        return [_text(part, within) for part in value]
    return [_text(value, within)]


def _switch(verb, name, row, value):
    if not _is_bool(value):
        _refuse(verb, name, repr(value), "True or False")
    if value:
        return [row["flag"]]
    negative = "no-" + row["flag"][2:]
    return ["--" + negative] if negative in row["names"] else []


def words(verb, keywords, files=(), output=None):
    """The command line of a call. None leaves a keyword out. Raises UsageError for a keyword that is none."""
    table = _table(verb)
    line = []
    for name, value in keywords.items():
        if name not in table:
            near = _pellucid.nearest(name, list(table))
            hint = f"did you mean {near}?" if near else f"pellucid.options('{verb}') lists those that do"
            raise _pellucid.UsageError(f"{verb}: found the option {name}, which does not exist: {hint}")
        if value is None:
            continue
        row = table[name]
        if row["switch"]:
            line += _switch(verb, name, row, value)
            continue
        try:
            texts = _texts(row, value)
        except TypeError:
            _refuse(verb, name, repr(value), row["value"] or "a number or a text")
        for text in texts:
            line += [f"{row['flag']}={text}"] if text.startswith("-") else [row["flag"], text]
    if output is not None:
        line += ["--output", os.fspath(output)]
    return line + ["--"] + [os.fspath(path) for path in files]

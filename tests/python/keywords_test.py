"""Every flag is a keyword, and says the same."""

import pathlib
import re

import numpy
import pytest

import pellucid
from pellucid._words import words

VERBS = ("composite", "accumulate", "resolve", "flatten", "compare", "study")
OF_TERMINALS = {"help", "json", "stats", "explain", "explain_page", "output", "frames", "jobs", "skip_existing",
                "progress", "log_json"}


@pytest.mark.parametrize("verb", VERBS)
def test_every_flag_of_the_help_is_a_keyword(program, verb):
    help_text = program(verb, "--help").out
    flags = {name.replace("-", "_") for name in re.findall(r"^  (?:-\w, )?--([\w-]+)", help_text, re.M)}
    assert flags - OF_TERMINALS == set(pellucid.options(verb)) and len(flags) > 5


@pytest.mark.parametrize("keywords, expected", [
    ({"aa": 8}, ["--aa", "8"]),
    ({"aa": numpy.int64(8)}, ["--aa", "8"]),
    ({"tolerance": 0.1}, ["--tolerance", "0.1"]),
    ({"tolerance": numpy.float32(0.5)}, ["--tolerance", "0.5"]),
    ({"weight_range": (0.1, 100)}, ["--weight-range", "0.1:100"]),
    ({"environment": [1, 0.5, 0.25]}, ["--environment", "1,0.5,0.25"]),
    ({"environment": pathlib.Path("sky.exr")}, ["--environment", "sky.exr"]),
    ({"measure": True, "no_prune": False}, ["--measure"]),
    ({"self_modulation": False}, ["--no-self-modulation"]),
    ({"dispersion": False}, ["--dispersion", "off"]),
    ({"method": None}, []),
    ({"layers": ["transparent", "edges"]}, ["--layers", "transparent", "--layers", "edges"]),
    ({"set": {"Glass": {"thin": True, "coverage": 0.5}, "Leaf.coverage": 1}},
     ["--set", "Glass.thin=true", "--set", "Glass.coverage=0.5", "--set", "Leaf.coverage=1"]),
    ({"fog": {"density": 0.1, "albedo": (1, 0.5, 0.25)}}, ["--fog", "density=0.1,albedo=1:0.5:0.25"]),
    ({"camera": {"eye": (0, 1, 5), "look": (0, 0, 0), "fov": 40}}, ["--camera", "eye=0,1,5;look=0,0,0;fov=40"]),
    ({"far": -1.5}, ["--far=-1.5"]),
])
def test_words(keywords, expected):
    assert words("composite", keywords, ["a.exr", "-b.glb"]) == expected + ["--", "a.exr", "-b.glb"]


@pytest.mark.parametrize("keywords, sentence", [
    ({"metod": "over"}, "found the option metod, which does not exist: did you mean method?"),
    ({"zzzzzz": 1}, "pellucid.options('composite') lists"),
    ({"json": True}, "found the option json, which does not exist"),
    ({"measure": 3}, "measure: found 3, expected True or False"),
    ({"aa": object()}, "aa: found <object object"),
])
def test_refused(keywords, sentence):
    with pytest.raises(pellucid.UsageError, match=re.escape(sentence)):
        words("composite", keywords)


def test_options_say_what_the_help_says(program):
    help_text = " ".join(program("composite", "--help").out.split())
    for name, row in pellucid.options("composite").items():
        if name == "view":  # the program takes all views, a call one
            continue
        assert " ".join(row["help"].split()) in help_text, name
    with pytest.raises(pellucid.UsageError, match="found 'inspect'"):
        pellucid.options("inspect")


def test_docstrings_and_stubs_have_every_keyword():
    stubs = (pathlib.Path(pellucid.__file__).parent / "__init__.pyi").read_text(encoding="utf-8")
    for verb in VERBS:
        function = getattr(pellucid, verb)
        stub = stubs[stubs.index(f"def {verb}("):]
        stub = stub[:stub.index("...")]
        for name, row in pellucid.options(verb).items():
            assert f"    {name}: {row['help']}" in function.__doc__, name
            assert f"    {name}: Optional[" in stub, name
        assert "Raises" in function.__doc__ and "Returns" in function.__doc__


def test_the_version_is_the_programs(program):
    assert program("--version").out.strip() == pellucid.__version__

"""The job template of samples/farm keeps the schema of Open Job Description 2023-09, and its command works.

The facts are those of the specification's template schemas, sections 1 to 7, without extensions: which members an
object has, of which kind, and how long; which values a format string may name where it stands.
"""

import copy
import json
import os
import re
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
TEMPLATE = ROOT / "samples/farm/shot.openjd.json"
PROGRAM = Path(os.environ.get("PELLUCID_PROGRAM", ROOT / "build/bin/pellucid"))

REFERENCE = re.compile(r"\{\{\s*([^{}]*?)\s*\}\}")


class Broken(Exception):
    """What is wrong, and where."""


def expect(right, where, found, expected):
    if not right:
        raise Broken(f"{where}: found {found!r}, expected {expected}")


# A rule is a function of a value and of where it stands; these make rules.
def text(least=0, most=None, pattern=None):
    def rule(value, where):
        expect(isinstance(value, str), where, value, "a string")
        fits = len(value) >= least and (most is None or len(value) <= most)
        expect(fits, where, value, f"{least} to {most} characters")
        expect(pattern is None or re.fullmatch(pattern, value), where, value, f"a match of {pattern}")

    return rule


def one_of(*words):
    return lambda value, where: expect(value in words, where, value, " or ".join(words))


def whole(least=None, most=None):
    def rule(value, where):
        number = int(value) if isinstance(value, str) and re.fullmatch(r"[+-]?\d+", value) else value
        expect(isinstance(number, int) and not isinstance(number, bool), where, value, "an integer")
        fits = (least is None or number >= least) and (most is None or number <= most)
        expect(fits, where, value, f"{least} to {most}")

    return rule


def items(rule, least=0, most=None):
    def check(value, where):
        expect(isinstance(value, list), where, value, "a list")
        fits = len(value) >= least and (most is None or len(value) <= most)
        expect(fits, where, len(value), f"{least} to {most} elements")
        for index, item in enumerate(value):
            rule(item, f"{where}[{index}]")

    return check


def members(required, optional=None):
    every = {**required, **(optional or {})}

    def check(value, where):
        expect(isinstance(value, dict), where, value, "an object")
        for name in required:
            expect(name in value, where, sorted(value), f"a member {name}")
        for name, member in value.items():
            expect(name in every, where, name, f"one of {sorted(every)}")
            every[name](member, f"{where}.{name}")

    return check


def by(member, kinds):
    def check(value, where):
        expect(isinstance(value, dict) and value.get(member) in kinds, where, value, f"{member} of {sorted(kinds)}")
        kinds[value[member]](value, where)

    return check


def either(first, second):
    return lambda value, where: (first if isinstance(value, list) else second)(value, where)


NO_CONTROLS = r"[^\x00-\x1f\x7f-\x9f]*"
IDENTIFIER = text(1, 64, r"[A-Za-z_][A-Za-z0-9_]*")
DESCRIPTION = text(1, 2048)
VALUE = text(0, 1024)
FORMAT = text(1)
LABEL = text(1, 64, NO_CONTROLS)
INTERFACE = members({}, {"control": text(1), "label": LABEL, "groupLabel": LABEL})

STRING_LIKE = {"description": DESCRIPTION, "default": VALUE, "allowedValues": items(VALUE, 1), "minLength": whole(0),
               "maxLength": whole(0), "userInterface": INTERFACE}
PARAMETER = by("type", {
    "STRING": members({"name": IDENTIFIER, "type": text()}, STRING_LIKE),
    "PATH": members({"name": IDENTIFIER, "type": text()},
                    {**STRING_LIKE, "objectType": one_of("FILE", "DIRECTORY"),
                     "dataFlow": one_of("NONE", "IN", "OUT", "INOUT")}),
    "INT": members({"name": IDENTIFIER, "type": text()},
                   {"description": DESCRIPTION, "default": whole(), "allowedValues": items(whole(), 1),
                    "minValue": whole(), "maxValue": whole(), "userInterface": INTERFACE}),
})
CANCELATION = by("mode", {
    "TERMINATE": members({"mode": text()}),
    "NOTIFY_THEN_TERMINATE": members({"mode": text()}, {"notifyPeriodInSeconds": whole(1, 600)}),
})
ACTION = members({"command": FORMAT}, {"args": items(text(0)), "timeout": whole(1), "cancelation": CANCELATION})
SPACE = members({"taskParameterDefinitions": items(
    members({"name": IDENTIFIER, "type": one_of("INT"), "range": either(items(whole(), 1, 1024), FORMAT)}), 1, 16)},
    {"combination": text(1, 1280)})
STEP = members({"name": text(1, 64, NO_CONTROLS), "script": members({"actions": members({"onRun": ACTION})})},
               {"description": DESCRIPTION, "parameterSpace": SPACE})
JOB = members({"specificationVersion": one_of("jobtemplate-2023-09"), "name": text(1, None, NO_CONTROLS),
               "steps": items(STEP, 1)},
              {"$schema": text(), "description": DESCRIPTION, "parameterDefinitions": items(PARAMETER, 1, 50)})


def unique(names, where):
    expect(len(set(names)) == len(names), where, names, "names that differ")


def references(value):
    """Names in the format strings of a value, however deep."""
    if isinstance(value, str):
        return REFERENCE.findall(value)
    parts = value.values() if isinstance(value, dict) else value if isinstance(value, list) else []
    return [name for part in parts for name in references(part)]


def check_default(parameter, where):
    if "default" not in parameter or parameter["type"] != "INT":
        return
    whole(parameter.get("minValue"), parameter.get("maxValue"))(parameter["default"], f"{where}.default")


def check_names(job):
    parameters = {each["name"]: each["type"] for each in job.get("parameterDefinitions", [])}
    unique([each["name"] for each in job.get("parameterDefinitions", [])], "parameterDefinitions")
    unique([each["name"] for each in job["steps"]], "steps")
    # On the submitting machine a path is known as it was given; on the host as it is mapped there, too.
    early = {f"Param.{name}" for name, kind in parameters.items() if kind != "PATH"}
    early |= {f"RawParam.{name}" for name in parameters}
    session = {f"Session.{name}" for name in ("WorkingDirectory", "HasPathMappingRules", "PathMappingRulesFile")}
    late = early | session | {f"Param.{name}" for name in parameters}
    for name in references(job["name"]):
        expect(name in early, "name", name, f"one of {sorted(early)}")
    for step in job["steps"]:
        tasks = [each["name"] for each in step.get("parameterSpace", {}).get("taskParameterDefinitions", [])]
        unique(tasks, step["name"])
        for name in references(step.get("parameterSpace", {})):
            expect(name in early, f"{step['name']}.parameterSpace", name, f"one of {sorted(early)}")
        known = late | {f"Task.{kind}.{name}" for name in tasks for kind in ("Param", "RawParam")}
        for name in references(step["script"]):
            expect(name in known, f"{step['name']}.script", name, f"one of {sorted(known)}")
    for index, parameter in enumerate(job.get("parameterDefinitions", [])):
        check_default(parameter, f"parameterDefinitions[{index}]")


def check(job):
    JOB(job, "template")
    check_names(job)


@pytest.fixture(name="job")
def fixture_job():
    return json.loads(TEMPLATE.read_text(encoding="utf-8"))


def test_the_template_keeps_the_schema(job):
    check(job)


# Each breaks the template in one place.
BREAKS = {
    "another version": lambda job: job.update(specificationVersion="jobtemplate-2025-01"),
    "no steps": lambda job: job.update(steps=[]),
    "no name": lambda job: job.pop("name"),
    "an unknown member": lambda job: job.update(priority=50),
    "a name that is none": lambda job: job["parameterDefinitions"][0].update(name="1st"),
    "a name twice": lambda job: job["parameterDefinitions"].append(dict(job["parameterDefinitions"][0])),
    "an unknown type": lambda job: job["parameterDefinitions"][0].update(type="FILE"),
    "an unknown flow": lambda job: job["parameterDefinitions"][0].update(dataFlow="BOTH"),
    "a default out of its range": lambda job: parameter_of(job, "Passes").update(default=0),
    "a default of another kind": lambda job: parameter_of(job, "Passes").update(default=1.5),
    "a path in the job's name": lambda job: job.update(name="{{Param.Opaque}}"),
    "a parameter that nobody defines": lambda job: on_run(job)["args"].append("{{Param.Missing}}"),
    "a task's parameter in the range": lambda job: task_of(job).update(range="{{Task.Param.Frame}}"),
    "a period that is too long": lambda job: on_run(job)["cancelation"].update(notifyPeriodInSeconds=601),
    "an action without a command": lambda job: on_run(job).pop("command"),
    "an argument that is no text": lambda job: on_run(job)["args"].append(8),
}


def parameter_of(job, name):
    return next(each for each in job["parameterDefinitions"] if each["name"] == name)


def on_run(job):
    return job["steps"][0]["script"]["actions"]["onRun"]


def task_of(job):
    return job["steps"][0]["parameterSpace"]["taskParameterDefinitions"][0]


@pytest.mark.parametrize("name", BREAKS)
def test_what_breaks_it_is_found(job, name):
    broken = copy.deepcopy(job)
    BREAKS[name](broken)
    with pytest.raises(Broken):
        check(broken)


def test_the_command_of_a_task_makes_its_frame(job, tmp_path):
    samples = [PROGRAM.parent / "pellucid_samples", ".", "bars", "90"]
    subprocess.run(samples, cwd=tmp_path, check=True, capture_output=True)
    (tmp_path / "bars.exr").rename(tmp_path / "shot.1001.exr")
    usual = [each for each in job["parameterDefinitions"] if "default" in each]
    values = {f"Param.{each['name']}": str(each["default"]) for each in usual}
    values |= {"Param.Pellucid": str(PROGRAM), "Param.Opaque": "shot.####.exr", "Param.Glass": "bars.glb",
               "Param.Output": "out.####.exr", "Param.Passes": "1", "Task.Param.Frame": "1001"}
    action = on_run(job)
    words = [REFERENCE.sub(lambda found: values[found[1]], word) for word in [action["command"], *action["args"]]]
    ended = subprocess.run(words, cwd=tmp_path, check=False, capture_output=True, text=True)
    assert ended.returncode == 0, ended.stderr
    assert "openjd_progress: 100" in ended.stderr + ended.stdout
    assert (tmp_path / "out.1001.exr").exists()

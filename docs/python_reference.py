"""Prints the reference of the Python module as a page: its docstrings."""

import inspect

import pellucid

print("# The Python module\n")
print(inspect.getdoc(pellucid).split("\n")[0])
for name in sorted(pellucid.__all__):
    thing = getattr(pellucid, name)
    print(f"\n## {name}\n\n```text\n{inspect.getdoc(thing)}\n```")
    if not inspect.isclass(thing):
        continue
    for member, value in vars(thing).items():
        text = inspect.getdoc(value) if not member.startswith("_") else None
        if text and (inspect.isfunction(value) or isinstance(value, (property, classmethod))):
            print(f"\n### {name}.{member}\n\n```text\n{text}\n```")

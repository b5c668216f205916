"""docs/api.md: the public names of `zerorate_tools`, from their annotations and docstrings."""

import griffe

_HEAD = """\
# `zerorate_tools` from Python

Made from the docstrings by `make docs`. [notebook.md](notebook.md) shows them at work. Names
are imported when they are first used; every error on purpose is a `ZerorateError`.
"""
#: What the firmware and the drivers give a program on a board, and on a host alike.
_FIRMWARE = (
    ("zerorate.corrector", "Corrector"),
    ("zerorate.settings", "Sensor"),
    ("zerorate.checked", "CheckedCorrector"),
    ("zerorate.model", "EffectModel"),
    ("zerorate.motion.orientation", "orientation"),
    ("zerorate_i2c.mpu6050", "MPU6050"),
)


_WIDEST = 90


def api_page(repository):
    """The page's text."""
    tools = _loaded(repository / "tools", "zerorate_tools")
    parts = [_HEAD]
    for name in tools.exports:
        parts.append(_entry(str(name), tools[str(name)].final_target))
    parts.append("# On a board: `zerorate` and `zerorate_i2c`\n")
    roots = {"zerorate": "firmware", "zerorate_i2c": "drivers"}
    for module, name in _FIRMWARE:
        package = module.partition(".")[0]
        loaded = _loaded(repository / roots[package], package)
        parts.append(_entry(name, loaded[module.partition(".")[2]][name]))
    return "\n".join(parts)


def _loaded(folder, package):
    loader = griffe.GriffeLoader(search_paths=[str(folder)], allow_inspection=False)
    loaded = loader.load(package)
    loader.resolve_aliases()
    return loaded


def _entry(name, what):
    # py, not python: a signature is shown, not run
    lines = [f"## `{name}`", "", "```py", _signature(name, what), "```", "", _text(what), ""]
    if what.is_class:
        for member in what.members.values():
            if not member.is_alias and not member.name.startswith("_") and member.has_docstring:
                signature = " ".join(_signature(member.name, member).split())
                lines += [f"**`{signature}`**", "", _text(member), ""]
    return "\n".join(lines)


def _signature(name, what):
    if not what.is_class and not what.is_function:
        return f"{name}: {what.annotation}" if getattr(what, "annotation", None) else name
    parameters = _parameters(what.parameters)
    returns = f" -> {what.returns}" if what.is_function and what.returns is not None else ""
    line = f"{name}({', '.join(parameters)}){returns}"
    if len(line) < _WIDEST:
        return line
    return f"{name}(\n    " + ",\n    ".join(parameters) + f",\n){returns}"


def _parameters(parameters):
    shown, named_only = [], False
    for one in parameters:
        if one.name == "self":
            continue
        if one.kind is griffe.ParameterKind.keyword_only and not named_only:
            shown.append("*")
            named_only = True
        stars = {"variadic positional": "*", "variadic keyword": "**"}.get(one.kind.value, "")
        text = stars + one.name + (f": {one.annotation}" if one.annotation is not None else "")
        if one.default is not None and not stars:
            text += f" = {one.default}" if one.annotation is not None else f"={one.default}"
        shown.append(text)
    return shown


def _text(what):
    return what.docstring.value.strip() if what.docstring else ""

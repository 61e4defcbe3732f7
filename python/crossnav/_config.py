# SPDX-License-Identifier: MIT
"""Settings as users write them: nested mappings, dotted keys, TOML text or a TOML file."""

import json
import os
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Union

from crossnav._errors import Error

if TYPE_CHECKING:
    from crossnav._core import Config

Settings = Union["Config", Mapping[str, Any], str, "os.PathLike[str]", None]
"""A Config, a mapping (nested or with dotted keys), a TOML text, or the path of a TOML file."""


def _value(key: str, value: object) -> str:
    """A scalar as TOML."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return json.dumps(value)
    if isinstance(value, int):
        return str(int(value))
    if isinstance(value, float):
        return repr(float(value))
    item = getattr(value, "item", None)  # a NumPy scalar
    if callable(item):
        return _value(key, item())
    raise Error(f'key "{key}" must be a single value', "config")


def _lines(settings: Mapping[str, Any], prefix: str) -> list[str]:
    lines = []
    for name, value in settings.items():
        key = prefix + str(name)
        if isinstance(value, Mapping):
            lines += _lines(value, key + ".")
        else:
            lines.append(".".join(json.dumps(part) for part in key.split("."))
                         + " = " + _value(key, value))
    return lines


def toml_of(settings: object) -> tuple[str, str]:
    """(TOML text, its name in messages) of the user's settings."""
    if isinstance(settings, str):
        return settings, "config"
    if isinstance(settings, os.PathLike):
        path = os.fspath(settings)
        try:
            with open(path, encoding="utf-8") as file:
                return file.read(), str(path)
        except OSError as error:
            raise Error(error.strerror or str(error), str(path), "io") from error
    if isinstance(settings, Mapping):
        return "\n".join(_lines(settings, "")), "config"
    raise TypeError("settings are a Config, a mapping, a TOML text or the path of a TOML file")

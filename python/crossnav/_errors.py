# SPDX-License-Identifier: MIT
"""Errors of outside data: files, settings, observations."""


class Error(Exception):
    """Bad data from outside. ``str(error)`` is the message of the program `crossnav`."""

    what: str
    """Reason and remedy."""
    where: str
    """The file, and key, line or node inside it; may be empty."""
    code: str
    """not_found, malformed, unsupported, invalid, mismatch or io."""

    def __init__(self, what: str, where: str = "", code: str = "invalid") -> None:
        super().__init__(f"{where}: {what}" if where else what)
        self.what = what
        self.where = where
        self.code = code

    def __reduce__(self) -> tuple[type["Error"], tuple[str, str, str]]:
        return type(self), (self.what, self.where, self.code)

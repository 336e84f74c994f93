"""What goes wrong, in the program's own words."""

from __future__ import annotations

from typing import Any

# docs of the program's exit codes: README.md. Those of verbs that compare pixels are no errors.
_KINDS = {1: "internal", 2: "input", 3: "render", 4: "environment", 5: "corrupt", 130: "interrupted"}


class Error(Exception):
    """Something that Seedframe could not do.

    Attributes:
        message: what was expected, what was found, where, and what to do; several lines if there is more than one mistake.
        kind: who can mend it. ``input``: a config, a value or an argument is wrong. ``environment``: Blender, the disk, memory
            or the program itself is not as needed. ``corrupt``: a file is not as it was written. ``render``: frames could
            not be made. ``interrupted``: stopped by a signal. ``internal``: a mistake in Seedframe.
        exit_code: of the program if it has ended, negative for the signal that ended it; ``None`` otherwise.

    """

    def __init__(self, message: str, kind: str = "input", exit_code: int | None = None) -> None:
        super().__init__(message)
        self.message = message
        self.kind = kind
        self.exit_code = exit_code

    def __reduce__(self) -> tuple[Any, ...]:
        return Error, (self.message, self.kind, self.exit_code)


def kind_of_exit(exit_code: int) -> str:
    """The kind of error that an exit code of the program stands for."""
    if exit_code < 0:
        return "environment"  # killed
    return _KINDS.get(exit_code, "internal")

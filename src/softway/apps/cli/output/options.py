"""Options that several commands share."""

from typing import Annotated

from cyclopts import Parameter

Set = Annotated[tuple[str, ...], Parameter(name="--set", negative=())]
Quiet = Annotated[bool, Parameter(name=["--quiet", "-q"], negative=())]
AllowPython = Annotated[bool, Parameter(negative=())]
Strict = Annotated[bool, Parameter(negative=())]

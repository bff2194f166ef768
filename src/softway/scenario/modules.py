"""Python of the user's own in a scenario: ``module:name``, and when it may run.

A scenario is data. It runs code of a module only if the module lies in the folder of the scenario, where whoever wrote
the one could write the other, or if the caller allows it. Nothing of the module runs before that is known.
"""

import importlib
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, is_dataclass
from importlib.machinery import PathFinder
from pathlib import Path
from typing import Any

from softway.errors import InputError
from softway.laws.fitting import asked, lacking

_OURS = "softway."


@dataclass(frozen=True, slots=True, kw_only=True)
class Modules:
    """Finds what a scenario names by ``module:name``.

    Parameters
    ----------
    folder
        That of the scenario, whose modules are admitted; None: there is none.
    allowed
        Whether installed modules are admitted too.

    Examples
    --------
    >>> Modules(allowed=True).found("math:pi", "here")
    3.141592653589793
    >>> Modules().found("math:pi", "here")
    Traceback (most recent call last):
    softway.errors.InputError: here: 'math:pi' would run Python that does not lie beside the scenario
      try: math.py in its folder, or --allow-python (allow_python=True) if you trust the module
    """

    folder: Path | None = None
    allowed: bool = False

    def law(self, kind: str, protocols: tuple[type, ...], where: str) -> type:
        """The dataclass named by ``module:Class``, which must have what one of the protocols asks for.

        Raises
        ------
        InputError
            It may not run, is not found, fails, is no dataclass, or lacks a member.
        """
        if kind.startswith(_OURS):
            found = _taken(kind, where)
        else:
            found = self.found(kind, where)
        if not (isinstance(found, type) and is_dataclass(found)):
            raise InputError(where, f"{kind!r} is no dataclass", "a class with @dataclass(frozen=True, kw_only=True)")
        missing = [lacking(found, p) for p in protocols]
        if missing and all(missing):
            share = [len(names) / len(asked(p)) for names, p in zip(missing, protocols, strict=True)]
            least = share.index(min(share))
            problem = f"{kind!r} is no {' or '.join(p.__name__ for p in protocols)}"
            raise InputError(where, problem, f"for a {protocols[least].__name__} it lacks: {', '.join(missing[least])}")
        return found

    def found(self, text: str, where: str) -> Any:
        """What ``module:name`` stands for."""
        module, sign, name = text.partition(":")
        parts = module.split(".")
        if not (sign and name.isidentifier() and all(part.isidentifier() for part in parts)):
            raise InputError(where, f"{text!r} names nothing in a module", "module:name, such as my_law:MyLaw")
        if self.folder is not None and _lies_in(self.folder, parts[0]):
            with _first(self.folder, parts[0], where):
                return _taken(text, where)
        if not self.allowed:
            problem = f"{text!r} would run Python that does not lie beside the scenario"
            remedy = f"{parts[0]}.py in its folder, or --allow-python (allow_python=True) if you trust the module"
            raise InputError(where, problem, remedy)
        return _taken(text, where)


def _lies_in(folder: Path, name: str) -> bool:
    """Whether a folder holds a module or package of that name."""
    return (folder / f"{name}.py").is_file() or (folder / name / "__init__.py").is_file()


@contextmanager
def _first(folder: Path, name: str, where: str) -> Iterator[None]:
    """Search the folder before all others; a module of that name beside another scenario gives way."""
    own = [(folder / file).resolve() for file in (f"{name}.py", f"{name}/__init__.py")]
    installed = PathFinder.find_spec(name)
    origin = None if installed is None else installed.origin
    if name in sys.stdlib_module_names or origin is not None and Path(origin).resolve() not in own:
        problem = f"{name!r} beside the scenario has the name of another module ({origin or 'part of Python'})"
        raise InputError(where, problem, f"another name for {name}.py")
    known = getattr(sys.modules.get(name), "__file__", None)
    if known is None or Path(known).resolve() not in own:
        for key in [k for k in sys.modules if k == name or k.startswith(f"{name}.")]:
            del sys.modules[key]
    importlib.invalidate_caches()
    place = str(folder.resolve())
    sys.path.insert(0, place)
    try:
        yield
    finally:
        sys.path.remove(place)


def _taken(text: str, where: str) -> Any:
    """Import the module and take the name out of it."""
    module, _, name = text.partition(":")
    try:
        source = importlib.import_module(module)
    except ModuleNotFoundError as error:
        problem = f"{text!r}: there is no module {error.name!r}"
        raise InputError(where, problem, f"{module}.py beside the scenario, or install it") from error
    except Exception as error:  # code of the user: whatever it raises is what is wrong
        raise InputError(where, f"{text!r} fails: {type(error).__name__}: {error}", "a module that imports") from error
    if not hasattr(source, name):
        own = [n for n, v in vars(source).items() if isinstance(v, type) and v.__module__ == module]
        raise InputError(where, f"{module!r} has no {name!r}", f"one of: {', '.join(own) or 'no class'}")
    return getattr(source, name)

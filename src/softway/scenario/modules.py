"""Python of the user's own in a scenario: ``module:name``, and when it may run.

A scenario is data. It runs code of a module only if the module lies in the folder of the scenario, where whoever wrote
the one could write the other, or if the caller allows it. Nothing of the module runs before that is known.
"""

import importlib
import sys
import sysconfig
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass, fields, is_dataclass
from importlib.machinery import PathFinder
from pathlib import Path
from threading import RLock
from types import FunctionType
from typing import Any

from softway.errors import InputError
from softway.laws.fitting import asked, lacking

_OURS = "softway."
READING = RLock()
"""Held while a scenario is read: Python looks for modules in one list of folders, and knows one of each name."""


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
        own = None if self.folder is None else _beside(self.folder, parts[0])
        if self.folder is not None and own is not None:
            with READING, _first(own, parts[0], self.folder, where):
                return _taken(text, where)
        if not self.allowed:
            problem = f"{text!r} would run Python that does not lie beside the scenario"
            remedy = f"{parts[0]}.py in its folder, or --allow-python (allow_python=True) if you trust the module"
            raise InputError(where, problem, remedy)
        return _taken(text, where)


def own_sources(data: Any, made: object = None) -> dict[str, str]:
    """Texts of the files behind every ``module:name`` in the data of a scenario, by the name of the file.

    Installed modules and packages are left out, for they are more than one file, and so is a script that runs.

    Parameters
    ----------
    data
        The scenario as tables and lists.
    made
        The scenario as it was read: its objects know their file, also where another scenario has brought a module of
        the same name since.

    Examples
    --------
    >>> own_sources({"kind": "math:pi", "law": [{"kind": "NeoHookean"}]})
    {}
    """
    files = {name: getattr(sys.modules.get(name), "__file__", None) or "" for name in _named(data)}
    origins = dict(_origins(made))
    known = {name: Path(origins.get(name) or file) for name, file in files.items() if name != "__main__" and file}
    return {f"{n}.py": f.read_text(encoding="utf-8") for n, f in known.items() if not _installed(f)}


def _named(data: Any) -> Iterator[str]:
    """The modules of every ``module:name`` in the data."""
    if isinstance(data, str):
        module, sign, name = data.partition(":")
        if sign and name.isidentifier():
            yield module
    elif isinstance(data, list | tuple | Mapping):
        for item in data.values() if isinstance(data, Mapping) else data:
            yield from _named(item)


def _origins(made: object) -> Iterator[tuple[str, str]]:
    """Name and file of the module of every function in an object, and of the methods of every class."""
    if isinstance(made, FunctionType):
        yield made.__module__, made.__globals__.get("__file__", "")
    elif isinstance(made, list | tuple | Mapping):
        for item in made.values() if isinstance(made, Mapping) else made:
            yield from _origins(item)
    elif is_dataclass(made):
        methods = (f for f in vars(type(made)).values() if isinstance(f, FunctionType))
        yield from (found for method in methods for found in _origins(method))
        for part in fields(made):
            yield from _origins(getattr(made, part.name, None))


def _installed(file: Path) -> bool:
    """Whether a file is part of Python or of an installed package, of softway itself too."""
    homes = [sysconfig.get_path(name) for name in ("stdlib", "platstdlib", "purelib", "platlib")]
    places = [Path(home).resolve() for home in homes] + [Path(__file__).resolve().parents[1]]
    return file.name == "__init__.py" or any(file.resolve().is_relative_to(place) for place in places)


def _beside(folder: Path, name: str) -> Path | None:
    """The file of a module or package of that name in a folder."""
    files = (folder / f"{name}.py", folder / name / "__init__.py")
    return next((file.resolve() for file in files if file.is_file()), None)


@contextmanager
def _first(own: Path, name: str, folder: Path, where: str) -> Iterator[None]:
    """Search the folder before all others; a module of that name beside another scenario gives way."""
    installed = PathFinder.find_spec(name)
    origin = None if installed is None else installed.origin
    if name in (*sys.stdlib_module_names, "__main__") or origin is not None and not _same(Path(origin), own):
        problem = f"{name!r} beside the scenario has the name of another module ({origin or 'part of Python'})"
        raise InputError(where, problem, f"another name for {name}.py")
    known = getattr(sys.modules.get(name), "__file__", None)
    if known is None or not _same(Path(known), own):
        for key in [k for k in sys.modules if k == name or k.startswith(f"{name}.")]:
            del sys.modules[key]
    importlib.invalidate_caches()
    place = str(folder.resolve())
    sys.path.insert(0, place)
    try:
        yield
    finally:
        sys.path.remove(place)


def _same(one: Path, other: Path) -> bool:
    """Whether two files are one, or copies of each other."""
    return one.resolve() == other or one.is_file() and one.read_bytes() == other.read_bytes()


def _taken(text: str, where: str) -> Any:
    """Import the module and take the name out of it."""
    module, _, name = text.partition(":")
    try:
        source = importlib.import_module(module)
    except ModuleNotFoundError as error:
        if error.name != module:
            problem = f"{text!r} asks for what is not there: no module {error.name!r}"
            raise InputError(where, problem, f"to install what {module} imports") from error
        problem = f"{text!r}: there is no module {error.name!r}"
        raise InputError(where, problem, f"{module}.py beside the scenario, or install it") from error
    except Exception as error:  # code of the user: whatever it raises is what is wrong
        raise InputError(where, f"{text!r} fails: {type(error).__name__}: {error}", "a module that imports") from error
    if not hasattr(source, name):
        own = [n for n, v in vars(source).items() if isinstance(v, type) and v.__module__ == module]
        raise InputError(where, f"{module!r} has no {name!r}", f"one of: {', '.join(own) or 'no class'}")
    return getattr(source, name)

"""User-defined Python code in a scenario, ``module:name``, and the rules for running it.

A scenario is data.  It runs the code of a module only if the module lies in the folder of the scenario, or if the
caller allows it.  No code of the module runs before this has been checked.
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
from softway.scenario.text.conformance import asked, lacking

_OURS = "softway."
READING = RLock()
"""Lock held while a scenario is read: Python has only one search path and one module of each name."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Modules:
    """Finder of the objects that a scenario names by ``module:name``.

    Parameters
    ----------
    folder
        Folder of the scenario, whose modules are admitted; None without such a folder.
    allowed
        True if installed modules are also admitted.

    Examples
    --------
    >>> Modules(allowed=True).found("math:pi", "here")
    3.141592653589793
    >>> Modules().found("math:pi", "here")
    Traceback (most recent call last):
    softway.errors.InputError: here: 'math:pi' would run Python code outside of the folder of the scenario
      try: math.py in that folder, or --allow-python (allow_python=True) if you trust the module
    """

    folder: Path | None = None
    allowed: bool = False

    def law(self, kind: str, protocols: tuple[type, ...], where: str) -> type:
        """Find the dataclass named by ``module:Class``, which must have the members of one of the protocols.

        Raises
        ------
        InputError
            If the module may not run, is not found or fails, or if the class is not a dataclass or lacks a member.
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
            remedy = f"add the members that a {protocols[least].__name__} needs: {', '.join(missing[least])}"
            raise InputError(where, problem, remedy)
        return found

    def found(self, text: str, where: str) -> Any:
        """Find the object that ``module:name`` refers to."""
        module, sign, name = text.partition(":")
        parts = module.split(".")
        if not (sign and name.isidentifier() and all(part.isidentifier() for part in parts)):
            raise InputError(where, f"{text!r} is not of the form module:name", "module:name, such as my_law:MyLaw")
        own = None if self.folder is None else _beside(self.folder, parts[0])
        if self.folder is not None and own is not None:
            with READING, _first(own, parts[0], self.folder, where):
                return _taken(text, where)
        if not self.allowed:
            problem = f"{text!r} would run Python code outside of the folder of the scenario"
            remedy = f"{parts[0]}.py in that folder, or --allow-python (allow_python=True) if you trust the module"
            raise InputError(where, problem, remedy)
        return _taken(text, where)


def own_sources(data: Any, made: object = None) -> dict[str, str]:
    """Source texts of all modules named by ``module:name`` in the data of a scenario, by file name.

    Installed modules and packages are omitted, since they consist of more than one file, and so is the running script.

    Parameters
    ----------
    data
        Scenario as tables and lists.
    made
        Scenario as it was read.  Its objects know their source file, even if another scenario has loaded a module of
        the same name since then.

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
    """Names of the modules of every ``module:name`` in the data."""
    if isinstance(data, str):
        module, sign, name = data.partition(":")
        if sign and name.isidentifier():
            yield module
    elif isinstance(data, list | tuple | Mapping):
        for item in data.values() if isinstance(data, Mapping) else data:
            yield from _named(item)


def _origins(made: object) -> Iterator[tuple[str, str]]:
    """Module names and files of all functions in an object, and of the methods of its classes."""
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
    """True if a file belongs to Python or to an installed package, including softway itself."""
    homes = [sysconfig.get_path(name) for name in ("stdlib", "platstdlib", "purelib", "platlib")]
    places = [Path(home).resolve() for home in homes] + [Path(__file__).resolve().parents[2]]
    return file.name == "__init__.py" or any(file.resolve().is_relative_to(place) for place in places)


def _beside(folder: Path, name: str) -> Path | None:
    """File of the module or package with a given name in a folder; None without one."""
    files = (folder / f"{name}.py", folder / name / "__init__.py")
    return next((file.resolve() for file in files if file.is_file()), None)


@contextmanager
def _first(own: Path, name: str, folder: Path, where: str) -> Iterator[None]:
    """Search the folder first, and unload a module of the same name from the folder of another scenario."""
    installed = PathFinder.find_spec(name)
    origin = None if installed is None else installed.origin
    if name in (*sys.stdlib_module_names, "__main__") or origin is not None and not _same(Path(origin), own):
        problem = f"{name!r} next to the scenario has the name of another module ({origin or 'part of Python'})"
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
    """True if two paths are the same file or have the same content."""
    return one.resolve() == other or one.is_file() and one.read_bytes() == other.read_bytes()


def _taken(text: str, where: str) -> Any:
    """Import the module and return the named object."""
    module, _, name = text.partition(":")
    try:
        source = importlib.import_module(module)
    except ModuleNotFoundError as error:
        if error.name != module:
            problem = f"{text!r} imports the module {error.name!r}, which is not installed"
            raise InputError(where, problem, f"install {error.name}") from error
        problem = f"{text!r}: there is no module {error.name!r}"
        raise InputError(where, problem, f"{module}.py next to the scenario, or install it") from error
    except Exception as error:  # user code may raise any exception
        problem = f"{text!r} cannot be imported: {type(error).__name__}: {error}"
        raise InputError(where, problem, f"correct the module {module}") from error
    if not hasattr(source, name):
        own = [n for n, v in vars(source).items() if isinstance(v, type) and v.__module__ == module]
        raise InputError(where, f"{module!r} has no {name!r}", f"one of: {', '.join(own) or 'no class'}")
    return getattr(source, name)

"""No module of the package holds state: runs in threads of one process share nothing that one of them changes."""

import ast
import importlib
import logging
from collections import deque
from collections.abc import Iterable, Iterator
from contextvars import ContextVar
from fnmatch import fnmatch
from pathlib import Path
from threading import Event, Lock, RLock

import numpy as np
import pytest

from sources import Source, functions, parsed

CHANGES = {
    "append", "appendleft", "extend", "insert", "pop", "popleft", "popitem", "remove", "clear", "update", "setdefault",
    "add", "discard", "sort", "reverse", "fill", "set", "setflags", "move_to_end",
}  # fmt: skip
"""Methods that change what they are called on."""
PROCESS = {
    "os.chdir", "os.putenv", "os.umask", "os.environ.*", "sys.path.*", "sys.setrecursionlimit", "signal.signal",
    "signal.set*", "warnings.*", "locale.setlocale", "logging.basicConfig", "logging.disable", "numpy.random.seed",
    "np.random.seed", "np.random.set_state", "np.seterr", "np.set_printoptions", "matplotlib.use", "*.rcParams.*",
    "gc.*", "atexit.register", "*.rc_context", "*.setLevel", "*.addHandler", "tracemalloc.*",
}  # fmt: skip
"""Calls that change what all of a process shares."""
ALLOWED = {
    "softway: logging.getLogger(__name__).addHandler": "silence, until the program around it says where the log goes",
    "softway.kernels.jit.threads: _CHOSEN.set": "a context variable, of one thread, put back where it was set",
    "softway.studies.processes: signal.signal": "in a process of its own, which nobody else has",
    "softway.interrupts: signal.signal": "the same",
    "softway.interrupts: signal.setitimer": "the same",
    "softway.interrupts: sys.unraisablehook": "the same",
    "softway.record.view.style: library().rc_context": "put back, under a lock",
    "softway.scenario.text.user_modules: sys.path.insert": "put back, under a lock",
    "softway.scenario.text.user_modules: sys.path.remove": "the same",
    "softway.scenario.text.user_modules: del sys.modules": "under a lock: modules of one name beside two scenarios",
}
"""What is done nevertheless, and why it does no harm."""
CACHES = (
    "softway.kernels.*",
    "softway.meshes.element",
    "softway.contact.surfaces.facet_geometry",
    "softway.apps.verify.*",
    "softway.solve.linear.blas_threads",
)
"""Modules that may keep what functions of a few short arguments found: kernels, tables of cells, libraries that are
loaded; in the processes of the suite its marches."""
KEPT = (ContextVar, type(Lock()), type(RLock()), Event, deque, bytearray)
HOLDERS = {
    "softway.kernels.jit.threads._CHOSEN": "see above",
    "softway.record.view.style._ONE_AT_A_TIME": "a lock",
    "softway.scenario.text.user_modules.READING": "a lock",
}


def names_of(tree: ast.Module) -> set[str]:
    """What a module binds at its top, but for functions and classes."""
    found: set[str] = set()
    for node in tree.body:
        targets = node.targets if isinstance(node, ast.Assign) else [getattr(node, "target", None)]
        found |= {t.id for t in targets if isinstance(t, ast.Name)}
    return found


def bound(node: ast.FunctionDef | ast.AsyncFunctionDef) -> set[str]:
    """What a function binds for itself."""
    args = node.args
    named = {a.arg for a in (*args.posonlyargs, *args.args, *args.kwonlyargs, args.vararg, args.kwarg) if a}
    return named | {n.id for n in ast.walk(node) if isinstance(n, ast.Name) and isinstance(n.ctx, ast.Store)}


def root(node: ast.expr) -> str:
    """Name at the root of ``name.attribute[...]``, if there is one."""
    while isinstance(node, ast.Attribute | ast.Subscript):
        node = node.value
    return node.id if isinstance(node, ast.Name) else ""


def changed(source: Source) -> Iterator[str]:
    """What functions of a module change beyond themselves: things that it, or another module, holds."""
    imported = {
        alias.asname or alias.name.split(".")[0]
        for n in ast.walk(source.tree) if isinstance(n, ast.Import | ast.ImportFrom) for alias in n.names
    }  # fmt: skip
    outer = names_of(source.tree) | imported | {n.name for n in ast.walk(source.tree) if isinstance(n, ast.ClassDef)}
    for function in functions(source.tree):
        inner = bound(function)
        for node in ast.walk(function):
            for target in written(node):
                if root(target) in outer - inner | {"cls"}:
                    word = "del " if isinstance(node, ast.Delete) else ""
                    yield word + ast.unparse(target.value if isinstance(target, ast.Subscript) else target)
            called = node.func if isinstance(node, ast.Call) else None
            changes = isinstance(called, ast.Attribute) and called.attr in CHANGES
            if called is not None and changes and root(called) in outer - inner - imported | {"cls"}:
                yield ast.unparse(called)


def written(node: ast.AST) -> Iterable[ast.expr]:
    """Places that a statement writes to, other than plain names."""
    if isinstance(node, ast.Assign | ast.Delete):
        targets = node.targets
    else:
        targets = [node.target] if isinstance(node, ast.AugAssign | ast.AnnAssign) else []
    return [t for t in targets if isinstance(t, ast.Attribute | ast.Subscript)]


def process_wide(source: Source) -> Iterator[str]:
    """Calls that change what the process shares."""
    for node in ast.walk(source.tree):
        if isinstance(node, ast.Call):
            called = ast.unparse(node.func)
            if any(fnmatch(called, pattern) for pattern in PROCESS):
                yield called


def complaints(source: Source) -> set[str]:
    return {f"{source.name}: {what}" for what in (*changed(source), *process_wide(source))}


def test_no_module_changes_what_others_see(sources: tuple[Source, ...]) -> None:
    found = {c for source in sources if not source.name.startswith("softway.apps.cli") for c in complaints(source)}
    assert found - ALLOWED.keys() == set()
    assert ALLOWED.keys() - found == set(), "no longer needed"


def test_no_module_keeps_a_thing_made_to_change(sources: tuple[Source, ...]) -> None:
    """Arrays that can be written to, context variables, locks, events; and results only where that is said above."""
    wrong: list[str] = []
    for source in sources:
        if source.name.endswith("__main__"):
            continue
        module = importlib.import_module(source.name)
        for name in names_of(source.tree) & vars(module).keys():
            value = getattr(module, name)
            loose = isinstance(value, np.ndarray) and value.flags.writeable
            if (loose or isinstance(value, KEPT)) and f"{source.name}.{name}" not in HOLDERS:
                wrong.append(f"{source.name}.{name}")
        for node in ast.walk(source.tree):
            kept = [ast.unparse(d) for d in getattr(node, "decorator_list", ())]
            keeps = {"cache", "lru_cache", "functools.cache"} & {k.split("(")[0] for k in kept}
            if keeps and not any(fnmatch(source.name, place) for place in CACHES):
                wrong.append(f"{source.name}.{getattr(node, 'name', '')} keeps what it found")
    assert not wrong
    assert logging.getLogger("softway").level == logging.NOTSET


BAD = """
import os, sys, random
KNOWN = {}
class Counter:
    total = 0
    @classmethod
    def more(cls):
        cls.total += 1
def remember(key):
    KNOWN[key] = 1
    KNOWN.update(other=2)
    del KNOWN[key]
    sys.modules[key] = None
    Counter.total = 3
    os.chdir("/")
def harmless(KNOWN):
    KNOWN["a"] = 1
    own = []
    own.append(2)
"""


@pytest.mark.parametrize(
    "what", ["cls.total", "KNOWN", "KNOWN.update", "del KNOWN", "sys.modules", "Counter.total", "os.chdir"]
)
def test_what_would_be_found(tmp_path: Path, what: str) -> None:
    (tmp_path / "bad.py").write_text(BAD)
    assert f"bad: {what}" in complaints(parsed(tmp_path / "bad.py", tmp_path))
    assert len(complaints(parsed(tmp_path / "bad.py", tmp_path))) == 7

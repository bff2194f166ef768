"""Python sources as syntax trees, and questions about them."""

import ast
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

Function = ast.FunctionDef | ast.AsyncFunctionDef
Documented = Function | ast.ClassDef


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Source:
    """A module: dotted ``name``, ``text`` and its ``tree``."""

    path: Path
    name: str
    text: str
    tree: ast.Module


def read_sources(folder: Path) -> tuple[Source, ...]:
    """Every module under ``folder``, in the order of names."""
    return tuple(parsed(p, folder) for p in sorted(folder.rglob("*.py")))


def parsed(path: Path, folder: Path) -> Source:
    """The module at ``path``; its name is relative to ``folder``."""
    text = path.read_text(encoding="utf-8")
    parts = path.relative_to(folder).with_suffix("").parts
    name = ".".join(p for p in parts if p != "__init__")
    return Source(path=path, name=name, text=text, tree=ast.parse(text, filename=str(path)))


def functions(tree: ast.AST) -> Iterator[Function]:
    """Every function and method, nested ones too."""
    return (n for n in ast.walk(tree) if isinstance(n, Function))


def classes(tree: ast.AST) -> Iterator[ast.ClassDef]:
    """Every class, nested ones too."""
    return (n for n in ast.walk(tree) if isinstance(n, ast.ClassDef))


def public(tree: ast.Module) -> Iterator[tuple[str, Documented]]:
    """Public functions and classes of a module, and public methods of these classes, with their qualified names."""
    for node in tree.body:
        if isinstance(node, Documented) and not node.name.startswith("_"):
            yield node.name, node
            if isinstance(node, ast.ClassDef):
                for inner in node.body:
                    if isinstance(inner, Function) and not inner.name.startswith("_"):
                        yield f"{node.name}.{inner.name}", inner


def length(node: Function) -> int:
    """Lines of a function from ``def`` to its end, without the docstring."""
    lines = (node.end_lineno or node.lineno) - node.lineno + 1
    first = node.body[0]
    if ast.get_docstring(node, clean=False) is not None:
        lines -= (first.end_lineno or first.lineno) - first.lineno + 1
    return lines


def imported(tree: ast.AST) -> Iterator[tuple[int, str]]:
    """Line and full name of every imported module, wherever the statement stands."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            yield from ((node.lineno, alias.name) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            yield node.lineno, "." * node.level + (node.module or "")


def decorators(node: ast.ClassDef) -> Iterator[tuple[str, dict[str, ast.expr]]]:
    """Last word and keywords of each decorator of a class."""
    for item in node.decorator_list:
        call = item if isinstance(item, ast.Call) else None
        target = call.func if call else item
        keywords = {k.arg: k.value for k in call.keywords if k.arg} if call else {}
        yield (target.attr if isinstance(target, ast.Attribute) else getattr(target, "id", "")), keywords


def is_dataclass(node: ast.ClassDef) -> bool:
    """Whether a class is decorated as a dataclass."""
    return any(word == "dataclass" for word, _ in decorators(node))


def bases(node: ast.ClassDef) -> set[str]:
    """Last words of the bases of a class, ``Protocol[T]`` counted as ``Protocol``."""
    plain = [b.value if isinstance(b, ast.Subscript) else b for b in node.bases]
    return {b.attr if isinstance(b, ast.Attribute) else getattr(b, "id", "") for b in plain}

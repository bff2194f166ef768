"""Sphinx: what the reference says of the fields of a data class, in its signature and as a list with types and units.

The docstrings say what a field means; type, unit and default are read from the annotations, as the reader of scenarios
does.  Signatures of functions are those of the source, with its short names of types.
"""

import ast
import inspect
import re
import textwrap
import types
from collections.abc import Callable, Iterator, Mapping
from dataclasses import MISSING, is_dataclass
from importlib import import_module
from itertools import groupby
from pathlib import Path
from typing import Annotated, Any, Literal, Union, get_args, get_origin

import numpy as np
from sphinx.ext.napoleon import Config, NumpyDocstring

from softway.scenario.hints.docstrings import described
from softway.scenario.hints.type_hints import Hint, hints, inputs, members, required

PAGES = Path(__file__).parents[2] / "reference"
NAMES = re.compile(r"^\.\. auto(?:class|function|exception):: (\S+)$", re.MULTILINE)
STYLE = Config(napoleon_google_docstring=False, napoleon_use_rtype=False)


def documented() -> Mapping[Any, str]:
    """What the pages of the reference document, by the names that they use."""
    names = [name for page in sorted(PAGES.rglob("*.md")) for name in NAMES.findall(page.read_text(encoding="utf-8"))]
    full = [name if name.startswith("softway.") else f"softway.{name}" for name in names]
    return {located(name): name for name in full}


def located(path: str) -> Any:
    """What a dotted path leads to; nothing if it does not."""
    module, _, name = path.rpartition(".")
    try:
        return getattr(import_module(module), name)
    except (ImportError, AttributeError, ValueError):
        return None


DOCUMENTED = documented()


def setup(app: Any) -> dict[str, bool]:
    """Connect to autodoc."""
    app.connect("autodoc-process-signature", signature)
    app.connect("autodoc-process-docstring", parameters, priority=400)
    app.connect("autodoc-process-docstring", sections)
    app.connect("missing-reference", moved)
    return {"parallel_read_safe": True, "parallel_write_safe": True}


def signature(_app: Any, what: str, _name: str, thing: Any, _options: Any, given: str | None, back: str | None) -> Any:
    """Fields and defaults of a data class; of a function what its source says."""
    if is_dataclass(thing):
        return f"({', '.join(_entries(thing))})", None
    if what == "class":
        return "", None
    return _of_source(inspect.unwrap(thing)) if what in ("function", "method") else (given, back)


def parameters(_app: Any, _what: str, _name: str, thing: Any, _options: Any, lines: list[str]) -> None:
    """The section Parameters of a data class, with all its fields in the order of the signature."""
    if not (isinstance(thing, type) and is_dataclass(thing) and inputs(thing)):
        return
    said = described(thing)
    start, end = _section(lines)
    lines[start:end] = [":Parameters:", *(f"    {line}" for line in _listed(thing, said.fields)), ""]


def sections(app: Any, what: str, name: str, thing: Any, options: Any, lines: list[str]) -> None:
    """Sections in the style of NumPy; a colon in the sentence of a property does not end its type."""
    kind = "method" if what == "property" else what
    lines[:] = NumpyDocstring(list(lines), STYLE, app, kind, name, thing, options).lines()


def _entries(cls: type) -> Iterator[str]:
    """Arguments of the constructor without types."""
    found = list(inspect.signature(cls).parameters.values())
    for k, parameter in enumerate(found):
        if parameter.kind is parameter.KEYWORD_ONLY and (k == 0 or found[k - 1].kind is not parameter.KEYWORD_ONLY):
            yield "*"
        default = default_of(cls, parameter.name)
        yield f"{parameter.name}={default}" if default else parameter.name


def default_of(cls: type, name: str) -> str:
    """The default of a field as one would write it; nothing if it has none."""
    field = inputs(cls)[name]
    if required(field):
        return ""
    return _written(field.default_factory() if field.default_factory is not MISSING else field.default)


def _written(value: Any) -> str:
    """A value as one would write it: a class with the arguments that are not its defaults."""
    if not is_dataclass(value):
        return "..." if " at 0x" in repr(value) else repr(value)
    own = {name: _written(getattr(value, name)) for name in inputs(type(value))}
    told = [f"{name}={text}" for name, text in own.items() if text != default_of(type(value), name)]
    return f"{type(value).__name__}({', '.join(told)})"


def _section(lines: list[str]) -> tuple[int, int]:
    """Where the section Parameters of a docstring is; where there is none, before the first section or at the end."""
    heads = [k - 1 for k, line in enumerate(lines) if k and line.strip() and set(line.strip()) == {"-"}]
    ends = [*heads[1:], len(lines)]
    for head, end in zip(heads, ends[: len(heads)], strict=True):
        if lines[head].strip() == "Parameters":
            return head, end
    place = heads[0] if heads else len(lines)
    return place, place


def _listed(cls: type, said: dict[str, str]) -> Iterator[str]:
    """Fields of one meaning in one entry: name, type and unit; what is said of them."""
    kinds = hints(cls)
    for (text, kind), several in groupby(inputs(cls), key=lambda name: (said.get(name, ""), kinds[name])):
        unit = Hint.of(kind, None).unit
        shown = f" [{unit}]" if unit and f"[{unit}]" not in text else ""
        yield f"{', '.join(f'**{name}**' for name in several)} : {brief(kind)}{shown}"
        yield f"    {text or '..'}"


def brief(hint: Any) -> str:
    """A type in a few words, with links to what the reference has."""
    kind = Hint.of(hint, None).type
    origin, inner = get_origin(kind), get_args(kind)
    if isinstance(kind, type) and kind in DOCUMENTED:
        return f":py:class:`~{DOCUMENTED[kind]}`"
    if origin in (Union, types.UnionType):
        return " | ".join(brief(option) for option in members(kind))
    if origin is Literal:
        return " | ".join(f'``"{word}"``' if isinstance(word, str) else f"``{word}``" for word in inner)
    if kind is np.ndarray or origin is np.ndarray:
        return "array"
    if origin is not None and inner and origin.__name__ != "Callable":
        return f"{origin.__name__}\\[{', '.join('...' if part is ... else brief(part) for part in inner)}]"
    if origin is not None:
        return "function"
    return "None" if kind is types.NoneType else getattr(kind, "__name__", str(kind))


def moved(app: Any, env: Any, node: Any, content: Any) -> Any:
    """The place of what is named by the module that defines it and documented by its public name."""
    thing = located(node.get("reftarget", ""))
    if not callable(thing) or thing not in DOCUMENTED:
        return None
    place = env.domains.python_domain
    return place.resolve_xref(env, node["refdoc"], app.builder, "obj", DOCUMENTED[thing], node, content)


def _of_source(function: Callable[..., Any]) -> tuple[str, str | None]:
    """Arguments and result as the source writes them, with links; without self."""
    tree = ast.parse(textwrap.dedent(inspect.getsource(function))).body[0]
    assert isinstance(tree, ast.FunctionDef)
    if tree.args.args and tree.args.args[0].arg in ("self", "cls"):
        del tree.args.args[0]
    linked = _Linked(function.__globals__)
    for argument in (*tree.args.args, *tree.args.kwonlyargs, *filter(None, (tree.args.vararg, tree.args.kwarg))):
        argument.annotation = argument.annotation and linked.visit(argument.annotation)
    return f"({ast.unparse(tree.args)})", tree.returns and ast.unparse(linked.visit(tree.returns))


def linked(thing: Any, name: str) -> str:
    """A type of a signature: documented classes as ``~module.Name``, unions of them spelt out, others by their name."""
    if isinstance(thing, types.UnionType):
        return " | ".join(linked(member, getattr(member, "__name__", str(member))) for member in members(thing))
    if get_origin(thing) is Annotated:
        return linked(get_args(thing)[0], get_args(thing)[0].__name__)
    return f"~{DOCUMENTED[thing]}" if isinstance(thing, type) and thing in DOCUMENTED else name


class _Linked(ast.NodeTransformer):
    """Annotations by :func:`linked`; Sphinx shows ``~module.Name`` as Name."""

    def __init__(self, names: Mapping[str, Any]) -> None:
        self.names = names

    def visit_Name(self, node: ast.Name) -> ast.AST:
        return ast.parse(linked(self.names.get(node.id), node.id), mode="eval").body

    def visit_Constant(self, node: ast.Constant) -> ast.AST:
        return self.visit(ast.parse(node.value, mode="eval").body) if isinstance(node.value, str) else node

    def visit_Subscript(self, node: ast.Subscript) -> ast.AST:
        return node if ast.unparse(node.value) == "Literal" else self.generic_visit(node)

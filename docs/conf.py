"""Sphinx configuration of the documentation: pages, reference and gallery, none of which needs the network."""

import sys
from importlib.metadata import version as installed
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "web" / "extensions"))

project = "softway"
author = "the softway developers"
copyright = author
release = version = installed("softway")
extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.mathjax",
    "sphinx-mathjax-offline",
    "sphinx_gallery.gen_gallery",
    "cyclopts.ext.sphinx",
    "fields",
    "keys",
    "written",
]
source_suffix = {".md": "markdown", ".rst": "restructuredtext"}
exclude_patterns = ["_build", "scripts", "web"]
nitpicky = True
nitpick_ignore_regex = [  # names of types that are no part of the reference
    ("py:class", r"(numpy|np|sp|collections|pyvista|pathlib|typing)\..*|Path|Callable|Iterator|Mapping|Sequence|Any"),
    (
        "py:class",
        r"(Int|Bool)?Array|ArrayLike|Second|Precision|Cancel|Watch|TimeWeight|Method|LawName|Law|Part|Units|Entrant",
    ),
    ("py:class", r"Side|BallGroup|CheckedRigid|CheckedHeat|Body|MotionLaw|Travel|Turn|Quality|Ranks|StepGroup"),
    ("py:class", r"Records|Modules|ImpactRule|TryWatch|Tell|MechanismWatch|Spin|Velocity|Direction|NoneType|npt\..*"),
]

myst_enable_extensions = ["dollarmath", "amsmath", "deflist"]
myst_heading_anchors = 3

autodoc_member_order = "bysource"
maximum_signature_line_length = 88
toc_object_entries_show_parents = "hide"

sphinx_gallery_conf = {
    "examples_dirs": "../examples/gallery",
    "gallery_dirs": "examples",
    "filename_pattern": r"\.py",
    "show_signature": False,
    "show_memory": False,
    "write_computation_times": False,
    "remove_config_comments": True,
    "abort_on_example_error": True,
    "only_warn_on_example_error": False,
    "download_all_examples": False,
    "reference_url": {"softway": None},
    "doc_module": ("softway",),
    "capture_repr": (),
    "reset_modules": ("matplotlib", "pictures.plain"),
    "subsection_order": [f"../examples/gallery/{name}" for name in ("impacts", "methods", "contact", "materials")],
    "within_subsection_order": "pictures.Order",
}

html_theme = "furo"
html_title = f"softway {release}"
html_show_sourcelink = False
html_copy_source = False
html_static_path = ["web/static"]
html_css_files = ["softway.css"]

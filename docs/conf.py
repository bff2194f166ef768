"""Sphinx configuration of the documentation."""

from importlib.metadata import version as installed

project = "softway"
author = "the softway developers"
copyright = author
release = version = installed("softway")
extensions = ["myst_parser", "sphinx.ext.mathjax"]
myst_enable_extensions = ["dollarmath", "amsmath", "deflist"]
myst_heading_anchors = 3
source_suffix = {".md": "markdown"}
exclude_patterns = ["_build"]
html_theme = "alabaster"
html_title = f"softway {release}"

"""What all tests share: pictures without a screen, and reproducible generated cases."""

import matplotlib as mpl
from hypothesis import settings

mpl.use("Agg")
settings.register_profile("softway", derandomize=True, deadline=None, max_examples=25, database=None)
settings.load_profile("softway")

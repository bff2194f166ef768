"""What all tests share: pictures without a screen, reproducible generated cases, processes that can be interrupted."""

import signal

import matplotlib as mpl
from hypothesis import settings

mpl.use("Agg")
settings.register_profile("softway", derandomize=True, deadline=None, max_examples=25, database=None)
settings.load_profile("softway")

if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:  # begun in the background: processes of tests would inherit it
    signal.signal(signal.SIGINT, signal.default_int_handler)

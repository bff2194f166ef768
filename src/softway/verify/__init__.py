"""The verification suite: cases with a reference, computed on the user's machine and compared.

To add a case X07:

1. ``data/X07.json``: ``id``, ``title`` (one line), ``definition`` (what is computed), ``reference`` (``source`` and
   whatever the reference consists of), and ``qoi``, a list of quantities: ``name``, ``value`` (a number or nested
   lists), ``tol_abs``, ``tol_rel`` or both (the larger counts), optionally ``mesh`` and, where softway is known to miss
   the tolerance, ``why``: a sentence with the cause.
2. ``cases/x07.py`` with ``compute() -> Outcome``: the values by the names of the file, and panels of curves for the
   report.  Scenes that several cases share are in ``scenes/``, motions known exactly in ``exact/``.
3. A line in ``catalogue.py`` with the seconds that it takes; those of at most ``QUICK`` seconds make ``--quick``.
4. Tests: ``tests/verification/test_catalogue.py`` runs cheap cases.  A case that a dedicated test computes too (so that
   more can be said about the same march) is named in its ``ELSEWHERE``; share marches through ``functools.cache`` on
   functions of the case's module.
"""

from softway.verify.case import Case, Outcome
from softway.verify.catalogue import chosen, listed
from softway.verify.quantity import Quantity, compared
from softway.verify.result import Result, examined
from softway.verify.suite import verified

__all__ = ["Case", "Outcome", "Quantity", "Result", "chosen", "compared", "examined", "listed", "verified"]

"""Verification suite: cases with a reference solution, computed on the user's machine and compared.

To add a case X07:

1. Write ``data/GROUP/X07.json``, with a folder such as ``contact`` for GROUP: ``id``, ``title`` (one line),
   ``definition`` (the problem), ``reference`` (``source`` and the data of the reference), and ``qoi``, a list of
   quantities: ``name``, ``value`` (a number or nested lists), ``tol_abs``, ``tol_rel`` or both (the larger tolerance
   is used), optionally ``mesh``. If softway is known to miss the tolerance, add ``why``: a sentence with the cause.
2. Write ``cases/GROUP/x07_subject.py`` with ``compute() -> Outcome``: the values by the names in the file, and panels
   of curves for the report. Scenes shared by several cases are in ``scenes/``, exact motions in ``exact/``.
3. Add the line ``"X07": (SECONDS, "GROUP.x07_subject")`` to ``CASES`` in ``catalogue.py``, with the computing time;
   cases of at most ``QUICK`` seconds belong to ``--quick``.
4. Add tests: ``tests/verification/test_catalogue.py`` runs the cheap cases. A case with a dedicated test, which checks
   more of the same march in ``tests/verification/GROUP/test_x07_subject.py``, is listed in its ``ELSEWHERE``; share
   marches through ``functools.cache`` on functions of the case's module.
"""

from softway.apps.verify.case import Case, Outcome
from softway.apps.verify.catalogue import chosen, listed
from softway.apps.verify.quantity import Quantity, compared
from softway.apps.verify.result import Result, examined
from softway.apps.verify.suite import verified

__all__ = ["Case", "Outcome", "Quantity", "Result", "chosen", "compared", "examined", "listed", "verified"]

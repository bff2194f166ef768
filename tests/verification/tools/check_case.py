"""Compare results with a verification case: ``python check_case.py CASE.json RESULTS.json``.

A case lists quantities of interest, as those of ``softway/verify/data``; results map their names to values.
"""

import json
import sys
from pathlib import Path

from softway.apps.verify import compared


def main(arguments: list[str]) -> int:
    """Print a table; 0 when something was compared and nothing failed."""
    if len(arguments) != 2:
        print(__doc__)
        return 2
    case, results = (json.loads(Path(a).read_text(encoding="utf-8")) for a in arguments)
    given = [quantity for quantity in compared(case, results) if quantity.value is not None]
    print(f"{case['id']}  {case['title']}")
    for q in compared(case, results):
        verdict = "not given" if q.value is None else "pass" if q.passed else "fail"
        print(f"  {verdict:9}  error {q.error:10.3e}  tolerance {q.tolerance:10.3e}  {q.name}")
    return 0 if given and all(quantity.passed for quantity in given) else 1


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))

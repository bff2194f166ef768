"""``python -m softway`` is the command ``softway``."""

from softway.apps.cli import main

if __name__ == "__main__":
    raise SystemExit(main())

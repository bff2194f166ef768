"""``python -m softway`` is the command ``softway``."""

from softway.cli import main

if __name__ == "__main__":
    raise SystemExit(main())

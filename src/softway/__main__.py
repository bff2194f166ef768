"""``python -m softway`` is the command ``softway``."""

import sys

INTERRUPTED = 130


def main() -> int:
    """Run the command line and return the exit code, also if it is interrupted while the package is loaded."""
    try:
        from softway.apps.cli import main as command

        return command()
    except KeyboardInterrupt:
        sys.stderr.write("interrupted\n")
        return INTERRUPTED


if __name__ == "__main__":
    raise SystemExit(main())

"""The command ``softway``."""

from softway.cli.commands import main as main

"""Command line ``softway``."""

from softway.apps.cli.commands import main as main

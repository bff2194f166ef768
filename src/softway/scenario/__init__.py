"""Scenarios: the description of a run as text, with reader, checks and writer."""

from softway.scenario.checks.check import Checked as Checked
from softway.scenario.checks.check import check as check
from softway.scenario.files import dump as dump
from softway.scenario.files import dumps as dumps
from softway.scenario.files import load as load
from softway.scenario.files import loads as loads
from softway.scenario.scenario import Scenario as Scenario

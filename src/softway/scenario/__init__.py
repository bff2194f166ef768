"""Scenarios: the text form of a run, read, checked and written."""

from softway.scenario.check import Checked as Checked
from softway.scenario.check import check as check
from softway.scenario.codec import dump as dump
from softway.scenario.codec import load as load
from softway.scenario.codec import loads as loads
from softway.scenario.codec import resolved as resolved
from softway.scenario.scenario import Scenario as Scenario

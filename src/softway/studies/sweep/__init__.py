"""Sweeps of a scenario over combinations of values, computed in processes or by Dask, with one result table."""

from softway.studies.sweep.rows import Row as Row
from softway.studies.sweep.rows import Sweep as Sweep
from softway.studies.sweep.sweep import sweep as sweep

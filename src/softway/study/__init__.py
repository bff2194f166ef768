"""A scenario over the product of some values: planned, computed in processes or by Dask, and put into one table."""

from softway.study.rows import Row as Row
from softway.study.rows import Sweep as Sweep
from softway.study.sweep import sweep as sweep

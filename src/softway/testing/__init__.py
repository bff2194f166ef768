"""Public checks for laws, elements, obstacles and solvers, including your own implementations."""

from softway.testing.elements import check_element as check_element
from softway.testing.examination import Finding as Finding
from softway.testing.laws import check_law as check_law
from softway.testing.laws import examine_law as examine_law
from softway.testing.obstacles import check_obstacle as check_obstacle
from softway.testing.solvers import check_solver as check_solver

__all__ = ["Finding", "check_element", "check_law", "check_obstacle", "check_solver", "examine_law"]

"""Public examinations: a law, an element or an obstacle of your own is checked as those of the package are."""

from softway.testing.elements import check_element as check_element
from softway.testing.laws import check_law as check_law
from softway.testing.obstacles import check_obstacle as check_obstacle

__all__ = ["check_element", "check_law", "check_obstacle"]

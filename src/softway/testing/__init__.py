"""Public examinations: a law or an element of your own is checked as those of the package are."""

from softway.testing.elements import check_element as check_element
from softway.testing.laws import check_law as check_law

__all__ = ["check_element", "check_law"]

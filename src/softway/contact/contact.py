"""The declaration of a contact: who may touch whom, and by which rule."""

from dataclasses import dataclass

from softway.contact.timing import Energy, Timing


@dataclass(frozen=True, slots=True, kw_only=True)
class Contact:
    """Unilateral frictionless contact of the nodes of a tag with a tool.

    Parameters
    ----------
    between
        ``("body.tag", "tool")``.
    name
        Used in the columns of the history; by default ``body.tag-tool``.
    timing
        What a touch does to the slab: :class:`Energy`, :class:`Impulse` or :class:`Paper`.

    Examples
    --------
    >>> Contact(between=("bar.right", "wall")).label
    'bar.right-wall'
    """

    between: tuple[str, str]
    name: str = ""
    timing: Timing = Energy()

    @property
    def label(self) -> str:
        """Name of the contact in records."""
        return self.name or f"{self.between[0]}-{self.between[1]}"

    @property
    def body(self) -> str:
        """Name of the deformable body."""
        return self.between[0].partition(".")[0]

    @property
    def tag(self) -> str:
        """Tag of the candidate nodes; the whole surface when none is given."""
        return self.between[0].partition(".")[2] or "surface"

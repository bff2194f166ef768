"""URDF text without the geometry, which rigid bodies do not need, and with a list of what nobody reads."""

from dataclasses import dataclass
from xml.etree import ElementTree

GEOMETRY = ("visual", "collision")
READ = {
    "robot": {"link", "joint"},
    "link": {"inertial", *GEOMETRY},
    "joint": {"parent", "child", "origin", "axis", "limit", "dynamics", "mimic"},
}
"""Elements that are read, below those of each name."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Stripped:
    """Text of a URDF file without geometry, and what it had besides, by name."""

    text: str
    left_out: tuple[str, ...]


def urdf_without_geometry(text: str) -> Stripped | None:
    """URDF text without visual and collision geometry; None for MJCF, or text that is no XML.

    Examples
    --------
    >>> urdf_without_geometry("<robot><link name='a'><visual/></link><gazebo/></robot>").left_out
    ("visual of the link 'a'", "'gazebo' of the robot")
    """
    try:
        root = ElementTree.fromstring(text)
    except ElementTree.ParseError:
        return None
    if root.tag != "robot":
        return None
    found = []
    for one in list(root):
        for part in list(one):
            if part.tag not in READ.get(one.tag, {part.tag}) or part.tag in GEOMETRY:
                found.append(f"{part.tag} of the {one.tag} {one.get('name', '')!r}")
            if part.tag in GEOMETRY:
                one.remove(part)
            if part.tag == "limit" and part.get("velocity"):
                found.append(f"velocity limit of the joint {one.get('name', '')!r}")
        if one.tag not in READ["robot"]:
            name = one.get("name")
            found.append(f"{one.tag!r} of the robot" + (f" ({name!r})" if name else ""))
    return Stripped(text=ElementTree.tostring(root, encoding="unicode"), left_out=tuple(found))

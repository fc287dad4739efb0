"""Texts made of parts, through Blender's catalogue: the template is looked up, then the parts are put in.

A text that is whole needs none of this where Blender looks it up itself: names and tooltips of classes and properties,
labels and buttons, and what operators report.
"""

import re

from bpy.app.translations import pgettext_iface, pgettext_rpt, pgettext_tip
from bpy.app.translations import pgettext_n as n_

NO_COLOR = n_("photo {photo} has no color at {x:g}, {y:g}; load the photo, pick inside it")
_NUMBER = re.compile(r"(?<![\w.])-?\d+(?:\.\d+)?(?![\w.]*\w)")


def label(template, **parts):
    """Return a text for panels and the status bar."""
    return pgettext_iface(template).format(**parts)


def told(template, **parts):
    """Return a text for reports."""
    return pgettext_rpt(template).format(**parts)


def tip(template, **parts):
    """Return a text for tooltips, of which why something cannot be done is a part."""
    return pgettext_tip(template).format(**parts)


def core_line(line):
    """Return a line that the core said; it is looked up with {} for its numbers: "Seed {} of {}".

    Where it is not found, a name before it stays as it is: "wall: Seed 1 of 50".
    """
    numbers = _NUMBER.findall(line)
    # Names in a line may hold braces.
    template = _NUMBER.sub("\0", line).replace("{", "{{").replace("}", "}}").replace("\0", "{}")
    found = pgettext_rpt(template)
    if found != template:
        return found.format(*numbers)
    name, colon, rest = line.partition(": ")
    return name + colon + core_line(rest) if colon else line

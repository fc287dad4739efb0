"""Texts made of parts, through Blender's catalog: the template is looked up, then the parts are put in.

A text that is whole needs none of this where Blender looks it up itself: names and tooltips of classes and properties,
labels and buttons, and what operators report.
"""

import re

from bpy.app.translations import pgettext_iface, pgettext_rpt, pgettext_tip
from bpy.app.translations import pgettext_n as n_

from ...reflcolor_addon.messages import translated

# "--grid angle, or Grid by Angle in the import dialog"; in other languages, too, the two are parted by a comma.
_OPTION = re.compile(r"--[a-z][^,;]*, (?:or|oder) ")

NO_COLOR = n_("photo {photo} has no color at {x:g}, {y:g}; load the photo, pick inside it")


def label(template, **parts):
    """Return a text for panels and the status bar."""
    return pgettext_iface(template).format(**parts)


def report_text(template, **parts):
    """Return a text for reports."""
    return pgettext_rpt(template).format(**parts)


def tip(template, **parts):
    """Return a text for tooltips, of which why something cannot be done is a part."""
    return pgettext_tip(template).format(**parts)


def shown(line):
    """Return a line of the core, a Message, as the window shows it: without the options of the command line.

    Where the core names an option and, after "or", what the window has instead, the latter is left.
    """
    return _OPTION.sub("", translated(line, pgettext_rpt))

"""Texts made of parts, through Blender's catalogue: the template is looked up, then the parts are put in.

A text that is whole needs none of this where Blender looks it up itself: names and tooltips of classes and properties,
labels and buttons, and what operators report.
"""

from bpy.app.translations import pgettext_iface, pgettext_rpt, pgettext_tip
from bpy.app.translations import pgettext_n as n_

from ...reflcolor_addon.messages import translated

NO_COLOR = n_("photo {photo} has no color at {x:g}, {y:g}; load the photo, pick inside it")


def label(template, **parts):
    """Return a text for panels and the status bar."""
    return pgettext_iface(template).format(**parts)


def told(template, **parts):
    """Return a text for reports."""
    return pgettext_rpt(template).format(**parts)


def tip(template, **parts):
    """Return a text for tooltips, of which why something cannot be done is a part."""
    return pgettext_tip(template).format(**parts)


def shown(line):
    """Return a line of the core, a Message, as the window shows it."""
    return translated(line, pgettext_rpt)

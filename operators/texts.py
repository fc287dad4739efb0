"""Texts made of parts, through Blender's catalogue: the template is looked up, then the parts are put in."""

from bpy.app.translations import pgettext_iface, pgettext_rpt


def label(template, **parts):
    """Return a text for panels, in the language of the interface."""
    return pgettext_iface(template).format(**parts)


def told(template, **parts):
    """Return a text for reports and the status bar, in their language."""
    return pgettext_rpt(template).format(**parts)

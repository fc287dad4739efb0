"""What the extension shows: the steps in the sidebars of the 3D View and the Image Editor."""

from ..operators.registration import Registration

# Panels are drawn in this order.
_registration = Registration(
    __package__,
    (
        "scan",
        "images",
        "seeds",
        "colorize",
        "messages",
        "compare",
        "looking",
        "provenance",
        "menus",
        "presets",
        "status_bar",
        "translations",
    ),
)
register, unregister = _registration.register, _registration.unregister

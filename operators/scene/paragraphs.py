"""Long texts in popups."""

import textwrap

POPUP_WIDTH, _LETTERS = 480, 76


def draw_paragraph(layout, text, icon):
    """Draw a text that is translated already over as many lines as it takes, in a popup of POPUP_WIDTH."""
    column = layout.column(align=True)
    for number, line in enumerate(textwrap.wrap(text, _LETTERS)):
        column.label(text=line, icon="BLANK1" if number else icon, translate=False)

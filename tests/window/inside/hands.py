"""Mouse and keyboard: events that go through Blender's own queue, as a person's do."""

import bpy

_BUTTONS = {"LEFT": "LEFTMOUSE", "MIDDLE": "MIDDLEMOUSE", "RIGHT": "RIGHTMOUSE"}
# A person's hand: a press and a move of this many steps is a drag, not a click.
_STEPS = 8


class Hands:
    """Places are (x, y) in pixels of the window, from its bottom left. Every act is a generator: ``yield from`` it.

    Attributes
    ----------
    presses : int
        How often a mouse button or a key was pressed.
    """

    def __init__(self):
        self._at = (0, 0)
        self.presses = 0

    @property
    def bpy_window(self):
        """The window that the hands work in: the one opened last."""
        return bpy.context.window_manager.windows[-1]

    def move(self, place, turns=2):
        """Move the mouse to a place, and let Blender's event loop turn."""
        self._at = (round(place[0]), round(place[1]))
        self._event("MOUSEMOVE", "NOTHING")
        yield from self._turns(turns)

    def click(self, place, button="LEFT", **held):
        """Click at a place, with keys held: ``shift=True``, ``ctrl=True``, ``alt=True``."""
        yield from self.move(place)
        yield from self._hold(held)
        self._event(_BUTTONS[button], "PRESS", **held)
        self.presses += 1
        yield from self._turns(1)
        self._event(_BUTTONS[button], "RELEASE", **held)
        yield from self._turns(2)
        yield from self._let_go(held)

    def drag(self, start, end, button="LEFT", steps=_STEPS, through=(), **held):
        """Press at a place, move to another, by way of others if need be, and release there."""
        yield from self.move(start)
        yield from self._hold(held)
        self._event(_BUTTONS[button], "PRESS", **held)
        self.presses += 1
        yield from self._turns(1)
        for place in (*through, end):
            x, y = self._at
            for step in range(1, steps + 1):
                part = step / steps
                self._at = (round(x + (place[0] - x) * part), round(y + (place[1] - y) * part))
                self._event("MOUSEMOVE", "NOTHING", **held)
                yield from self._turns(1)
        self._event(_BUTTONS[button], "RELEASE", **held)
        yield from self._turns(2)
        yield from self._let_go(held)

    def key(self, name, text="", **held):
        """Press and release a key by Blender's name for it ("Z", "ESC", "RET"), where the mouse is."""
        yield from self._hold(held)
        self._event(name, "PRESS", unicode=text, **held)
        self.presses += 1
        yield from self._turns(1)
        self._event(name, "RELEASE", **held)
        yield from self._turns(2)
        yield from self._let_go(held)

    def type(self, text):
        """Type a text into the field that has the cursor."""
        for letter in text:
            name = letter.upper() if letter.isalpha() and letter.isascii() else _KEYS[letter]
            yield from self.key(name, text=letter)

    def wheel(self, place, turns, **held):
        """Turn the wheel over a place; up is positive."""
        yield from self.move(place)
        yield from self._hold(held)
        for _ in range(abs(turns)):
            self._event("WHEELUPMOUSE" if turns > 0 else "WHEELDOWNMOUSE", "PRESS", **held)
            yield from self._turns(1)
        yield from self._let_go(held)

    def _hold(self, held):
        """Press the keys to be held: by them, not by the mouse's events, Blender knows what is held in a drag."""
        for name in held:
            self._event(f"LEFT_{name.upper()}", "PRESS", **{name: True})
            yield from self._turns(1)

    def _let_go(self, held):
        for name in held:
            self._event(f"LEFT_{name.upper()}", "RELEASE")
            yield from self._turns(1)

    def _event(self, kind, value, **more):
        x, y = self._at
        self.bpy_window.event_simulate(kind, value, x=x, y=y, **more)

    def _turns(self, count):
        """Let Blender's event loop turn, so that what is in its queue is done."""
        for _ in range(count):
            yield 0.0


_KEYS = {".": "PERIOD", "-": "MINUS", "/": "SLASH", ",": "COMMA", " ": "SPACE"}
_KEYS |= {"0": "ZERO", "1": "ONE", "2": "TWO", "3": "THREE", "4": "FOUR"}
_KEYS |= {"5": "FIVE", "6": "SIX", "7": "SEVEN", "8": "EIGHT", "9": "NINE"}

"""Plots of error against number of seeds."""

import math

import numpy as np

from .scenes import COUNTS

# BGR, and the methods from the weakest to the strongest.
_COLORS = {
    "Enhanced": (190, 110, 30),
    "constant": (160, 160, 160),
    "linear": (60, 160, 200),
    "Levin, three channels": (40, 40, 200),
    "Natural": (0, 0, 0),
}
_LEADING = "Natural"
_WIDTH, _HEIGHT, _MARGIN, _COLUMNS = 330, 250, 44, 4
_SCALE = 2


def draw(results, folder):
    """Draw one panel for each scan into FOLDER/quality.png."""
    import cv2

    names = list(dict.fromkeys(result["scan"] for result in results))
    panels = [_panel(name, [r for r in results if r["scan"] == name]) for name in names] + [_legend()]
    columns = min(_COLUMNS, len(panels))
    panels += [np.full_like(panels[0], 255)] * (-len(panels) % columns)
    rows = [np.hstack(panels[start : start + columns]) for start in range(0, len(panels), columns)]
    folder.mkdir(parents=True, exist_ok=True)
    if not cv2.imwrite(str(folder / "quality.png"), np.vstack(rows)):
        raise OSError(f"{folder / 'quality.png'}: cannot be written")


def _panel(name, results):
    import cv2

    image = np.full((_HEIGHT * _SCALE, _WIDTH * _SCALE, 3), 255, np.uint8)
    errors = {method: [r["figures"][method]["as_is"]["ciede2000_mean"] for r in results] for method in _COLORS}
    low = math.floor(min(map(min, errors.values())) * 2) / 2
    high = math.ceil(max(map(max, errors.values())) * 2) / 2
    right, bottom = _WIDTH - 14, _HEIGHT - _MARGIN + 8

    def place(seeds, error):
        across = math.log(seeds / min(COUNTS)) / math.log(max(COUNTS) / min(COUNTS))
        up = (error - low) / (high - low)
        return tuple(round(_SCALE * v) for v in (_MARGIN + across * (right - _MARGIN - 8), bottom - up * (bottom - 34)))

    step = next(step for step in (0.5, 1.0, 2.0, 5.0, 10.0) if high - low <= 8 * step)
    for tick in np.arange(low, high + 1e-9, step):
        y = place(min(COUNTS), tick)[1]
        cv2.line(image, (_MARGIN * _SCALE, y), (right * _SCALE, y), (225, 225, 225), 1)
        _text(image, f"{tick:g}", (10, y / _SCALE + 4))
    for count in COUNTS:
        x = place(count, low)[0] / _SCALE
        _text(image, f"{count}", (x - 10, bottom + 16))
    _text(image, f"{name}: CIEDE2000 over seeds", (_MARGIN, 20), bold=True)
    for method, color in _COLORS.items():
        points = [place(result["count"], error) for result, error in zip(results, errors[method], strict=True)]
        cv2.polylines(image, [np.array(points)], False, color, 5 if method == _LEADING else 3, cv2.LINE_AA)
    return image


def _legend():
    import cv2

    image = np.full((_HEIGHT * _SCALE, _WIDTH * _SCALE, 3), 255, np.uint8)
    for index, (method, color) in enumerate(_COLORS.items()):
        y = 50 + 28 * index
        ends = [(round(x * _SCALE), round((y - 4) * _SCALE)) for x in (_MARGIN, _MARGIN + 40)]
        cv2.line(image, *ends, color, 5 if method == _LEADING else 3, cv2.LINE_AA)
        _text(image, method, (_MARGIN + 52, y))
    return image


def _text(image, text, place, *, bold=False):
    import cv2

    place = tuple(round(v * _SCALE) for v in place)
    cv2.putText(image, text, place, cv2.FONT_HERSHEY_SIMPLEX, 0.42 * _SCALE, (0, 0, 0), 2 if bold else 1, cv2.LINE_AA)

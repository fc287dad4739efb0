"""Whether a JSON text is whole."""

import json

from .fault import Fault


def check_json(file, size):
    """JSON in UTF-8 that can be parsed to its end, with no number that JSON has no word for."""
    try:
        json.loads(file.read().decode("utf-8-sig"), parse_constant=_refuse)
    except ValueError:
        raise Fault("it is not complete JSON text") from None


def _refuse(name):
    raise ValueError(name)

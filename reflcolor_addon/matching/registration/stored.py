"""Registrations as JSON, so that what was found out about a photo need not be found out again."""

import math
from dataclasses import asdict, fields

import numpy as np

from ..models import Camera, GridHomography
from .registration import Registration
from .verification import Evidence


def as_document(registration):
    """Return a `Registration` as what JSON can hold."""
    model = registration.model
    described = None
    if model is not None:
        values = {field.name: getattr(model, field.name) for field in fields(model)}
        described = {"kind": model.kind} | {
            name: value.tolist() if isinstance(value, np.ndarray) else value for name, value in values.items()
        }
    return {
        "model": described,
        "evidence": asdict(registration.evidence),
        "found_by": registration.found_by,
        "untestable": registration.untestable,
    }


def from_document(document):
    """Return the `Registration` that `as_document` described.

    Raises
    ------
    ValueError
        If the document is none that `as_document` made.
    """
    try:
        model = document["model"]
        if model is not None:
            kind, values = model["kind"], {name: value for name, value in model.items() if name != "kind"}
            of_kind = {Camera.kind: Camera, GridHomography.kind: GridHomography}[kind]
            model = of_kind(**{name: _value(value) for name, value in values.items()})
        evidence = Evidence(**document["evidence"])
        numbers = [value for value in asdict(evidence).values() if isinstance(value, float)]
        if not all(map(math.isfinite, numbers)):
            raise ValueError("evidence holds a number that is not finite")
        return Registration(model, evidence, document["found_by"], document["untestable"])
    except (KeyError, TypeError) as error:
        raise ValueError(f"no registration: {error}") from error


def _value(value):
    # A grid's shape is a list of two whole numbers; every other list is an array.
    if isinstance(value, list):
        whole = all(isinstance(entry, int) for entry in value)
        return tuple(value) if whole else np.array(value, np.float64)
    return value

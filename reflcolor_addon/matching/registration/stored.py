"""Registrations as JSON, so that a photo need not be registered again."""

import math
from dataclasses import asdict, fields

import numpy as np

from ..models import Camera, GridHomography
from .registration import Registration
from .verification import Evidence


def as_document(registration):
    """Return a `Registration` as values that JSON can hold."""
    return {
        "model": None if registration.model is None else model_document(registration.model),
        "evidence": asdict(registration.evidence),
        "found_by": registration.found_by,
        "untestable": registration.untestable,
        "beside": registration.beside,
    }


def from_document(document):
    """Return the `Registration` that `as_document` described.

    Raises
    ------
    ValueError
        If `as_document` did not make the document.
    """
    try:
        model = None if document["model"] is None else model_of(document["model"])
        evidence = Evidence(**document["evidence"])
        numbers = [value for value in asdict(evidence).values() if isinstance(value, float)]
        if not all(map(math.isfinite, numbers)):
            raise ValueError("evidence holds a number that is not finite")
        return Registration(model, evidence, document["found_by"], document["untestable"], document["beside"])
    except (KeyError, TypeError) as error:
        raise ValueError(f"no registration: {error}") from error


def model_document(model):
    """Return a Camera or GridHomography as values that JSON can hold."""
    values = {field.name: getattr(model, field.name) for field in fields(model)}
    return {"kind": model.kind} | {
        name: value.tolist() if isinstance(value, np.ndarray) else value for name, value in values.items()
    }


def model_of(document):
    """Return the model that `model_document` described; raises KeyError, TypeError or ValueError if it did not."""
    values = {name: value for name, value in document.items() if name != "kind"}
    of_kind = {Camera.kind: Camera, GridHomography.kind: GridHomography}[document["kind"]]
    return of_kind(**{name: _value(value) for name, value in values.items()})


def _value(value):
    # A grid's shape is a list of two whole numbers; every other list is an array.
    if isinstance(value, list):
        whole = all(isinstance(entry, int) for entry in value)
        return tuple(value) if whole else np.array(value, np.float64)
    return value

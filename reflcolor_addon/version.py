"""The version of the package; the extension's manifest says the same."""

__version__ = "0.1.0"

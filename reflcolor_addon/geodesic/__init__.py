"""Geodesic distances over reflectance and range, and the weighted mean over seeds (eq. 1 to 6)."""

"""A virtual laser scanner and a virtual camera, for scans whose true colors are known."""

"""What a format is: one module with a `FORMAT`, listed in this package."""

from collections.abc import Callable
from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Format:
    """A kind of scan file.

    Parameters
    ----------
    name : str
    suffixes : tuple of str
        Lower case, with the dot.
    read : callable
        Called as ``read(file, path, options=, outside=, progress=, cancelled=)`` with the open binary file; returns a
        list of Scan, raises ScanError or Cancelled.
    pixels : callable
        Called as ``pixels(file, path, options=, outside=)``; returns how many pixels each scan has, as far as the
        file's header tells without its points being read. Raises ScanError where the header alone shows that it cannot
        be read.
    sniff : callable or None
        Called with the first bytes of a file; True where they can be no other format's. None for plain numbers.
    about : str
        What is read of it, in a line.
    """

    name: str
    suffixes: tuple[str, ...]
    read: Callable
    pixels: Callable
    sniff: Callable | None
    about: str


REFUSED = {
    ".fls": "FARO: open it in FARO SCENE and export it as E57 (structured) or PTX",
    ".lsproj": "FARO: open it in FARO SCENE and export it as E57 (structured) or PTX",
    ".fws": "FARO: open it in FARO SCENE and export it as E57 (structured) or PTX",
    ".zfs": "Zoller + Froehlich: open it in LaserControl and export it as E57 (structured) or PTX",
    ".zfprj": "Zoller + Froehlich: open it in LaserControl and export it as E57 (structured) or PTX",
    ".rdbx": "RIEGL: export it from RiSCAN PRO or RiPROCESS as E57 with rows and columns",
    ".rxp": "RIEGL: export it from RiSCAN PRO or RiPROCESS as E57 with rows and columns",
    ".rdb": "RIEGL: export it from RiSCAN PRO or RiPROCESS as E57 with rows and columns",
    ".3dd": "RIEGL: export it from RiSCAN PRO or RiPROCESS as E57 with rows and columns",
    ".rcp": "Autodesk: export its scans from ReCap as E57 or PTS",
    ".rcs": "Autodesk: export its scans from ReCap as E57 or PTS",
    ".ptg": "Leica: open it in Cyclone and export it as PTX or E57 (structured)",
    ".imp": "Leica: open it in Cyclone and export it as PTX or E57 (structured)",
    ".lgs": "Leica: open it in Cyclone and export it as PTX or E57 (structured)",
    ".lgsx": "Leica: open it in Cyclone and export it as PTX or E57 (structured)",
    ".tzf": "Trimble: open it in RealWorks and export it as E57 (gridded) or PTX",
    ".rwp": "Trimble: open it in RealWorks and export it as E57 (gridded) or PTX",
    ".clr": "Topcon: open it in ScanMaster or Magnet Collage and export it as E57 or PTX",
    ".pcap": "packets of a spinning lidar: save its frames with the maker's tools as NumPy arrays or PCD",
    ".bag": "a recording of ROS: save its frames as organized PCD or NumPy arrays",
    ".cpe": "Callidus: open it in 3D-Extractor and export it as PTX or PTS",
}
"""Formats that are not supported, with the way to export from each maker's program, by suffix."""

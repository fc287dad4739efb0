"""How noisy pictures are, and what they take: python -m benchmarks.picture_samples [--samples 256]

The scan `doria`, enlarged to 760 x 1135 pixels, is rendered as Set Up Render leaves it, with 8 to 16 samples that
Cycles computes, and as many that it takes from a table. Printed are the processor time of each render, and how far the
picture is from one of many computed samples: root mean square, in levels of 255. Needs the extension built (`make
build`).
"""

import argparse
import resource
import sys
import tempfile
from pathlib import Path

import numpy as np

from benchmarks import geodesic_cases
from benchmarks.experiments.meshes import Renderer
from benchmarks.geodesic_tables import head, row

COMPUTED, TABLE = "AUTOMATIC", "TABULATED_SOBOL"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--samples", type=int, default=256, help="of the picture that the others are compared with")
    many = parser.parse_args().samples
    with tempfile.TemporaryDirectory() as folder:
        renderer = Renderer(Path(folder))
        renderer.picture([geodesic_cases.whole_scan("doria", 1, (760, 1135))])
        _, reference = _rendered(renderer, COMPUTED, many)
        head(f"Pictures of doria, to one of {many} samples", "samples", "from", "seconds", "levels")
        for samples in (8, 12, 16):
            for pattern in (COMPUTED, TABLE):
                seconds, picture = _rendered(renderer, pattern, samples)
                away = np.sqrt(np.mean((picture.astype(float) - reference) ** 2))
                row(samples, "a table" if pattern == TABLE else "Cycles", f"{seconds:.1f}", f"{away:.3f}")
    sys.stdout.flush()
    renderer.end(0)


def _rendered(renderer, pattern, samples):
    """Processor time of a render, and its picture."""
    import bpy

    bpy.context.scene.cycles.sampling_pattern, bpy.context.scene.cycles.samples = pattern, samples
    before = _processor()
    picture = renderer.taken()
    return _processor() - before, picture


def _processor():
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


if __name__ == "__main__":
    main()

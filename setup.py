"""The build of `pip install .`: the package, with the native kernel compiled for this machine beside it.

All else about the package is in pyproject.toml.
"""

import shutil
import sys
from pathlib import Path

from setuptools import Distribution, setup
from setuptools.command.bdist_wheel import bdist_wheel
from setuptools.command.build_py import build_py

sys.path.insert(0, str(Path(__file__).parent / "kernel"))
import build as kernel


class WithKernel(Distribution):
    """Says that the package holds native code."""

    def has_ext_modules(self):
        return True


class BuildWithKernel(build_py):
    """Puts the package ``reflcolor_kernel`` beside ours."""

    def run(self):
        # What an earlier build has left there would go into the wheel.
        shutil.rmtree(self.build_lib, ignore_errors=True)
        super().run()
        folder = Path(self.build_lib, "reflcolor_kernel").resolve()
        folder.mkdir(parents=True)
        platform = kernel.host_platform()
        kernel.compile_library(platform, folder / kernel.TARGETS[platform][1])
        (folder / "__init__.py").write_text(kernel.module_source(platform), "utf-8")


class WheelOfThisPlatform(bdist_wheel):
    """A wheel for any Python of this platform: the kernel is called through ctypes."""

    def get_tag(self):
        return "py3", "none", kernel.host_platform()


setup(
    distclass=WithKernel,
    cmdclass={"build_py": BuildWithKernel, "bdist_wheel": WheelOfThisPlatform},
    options={"build": {"build_base": "build/package"}},
)

# SPDX-License-Identifier: MIT
"""The tests import the pipeline's modules, which are the folder above."""

import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))

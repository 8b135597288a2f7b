"""Draw the figure of a run into its folder: python analyse.py RUN_FOLDER"""

import sys
from pathlib import Path

# One script serves all shear experiments: one folder up, or beside this one in a copy.
HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE), str(HERE.parent)]

import shear_figures

shear_figures.main()

"""Runs the program `halflight` as ``python -m halflight``."""
import sys

from .program import main

sys.exit(main())

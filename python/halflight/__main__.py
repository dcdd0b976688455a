"""``python -m halflight``: the program."""
import sys

from .program import main

sys.exit(main())

"""Counted checks: the first that fails ends the test with its line."""
import sys

count = 0


def check(condition, what):
    """Ends the test where the condition is false; what: what was expected."""
    global count
    count += 1
    if not condition:
        sys.exit(f"FAILED: {what}")

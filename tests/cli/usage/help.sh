# Help goes to standard output, names every command, and is the same in all spellings.
halflight --help >help
grep -q '^  render INPUT ' help
grep -q '^  info \[FILE\] ' help
grep -q '^  make SHAPE ' help
grep -q '^  diff A B ' help
grep -q '^  bench \[INPUT \.\.\.\] ' help
grep -q '^  view INPUT ' help
halflight help | cmp help -
halflight -h | cmp help -

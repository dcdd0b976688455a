# A file name cannot break the one line of an error, nor steer the terminal.
halflight info "$(printf 'a\033b.nrrd')"

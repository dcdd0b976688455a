[ -w /dev/full ] || { echo "no /dev/full here"; exit 77; }
halflight help render >/dev/full

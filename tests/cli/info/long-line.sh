# Formats are told apart by the first 1024 bytes. A line of 60,000 is refused like any other file.
head -c 60000 /dev/zero | tr '\0' a >long.txt
halflight info long.txt 2>&1 | cut -c 1-47

halflight make sphere --size 512 --max-memory 16M

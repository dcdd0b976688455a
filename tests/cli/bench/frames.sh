halflight bench --frames 0

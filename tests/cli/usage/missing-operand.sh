halflight render --json

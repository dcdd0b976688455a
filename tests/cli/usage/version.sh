halflight --version

halflight help rendering

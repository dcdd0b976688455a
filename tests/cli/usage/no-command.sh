halflight 

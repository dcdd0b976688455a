echo "{\"shapes\": [{\"type\": \"sphere\", \"radius\": -1}]}" >ball.json
halflight make ball.json

halflight diff nowhere.png nowhere.png

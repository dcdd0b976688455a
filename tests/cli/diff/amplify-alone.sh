halflight diff a.npy b.npy --amplify 3

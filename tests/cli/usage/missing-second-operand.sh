halflight diff a.npy

echo b >b.npy
halflight diff a.npy b.npy -o ./b.npy

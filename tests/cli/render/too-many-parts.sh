tool ball 16 ball_16x16x16_uint8.raw
halflight render ball_16x16x16_uint8.raw --quiet --light-size 25 --soft-method sublights --light-samples 64 --size 1024x1024 -o out.npy

tool ball 32 ball_32x32x32_uint8.raw
halflight info ball_32x32x32_uint8.raw --max-memory 8K
